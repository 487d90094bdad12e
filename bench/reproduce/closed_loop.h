#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/report/figure.h"
#include "sidestep/bench/reproduce/csv_table.h"
#include "sidestep/bench/reproduce/field_timer.h"
#include "sidestep/bench/run_identity.h"
#include "sidestep/bench/run_row.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// The closed-loop study of Finean, Merkt & Havoutis (ICAPS 2021), on this loop.
struct ClosedLoopOptions {
  double speed_m_s = 1.4;
  std::vector<int> voxels_per_side = {64, 96, 128, 160, 192, 224, 256, 288, 320};
};

/// The settings of the published closed loop, as factors of a run (cli/run_case.h): sigma, epsilon,
/// no interpolated costs, an observation each cycle, and the speed of what moves.
Factors PublishedSettings(double speed_m_s);
/// The factor that is the size of the grid, and its value for as many cells on each side.
inline constexpr const char* kCellsFactor = "workspace.cells";
std::string CellsValue(int voxels_per_side);

/// A run of the study, ready to be made.
struct ClosedLoopCase {
  scenarios::Scenario scenario;  ///< resolved
  robot::RobotModel robot;
  RunIdentity identity;
};
/// Makes one of its factors: the published settings, the grid and the kind of knowledge.
using ClosedLoopLoader = std::function<ClosedLoopCase(const Factors&)>;

/// How fast the loop turns and a field is predicted, in one grid. One core, CPU time.
struct LoopRate {
  int voxels_per_side = 0;
  std::vector<double> cycle_s;               ///< of each planning cycle of a run
  std::vector<PredictionTimes> predictions;  ///< of the fields of later steps
};

/// What a whole run costs that predicts at each step, from the second on, the fields of all the
/// steps that remain: 435 predictions of 31 steps. Over the five field scenes, 96 voxels a side.
struct WholeRunTimes {
  std::vector<double> init_s;
  std::vector<PredictionTimes> predictions;
};

struct ClosedLoopStudy {
  EpisodeResult update, prediction;  ///< at the speed, 96 voxels a side
  /// Of all runs, those two first; what is fixed is none of their factors, and their traces and
  /// commands are not filled.
  std::vector<RunRow> rows;
  std::vector<LoopRate> rates;
  WholeRunTimes whole_run;
};

/// @param scenarios_dir the folder of the field scenes.
/// @param on_part called with what is about to be done.
ClosedLoopStudy RunClosedLoopStudy(const ClosedLoopLoader& load, const WorldFactory& make_world,
                                   const std::string& scenarios_dir,
                                   const ClosedLoopOptions& options,
                                   const std::function<void(const std::string&)>& on_part = {});

/// The 435 predictions of a scene, each step from the second on predicting all that remain.
void TimeWholeRun(const scenarios::Scenario& scene, const GridSpec& grid, double margin_m,
                  WholeRunTimes& times);

}  // namespace sidestep::bench
