#pragma once

#include <optional>
#include <string>

#include "sidestep/bench/report/figure.h"
#include "sidestep/bench/reproduce/closed_loop.h"
#include "sidestep/bench/reproduce/csv_table.h"

namespace sidestep::bench {

/// What was measured by the authors, as far as it is given.
struct PublishedRates {
  /// Columns voxels_per_side, index, composite_prediction_s.
  std::optional<CsvTable> predictions;
  /// Columns voxels_per_side, fastest_rate_hz, median_rate_hz, slowest_rate_hz.
  std::optional<CsvTable> loops;
};

/// One row a grid: update rates (of the shortest, median and longest cycle) and prediction rates
/// (of the median) [Hz], ours and then the published ones; empty where there are none.
CsvTable MakeRatesTable(const ClosedLoopStudy& study, const PublishedRates& published);

/// One row a kind of field: initialisation, full computation, dense composite, lazy composite with
/// its making; least, median, mean and greatest time of the 435 predictions of each scene [ms]. The
/// first column counts the kinds in this order, from 1.
CsvTable MakeWholeRunTable(const WholeRunTimes& times);

/// Joint positions and velocities over time, execute-and-update beside prediction.
Figure MakeJointsFigure(const ClosedLoopStudy& study);
/// Rates over the size of the grid.
Figure MakeRatesFigure(const CsvTable& rates);

/// The chief figures, for a terminal.
std::string DescribeClosedLoop(const ClosedLoopStudy& study, const PublishedRates& published);

/// @param joints_svg, rates_svg drawn figures; empty: there is none.
std::string MakeClosedLoopPage(const ClosedLoopOptions& options, const ClosedLoopStudy& study,
                               const PublishedRates& published, const std::string& joints_svg,
                               const std::string& rates_svg);

}  // namespace sidestep::bench
