#include "sidestep/bench/report/figure.h"

#include <fmt/core.h>

#include <filesystem>
#include <stdexcept>

#include "sidestep/core/number_text.h"

namespace sidestep::bench {
namespace {

constexpr const char* kNotFinite = "NaN";

// Text in single quotes, as gnuplot reads it: nothing in it is special but the quote.
std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
  return quoted + "'";
}

std::string PlotNumber(double value) { return FiniteText("{:.10g}", value, kNotFinite); }

std::string BlockName(std::size_t panel, std::size_t series) {
  return "$p" + std::to_string(panel) + "_" + std::to_string(series);
}

void WriteData(std::string& script, const Series& series, const std::string& block) {
  const bool has_band = !series.low.empty();
  if (series.x.size() != series.y.size() || series.low.size() != series.high.size() ||
      (has_band && series.low.size() != series.x.size())) {
    throw std::invalid_argument("ToGnuplot: a series' columns differ in length");
  }
  script += block + " << EOD\n";
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    script += PlotNumber(series.x[i]);
    for (const double value : {series.y[i], has_band ? series.low[i] : series.y[i],
                               has_band ? series.high[i] : series.y[i]}) {
      script += " " + PlotNumber(value);
    }
    script += "\n";
  }
  script += "EOD\n";
}

std::string Look(const Series& series) {
  const std::string color = " lc rgb '" + FigureColor(series.color) + "'";
  switch (series.style) {
    case Series::Style::kLine:
      return "with linespoints pt 7 ps 0.6 lw 2" + color;
    case Series::Style::kPlainLine:
      return "with lines lw 2" + color;
    case Series::Style::kOpenPoints:
      return "with points pt 6 ps 1.3 lw 1.5" + color;
    case Series::Style::kBars:
      return "with yerrorbars pt 7 ps 0.8 lw 1.5" + color;
  }
  return "";
}

void WritePanel(std::string& script, const Panel& panel, std::size_t index) {
  script += "set title " + Quoted(panel.title) + "\nset xlabel " + Quoted(panel.x_label) +
            " offset 0,0.4\nset ylabel " + Quoted(panel.y_label) + "\n" +
            (panel.log_x ? "set" : "unset") + " logscale x\n" + (panel.log_y ? "set" : "unset") +
            " logscale y\n";
  if (panel.x_names.empty()) {
    script += "set xtics auto\nset xrange [*:*]\n";
  } else {
    std::string names;
    for (std::size_t i = 0; i < panel.x_names.size(); ++i) {
      names += (i == 0 ? "" : ", ") + Quoted(panel.x_names[i]) + " " + std::to_string(i);
    }
    script += "set xtics (" + names +
              ")\nset xrange [-0.5:" + PlotNumber(static_cast<double>(panel.x_names.size()) - 0.5) +
              "]\n";
  }
  if (panel.y_range.size() == 2) {
    script +=
        "set yrange [" + PlotNumber(panel.y_range[0]) + ":" + PlotNumber(panel.y_range[1]) + "]\n";
  } else {
    script += "set yrange [*:*]\n";
  }
  std::string separator = "plot ";
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    if (panel.series[i].low.empty() || panel.series[i].style == Series::Style::kBars) continue;
    script += separator + BlockName(index, i) + " using 1:3:4 with filledcurves fs transparent " +
              "solid 0.10 noborder lc rgb '" + FigureColor(panel.series[i].color) + "' notitle";
    separator = ", \\\n     ";
  }
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const Series& series = panel.series[i];
    script += separator + BlockName(index, i) + " using " +
              (series.style == Series::Style::kBars ? "1:2:3:4 " : "1:2 ") + Look(series) + " " +
              (series.title.empty() ? "notitle" : "title " + Quoted(series.title));
    separator = ", \\\n     ";
  }
  script += "\n";
}

}  // namespace

std::string FigureColor(int color) {
  // Okabe and Ito's colours, which the colour-blind can tell apart.
  constexpr const char* kPalette[] = {"#999999", "#d55e00", "#0072b2", "#009e73",
                                      "#cc79a7", "#e69f00", "#56b4e9", "#000000"};
  constexpr int kColors = static_cast<int>(std::size(kPalette));
  return kPalette[((color % kColors) + kColors) % kColors];
}

std::string ToGnuplot(const Figure& figure, const std::string& stem) {
  std::string script;
  for (std::size_t p = 0; p < figure.panels.size(); ++p) {
    for (std::size_t s = 0; s < figure.panels[p].series.size(); ++s) {
      WriteData(script, figure.panels[p].series[s], BlockName(p, s));
    }
  }
  const int columns = figure.columns;
  const int rows = (static_cast<int>(figure.panels.size()) + columns - 1) / columns;
  const int width = columns * figure.panel_width_px, height = rows * figure.panel_height_px;
  script +=
      "set encoding utf8\n"
      "set grid lc rgb '#dddddd' lt 1 lw 0.5\n"
      "set border 3 lc rgb '#444444'\n"
      "set tics nomirror\n"
      "set format y '%g'\n"
      "set key outside bottom center horizontal samplen 2 height 1\n";
  for (const char* const terminal : {"svg", "png"}) {
    const std::string device = terminal == std::string("svg") ? "svg" : "pngcairo";
    const std::string file = std::filesystem::path(stem + "." + terminal).filename().string();
    script += fmt::format(
        "set terminal {} noenhanced size {},{} background rgb 'white' font 'sans-serif,12'\n"
        "set output {}\nset multiplot layout {},{}\n",
        device, width, height, Quoted(file), rows, columns);
    for (std::size_t p = 0; p < figure.panels.size(); ++p) WritePanel(script, figure.panels[p], p);
    script += "unset multiplot\nunset output\n";
  }
  return script;
}

}  // namespace sidestep::bench
