// The planner keeps its rate, and where it does not, the arm still stops in time.
#include <fmt/core.h>

#include <algorithm>

#include "sidestep/bench/statistics.h"
#include "sidestep/bench/validation/support.h"
#include "sidestep/record/questions.h"

namespace sidestep::bench {
namespace {

constexpr double kMostPeriods = 2;
constexpr double kResting_rad_s = 0.05;

// Who is made to brake, or is pushed, waits until he rests before he plans anew.
bool ComesToRest(const record::Recording& recording, EpisodeTime from, EpisodeTime to) {
  const ControlSample* const first = record::TickAt(recording, from);
  const ControlSample* const last = record::TickAt(recording, to);
  if (first == nullptr || last->v_command.norm() >= kResting_rad_s) return false;
  return std::any_of(first, last + 1, [](const ControlSample& tick) {
    return IsToldToMove(tick) || IsMoving(tick.v);
  });
}

Facts MeasureReplanPeriod(const ValidationRun& run) {
  const std::vector<CycleRecord>& cycles = run.result.recording.cycles;
  std::vector<double> periods;
  for (std::size_t i = 1; i < cycles.size(); ++i) {
    if (ComesToRest(run.result.recording, cycles[i - 1].t, cycles[i].t)) continue;
    const double period_s = (cycles[i].t - cycles[i - 1].t).seconds();
    periods.push_back(period_s * run.scenario.replan_rate_hz);
  }
  if (periods.empty()) return {};
  return {{"replan_periods_p99", Quantile(periods, 0.99)}};
}

ItemFinding JudgeReplanPeriod(const Evidence& evidence) {
  const auto is_nominal = [](const RunRow& row) {
    return IsOfGroup(row, validation_group::kEnvelope);
  };
  const auto is_late = [](const RunRow& row) {
    return row.factors.at("timing").starts_with("planner_");
  };
  const std::vector<Told> periods = LargestFirst(evidence, "replan_periods_p99", is_nominal);
  const std::vector<Told> touched = LargestFirst(evidence, "contact_in_motion", is_late);
  if (periods.empty()) return NothingRun("no episode had two planning cycles");
  ItemFinding finding;
  const bool passes = periods.front().value <= kMostPeriods + 1e-9 && SumOf(touched) == 0;
  finding.verdict = passes ? ItemVerdict::kPass : ItemVerdict::kFail;
  finding.evidence = fmt::format(
      "99 % of periods are at most {:.2f} of the nominal one; a moving arm touched "
      "something in {} of {} episodes whose planner took two or four times as long",
      periods.front().value, SumOf(touched), touched.size());
  finding.worst = SumOf(touched) > 0 ? WorstOf(touched, 0, "touched in motion")
                                     : WorstOf(periods, kMostPeriods, "{:.2f} periods");
  return finding;
}

}  // namespace

ValidationItem ReplanPeriodItem() {
  return {12,
          "planning rate",
          "99 % of periods at most twice the nominal one; a late planner leads to no contact",
          "every plan ends at rest, so that one that is not renewed stops by itself",
          MeasureReplanPeriod,
          JudgeReplanPeriod};
}

}  // namespace sidestep::bench
