#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sidestep/bench/report/figure.h"
#include "sidestep/bench/reproduce/csv_table.h"
#include "sidestep/bench/reproduce/published_columns.h"

namespace sidestep::bench {

/// The published figure for a grid of `voxels` a side; nothing where it, or the table, is missing.
inline std::optional<double> PublishedAt(const std::optional<CsvTable>& published, double voxels,
                                         const std::string& column) {
  return published ? published->Lookup(kVoxelsColumn, voxels, column) : std::nullopt;
}

/// What was measured over the size of the grid, and the published figures for the same.
struct SizeCurve {
  std::string words;                                  ///< for the key
  std::vector<double> voxels, y;                      ///< a point a size
  std::vector<double> low, high;                      ///< of its band; empty: none
  std::vector<double> published_voxels, published_y;  ///< may be empty
};

/// One panel with a logarithmic y axis: a curve each, and rings of its colour for what is
/// published.
Figure MakeSizeFigure(const std::string& title, const std::string& y_label,
                      const std::vector<SizeCurve>& curves);

}  // namespace sidestep::bench
