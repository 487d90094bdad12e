#include "sidestep/bench/episode.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <exception>
#include <iterator>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "sidestep/bench/clock.h"
#include "sidestep/bench/episode_recorder.h"
#include "sidestep/bench/latency.h"
#include "sidestep/bench/metrics/registry.h"
#include "sidestep/bench/planning_worker.h"
#include "sidestep/bench/robot_filter.h"
#include "sidestep/bench/safety_watch.h"
#include "sidestep/bench/scan_order.h"
#include "sidestep/bench/scenario_planner.h"
#include "sidestep/bench/sensor_watch.h"
#include "sidestep/bench/true_world.h"
#include "sidestep/control/safety.h"
#include "sidestep/core/cpu_time.h"
#include "sidestep/core/goal.h"
#include "sidestep/planner/replanner.h"
#include "sidestep/robot/robot_error.h"
#include "sidestep/robot/tolerance_scale.h"
#include "sidestep/sdf/map/object_field.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::bench {
namespace {

constexpr double kAfterGoal = 0.5;     // s of episode after the goal is reached
constexpr double kTimeEpsilon = 1e-9;  // s; far below a physics step, far above rounding
constexpr double kPoll_s = 2e-3;       // on a wall clock, how long nobody looks up
constexpr double kLongestStop_s = 3;   // an arm that is told to hold rests by then
constexpr double kUsualStop_s = 0.25;  // under the profile lab
constexpr double kStill_rad_s = 0.01;
constexpr double kSeesCommand_s = 1.5e-3;  // a robot has looked at what it was told by then
constexpr double kPlanningShare = 0.9;     // of a cycle in real time; judging the plan is the rest
constexpr double kHandOver_s = 5e-3;  // a plan is with the robot so long before it takes effect

constexpr const char* kLate = "late";  // the status of a plan that came after its moment

// What is nearer than this under the profile lab, its supervisor stops for.
double FleesWithin(const scenarios::Scenario& scenario) {
  constexpr double kSoon_s = 1.5;
  const bool is_stopped = scenario.safety.profile == scenarios::SafetyProfile::kLab;
  return is_stopped ? kSoon_s : std::numeric_limits<double>::infinity();
}

StageTimes NoTimes() {
  StageTimes times;
  for (const char* const stage : kCycleStages) times[stage];
  times["cycle"];
  return times;
}

// The trace tells how its episode ended, as the result does.
void TellInHeader(EpisodeResult& result) {
  result.recording.header["outcome"] = ToString(result.outcome);
  if (!result.reason.empty()) result.recording.header["reason"] = result.reason;
}

// Why the robot was never given a plan.
std::string WhyNoPlan(const record::Recording& recording) {
  if (recording.observations.empty()) return "no scan has arrived";
  if (recording.cycles.empty()) return "no planning cycle was due after the first scan";
  const CycleRecord& last = recording.cycles.back();
  return "none of " + std::to_string(recording.cycles.size()) +
         " plans was accepted; the last one: " + last.status +
         (last.reason.empty() ? "" : ", " + last.reason);
}

std::vector<std::string> NamesOf(const std::vector<robot::NamedSensor>& sensors) {
  std::vector<std::string> names;
  for (const robot::NamedSensor& sensor : sensors) names.push_back(sensor.name);
  return names;
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
       const EpisodeOptions& options)
      : scenario_(scenario),
        world_(world),
        options_(options),
        planner_(MakePlanner(scenario, robot)),
        model_(sdf::MakeWorldModel(MakeWorldModelOptions(
            scenario, scenario.epsilon_m + robot.largest_sphere_radius_m(), world))),
        horizon_s_(HorizonOf(scenario, robot)),
        replanner_(*planner_, {horizon_s_, scenario.step_s, scenario.q_goal, FleesWithin(scenario),
                               planner_->DirectTime_s(scenario.q_start, scenario.q_goal)}),
        goal_(scenario.q_goal, scenario.dwell_s, robot::ToleranceScale(planner_->robot())),
        latency_(scenario),
        clock_(options.clock == EpisodeClock::kWall ? MakeWallClock() : MakeVirtualClock()),
        is_real_time_(options.clock != EpisodeClock::kVirtual),
        worker_(is_real_time_ ? MakeThreadWorker() : MakeInlineWorker()),
        recorder_(scenario, robot, world),
        scans_(NamesOf(world.sensors)),
        robot_filter_(scenario, planner_->robot()),
        end_s_(options.horizons * horizon_s_) {
    if (scenario.safety.profile != scenarios::SafetyProfile::kOff) {
      safety_.emplace(scenario, world);
    }
    for (const robot::NamedSensor& sensor : world.sensors) {
      sensors_.emplace_back(sensor, /*has_own_clock=*/is_real_time_);
    }
    result_.times = NoTimes();
    KeepJournal();
  }

  EpisodeResult Run() {
    try {
      Go();
      KeepLastContact();
    } catch (const robot::RobotError& error) {
      Abort(error.what());
      KeepTicks(error.last_ticks());
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

  // A cycle that has begun and whose result has not been taken.
  struct Begun {
    double t_s;
    HorizonOffset expected;  // to take so long
    std::shared_ptr<const sdf::DistanceField> field;
  };

  void Go() {
    while (true) {
      const std::string why_stop = options_.why_stop ? options_.why_stop() : "";
      if (!why_stop.empty()) {
        Note(control::SafetyCheck::kOperatorStop, control::Reaction::kBrake);
        return Stop("it was stopped from outside: " + why_stop);
      }
      const robot::RobotStatus status = world_.robot->Status();
      if (status.mode == robot::RobotMode::kFault) return Stop("the robot stopped: " + status.why);
      // Of things due at the same time, plans take effect first, then scans, then a new cycle.
      double next_s = std::min({NextEffect(), NextScan(), NextCycle(), end_s_});
      if (is_real_time_) next_s = std::min(next_s, now_s_ + kPoll_s);
      Advance(clock_->WaitUntil(EpisodeTime(std::max(now_s_, next_s))).seconds());
      if (now_s_ >= end_s_) break;
      TakeCycle();
      if (NextEffect() <= now_s_) {
        const planner::TimedPlan& plan = pending_.front().plan;
        world_.robot->Submit(plan.trajectory, plan.start);
        if (std::exchange(begins_anew_, false)) {
          begun_anew_s_ = std::max(now_s_, (plan.start + lag_).seconds());
        }
        pending_.pop_front();
      } else if (NextScan() <= now_s_) {
        Sense();
      } else if (NextCycle() <= now_s_) {
        BeginCycle();
      }
    }
  }

  // What was found beside the robot's own supervisor.
  void Note(control::SafetyCheck check, control::Reaction reaction, double value = 0,
            double limit = 0) {
    recorder_.Keep(SafetyEvent{EpisodeTime(now_s_), control::ToString(check),
                               control::ToString(reaction), value, limit});
  }

  // It is to end, or nothing more can come of it: the robot comes to rest first.
  void Stop(const std::string& why) {
    world_.robot->Hold();
    const double latest_s = now_s_ + kLongestStop_s;
    do {
      Advance(clock_->WaitUntil(EpisodeTime(now_s_ + 0.01)).seconds());
    } while (!Rests() && now_s_ < latest_s);
    is_aborted_ = true;
    result_.reason = why;
  }

  // Whether it stands, and is told to; so slow it may have only begun to move.
  bool Rests() const {
    const std::vector<ControlSample>& ticks = recorder_.recording().control;
    const bool is_told = ticks.empty() || ticks.back().v_command.isZero(1e-6);
    return is_told && world_.robot->Read().v.cwiseAbs().maxCoeff() <= kStill_rad_s;
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
    as_far_as_it_goes([this] { KeepFindings(); });
    as_far_as_it_goes([this] { KeepLastContact(); });
  }

  double NextEffect() const { return pending_.empty() ? end_s_ + 1 : pending_.front().effect_s; }
  double NextCycle() const { return worker_->is_busy() ? end_s_ + 1 : next_cycle_s_; }
  double NextScan() {
    const SensorWatch* const next = NextSensor();
    const double read_s = next == nullptr ? end_s_ + 1 : next->NextDue().seconds();
    return std::min(read_s, scans_.NextDue().seconds());
  }
  // The one that is due first.
  SensorWatch* NextSensor() {
    const auto earlier = [](const SensorWatch& a, const SensorWatch& b) {
      return a.NextDue() < b.NextDue();
    };
    const auto first = std::min_element(sensors_.begin(), sensors_.end(), earlier);
    return first == sensors_.end() ? nullptr : &*first;
  }

  void Advance(double t_s) {
    now_s_ = t_s;
    world_.robot->AdvanceTo(EpisodeTime(t_s));
    if (options_.clock == EpisodeClock::kRobot) {
      now_s_ = std::max(now_s_, world_.robot->Read().t.seconds());
    }
    KeepTicks();
    KeepTruth();
    const std::vector<double> answers_s = world_.robot->TakeAnswerTimes();
    result_.answers_s.insert(result_.answers_s.end(), answers_s.begin(), answers_s.end());
    KeepFindings();
    KeepJournal();
  }

  void KeepJournal() {
    if (options_.journal != nullptr) options_.journal->Keep(recorder_.recording());
  }

  void KeepFindings() {
    for (SafetyEvent& event : world_.robot->TakeSafetyEvents()) recorder_.Keep(std::move(event));
  }

  void KeepTicks() { KeepTicks(world_.robot->TakeControlLog()); }

  // Those that are not kept already.
  void KeepTicks(std::vector<ControlSample> ticks) {
    const std::vector<ControlSample>& kept = recorder_.recording().control;
    for (ControlSample& tick : ticks) {
      if (!kept.empty() && tick.t <= kept.back().t) continue;
      if (tick.t.seconds() <= end_s_ + kTimeEpsilon) goal_.Observe(tick.t, tick.q, tick.v);
      if (goal_.dwelt()) end_s_ = std::min(end_s_, goal_.dwelt()->seconds() + kAfterGoal);
      if (tick.t.seconds() <= end_s_ + kTimeEpsilon) recorder_.Keep(std::move(tick));
    }
  }

  void KeepTruth() {
    if (world_.truth == nullptr) return;
    for (TruthSample& sample : world_.truth->TakeSamples()) KeepTruth(std::move(sample));
  }

  void KeepTruth(TruthSample sample) {
    if (sample.t.seconds() <= end_s_ + kTimeEpsilon) recorder_.Keep(std::move(sample));
  }

  void KeepLastContact() {
    if (world_.truth == nullptr) return;
    std::optional<TruthSample> contact = world_.truth->ContactSinceLastSample();
    if (contact) KeepTruth(std::move(*contact));
  }

  void Sense() {
    // First from all of them: what they saw at one moment belongs together.
    for (SensorWatch* sensor = NextSensor();
         sensor != nullptr && sensor->NextDue().seconds() <= now_s_; sensor = NextSensor()) {
      Read(*sensor);
    }
    for (auto scans = scans_.Take(EpisodeTime(now_s_)); !scans.empty();
         scans = scans_.Take(EpisodeTime(now_s_))) {
      Learn(scans);
    }
  }

  void Read(SensorWatch& sensor) {
    const double begin = ThreadCpuSeconds();
    std::optional<Scan> scan = sensor.Read(EpisodeTime(now_s_));
    sense_s_ += ThreadCpuSeconds() - begin;
    if (const auto jump_s = sensor.TakeClockJump()) {
      // Without its scans, what is seen gets stale.
      Note(control::SafetyCheck::kClockJump, control::Reaction::kNone, *jump_s,
           ClockWatch::kJump_s);
    }
    if (!scan) return;
    if (robot_filter_.Sees(scan->sensor)) {
      robot_filter_.Remove(MeasuredAt(scan->t, recorder_.recording().control, world_.robot->Read()),
                           &*scan);
    }
    if (!scans_.Put(*std::move(scan), EpisodeTime(now_s_))) sensor.LeaveOut();
  }

  void Learn(const std::vector<Scan>& scans) {
    has_scan_ = true;
    model_->Observe(scans);
    for (TrackEvent& event : model_->TakeEvents()) recorder_.Keep(std::move(event));
    recorder_.Keep(scans, EpisodeTime(now_s_), model_->ChangedCells());
    if (safety_) world_.robot->Watch(safety_->Observe(scans));
  }

  // The first multiple of the period that is past `t_s`, or as good as there, and not used yet.
  void ScheduleCycle(double t_s) {
    while (next_cycle_s_ < t_s - kTimeEpsilon) {
      next_cycle_s_ = ++cycle_index_ / scenario_.replan_rate_hz;
    }
  }

  void BeginCycle() {
    const HorizonOffset expected = latency_.Expected();
    next_cycle_s_ = ++cycle_index_ / scenario_.replan_rate_hz;
    // In real time a cycle that is done early need not wait for its moment.
    if (!is_real_time_) ScheduleCycle(now_s_ + expected.seconds());
    if (!has_scan_) return;  // nothing is known yet
    const robot::RobotStatus status = world_.robot->Status();
    // What it follows is behind its time as far as it has slowed down.
    replanner_.Delay(HorizonOffset(status.lag.seconds() - lag_.seconds()));
    lag_ = status.lag;
    // What begins anew, and is to begin or just has, may be followed from the next tick on.
    const bool may_go_on = !status.is_held && now_s_ - begun_anew_s_ <= kSeesCommand_s;
    if (!may_go_on && status.mode == robot::RobotMode::kHolding) {
      // It has left its plan by itself, and begins anew when it rests.
      world_.robot->Hold();
      pending_.clear();
      replanner_.Forget();
      begins_anew_ = true;
      if (world_.robot->Read().v.cwiseAbs().maxCoeff() > kStill_rad_s) return;
    }
    begun_ = {now_s_, expected, model_->MakeField()};
    planner::CycleTask task = replanner_.Prepare(EpisodeTime(now_s_), world_.robot->Read(),
                                                 expected, goal_, begun_.field);
    task.budget = BudgetOf(expected);
    worker_->Begin([this, task = std::move(task)] { return replanner_.Work(task); });
    if (!is_real_time_) TakeCycle();
  }

  // Of a cycle that begins now: a plan that is good enough in time is worth more than a better one
  // that is dropped. Only where time is real does a clock say when.
  planner::PlanBudget BudgetOf(HorizonOffset latency) const {
    planner::PlanBudget budget;
    if (is_real_time_) {
      const std::chrono::duration<double> left(kPlanningShare * latency.seconds() - kHandOver_s);
      budget.deadline = std::chrono::steady_clock::now() +
                        std::chrono::duration_cast<std::chrono::steady_clock::duration>(left);
    } else if (scenario_.most_iterations > 0) {
      return planner_->BudgetOf(scenario_.most_iterations);
    }
    return budget;
  }

  // Takes the result of a cycle, if one is there.
  void TakeCycle() {
    std::optional<planner::CycleResult> cycle = worker_->TakeFinished();
    if (!cycle) return;
    const double cpu_s = KeepTimes(*cycle);
    const double took_s = is_real_time_ ? now_s_ - begun_.t_s : latency_.Charge(cpu_s).seconds();
    latency_.Learn(is_real_time_ ? took_s : cpu_s);
    const double effect_s = begun_.t_s + begun_.expected.seconds();
    CycleRecord& record = cycle->record;
    const double hand_over_s = is_real_time_ ? kHandOver_s : -kTimeEpsilon;
    if (cycle->plan && begun_.t_s + took_s > effect_s - hand_over_s) {
      record.accepted = false;
      record.status = kLate;
      ++result_.late_plans;
    } else {
      replanner_.Accept(*cycle);
      // It agrees with what runs until it takes effect, or begins then. On a wall clock, where
      // nobody may be looking at that very moment, the robot has it before.
      if (cycle->plan) {
        pending_.push_back({*cycle->plan, is_real_time_ ? now_s_ : effect_s});
        pending_.back().plan.start = cycle->plan->start - lag_;
      }
    }
    ScheduleCycle(begun_.t_s + took_s);
    record.objects = model_->DescribeObjects(planner::TimesToDescribe(record));
    recorder_.Keep(std::move(record));
    if (options_.observe_field) {
      options_.observe_field(EpisodeTime(begun_.t_s), begun_.field, world_.truth);
    }
  }

  // @return the CPU time that the cycle needed.
  double KeepTimes(const planner::CycleResult& cycle) {
    const sdf::WorldModelTimes map = model_->TakeTimes();
    const double seconds[] = {sense_s_,    map.map_s,     map.segment_s,
                              map.track_s, map.predict_s, cycle.optimise_s};
    static_assert(std::size(seconds) == std::size(kCycleStages));
    double sum = 0;
    for (std::size_t i = 0; i < std::size(kCycleStages); ++i) {
      result_.times[kCycleStages[i]].push_back(seconds[i]);
      sum += seconds[i];
    }
    result_.times["cycle"].push_back(sum);
    if (sum > begun_.expected.seconds()) ++result_.cycles_over_charge;
    sense_s_ = 0;
    return sum;
  }

  EpisodeResult Finish() {
    result_.recording = recorder_.Take();
    const record::Recording& recording = result_.recording;
    ComputeMetrics(result_.recording);
    result_.outcome = is_aborted_ ? Outcome::kAborted : Judge(recording, goal_.dwelt().has_value());
    if (!is_aborted_ && recording.metrics.at("plans_accepted") == 0) {
      result_.reason = WhyNoPlan(recording);
    }
    TellInHeader(result_);
    for (const SensorWatch& sensor : sensors_) {
      result_.scans_left_out[sensor.name()] += sensor.num_left_out();
    }
    return std::move(result_);
  }

  const scenarios::Scenario& scenario_;
  EpisodeWorld& world_;
  std::vector<SensorWatch> sensors_;
  const EpisodeOptions& options_;
  std::unique_ptr<planner::Planner> planner_;
  std::unique_ptr<sdf::WorldModel> model_;
  double horizon_s_;
  planner::Replanner replanner_;
  GoalWatch goal_;
  LatencyModel latency_;
  std::unique_ptr<Clock> clock_;
  const bool is_real_time_;
  std::unique_ptr<PlanningWorker> worker_;
  EpisodeRecorder recorder_;
  ScanOrder scans_;
  RobotFilter robot_filter_;
  std::optional<SafetyWatch> safety_;

  std::deque<Pending> pending_;
  Begun begun_ = {};
  HorizonOffset lag_{0};  // of the robot behind its plans, as the latest cycle knew it
  double now_s_ = 0;
  int cycle_index_ = 0;
  double next_cycle_s_ = 0;
  double end_s_;
  double sense_s_ = 0;
  bool begins_anew_ = true;   // the next plan: it goes on with no other
  double begun_anew_s_ = -1;  // when the latest of such was to begin
  bool has_scan_ = false;
  bool is_aborted_ = false;
  EpisodeResult result_;
};

}  // namespace

namespace {

bool SeesTags(const scenarios::Scenario& scenario) {
  const std::vector<scenarios::SensorSettings> sensors = scenarios::SensorsOf(scenario);
  return std::any_of(sensors.begin(), sensors.end(), [](const auto& sensor) {
    return sensor.tags.has_value() || sensor.tag_images.has_value();
  });
}

sdf::EvidenceOptions EvidenceOf(const scenarios::EvidenceSettings& settings) {
  sdf::EvidenceOptions options;
  options.hit = settings.hit;
  options.miss = settings.miss;
  options.least = settings.least;
  options.most = settings.most;
  options.settle_scans = settings.settle_scans;
  options.decay_per_s = settings.decay_per_s;
  options.noise_sigmas = settings.noise_sigmas;
  options.average_scans = settings.average_scans;
  options.least_cells = settings.least_cells;
  return options;
}

// Whether a tag may be said to be where it is not. What is only noisy needs no gates, and they cost
// time where something stops dead.
bool TagsMayMisbehave(const scenarios::Scenario& scenario) {
  const std::vector<scenarios::SensorSettings> sensors = scenarios::SensorsOf(scenario);
  return std::any_of(sensors.begin(), sensors.end(), [](const auto& sensor) {
    if (!sensor.tags) return false;
    const scenarios::TagSettings& tags = *sensor.tags;
    return std::max({tags.partly_hidden, tags.flips, tags.outliers, tags.swaps, tags.phantoms}) > 0;
  });
}

// Of what is known by its shape, and not by cells that the workspace bounds.
void CheckFieldSizes(const scenarios::Scenario& scenario, const sdf::WorldModelOptions& options) {
  const bool by_truth = options.knowledge == sdf::Knowledge::kFullKnowledge;
  const bool by_tags = options.knowledge == sdf::Knowledge::kPrediction && SeesTags(scenario);
  if (!by_truth && !by_tags) return;
  const double growth_m = by_tags ? sdf::LargestGrowth(options) : 0;
  for (std::size_t i = 0; i < scenario.moving_obstacles.size(); ++i) {
    const double cells = sdf::ShapeFieldCells(
        scenario.moving_obstacles[i].shape, options.grid.cell_m, options.max_distance_m + growth_m);
    if (cells <= sdf::kMostShapeFieldCells) continue;
    throw scenarios::WrongValue(
        scenario, "moving_obstacles[" + std::to_string(i) + "].shape",
        fmt::format("its field would have {:.3g} cells of {:g} m, it may have {:.3g}: make '{}' "
                    "smaller or workspace.cell_m larger",
                    cells, options.grid.cell_m, sdf::kMostShapeFieldCells,
                    scenario.moving_obstacles[i].name),
        {"workspace.cell_m"});
  }
}

}  // namespace

sdf::WorldModelOptions MakeWorldModelOptions(const scenarios::Scenario& scenario,
                                             double max_distance_m, const EpisodeWorld& world) {
  sdf::WorldModelOptions options;
  options.knowledge = sdf::KnowledgeFromString(scenario.knowledge);
  options.predictor = scenario.predictor;
  options.coast = HorizonOffset(scenario.tracking.coast_s);
  options.max_speed_m_s = scenario.tracking.max_speed_m_s;
  options.gates_named_objects = TagsMayMisbehave(scenario);
  options.growth_sigmas = scenario.growth_sigmas;
  options.growth_limit_m = scenario.growth_limit_m;
  if (scenario.safety.profile == scenarios::SafetyProfile::kLab) {
    // Plans that the supervisor lets through: its stops keep clear of where things can stray.
    options.stray_m_s2 = scenario.safety.obstacle_acceleration_m_s2;
    options.stray_s = kUsualStop_s;
  }
  options.grid = scenario.grid;
  for (const scenarios::SensorSettings& sensor : scenarios::SensorsOf(scenario)) {
    if (!sensor.camera) continue;
    options.views[NameOf(sensor)] = {sdf::UnseenSpaceFromString(sensor.camera->unseen),
                                     sensor.camera->noise_per_m};
  }
  if (!scenario.evidence.single_frames) options.evidence = EvidenceOf(scenario.evidence);
  options.max_distance_m = max_distance_m;
  options.cells = scenario.sensor.cells;
  options.exact.half_spaces = {FloorOf(scenario)};
  if (scenario.static_world == scenarios::StaticWorld::kExact)
    options.exact.shapes = StaticShapes(scenario);
  // Where the scenario is not simulated, its motions are not the truth.
  if (world.truth != nullptr) options.true_obstacles = TrueMotions(scenario);
  CheckFieldSizes(scenario, options);
  return options;
}

EpisodeResult RunEpisode(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                         const WorldFactory& make_world, const EpisodeOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  EpisodeWorld world = make_world(scenario, robot);
  const HoldAtTheEnd hold(*world.robot);
  EpisodeResult result = Loop(scenario, robot, world, options).Run();
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

EpisodeResult CutOffEpisode(record::Recording recording) {
  EpisodeResult result;
  result.outcome = Outcome::kAborted;
  result.reason = "its process ended before the episode did";
  result.times = NoTimes();
  result.recording = std::move(recording);
  ComputeMetrics(result.recording);
  TellInHeader(result);
  return result;
}

void RequireWhole(const EpisodeResult& result) {
  if (result.outcome != Outcome::kAborted) return;
  throw std::runtime_error("the episode was aborted: " + result.reason);
}

}  // namespace sidestep::bench
