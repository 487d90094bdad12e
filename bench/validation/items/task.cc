// An arm that never moves is safe, and of no use.
#include <fmt/core.h>

#include "sidestep/bench/validation/support.h"

namespace sidestep::bench {
namespace {

constexpr double kLeastGoalShare = 0.85;

Facts MeasureTask(const ValidationRun& run) {
  return {{"reaches_goal", run.result.outcome == Outcome::kGoal ? 1 : 0}};
}

ItemFinding JudgeTask(const Evidence& evidence) {
  const auto is_solvable = [](const RunRow& row) {
    const auto free = row.metrics.find("free_path");
    return IsWithinEnvelope(row) && free != row.metrics.end() && free->second == 1;
  };
  const std::vector<Told> told = LargestFirst(evidence, "reaches_goal", is_solvable);
  if (told.empty()) return NothingRun("no free motion was found in any episode");
  ItemFinding finding;
  const double share = SumOf(told) / static_cast<double>(told.size());
  finding.verdict = share >= kLeastGoalShare ? ItemVerdict::kPass : ItemVerdict::kFail;
  finding.evidence = fmt::format(
      "the goal was reached in {} of {} episodes within the envelope for which one who knows the "
      "future finds a free motion ({:.0f} %)",
      SumOf(told), told.size(), 100 * share);
  for (const Told& one : told) {
    if (one.value == 1 || finding.worst.size() == 3) continue;
    finding.worst.push_back({NameOf(*one.row), one.row->outcome});
  }
  return finding;
}

}  // namespace

ValidationItem TaskItem() {
  return {20,
          "the task",
          "the goal reached in 85 % of episodes in which it can be",
          "a search with the true future and many guesses",
          MeasureTask,
          JudgeTask};
}

}  // namespace sidestep::bench
