#include "sidestep/bench/robot_filter.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace sidestep::bench {
namespace {

constexpr double kReachSigmas = 4;

struct Ball {
  Eigen::Vector3d a, b;  // the ends of its axis
  double radius_m;
};

double Distance(const Ball& ball, const Eigen::Vector3d& p) {
  const Eigen::Vector3d axis = ball.b - ball.a, from_a = p - ball.a;
  const double length_m2 = axis.squaredNorm();
  const double along = length_m2 > 0 ? std::clamp(from_a.dot(axis) / length_m2, 0.0, 1.0) : 0;
  return (from_a - along * axis).norm() - ball.radius_m;
}

Eigen::Matrix3Xd Keep(const Eigen::Matrix3Xd& points, const std::vector<Eigen::Index>& columns) {
  Eigen::Matrix3Xd kept(3, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t n = 0; n < columns.size(); ++n) {
    kept.col(static_cast<Eigen::Index>(n)) = points.col(columns[n]);
  }
  return kept;
}

}  // namespace

RobotFilter::RobotFilter(const scenarios::Scenario& scenario, const robot::RobotModel& robot)
    : robot_(robot), capsules_(robot) {
  for (const scenarios::SensorSettings& sensor : scenarios::SensorsOf(scenario)) {
    if (!sensor.camera || !sensor.camera->sees_robot) continue;
    margins_[NameOf(sensor)] = {sensor.camera->robot_margin_m, sensor.camera->noise_per_m};
  }
}

void RobotFilter::Remove(const Eigen::VectorXd& q, Scan* scan) const {
  const Margin& margin = margins_.at(scan->sensor);
  std::vector<Ball> balls;
  const Eigen::Matrix3Xd p_WS = robot_.ComputeSphereCenters(q, false).p_WS;
  for (Eigen::Index s = 0; s < p_WS.cols(); ++s) {
    balls.push_back({p_WS.col(s), p_WS.col(s), robot_.sphere_radii_m()(s)});
  }
  control::ArmCapsules::All placed;
  capsules_.Place(q, placed);
  for (std::size_t k = 0; k < static_cast<std::size_t>(capsules_.size()); ++k) {
    balls.push_back({placed[k].a, placed[k].b, placed[k].radius_m});
  }
  const Eigen::Matrix3d R_WC = scan->X_WC.rotation().toRotationMatrix();
  std::vector<Eigen::Index> others, own;
  for (Eigen::Index n = 0; n < scan->p_CP.cols(); ++n) {
    const Eigen::Vector3d p_CP = scan->p_CP.col(n);
    const Eigen::Vector3d p_WP = scan->X_WC.translation() + R_WC * p_CP;
    const double deviation_m = margin.noise_per_m * std::abs(p_CP.z()) * p_CP.norm();
    const double reach_m = margin.fixed_m + kReachSigmas * deviation_m;
    const bool is_own = std::any_of(balls.begin(), balls.end(), [&](const Ball& ball) {
      return Distance(ball, p_WP) <= reach_m;
    });
    (is_own ? own : others).push_back(n);
  }
  if (!scan->rays.empty()) {
    std::vector<int> rays;
    for (const Eigen::Index n : others) rays.push_back(scan->rays[static_cast<std::size_t>(n)]);
    scan->rays = std::move(rays);
  }
  const Eigen::Matrix3Xd free_ends = scan->p_CFree;
  const Eigen::Matrix3Xd own_points = Keep(scan->p_CP, own);
  scan->p_CP = Keep(scan->p_CP, others);
  scan->p_CFree.resize(3, free_ends.cols() + own_points.cols());
  scan->p_CFree << free_ends, own_points;
}

Eigen::VectorXd MeasuredAt(EpisodeTime t, const std::vector<ControlSample>& recorded,
                           const JointState& now) {
  const auto after = std::lower_bound(
      recorded.begin(), recorded.end(), t,
      [](const ControlSample& sample, EpisodeTime time) { return sample.t < time; });
  const auto off_s = [t](EpisodeTime other) { return std::abs((other - t).seconds()); };
  double least_s = off_s(now.t);
  Eigen::VectorXd q = now.q;
  const auto look_at = [&](const ControlSample& sample) {
    if (off_s(sample.t) > least_s) return;
    least_s = off_s(sample.t);
    q = sample.q;
  };
  if (after != recorded.end()) look_at(*after);
  if (after != recorded.begin()) look_at(*(after - 1));
  return q;
}

}  // namespace sidestep::bench
