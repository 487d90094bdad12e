#pragma once

#include <string>
#include <vector>

namespace sidestep::bench {

/// One curve of a panel.
struct Series {
  enum class Style {
    kLine,        ///< a line through its points, which are marked
    kPlainLine,   ///< a line alone
    kOpenPoints,  ///< rings alone: what is compared with
    kBars         ///< points alone, with bars from low to high
  };
  std::string title;  ///< for the key; empty: not listed
  Style style = Style::kLine;
  int color = 0;                  ///< of the figure's palette; equal numbers, equal colours
  std::vector<double> x, y;       ///< as many of both; points that are not finite are left out
  std::vector<double> low, high;  ///< empty, or bounds of y, drawn as a band or bars
};

/// One pair of axes.
struct Panel {
  std::string title, x_label, y_label;
  bool log_y = false;
  std::vector<double> y_range;  ///< empty: as the data want; else two numbers
  std::vector<Series> series;
  bool log_x = false;
  /// What x = 0, 1, 2, ... are called; empty: numbers.
  std::vector<std::string> x_names = {};
};

/// Panels in rows of `columns`, with one key for each panel that lists series.
struct Figure {
  std::vector<Panel> panels;
  int columns = 1;
  int panel_width_px = 560, panel_height_px = 380;
};

/// Of the palette, as SVG and gnuplot write it.
std::string FigureColor(int color);

/// The figure as a gnuplot script, data included, that writes `stem`.svg and `stem`.png.
/// @throws std::invalid_argument for series whose columns differ in length.
std::string ToGnuplot(const Figure& figure, const std::string& stem);

}  // namespace sidestep::bench
