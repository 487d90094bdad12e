#include "sidestep/control/tool_gate.h"

#include <algorithm>
#include <cmath>

namespace sidestep::control {
namespace {

constexpr double kAimedAt = 0.94;   // of the speed
constexpr double kStep_s = 0.05;    // between looks
constexpr double kGlance_s = 2e-3;  // of which each measures a speed

}  // namespace

ToolGate::ToolGate(const robot::RobotModel& robot, double most_m_s)
    : robot_(robot),
      most_m_s_(most_m_s),
      q_(robot.num_joints()),
      sample_q_(robot.num_joints()),
      sample_v_(robot.num_joints()),
      sample_a_(robot.num_joints()) {}

bool ToolGate::is_open() const { return std::isinf(most_m_s_); }

Eigen::Vector3d ToolGate::ToolAt(const JointVector& q) noexcept {
  q_ = q;
  return robot_.ComputeToolPose(q_).translation();
}

double ToolGate::SpeedBetween(const JointVector& q_from, const JointVector& q_to,
                              double period_s) noexcept {
  return (ToolAt(q_to) - ToolAt(q_from)).norm() / period_s;
}

ToolGate::Ahead ToolGate::LookAhead(const Trajectory& plan, HorizonOffset offset,
                                    double slowing_per_s) noexcept {
  const int looks = static_cast<int>(std::ceil(1 / (slowing_per_s * kStep_s)));
  const auto tool_at = [&](double after_s) {
    SampleInto(plan, HorizonOffset(offset.seconds() + after_s), sample_q_, sample_v_, sample_a_);
    return ToolAt(sample_q_);
  };
  Ahead ahead;
  for (int look = 0; look <= looks; ++look) {
    const double after_s = look * kStep_s;
    const double speed_m_s = (tool_at(after_s + kGlance_s) - tool_at(after_s)).norm() / kGlance_s;
    ahead.fastest_m_s = std::max(ahead.fastest_m_s, speed_m_s);
    // It takes at least as long to come there as planned, and the pace can fall meanwhile.
    const double aimed_at = kAimedAt * most_m_s_ / speed_m_s;
    ahead.pace = std::min(ahead.pace, aimed_at + slowing_per_s * after_s);
  }
  return ahead;
}

}  // namespace sidestep::control
