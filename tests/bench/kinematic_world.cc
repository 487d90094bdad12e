#include "tests/bench/kinematic_world.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "sidestep/bench/true_world.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/robot/robot_error.h"

namespace sidestep::bench {
namespace {

constexpr int kTicksPerSecond = 1000, kTicksPerSample = 10;

void BreakIfAsked(const KinematicWorld& world, const std::string& who, EpisodeTime now) {
  if (world.breaks != who || now.seconds() < world.breaks_at_s) return;
  throw std::runtime_error("the " + who + " broke");
}

class Robot final : public robot::RobotInterface {
 public:
  Robot(KinematicWorld& world, const Eigen::VectorXd& q) : world_(world), q_(q) {
    v_ = a_ = Eigen::VectorXd::Zero(q.size());
  }

  EpisodeTime now() const { return EpisodeTime(static_cast<double>(ticks_) / kTicksPerSecond); }
  const std::vector<ControlSample>& history() const { return history_; }

  JointState Read() const override { return {now(), q_, v_}; }

  robot::RobotStatus Status() const override {
    if (world_.holds || is_held_) return {robot::RobotMode::kHolding, "", is_held_};
    return {trajectory_ ? robot::RobotMode::kMoving : robot::RobotMode::kReady, "", false,
            HorizonOffset(lag_s_)};
  }

  void Submit(const Trajectory& trajectory, EpisodeTime start) override {
    world_.submissions.push_back({now(), start});
    world_.holds = false;
    trajectory_ = trajectory;
    start_ = start;
  }

  void Hold() noexcept override {
    trajectory_.reset();
    world_.holds = true;
  }

  void AdvanceTo(EpisodeTime t) override {
    while (now().seconds() < t.seconds() - 1e-9) {
      if (world_.breaks == "robot" && now().seconds() >= world_.breaks_at_s) {
        findings_.push_back({now(), "link", "brake", 20, 19});
        throw robot::RobotError("the robot broke", TakeControlLog());
      }
      Tick();
    }
  }

  std::vector<SafetyEvent> TakeSafetyEvents() override { return std::exchange(findings_, {}); }

  std::vector<ControlSample> TakeControlLog() override {
    const auto begin = history_.begin() + static_cast<std::ptrdiff_t>(taken_);
    std::vector<ControlSample> log(begin, history_.end());
    taken_ = history_.size();
    return log;
  }

 private:
  void Tick() {
    const double t_s = now().seconds();
    is_held_ = t_s > world_.held_from_s && t_s <= world_.held_until_s;
    if (is_held_) {
      Hold();
      v_.setZero();
      a_.setZero();
    }
    const bool is_slow = t_s > world_.slow_from_s && t_s <= world_.slow_until_s;
    const double pace = is_slow ? 0.5 : 1;
    lag_s_ += (1 - pace) / kTicksPerSecond;
    const EpisodeTime planned = now() - HorizonOffset(lag_s_);
    if (trajectory_ && world_.moves && planned >= start_) {
      const TrajectoryPoint point = Sample(*trajectory_, planned - start_);
      q_ = point.q;
      v_ = pace * point.v;
      a_ = point.a;
    }
    history_.push_back({now(), q_, v_, a_, q_, v_, Eigen::VectorXd::Zero(q_.size())});
    ++ticks_;
  }

  KinematicWorld& world_;
  std::int64_t ticks_ = 0;
  std::size_t taken_ = 0;
  double lag_s_ = 0;
  bool is_held_ = false;
  Eigen::VectorXd q_, v_, a_;
  std::optional<Trajectory> trajectory_;
  EpisodeTime start_;
  std::vector<SafetyEvent> findings_;
  std::vector<ControlSample> history_;
};

// Sees the centre of every filled cell.
class CellSensor final : public robot::Sensor {
 public:
  CellSensor(KinematicWorld& world, const scenarios::Scenario& scenario)
      : world_(world),
        scenario_(scenario),
        solids_({StaticShapes(scenario), {}}, TrueMotions(scenario)) {}

  EpisodeTime NextDue() const override {
    return EpisodeTime(world_.sees ? num_scans_ / scenario_.sensor.rate_hz
                                   : std::numeric_limits<double>::infinity());
  }

  std::optional<Scan> Read(EpisodeTime) override {
    const EpisodeTime t = NextDue();
    BreakIfAsked(world_, "sensor", t);
    if (t.seconds() >= world_.falls_silent_at_s) {
      ++world_.empty_reads;
      return std::nullopt;
    }
    ++num_scans_;
    std::vector<Eigen::Vector3d> points;
    const auto [nx, ny, nz] = scenario_.grid.size;
    for (int k = 0; k < nz; ++k) {
      for (int j = 0; j < ny; ++j) {
        for (int i = 0; i < nx; ++i) {
          const Eigen::Vector3d p_W = scenario_.grid.Center(i, j, k);
          if (solids_.Distance(p_W, t) <= 0) points.push_back(p_W);
        }
      }
    }
    Scan scan;
    scan.t = t;
    scan.p_CP.resize(3, static_cast<Eigen::Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) {
      scan.p_CP.col(static_cast<Eigen::Index>(i)) = points[i];
    }
    return scan;
  }

 private:
  KinematicWorld& world_;
  const scenarios::Scenario& scenario_;
  sdf::ShapeField solids_;  // without the floor
  int num_scans_ = 0;
};

// Judges by the robot's spheres, the mounted one left out.
class SphereTruth final : public robot::WorldTruth {
 public:
  SphereTruth(const KinematicWorld& world, const Robot& robot, const robot::RobotModel& model,
              const scenarios::Scenario& scenario)
      : world_(world),
        robot_(robot),
        model_(model),
        scenario_(scenario),
        true_world_(TrueWorld(scenario, std::numeric_limits<double>::infinity())) {}

  std::vector<ObjectObservation> ObstaclesAt(EpisodeTime t) const override {
    std::vector<ObjectObservation> obstacles;
    for (const scenarios::MovingObstacle& obstacle : scenario_.moving_obstacles) {
      ObjectObservation& seen = obstacles.emplace_back();
      seen.id = obstacle.name;
      seen.t = t;
      seen.X_WO = PoseAt(obstacle, t);
      seen.shape = obstacle.shape;
    }
    return obstacles;
  }

  std::vector<TruthSample> TakeSamples() override {
    std::vector<TruthSample> samples;
    for (; judged_ < robot_.history().size(); judged_ += kTicksPerSample) {
      const ControlSample& tick = robot_.history()[judged_];
      BreakIfAsked(world_, "truth", tick.t);
      TruthSample& sample = samples.emplace_back();
      sample.t = tick.t;
      sample.clearance_m = std::numeric_limits<double>::infinity();
      const robot::SphereCenters centers = model_.ComputeSphereCenters(tick.q, false);
      for (Eigen::Index s = 1; s < centers.p_WS.cols(); ++s) {
        const double distance_m = true_world_.Distance(centers.p_WS.col(s), tick.t);
        sample.clearance_m = std::min(sample.clearance_m, distance_m - model_.sphere_radii_m()(s));
      }
      sample.in_contact = sample.clearance_m <= 0;
      if (sample.in_contact) sample.contact_s = tick.t.seconds();
      for (const ObjectObservation& o : ObstaclesAt(tick.t)) sample.X_WO.push_back(o.X_WO);
    }
    return samples;
  }

 private:
  const KinematicWorld& world_;
  const Robot& robot_;
  const robot::RobotModel& model_;
  const scenarios::Scenario& scenario_;
  sdf::ShapeField true_world_;
  std::size_t judged_ = 0;
};

struct Stage {
  Stage(KinematicWorld& world, const scenarios::Scenario& scenario, const robot::RobotModel& model)
      : robot(world, scenario.q_start),
        sensor(world, scenario),
        truth(world, robot, model, scenario) {}
  Robot robot;
  CellSensor sensor;
  SphereTruth truth;
};

}  // namespace

WorldFactory KinematicWorld::Factory() {
  return [this](const scenarios::Scenario& scenario, const robot::RobotModel& model) {
    const auto stage = std::make_shared<Stage>(*this, scenario, model);
    EpisodeWorld world;
    world.owner = stage;
    world.robot = &stage->robot;
    world.sensors = {{"cells", &stage->sensor}};
    if (judges) world.truth = &stage->truth;
    world.joints = model.joint_names();
    for (const scenarios::MovingObstacle& obstacle : scenario.moving_obstacles) {
      world.obstacles.push_back(obstacle.name);
    }
    return world;
  };
}

}  // namespace sidestep::bench
