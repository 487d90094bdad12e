#include "sidestep/bench/metrics/safety_metrics.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

#include "sidestep/planner/planner.h"
#include "sidestep/record/questions.h"

namespace sidestep::bench {

double FirstContact(const record::Recording& recording) {
  const std::optional<record::Touch> touch = record::FirstTouch(recording);
  return touch ? touch->t.seconds() : kNoContact;
}

double MinClearance(const record::Recording& recording) {
  const std::optional<record::Clearance> least = record::LeastClearance(recording);
  return least ? least->clearance_m : std::numeric_limits<double>::quiet_NaN();
}

double Replans(const record::Recording& recording) {
  return static_cast<double>(recording.cycles.size());
}

double PlansAccepted(const record::Recording& recording) {
  return static_cast<double>(std::count_if(recording.cycles.begin(), recording.cycles.end(),
                                           [](const CycleRecord& c) { return c.accepted; }));
}

double ReplansCutShort(const record::Recording& recording) {
  return static_cast<double>(std::count_if(recording.cycles.begin(), recording.cycles.end(),
                                           [](const CycleRecord& c) { return c.cut_short; }));
}

double ReplansShortOfGoal(const record::Recording& recording) {
  const std::string short_of_goal = planner::ToString(planner::PlanStatus::kShortOfGoal);
  return static_cast<double>(
      std::count_if(recording.cycles.begin(), recording.cycles.end(),
                    [&](const CycleRecord& c) { return c.status == short_of_goal; }));
}

double SamplesOutsideGrid(const record::Recording& recording) {
  return std::accumulate(
      recording.cycles.begin(), recording.cycles.end(), 0.0,
      [](double sum, const CycleRecord& cycle) { return sum + cycle.samples_outside_grid; });
}

}  // namespace sidestep::bench
