// A motion begins where the robot means to be, at rest, and ends at rest.
#include <fmt/core.h>

#include <algorithm>

#include "sidestep/bench/validation/support.h"

namespace sidestep::bench {
namespace {

constexpr double kMost_rad = 1e-6, kMost_rad_s = 1e-4, kMost_rad_s2 = 1e-2;
constexpr double kSettles_s = 0.2;  // of a command after its plan

double StandstillShare(const ControlSample& tick) {
  return std::max(tick.v_command.cwiseAbs().maxCoeff() / kMost_rad_s,
                  tick.a_command.cwiseAbs().maxCoeff() / kMost_rad_s2);
}

// Whether its last plan was followed to its end: others end in the middle of one, because their
// goal is reached, nearly, or their time is up.
bool IsOver(const record::Recording& recording) {
  const CycleRecord* last = nullptr;
  for (const CycleRecord& cycle : recording.cycles) {
    if (cycle.accepted) last = &cycle;
  }
  if (last == nullptr || !recording.safety.empty()) return false;
  const double plan_s = last->plan.t_s(last->plan.num_states() - 1);
  return recording.control.back().t > last->plan_start + HorizonOffset(plan_s + kSettles_s);
}

Facts MeasureStartAndStop(const ValidationRun& run) {
  const record::Recording& recording = run.result.recording;
  if (recording.control.empty()) return {};
  const ControlSample& first = recording.control.front();
  const double off_rad = (first.q_command - run.scenario.q_start).cwiseAbs().maxCoeff();
  Facts facts = {{"start_share", std::max(off_rad / kMost_rad, StandstillShare(first))}};
  if (IsOver(recording)) facts["end_share"] = StandstillShare(recording.control.back());
  return facts;
}

ItemFinding JudgeStartAndStop(const Evidence& evidence) {
  const auto is_whole = [](const RunRow& row) {
    return IsWithinEnvelope(row) && row.metrics.count("end_share") > 0;
  };
  const std::vector<Told> starts = LargestFirst(evidence, "start_share", IsWithinEnvelope);
  const std::vector<Told> ends = LargestFirst(evidence, "end_share", is_whole);
  if (starts.empty()) return NothingRun("no episode was run");
  ItemFinding finding;
  const bool passes = starts.front().value < 1 && (ends.empty() || ends.front().value < 1);
  finding.verdict = passes ? ItemVerdict::kPass : ItemVerdict::kFail;
  finding.evidence =
      fmt::format("of what is allowed, at most: {:.3g} at the beginning of {} episodes",
                  starts.front().value, starts.size());
  if (!ends.empty()) {
    finding.evidence +=
        fmt::format(", {:.3g} at the end of the last plan in {}", ends.front().value, ends.size());
  }
  const std::vector<Told>& worse = ends.empty() || starts.front().value > 1 ? starts : ends;
  finding.worst = WorstOf(worse, 1, "{:.3g} of what is allowed");
  return finding;
}

}  // namespace

ValidationItem StartAndStopItem() {
  return {4,
          "start and stop",
          "1e-6 rad from where the robot means to be, 1e-4 rad/s and 1e-2 rad/s^2 at the first "
          "and the last sample",
          "Franka's documentation: recommended conditions",
          MeasureStartAndStop,
          JudgeStartAndStop};
}

}  // namespace sidestep::bench
