#include "sidestep/core/number_text.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include "sidestep/core/random.h"

namespace sidestep::number_text_test {
namespace {

TEST(ShortestText, ReadsBackToTheSameBits) {
  RandomStream random(1, "numbers");
  for (int i = 0; i < 100000; ++i) {
    const auto value = std::bit_cast<double>(random.Bits());
    if (std::isnan(value)) continue;
    const std::string text = ShortestText(value);
    ASSERT_EQ(std::strtod(text.c_str(), nullptr), value) << text;
  }
}

TEST(ShortestText, IsWhatFilesHaveAlwaysHeld) {
  const struct {
    double value;
    const char* text;
  } cases[] = {{0, "0"},
               {-0.0, "-0"},
               {0.1, "0.1"},
               {1e5, "1e+05"},
               {123456, "123456"},
               {1e-7, "1e-07"},
               {1.0 / 3, "0.3333333333333333"},
               {INFINITY, "inf"},
               {-INFINITY, "-inf"},
               {5e-324, "5e-324"}};
  for (const auto& c : cases) EXPECT_EQ(ShortestText(c.value), c.text);
}

TEST(FiniteText, ShowsWhatIsNoNumberAsToldTo) {
  EXPECT_EQ(FiniteText("{:.1f} s", 2.25), "2.2 s");
  EXPECT_EQ(FiniteText("{:.3g}", 1234.5), "1.23e+03");
  for (const double value : {double{NAN}, double{INFINITY}, -double{INFINITY}}) {
    EXPECT_EQ(FiniteText("{:.1f} s", value), "-");
    EXPECT_EQ(FiniteText("{:.1f} s", value, "never"), "never");
  }
}

}  // namespace
}  // namespace sidestep::number_text_test
