// Figures and pages.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "sidestep/bench/report/figure.h"
#include "sidestep/bench/report/gnuplot.h"
#include "sidestep/bench/report/html_page.h"
#include "sidestep/core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::bench::report_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

Figure Sample() {
  Series curve;
  curve.title = "it's";
  curve.x = {1, 2, 3};
  curve.y = {0.5, NAN, 2};
  curve.low = {0.4, NAN, 1};
  curve.high = {0.6, NAN, 3};
  Series rings;
  rings.style = Series::Style::kOpenPoints;
  rings.x = {1};
  rings.y = {4};
  Figure figure;
  figure.panels = {{"one", "x", "y", false, {0, 5}, {curve, rings}},
                   {"two", "x", "y", true, {}, {curve}}};
  figure.columns = 2;
  return figure;
}

TEST(Figure, WritesItsDataIntoTheScript) {
  const std::string script = ToGnuplot(Sample(), "folder/name");
  EXPECT_THAT(script, AllOf(HasSubstr("1 0.5 0.4 0.6\n2 NaN NaN NaN\n"), HasSubstr("'it''s'"),
                            HasSubstr("set output 'name.svg'"), HasSubstr("set yrange [0:5]"),
                            HasSubstr("notitle"), Not(HasSubstr("folder"))));
}

TEST(Figure, RefusesColumnsOfDifferentLengths) {
  Figure figure = Sample();
  figure.panels[0].series[0].y.pop_back();
  EXPECT_THROW(ToGnuplot(figure, "name"), std::invalid_argument);
  figure = Sample();
  figure.panels[0].series[0].low.pop_back();
  EXPECT_THROW(ToGnuplot(figure, "name"), std::invalid_argument);
}

TEST(Figure, IsDrawnAsSvgAndPng) {
  ASSERT_NE(GnuplotVersion(), "") << kGnuplotRemedy;
  const TemporaryFolder folder;
  const std::string stem = folder.path() / "it's a figure";
  ASSERT_TRUE(DrawFigure(Sample(), stem));
  std::ifstream svg(stem + ".svg");
  const std::string text{std::istreambuf_iterator<char>(svg), {}};
  EXPECT_THAT(text, AllOf(HasSubstr("<svg"), HasSubstr("it's"), HasSubstr("</svg>")));
  std::ifstream png(stem + ".png", std::ios::binary);
  std::string magic(4, ' ');
  png.read(magic.data(), 4);
  EXPECT_EQ(magic, "\x89PNG");
}

TEST(HtmlPage, EscapesTextAndStandsAlone) {
  const TemporaryFolder folder;
  const std::string svg = folder.path() / "page.svg";
  std::ofstream(svg) << "<svg id=\"a\">#</svg>\n";
  HtmlPage page("a < b");
  page.Heading("x & y");
  page.Table({{"name", "<1>"}, {"\"q\"", "2"}});
  page.Paragraph("caf\xC3\xA9, caf\xE9");
  page.Picture(svg, "what it shows");
  EXPECT_THAT(page.ToText(),
              AllOf(HasSubstr("<title>a &lt; b</title>"), HasSubstr("<p>caf\xC3\xA9, caf\\xE9</p>"),
                    HasSubstr("<h2>x &amp; y</h2>"), HasSubstr("<td>&quot;q&quot;</td><td>2</td>"),
                    HasSubstr("src=\"data:image/svg+xml,%3Csvg id=%22a%22%3E%23%3C/svg%3E%0A\"")));
  EXPECT_THROW(page.Picture("/nowhere.svg", ""), InputError);
}

}  // namespace
}  // namespace sidestep::bench::report_test
