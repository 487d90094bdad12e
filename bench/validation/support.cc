#include "sidestep/bench/validation/support.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sidestep/control/arm_capsules.h"
#include "sidestep/control/follower.h"
#include "sidestep/control/joint_motion.h"
#include "sidestep/control/segment_box.h"
#include "sidestep/core/number_text.h"

namespace sidestep::bench {
namespace {

constexpr double kMoving_rad_s = 1e-3;
constexpr double kTick_s = 1e-3;
constexpr std::size_t kNamed = 3;

}  // namespace

std::string NameOf(const RunRow& row) { return row.factors.at("case"); }

bool IsOfGroup(const RunRow& row, const char* group) { return row.factors.at("group") == group; }

bool IsWithinEnvelope(const RunRow& row) {
  using namespace validation_group;
  for (const char* const group : {kEnvelope, kPerception, kTiming, kSoak}) {
    if (IsOfGroup(row, group)) return true;
  }
  return false;
}

bool IsEnvelopeOrSoak(const RunRow& row) {
  return IsOfGroup(row, validation_group::kEnvelope) || IsOfGroup(row, validation_group::kSoak);
}

std::vector<Told> LargestFirst(const Evidence& evidence, const std::string& fact,
                               const RowTest& filter) {
  std::vector<Told> told;
  for (const RunRow& row : evidence.rows) {
    const auto found = row.metrics.find(fact);
    if (found == row.metrics.end() || std::isnan(found->second) || !filter(row)) continue;
    told.push_back({&row, found->second});
  }
  std::stable_sort(told.begin(), told.end(),
                   [](const Told& a, const Told& b) { return a.value > b.value; });
  return told;
}

double SumOf(const std::vector<Told>& told) {
  double sum = 0;
  for (const Told& one : told) sum += one.value;
  return sum;
}

std::vector<NamedCase> WorstOf(const std::vector<Told>& told, double limit, const char* format) {
  std::vector<NamedCase> worst;
  for (const Told& one : told) {
    if (!worst.empty() && !(one.value > limit)) break;
    if (worst.size() == kNamed) break;
    worst.push_back({NameOf(*one.row), FiniteText(format, one.value)});
  }
  return worst;
}

ItemFinding NothingRun(const std::string& why) { return {ItemVerdict::kNotRun, why, {}}; }

bool IsMoving(const Eigen::VectorXd& v) { return v.norm() > kMoving_rad_s; }

bool IsBase(const robot::RobotModel& robot, const TruthSample& sample) {
  return sample.nearest_robot_part == robot.base();
}

bool IsToldToMove(const ControlSample& tick) { return IsMoving(tick.v_command); }

double FastestSphere_m_s(const robot::RobotModel& robot, const ControlSample& tick) {
  const robot::SphereCenters centers =
      robot.ComputeSphereCenters(tick.q_command, /*with_jacobian=*/true);
  double fastest_m_s = 0;
  for (Eigen::Index s = 0; s < centers.p_WS.cols(); ++s) {
    const Eigen::Vector3d v_m_s = centers.Jq.middleRows(3 * s, 3) * tick.v_command;
    fastest_m_s = std::max(fastest_m_s, v_m_s.norm());
  }
  return fastest_m_s;
}

control::JerkLimitedTracker LabTracker(const robot::RobotModel& robot) {
  control::SafetySettings settings;
  settings.range_margin_rad = kLeastJointMargin_rad;
  settings.v_share = kMostVelocityShare;
  return control::JerkLimitedTracker(control::LabLimits(robot, settings));
}

StopFrom StopOf(const control::JerkLimitedTracker& tracker, const ControlSample& tick) {
  StopFrom stop;
  stop.q_end = tick.q_command;
  for (int j = 0; j < tracker.num_joints(); ++j) {
    const control::JointMotion motion = {tick.q_command(j), tick.v_command(j), tick.a_command(j)};
    const control::JointStop joint(motion, tracker.bounds(j), kTick_s);
    stop.q_end(j) = joint.q_end();
    stop.seconds = std::max(stop.seconds, joint.ticks() * kTick_s);
    stop.keeps_to_limits =
        stop.keeps_to_limits && control::CanStopWithin(motion, tracker.bounds(j), kTick_s);
  }
  return stop;
}

double GreatestWay(const robot::RobotModel& robot, const Eigen::VectorXd& q_from,
                   const Eigen::VectorXd& q_to) {
  const Eigen::Matrix3Xd from = robot.ComputeSphereCenters(q_from, false).p_WS;
  const Eigen::Matrix3Xd to = robot.ComputeSphereCenters(q_to, false).p_WS;
  return (to - from).colwise().norm().maxCoeff();
}

double DistanceToObstacles(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                           const Eigen::VectorXd& q, const std::vector<Pose>& X_WO) {
  const control::ArmCapsules capsules(robot);
  control::ArmCapsules::All placed;
  capsules.Place(q, placed);
  double least_m = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < X_WO.size(); ++i) {
    const Pose X_OW = X_WO[i].Inverse();
    const Eigen::Vector3d half_m = HalfExtents(scenario.moving_obstacles[i].shape);
    for (std::size_t c = 0; c < static_cast<std::size_t>(capsules.size()); ++c) {
      if (!placed[c].moves) continue;
      const double distance_m =
          control::SegmentBoxDistance(X_OW * placed[c].a, X_OW * placed[c].b, half_m);
      least_m = std::min(least_m, distance_m - placed[c].radius_m);
    }
  }
  return least_m;
}

}  // namespace sidestep::bench
