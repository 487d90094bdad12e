#include "sidestep/bench/hindsight.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sidestep/bench/free_path_search.h"
#include "sidestep/bench/recorded_fields.h"
#include "sidestep/bench/true_world.h"
#include "sidestep/record/questions.h"

namespace sidestep::bench {
namespace {

bool HasReached(const record::Recording& recording) {
  const auto time_s = recording.metrics.find("time_to_goal_s");
  return time_s != recording.metrics.end() && std::isfinite(time_s->second);
}

// Where the arm was told to be, from which every plan goes on.
PathStart StartAt(const record::Recording& recording, EpisodeTime t) {
  const ControlSample& tick = *record::TickAt(recording, t);
  return {t, tick.q_command, tick.v_command};
}

HindsightVerdict VerdictOn(const std::vector<HindsightCycle>& cycles) {
  const auto has_way = [](const HindsightCycle& cycle) { return cycle.had_a_way; };
  if (std::none_of(cycles.begin(), cycles.end(), has_way)) return HindsightVerdict::kNoWay;
  const bool known = std::any_of(cycles.begin(), cycles.end(), [](const HindsightCycle& cycle) {
    return cycle.had_a_way && cycle.knew_a_way && !cycle.was_thought_free;
  });
  return known ? HindsightVerdict::kKnown : HindsightVerdict::kNotKnown;
}

}  // namespace

std::string ToString(HindsightVerdict verdict) {
  switch (verdict) {
    case HindsightVerdict::kReached:
      return "reached";
    case HindsightVerdict::kNoWay:
      return "no way";
    case HindsightVerdict::kNotKnown:
      return "not known in time";
    case HindsightVerdict::kKnown:
      return "known in time";
  }
  throw std::invalid_argument("unknown HindsightVerdict");
}

std::optional<std::string> WhyCutShort(const record::Recording& recording) {
  return record::FirstTouch(recording) ? std::nullopt : record::WhyAborted(recording);
}

Hindsight LookBack(const record::Recording& recording, const scenarios::Scenario& scenario,
                   const robot::RobotModel& robot, int max_guesses, std::uint64_t seed) {
  if (static_cast<int>(recording.joints.size()) != robot.num_joints()) {
    throw std::invalid_argument("LookBack: the recording is of another robot");
  }
  if (recording.control.empty()) throw std::invalid_argument("LookBack: nothing was recorded");
  if (WhyCutShort(recording)) throw std::invalid_argument("LookBack: the episode was cut short");
  const std::string why_not = WhyNoRecordedFields(recording, scenario);
  if (!why_not.empty()) throw std::invalid_argument("LookBack: " + why_not);
  Hindsight hindsight;
  if (const auto touch = record::FirstTouch(recording)) hindsight.contact = touch->t;
  if (!hindsight.contact && HasReached(recording)) return hindsight;
  const EpisodeTime last = hindsight.contact.value_or(recording.control.back().t);
  const double reach_m = scenario.epsilon_m + robot.largest_sphere_radius_m();
  const sdf::ShapeField truth = TrueWorld(scenario, reach_m);
  const auto look = [&](const CycleRecord& record, const sdf::DistanceField& known) {
    if (record.t_effect >= last) return;
    const PathStart start = StartAt(recording, record.t_effect);
    const auto search = [&](const sdf::DistanceField& field) {
      return SearchFreePathFrom(start, field, scenario, robot, max_guesses, seed);
    };
    HindsightCycle cycle;
    cycle.t = record.t;
    cycle.t_effect = record.t_effect;
    cycle.was_thought_free = record.plan.num_states() > 0 && record.predicted_clearance_m > 0;
    const FreePath known_path = search(known), true_path = search(truth);
    cycle.knew_a_way = known_path.found;
    cycle.known_clearance_m = known_path.clearance_m;
    cycle.had_a_way = true_path.found;
    cycle.true_clearance_m = true_path.clearance_m;
    hindsight.cycles.push_back(cycle);
  };
  RemakeFields(recording, scenario, reach_m, look);
  hindsight.verdict = VerdictOn(hindsight.cycles);
  return hindsight;
}

}  // namespace sidestep::bench
