// At every tick there is a stop that keeps to the limits, and it is short.
#include <fmt/core.h>

#include <algorithm>

#include "sidestep/bench/validation/support.h"

namespace sidestep::bench {
namespace {

constexpr double kMostStop_s = 0.35, kMostStop_m = 0.10;
constexpr std::size_t kEvery = 10;  // ticks: how far it goes is looked at each 10 ms

Facts MeasureStopCoverage(const ValidationRun& run) {
  if (!run.one.is_supervised) return {};
  const control::JerkLimitedTracker tracker = LabTracker(run.robot);
  const std::vector<ControlSample>& ticks = run.result.recording.control;
  double longest_s = 0, furthest_m = 0, without = 0;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    const StopFrom stop = StopOf(tracker, ticks[i]);
    without += stop.keeps_to_limits ? 0 : 1;
    longest_s = std::max(longest_s, stop.seconds);
    if (i % kEvery != 0 || stop.seconds == 0) continue;
    furthest_m = std::max(furthest_m, GreatestWay(run.robot, ticks[i].q_command, stop.q_end));
  }
  return {{"ticks", static_cast<double>(ticks.size())},
          {"ticks_without_stop", without},
          {"stop_s", longest_s},
          {"stop_m", furthest_m}};
}

ItemFinding JudgeStopCoverage(const Evidence& evidence) {
  const RowTest all = [](const RunRow&) { return true; };
  const std::vector<Told> without = LargestFirst(evidence, "ticks_without_stop", all);
  const std::vector<Told> times = LargestFirst(evidence, "stop_s", IsWithinEnvelope);
  const std::vector<Told> ways = LargestFirst(evidence, "stop_m", IsWithinEnvelope);
  if (times.empty()) return NothingRun("no episode was run under supervision");
  ItemFinding finding;
  const bool passes = SumOf(without) == 0 && times.front().value <= kMostStop_s + 1e-9 &&
                      ways.front().value <= kMostStop_m;
  finding.verdict = passes ? ItemVerdict::kPass : ItemVerdict::kFail;
  finding.evidence = fmt::format(
      "{:.0f} of {:.0f} ticks without a stop within the limits; the longest stop takes {:.3f} s "
      "and {:.0f} mm of the arm's fastest part, straight",
      SumOf(without), SumOf(LargestFirst(evidence, "ticks", all)), times.front().value,
      1e3 * ways.front().value);
  if (SumOf(without) > 0) {
    finding.worst = WorstOf(without, 0, "{:.0f} ticks without a stop");
  } else if (times.front().value > kMostStop_s) {
    finding.worst = WorstOf(times, kMostStop_s, "{:.3f} s");
  } else {
    finding.worst = WorstOf(ways, kMostStop_m, "{:.3f} m");
  }
  return finding;
}

}  // namespace

ValidationItem StopCoverageItem() {
  return {9,
          "a stop at every tick",
          "at all of them within the limits; at most 0.35 s and 0.10 m",
          "a verified stop at all times, as SARA-shield and ARMTD have it",
          MeasureStopCoverage,
          JudgeStopCoverage};
}

}  // namespace sidestep::bench
