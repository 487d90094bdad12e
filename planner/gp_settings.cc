#include "sidestep/planner/gp_settings.h"

#include <vector>

namespace sidestep::planner {
namespace {

using Row = ParameterTable<GpSettings>::Row;

// Beyond these the normal equations are numbers that mean nothing.
std::vector<Row> SingleSolveRows() {
  using S = GpSettings;
  return {
      {"sigma_obs", &S::sigma_obs, "m", 1e-5, 1e3, "the smaller, the more an obstacle costs"},
      {"n_int", &S::num_interpolated, "", 0, 100, "obstacle costs between two support states"},
      {"qc", &S::qc, "", 1e-6, 1e6,
       "white noise on acceleration of the motion prior; the larger, the less smooth"},
      {"sigma_goal", &S::sigma_goal, "", 1e-7, 10, "how far off the goal a plan may end"},
      {"max_iterations", &S::max_iterations, "", 1, 1e5, "of the optimiser, for each guess"},
      {"function_tolerance", &S::function_tolerance, "", 1e-12, 1,
       "a solve ends when a step lowers the cost by no more than this share"},
  };
}

}  // namespace

const ParameterTable<GpSettings>& SingleSolveParameters() {
  static const ParameterTable<GpSettings> table(SingleSolveRows());
  return table;
}

const ParameterTable<GpSettings>& GpParameters() {
  static const ParameterTable<GpSettings> table([] {
    std::vector<Row> rows = SingleSolveRows();
    rows.push_back(
        {"detours", &GpSettings::num_detours, "", 0, 1000,
         "guesses over random configurations, where no direct one leads to a free plan"});
    return rows;
  }());
  return table;
}

}  // namespace sidestep::planner
