#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "sidestep/core/time.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sim/mujoco_model.h"

namespace sidestep::sim {

/// The simulated world of one scenario: MuJoCo's model and state, the arm's motors, and obstacles
/// that follow their prescribed paths. Time moves in ticks of 1 ms. After construction and after
/// each Step, everything that depends on positions and velocities (poses, contacts, bias forces)
/// belongs to time(); nothing is a step behind. Not copied: others refer to it.
class World {
 public:
  static constexpr int kTicksPerSecond = 1000;

  /// @param xml what BuildWorldXml made of `scenario`.
  /// @param model the same, compiled, with or without pictures.
  /// @param joints the arm's joints in the model; each must have one motor of gear 1.
  /// @param q_start where they begin, at rest.
  /// @throws InputError if the model has not these joints and motors; std::invalid_argument for a
  /// q_start of the wrong shape or not finite.
  World(const scenarios::Scenario& scenario, std::string xml, MujocoModelPtr model,
        const std::vector<std::string>& joints, const Eigen::VectorXd& q_start);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// One tick on, with this torque from the motors [N m], shape n.
  /// @throws SimulationError, with the time, if the state diverges.
  void Step(const Eigen::VectorXd& torque);

  /// At time 0 again, with the arm where it is now, at rest.
  void BeginAnew();

  std::int64_t ticks() const { return ticks_; }
  EpisodeTime time() const { return TimeOf(ticks_); }
  static EpisodeTime TimeOf(std::int64_t tick) {
    return EpisodeTime(static_cast<double>(tick) / kTicksPerSecond);
  }
  /// The first tick that is not before `t`. What lies within a nanosecond of a tick is that tick.
  static std::int64_t TickNotBefore(EpisodeTime t);

  Eigen::VectorXd q() const;  ///< shape n, rad
  Eigen::VectorXd v() const;  ///< shape n, rad/s
  /// Gravity and Coriolis forces on the joints, to be compensated. Shape n, N m.
  Eigen::VectorXd bias_torque() const;
  /// What the motors really applied in the last Step, within the model's limits. Shape n, N m.
  Eigen::VectorXd motor_torque() const;

  const std::vector<scenarios::MovingObstacle>& obstacles() const { return obstacles_; }
  const std::string& xml() const { return xml_; }  ///< MJCF of the whole world, to draw it
  const mjModel& model() const { return *model_; }
  const mjData& data() const { return *data_; }  ///< as it is now: not to be kept across a Step

 private:
  struct Joint {
    int qpos = 0, dof = 0, motor = 0;  ///< addresses in the model
  };

  Joint FindJoint(const std::string& name, const std::string& file) const;
  Eigen::VectorXd Gather(const mjtNum* of_dofs) const;
  void MoveObstacles();
  void ComputeWhatFollows();
  void CheckPhysics() const;

  std::string xml_;
  MujocoModelPtr model_;
  MujocoDataPtr data_;
  std::vector<scenarios::MovingObstacle> obstacles_;
  std::vector<int> mocap_ids_;  ///< of each obstacle
  std::vector<Joint> joints_;
  std::int64_t ticks_ = 0;
};

}  // namespace sidestep::sim
