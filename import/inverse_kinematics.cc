#include "sidestep/import/inverse_kinematics.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace sidestep::imports {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kEnough = 1e-6;  // m and rad
constexpr int kMostSteps = 200;
constexpr double kLongestStep = 0.3;  // of any joint: rad or m
constexpr double kMetresOfARadian = 0.25;

struct LinkState {
  Pose X_WL;
  Eigen::Matrix<double, 6, Eigen::Dynamic> J;  ///< of its origin's position and its rotation, in W
};

LinkState StateOf(const robot::RobotModel& robot, int link, const Eigen::VectorXd& q) {
  const robot::Kinematics& kinematics = robot.kinematics();
  robot::RowPlaces places;
  places.of[0].R_WK = robot.X_WB().rotation().toRotationMatrix();
  places.of[0].p_WK = robot.X_WB().translation();
  PlaceRows(kinematics.rows(), q, places);
  const robot::LinkOnRow& on_row = kinematics.link(link);
  const robot::RowPlace& row = places[on_row.row];
  const Eigen::Matrix3d R_WL = row.R_WK * on_row.R_KL;
  LinkState state;
  const Eigen::Vector3d p_WL = row.p_WK + row.R_WK * on_row.p_KL;
  state.X_WL = Pose(Eigen::Quaterniond(R_WL), p_WL);
  state.J.setZero(6, robot.num_joints());
  for (const int mover : kinematics.movers(on_row.row)) {
    const robot::KinematicRow& joint = kinematics.rows()[static_cast<std::size_t>(mover)];
    const robot::RowPlace& place = places[mover];
    Vector6d column = Vector6d::Zero();
    if (joint.slides) {
      column.head<3>() = place.z_W;
    } else {
      column << place.z_W.cross(p_WL - place.p_WJ), place.z_W;
    }
    state.J.col(joint.coordinate) += joint.multiplier * column;
  }
  return state;
}

// What leads from where the link is to the target: metres, and the rotation vector.
Vector6d ErrorOf(const Pose& X_WL, const Pose& X_WTarget) {
  Eigen::AngleAxisd turn(X_WTarget.rotation() * X_WL.rotation().conjugate());
  if (turn.angle() > std::numbers::pi) turn.angle() -= 2 * std::numbers::pi;
  Vector6d error;
  error << X_WTarget.translation() - X_WL.translation(), turn.angle() * turn.axis();
  return error;
}

double Middle(const robot::JointLimits& limits) {
  const bool is_bounded = std::isfinite(limits.q_min) && std::isfinite(limits.q_max);
  return is_bounded ? (limits.q_min + limits.q_max) / 2 : 0;
}

void Clamp(const robot::RobotModel& robot, Eigen::VectorXd& q) {
  for (int i = 0; i < robot.num_joints(); ++i) {
    const robot::JointLimits& limits = robot.limits()[static_cast<std::size_t>(i)];
    q(i) = std::clamp(q(i), limits.q_min, limits.q_max);
  }
}

}  // namespace

std::optional<Eigen::VectorXd> ReachFrom(const robot::RobotModel& robot, const LinkTarget& target,
                                         Eigen::VectorXd q) {
  Clamp(robot, q);
  for (int step = 0; step < kMostSteps; ++step) {
    const LinkState state = StateOf(robot, target.link, q);
    Vector6d error = ErrorOf(state.X_WL, target.X_WL);
    if (error.head<3>().norm() < kEnough && error.tail<3>().norm() < kEnough) return q;
    Eigen::Matrix<double, 6, Eigen::Dynamic> J = state.J;
    error.tail<3>() *= kMetresOfARadian;
    J.bottomRows<3>() *= kMetresOfARadian;
    const double damping = 1e-12 + 1e-2 * std::min(error.squaredNorm(), 1.0);
    const Eigen::Matrix<double, 6, 6> normal =
        J * J.transpose() + damping * Eigen::Matrix<double, 6, 6>::Identity();
    Eigen::VectorXd dq = J.transpose() * normal.ldlt().solve(error);
    const double longest = dq.cwiseAbs().maxCoeff();
    if (longest > kLongestStep) dq *= kLongestStep / longest;
    const Eigen::VectorXd before = q;
    q += dq;
    Clamp(robot, q);
    if ((q - before).cwiseAbs().maxCoeff() < 1e-12) break;  // it leans against limits
  }
  return std::nullopt;
}

std::optional<Eigen::VectorXd> SolvePose(
    const robot::RobotModel& robot, const LinkTarget& target, const Eigen::VectorXd& q_near,
    int num_starts, RandomStream& random,
    const std::function<bool(const Eigen::VectorXd&)>& is_good) {
  std::optional<Eigen::VectorXd> best;
  double least = std::numeric_limits<double>::infinity();
  for (int start = 0; start < num_starts + 2; ++start) {
    Eigen::VectorXd from = q_near;
    if (start == 1) {
      for (int i = 0; i < robot.num_joints(); ++i) {
        from(i) = Middle(robot.limits()[static_cast<std::size_t>(i)]);
      }
    }
    if (start > 1) from = RandomConfiguration(robot, random);
    const auto q = ReachFrom(robot, target, from);
    if (!q) continue;
    const double way = (*q - q_near).cwiseAbs().maxCoeff();
    if (way >= least || !is_good(*q)) continue;
    least = way;
    best = q;
  }
  return best;
}

Eigen::VectorXd RandomConfiguration(const robot::RobotModel& robot, RandomStream& random) {
  Eigen::VectorXd q(robot.num_joints());
  for (int i = 0; i < robot.num_joints(); ++i) {
    const robot::JointLimits& limits = robot.limits()[static_cast<std::size_t>(i)];
    const bool is_bounded = std::isfinite(limits.q_min) && std::isfinite(limits.q_max);
    q(i) = is_bounded ? random.Uniform(limits.q_min, limits.q_max)
                      : random.Uniform(-std::numbers::pi, std::numbers::pi);
  }
  return q;
}

}  // namespace sidestep::imports
