#pragma once

#include <Eigen/Core>

#include "sidestep/control/joint_vector.h"
#include "sidestep/core/time.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::control {

/// Keeps the tool frame below a speed: says how quickly a plan may be followed. Allocates nothing
/// after construction.
class ToolGate {
 public:
  /// @param most_m_s infinite: any.
  ToolGate(const robot::RobotModel& robot, double most_m_s);

  bool is_open() const;  ///< any speed will do
  double most_m_s() const { return most_m_s_; }

  /// How fast the tool is from one position of the joints to the next.
  double SpeedBetween(const JointVector& q_from, const JointVector& q_to, double period_s) noexcept;

  struct Ahead {
    double pace = 1;         ///< at which the plan may be followed now, 1 at most
    double fastest_m_s = 0;  ///< as planned, as far as it looks ahead
  };
  /// Looks so far ahead that a pace which falls by `slowing_per_s` is low enough when the plan gets
  /// fast. 6 % of the speed are kept in reserve for how commands follow plans.
  Ahead LookAhead(const Trajectory& plan, HorizonOffset offset, double slowing_per_s) noexcept;

 private:
  Eigen::Vector3d ToolAt(const JointVector& q) noexcept;

  const robot::RobotModel robot_;
  const double most_m_s_;
  Eigen::VectorXd q_;  // of the robot's number of joints, so that none has to be made
  JointVector sample_q_, sample_v_, sample_a_;
};

}  // namespace sidestep::control
