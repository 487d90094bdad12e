#include "sidestep/bench/reproduce/open_loop_rows.h"

#include <cstdint>

#include "sidestep/bench/outcome.h"
#include "sidestep/core/number_text.h"

namespace sidestep::bench {
namespace {

constexpr const char* kSolver = "gauss_newton";

}  // namespace

std::vector<SingleRun> OpenLoopRuns(const OpenLoopExperiment& experiment,
                                    const OpenLoopStudy& study, const std::string& predictor) {
  std::vector<SingleRun> runs;
  for (const OpenLoopRow& published : study.rows) {
    for (const auto& [knowledge, entry] : published.cases) {
      SingleRun& run = runs.emplace_back();
      run.scenario = experiment.name;
      run.seed = static_cast<std::uint64_t>(published.pair);
      RunRow& row = run.row;
      row.factors = {{"speed_m_s", ShortestText(published.speed_m_s)},
                     {"knowledge", ToString(knowledge)}};
      row.outcome =
          ToString(entry.result.colliding_states == 0 ? Outcome::kGoal : Outcome::kCollision);
      row.metrics = {{"gp_cost", entry.result.gp_cost},
                     {"min_clearance_m", entry.clearance.motion_m()}};
      row.subject = {experiment.scene.robot, kSolver, ToString(knowledge), predictor,
                     /*charged_latency_s=*/0};
    }
  }
  return runs;
}

}  // namespace sidestep::bench
