#include "sidestep/bench/episode.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <deque>
#include <exception>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "sidestep/bench/metrics/registry.h"
#include "sidestep/bench/planner_settings.h"
#include "sidestep/bench/sensor_watch.h"
#include "sidestep/bench/true_world.h"
#include "sidestep/core/cpu_time.h"
#include "sidestep/core/goal.h"
#include "sidestep/planner/registry.h"
#include "sidestep/planner/replanner.h"
#include "sidestep/scenarios/yaml_text.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::bench {
namespace {

constexpr double kAfterGoal = 0.5;     // s of episode after the goal is reached
constexpr double kHorizons = 2;        // an episode lasts at most this many horizons
constexpr double kTimeEpsilon = 1e-9;  // s; far below a physics step, far above rounding

// Appends the indices at which two grids of one size differ. Most of a scan is as it was, and most
// of the time of a plain loop would go into finding that out.
void AppendChanges(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& now,
                   std::vector<std::int64_t>& changed) {
  constexpr std::size_t kBlock = 256;
  for (std::size_t begin = 0; begin < now.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, now.size());
    if (std::memcmp(&before[begin], &now[begin], end - begin) == 0) continue;
    for (std::size_t i = begin; i < end; ++i) {
      if (now[i] != before[i]) changed.push_back(static_cast<std::int64_t>(i));
    }
  }
}

record::AskedLimits LimitsAskedFor(const scenarios::Scenario& scenario,
                                   const robot::RobotModel& robot) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const double v_scale = scenario.velocity_limits ? scenario.velocity_scale : kNone;
  const double a_scale = scenario.acceleration_limits ? scenario.acceleration_scale : kNone;
  const Eigen::Index n = robot.num_joints();
  record::AskedLimits asked = {Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n),
                               Eigen::VectorXd(n)};
  for (Eigen::Index j = 0; j < n; ++j) {
    const robot::JointLimits& joint = robot.limits()[static_cast<std::size_t>(j)];
    asked.v_max(j) = v_scale * joint.v_max;
    asked.a_max(j) = a_scale * joint.a_max;
    asked.jerk_max(j) = joint.jerk_max;
    asked.torque_rate_max(j) = joint.torque_rate_max;
  }
  return asked;
}

record::Recording BeginRecording(const scenarios::Scenario& scenario,
                                 const robot::RobotModel& robot, const EpisodeWorld& world) {
  record::Recording recording;
  recording.header = {{"scenario", scenario.name},       {"robot", robot.name()},
                      {"planner", scenario.planner},     {"knowledge", scenario.knowledge},
                      {"predictor", scenario.predictor}, {"seed", std::to_string(scenario.seed)}};
  for (const auto& [choice, chosen] : scenario.choices) {
    recording.header["choice." + choice] = chosen;
  }
  for (const auto& [key, value] : scenario.drawn) {
    recording.header["drawn." + key] = scenarios::Number(value);
  }
  recording.scenario_yaml = scenarios::ToYaml(scenario);
  recording.model_xml = world.model_xml;
  recording.joints = world.joints;
  recording.obstacles = world.obstacles;
  recording.q_start = scenario.q_start;
  recording.q_goal = scenario.q_goal;
  recording.dwell_s = scenario.dwell_s;
  recording.v_max.resize(robot.num_joints());
  for (int i = 0; i < robot.num_joints(); ++i) {
    recording.v_max(i) = robot.limits()[static_cast<std::size_t>(i)].v_max;
  }
  recording.limits = LimitsAskedFor(scenario, robot);
  return recording;
}

constexpr const char* kStages[] = {"sense", "map", "segment", "track", "predict", "optimise"};

// Why the robot was never given a plan.
std::string WhyNoPlan(const record::Recording& recording) {
  if (recording.observations.empty()) return "no scan has arrived";
  if (recording.cycles.empty()) return "no planning cycle was due after the first scan";
  return "none of " + std::to_string(recording.cycles.size()) +
         " plans was accepted; the last one: " + recording.cycles.back().status;
}

// Whatever happens, a robot is not left moving.
class HoldAtTheEnd {
 public:
  explicit HoldAtTheEnd(robot::RobotInterface& robot) : robot_(robot) {}
  ~HoldAtTheEnd() { robot_.Hold(); }
  HoldAtTheEnd(const HoldAtTheEnd&) = delete;
  HoldAtTheEnd& operator=(const HoldAtTheEnd&) = delete;

 private:
  robot::RobotInterface& robot_;
};

// The loop's state: what has happened so far and what is due.
class Loop {
 public:
  Loop(const scenarios::Scenario& scenario, const robot::RobotModel& robot, EpisodeWorld& world,
       const FieldObserver& observe_field)
      : scenario_(scenario),
        world_(world),
        sensor_(*world.sensor),
        observe_field_(observe_field),
        planner_(planner::MakePlanner(scenario.planner, robot, MakePlannerSettings(scenario))),
        model_(sdf::MakeWorldModel(MakeWorldModelOptions(
            scenario, scenario.epsilon_m + robot.largest_sphere_radius_m(), world))),
        replanner_(*planner_, *model_, {scenario.horizon_s, scenario.step_s, scenario.q_goal}),
        goal_(scenario.q_goal, scenario.dwell_s),
        end_s_(kHorizons * scenario.horizon_s) {
    result_.recording = BeginRecording(scenario, robot, world);
    for (const char* const stage : kStages) result_.times[stage];
    result_.times["cycle"];
  }

  EpisodeResult Run() {
    try {
      Go();
      KeepLastContact();
    } catch (const std::exception& error) {
      Abort(error.what());
    } catch (...) {
      Abort("something was thrown that is no std::exception");
    }
    return Finish();
  }

 private:
  struct Pending {
    planner::TimedPlan plan;
    double effect_s;
  };

  void Go() {
    while (true) {
      // Of things due at the same time, plans take effect first, then scans, then a new cycle.
      const double next_s =
          std::max(now_s_, std::min({NextEffect(), NextScan(), next_cycle_s_, end_s_}));
      Advance(next_s);
      if (next_s >= end_s_) break;
      if (NextEffect() <= next_s) {
        world_.robot->Submit(pending_.front().plan.trajectory, pending_.front().plan.start);
        pending_.pop_front();
      } else if (NextScan() <= next_s) {
        Sense();
      } else {
        Replan(next_s);
      }
    }
  }

  // Stops the robot first of all. What happened before is worth keeping, but whatever failed may
  // fail again in telling it.
  void Abort(const std::string& why) {
    world_.robot->Hold();
    is_aborted_ = true;
    result_.reason = why.empty() ? "something failed without saying what" : why;
    const auto as_far_as_it_goes = [](const auto& keep) {
      try {
        keep();
      } catch (...) {
      }
    };
    as_far_as_it_goes([this] { KeepTicks(); });
    as_far_as_it_goes([this] { KeepTruth(); });
    as_far_as_it_goes([this] { KeepLastContact(); });
  }

  double NextEffect() const { return pending_.empty() ? end_s_ + 1 : pending_.front().effect_s; }
  double NextScan() const { return sensor_.NextDue().seconds(); }

  void Advance(double t_s) {
    now_s_ = t_s;
    world_.robot->AdvanceTo(EpisodeTime(t_s));
    KeepTicks();
    KeepTruth();
  }

  void KeepTicks() {
    record::Recording& recording = result_.recording;
    for (ControlSample& tick : world_.robot->TakeControlLog()) {
      if (tick.t.seconds() <= end_s_ + kTimeEpsilon) goal_.Observe(tick.t, tick.q, tick.v);
      if (goal_.dwelt()) end_s_ = std::min(end_s_, goal_.dwelt()->seconds() + kAfterGoal);
      if (tick.t.seconds() <= end_s_ + kTimeEpsilon) recording.control.push_back(std::move(tick));
    }
  }

  void KeepTruth() {
    if (world_.truth == nullptr) return;
    for (TruthSample& sample : world_.truth->TakeSamples()) KeepTruth(std::move(sample));
  }

  void KeepTruth(TruthSample sample) {
    if (sample.t.seconds() > end_s_ + kTimeEpsilon) return;
    result_.recording.truth.push_back(std::move(sample));
  }

  void KeepLastContact() {
    if (world_.truth == nullptr) return;
    std::optional<TruthSample> contact = world_.truth->ContactSinceLastSample();
    if (contact) KeepTruth(std::move(*contact));
  }

  void Sense() {
    const double begin = ThreadCpuSeconds();
    const std::optional<Scan> scan = sensor_.Read(EpisodeTime(now_s_));
    sense_s_ += ThreadCpuSeconds() - begin;
    if (scan) {
      model_->Observe(*scan);
      std::vector<TrackEvent>& events = result_.recording.events;
      for (TrackEvent& event : model_->TakeEvents()) events.push_back(std::move(event));
      KeepObservation(*scan);
    }
  }

  void KeepObservation(const Scan& scan) {
    record::ObservationRecord& record = result_.recording.observations.emplace_back();
    record.t = scan.t;
    record.t_arrival = EpisodeTime(now_s_);
    const std::vector<std::uint8_t>& cells = model_->Occupancy().cells;
    last_cells_.resize(cells.size(), 0);
    AppendChanges(last_cells_, cells, record.changed_cells);
    last_cells_ = cells;
    for (const ObjectObservation& object : scan.objects) {
      record.objects.push_back({object.id, object.X_WO, object.covariance});
    }
  }

  void Replan(double t_s) {
    const double latency_s = scenario_.latency_s;
    // The first multiple of the period that is past this cycle's own time.
    next_cycle_s_ = ++cycle_index_ / scenario_.replan_rate_hz;
    while (next_cycle_s_ < t_s + latency_s - kTimeEpsilon) {
      next_cycle_s_ = ++cycle_index_ / scenario_.replan_rate_hz;
    }
    if (!sensor_.has_seen()) return;  // nothing is known yet
    planner::Replanner::Cycle cycle =
        replanner_.Run(EpisodeTime(t_s), world_.robot->Read(), HorizonOffset(latency_s), goal_);
    if (cycle.plan) pending_.push_back({*cycle.plan, t_s + latency_s});
    result_.recording.cycles.push_back(std::move(cycle.record));
    KeepTimes(cycle);
    // No scan has come in since, so this is the same field.
    if (observe_field_) observe_field_(EpisodeTime(t_s), model_->MakeField(), world_.truth);
  }

  void KeepTimes(const planner::Replanner::Cycle& cycle) {
    const sdf::WorldModelTimes map = model_->TakeTimes();
    const double seconds[] = {sense_s_,    map.map_s,     map.segment_s,
                              map.track_s, map.predict_s, cycle.optimise_s};
    static_assert(std::size(seconds) == std::size(kStages));
    double sum = 0;
    for (std::size_t i = 0; i < std::size(kStages); ++i) {
      result_.times[kStages[i]].push_back(seconds[i]);
      sum += seconds[i];
    }
    result_.times["cycle"].push_back(sum);
    sense_s_ = 0;
  }

  EpisodeResult Finish() {
    record::Recording& recording = result_.recording;
    for (const Metric& metric : Metrics()) {
      recording.metrics[metric.name] = metric.compute(recording);
    }
    result_.outcome = is_aborted_ ? Outcome::kAborted : Judge(recording, goal_.dwelt().has_value());
    recording.header["outcome"] = ToString(result_.outcome);
    if (!is_aborted_ && recording.metrics.at("plans_accepted") == 0) {
      result_.reason = WhyNoPlan(recording);
    }
    if (!result_.reason.empty()) recording.header["reason"] = result_.reason;
    return std::move(result_);
  }

  const scenarios::Scenario& scenario_;
  EpisodeWorld& world_;
  SensorWatch sensor_;
  const FieldObserver& observe_field_;
  std::unique_ptr<planner::Planner> planner_;
  std::unique_ptr<sdf::WorldModel> model_;
  planner::Replanner replanner_;
  GoalWatch goal_;

  std::deque<Pending> pending_;
  std::vector<std::uint8_t> last_cells_;  // filled by the latest scan
  double now_s_ = 0;
  int cycle_index_ = 0;
  double next_cycle_s_ = 0;
  double end_s_;
  double sense_s_ = 0;
  bool is_aborted_ = false;
  EpisodeResult result_;
};

}  // namespace

sdf::WorldModelOptions MakeWorldModelOptions(const scenarios::Scenario& scenario,
                                             double max_distance_m, const EpisodeWorld& world) {
  sdf::WorldModelOptions options;
  options.knowledge = sdf::KnowledgeFromString(scenario.knowledge);
  options.predictor = scenario.predictor;
  options.growth_sigmas = scenario.growth_sigmas;
  options.growth_limit_m = scenario.growth_limit_m;
  options.grid = scenario.grid;
  if (scenario.sensor.camera) {
    options.unseen = sdf::UnseenSpaceFromString(scenario.sensor.camera->unseen);
  }
  options.max_distance_m = max_distance_m;
  options.cells = scenario.sensor.cells;
  options.exact.half_spaces = {FloorOf(scenario)};
  if (scenario.static_world == scenarios::StaticWorld::kExact)
    options.exact.shapes = StaticShapes(scenario);
  // Where the scenario is not simulated, its motions are not the truth.
  if (world.truth != nullptr) options.true_obstacles = TrueMotions(scenario);
  return options;
}

EpisodeResult RunEpisode(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                         const WorldFactory& make_world, const FieldObserver& observe_field) {
  const auto begin = std::chrono::steady_clock::now();
  EpisodeWorld world = make_world(scenario, robot);
  const HoldAtTheEnd hold(*world.robot);
  EpisodeResult result = Loop(scenario, robot, world, observe_field).Run();
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

void RequireWhole(const EpisodeResult& result) {
  if (result.outcome != Outcome::kAborted) return;
  throw std::runtime_error("the episode was aborted: " + result.reason);
}

}  // namespace sidestep::bench
