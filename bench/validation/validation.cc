#include "sidestep/bench/validation/validation.h"

#include <exception>
#include <memory>
#include <utility>

#include "sidestep/bench/free_path_search.h"
#include "sidestep/bench/validation/behaviours.h"
#include "sidestep/bench/validation/faults.h"
#include "sidestep/bench/validation/faulty_sensor.h"
#include "sidestep/bench/validation/perception.h"
#include "sidestep/bench/validation/random_obstacle.h"
#include "sidestep/bench/validation/support.h"
#include "sidestep/bench/validation/timing.h"

namespace sidestep::bench {
namespace {

constexpr double kGivesUp_s = 3;                   // who has not moved for so long
constexpr int kGuesses = 20;                       // of the search for a free motion
constexpr const char* kReferencePlanner = "gpmp";  // that searches
constexpr const char* kGaveUp = "it does not get on";

// Seeds of different draws have nothing in common.
std::uint64_t SeedOf(const ValidationCase& one, const ValidationSubject& subject) {
  return subject.scenario.seed + 1000003 * static_cast<std::uint64_t>(one.draw);
}

// A world whose sensors are faulty.
WorldFactory WithFaults(const WorldFactory& make, const SensorFaults& faults, std::uint64_t seed) {
  return [=](const scenarios::Scenario& scenario, const robot::RobotModel& robot) {
    struct Owner {
      std::shared_ptr<void> world;
      std::vector<std::unique_ptr<FaultySensor>> sensors;
    };
    EpisodeWorld world = make(scenario, robot);
    const auto owner = std::make_shared<Owner>();
    owner->world = std::exchange(world.owner, owner);
    for (robot::NamedSensor& sensor : world.sensors) {
      owner->sensors.push_back(std::make_unique<FaultySensor>(sensor.sensor, faults, seed));
      sensor.sensor = owner->sensors.back().get();
    }
    return world;
  };
}

WorldFactory WorldOf(const ValidationCase& one, const ValidationSubject& subject,
                     const ValidationWorlds& worlds) {
  const ValidationFault& fault = ValidationFaultOf(one.fault);
  const WorldFactory make = one.on_the_wire
                                ? worlds.wired(fault.on_the_wire, TimingOf(one.timing).lost_share)
                                : worlds.simulated;
  const bool is_fault = &fault != &ValidationFaults().front();
  const SensorFaults& faults = is_fault ? fault.sensor : PerceptionOf(one.perception).faults;
  return WithFaults(make, faults, SeedOf(one, subject));
}

// Whether one who knows the future finds a way.
bool HasFreePath(scenarios::Scenario scenario, const robot::RobotModel& robot) {
  scenario.planner = kReferencePlanner;
  scenario.planner_parameters.clear();
  return SearchFreePath(scenario, robot, kGuesses, scenario.seed).found;
}

bool IsSearched(const ValidationCase& one) {
  return !one.on_the_wire &&
         (one.group == validation_group::kEnvelope || one.group == validation_group::kSoak);
}

}  // namespace

void CheckSubject(const ValidationSubject& subject) {
  const scenarios::Scenario& scenario = subject.scenario;
  if (scenario.safety.profile != scenarios::SafetyProfile::kLab) {
    throw scenarios::WrongValue(scenario, "safety.profile",
                                "must be lab to be validated, is " +
                                    ToString(scenario.safety.profile) +
                                    "; safety: {profile: lab, obstacle_speed_m_s: ..., "
                                    "obstacle_acceleration_m_s2: ...} declares what obstacles do");
  }
  if (subject.robot.capsules().empty()) {
    throw scenarios::WrongValue(scenario, "robot.model",
                                subject.robot.name() + " has no capsules to be supervised by");
  }
  if (scenario.moving_obstacles.empty()) {
    throw scenarios::WrongValue(scenario, "moving_obstacles",
                                "must hold what moves: that is what a validation varies");
  }
}

scenarios::Scenario ScenarioOf(const ValidationCase& one, const ValidationSubject& subject) {
  scenarios::Scenario scenario = subject.scenario;
  SetLikelySensor(scenario);
  scenario.seed = SeedOf(one, subject);
  scenario.knowledge = one.knowledge;
  if (!one.is_supervised) scenario.safety.profile = scenarios::SafetyProfile::kObserve;
  if (one.draw % 2 == 0) {
    std::swap(scenario.q_start, scenario.q_goal);
    std::swap(scenario.start_name, scenario.goal_name);
  }
  SetPerception(PerceptionOf(one.perception), scenario);
  scenario.latency_s *= TimingOf(one.timing).cycle_factor;
  if (one.group == validation_group::kSoak) {
    RandomStream random(scenario.seed, "validation soak");
    SetRandomMotion({0.2 * one.speed_m_s, 0.96 * one.speed_m_s,
                     0.95 * scenario.safety.obstacle_acceleration_m_s2},
                    random, scenario);
  } else {
    SetBehaviour(one.behaviour, one.speed_m_s, scenario.seed, subject.robot, scenario);
  }
  return scenario;
}

ValidationEpisode RunValidationCase(const ValidationCase& one, const ValidationSubject& subject,
                                    const ValidationWorlds& worlds,
                                    const std::function<std::string()>& why_stop) {
  ValidationEpisode episode;
  try {
    const scenarios::Scenario scenario = ScenarioOf(one, subject);
    const WorldFactory make = WorldOf(one, subject, worlds);
    const robot::RobotInterface* arm = nullptr;
    const auto make_world = [&](const scenarios::Scenario& of, const robot::RobotModel& model) {
      EpisodeWorld world = make(of, model);
      arm = world.robot;
      return world;
    };
    double moved_s = 0;
    bool gave_up = false;
    EpisodeOptions options;
    options.why_stop = [&]() -> std::string {
      const JointState state = arm->Read();
      if (IsMoving(state.v)) moved_s = state.t.seconds();
      gave_up = state.t.seconds() > moved_s + kGivesUp_s;
      return gave_up ? kGaveUp : why_stop();
    };
    episode.result = RunEpisode(scenario, subject.robot, make_world, options);
    if (gave_up) {  // as if its time had been up
      episode.result.outcome = Judge(episode.result.recording, /*reached=*/false);
      episode.result.reason = kGaveUp;
    }
    RunRow& row = episode.row;
    row.factors = FactorsOf(one);
    row.outcome = ToString(episode.result.outcome);
    row.error = episode.result.reason;
    row.metrics = MeasureFacts({one, scenario, subject.robot, episode.result});
    if (IsSearched(one)) {
      row.metrics["free_path"] = HasFreePath(scenario, subject.robot) ? 1 : 0;
    }
  } catch (const std::exception& error) {
    episode = {FailedRow(FactorsOf(one), error.what()), {}};
  }
  return episode;
}

std::vector<JudgedItem> JudgeItems(const Evidence& evidence, bool is_whole) {
  std::vector<JudgedItem> judged;
  for (const ValidationItem& item : ValidationItems()) {
    ItemFinding finding = item.judge(evidence);
    if (!is_whole && finding.verdict == ItemVerdict::kPass) {
      finding.verdict = ItemVerdict::kNotRun;
      finding.evidence = "not to its end; until then: " + finding.evidence;
    }
    judged.push_back({item, finding});
  }
  return judged;
}

}  // namespace sidestep::bench
