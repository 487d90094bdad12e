#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/bench/report/figure.h"
#include "sidestep/bench/reproduce/csv_table.h"
#include "sidestep/bench/reproduce/field_timer.h"

namespace sidestep::bench {

/// Table 1 of Finean, Merkt & Havoutis (ICAPS 2021): what a predicted field costs over the size of
/// the grid, computed anew or composed.
struct SdfTimingOptions {
  std::vector<int> voxels_per_side = {64, 96, 128, 160, 192, 224, 256, 288, 320};
  std::vector<std::string> scenes = FieldSceneNames();
  int repeats = 1;
};

/// Of one grid, over all scenes, moments and repeats [s, CPU].
struct SdfTimingSize {
  int voxels_per_side = 0;
  double cell_m = 0;
  std::vector<double> init_s;  ///< a scene and repeat each
  std::vector<PredictionTimes> predictions;
  int num_compared = 0;  ///< predictions whose objects all lie in the grid; only these are compared
  CompositeError largest_error;
};

/// The objects are seen 0.2 s and 0.6 s after the start, with a margin of 0.2 m, and predicted at
/// 0, 0.1, ... 3 s, all as published.
/// @param scenarios_dir the folder of scenarios. @throws InputError as LoadBoxScene.
/// @param on_size called after each size with the number of those done.
std::vector<SdfTimingSize> RunSdfTiming(const SdfTimingOptions& options,
                                        const std::string& scenarios_dir,
                                        const std::function<void(int done)>& on_size = {});

/// One row a size: the median, the 10 % and the 90 % quantile of each measure [ms], the errors [m].
CsvTable MakeSdfTimingTable(const std::vector<SdfTimingSize>& sizes);

/// Medians over the size, and the published means as rings.
/// @param published a table with the published column names, if there is one; what it does not have
/// is not drawn.
Figure MakeSdfTimingFigure(const CsvTable& ours, const std::optional<CsvTable>& published);

/// The medians, beside the published means if there are any, for a terminal.
std::string DescribeSdfTiming(const CsvTable& ours, const std::optional<CsvTable>& published);

/// The page that tells what came out.
std::string MakeSdfTimingPage(const SdfTimingOptions& options, const CsvTable& ours,
                              const std::optional<CsvTable>& published,
                              const std::string& svg_path);

}  // namespace sidestep::bench
