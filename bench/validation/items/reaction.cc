// How long it takes from what was seen to a plan that knows it.
#include <fmt/core.h>

#include <algorithm>

#include "sidestep/bench/statistics.h"
#include "sidestep/bench/validation/support.h"

namespace sidestep::bench {
namespace {

constexpr double kMost50_s = 0.20, kMost99_s = 0.30, kMostReaction_s = 0.5;

// From the capture of the newest scan that a cycle knew to the moment at which its plan took
// effect.
std::vector<double> Reactions(const record::Recording& recording) {
  std::vector<double> reactions_s;
  for (const CycleRecord& cycle : recording.cycles) {
    if (!cycle.accepted) continue;
    const record::ObservationRecord* newest = nullptr;
    for (const record::ObservationRecord& scan : recording.observations) {
      if (scan.t_arrival > cycle.t) break;
      newest = &scan;
    }
    if (newest != nullptr) reactions_s.push_back((cycle.t_effect - newest->t).seconds());
  }
  return reactions_s;
}

Facts MeasureReaction(const ValidationRun& run) {
  const std::vector<double> reactions_s = Reactions(run.result.recording);
  if (reactions_s.empty()) return {};
  return {{"reaction_p50_s", Quantile(reactions_s, 0.5)},
          {"reaction_p99_s", Quantile(reactions_s, 0.99)},
          {"reaction_max_s", Quantile(reactions_s, 1)}};
}

ItemFinding JudgeReaction(const Evidence& evidence) {
  const auto is_nominal = [](const RunRow& row) {
    return IsOfGroup(row, validation_group::kEnvelope);
  };
  const std::vector<Told> p50 = LargestFirst(evidence, "reaction_p50_s", is_nominal);
  const std::vector<Told> p99 = LargestFirst(evidence, "reaction_p99_s", is_nominal);
  const std::vector<Told> most = LargestFirst(evidence, "reaction_max_s", is_nominal);
  if (p50.empty()) return NothingRun("no plan was ever accepted");
  ItemFinding finding;
  const bool passes = p50.front().value <= kMost50_s && p99.front().value <= kMost99_s &&
                      most.front().value <= kMostReaction_s;
  finding.verdict = passes ? ItemVerdict::kPass : ItemVerdict::kFail;
  finding.evidence =
      fmt::format("in the worst episode: median {:.3f} s, 99 % {:.3f} s, most {:.3f} s",
                  p50.front().value, p99.front().value, most.front().value);
  finding.worst = WorstOf(most, kMostReaction_s, "{:.3f} s at most");
  return finding;
}

}  // namespace

ValidationItem ReactionItem() {
  return {11,
          "from capture to a changed plan",
          "median 0.20 s, 99 % 0.30 s, at most 0.5 s",
          "budget: 60 ms camera, a frame of waiting, 100 ms planning",
          MeasureReaction,
          JudgeReaction};
}

}  // namespace sidestep::bench
