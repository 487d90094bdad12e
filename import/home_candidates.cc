#include "sidestep/import/home_candidates.h"

#include <algorithm>
#include <cmath>

#include "sidestep/import/arm_pose.h"
#include "sidestep/import/solid_points.h"

namespace sidestep::imports {
namespace {

constexpr int kRandom = 300;
constexpr double kLow_m = 0.05;  // above the base's plane: hardly more than a planner's margin

int CountBelow(const robot::ArmDescription& arm, const Eigen::VectorXd& q) {
  const std::vector<Pose> links = LinkPosesAt(arm, q);
  int below = 0;
  for (std::size_t i = 0; i < links.size(); ++i) {
    std::vector<Ball> balls;
    for (const robot::LinkSolid& solid : arm.links[i + 1].solids) AppendBalls(solid, &balls);
    below += std::any_of(balls.begin(), balls.end(), [&](const Ball& ball) {
      return (links[i] * ball.p_L).z() - ball.radius_m < kLow_m;
    });
  }
  return below;
}

}  // namespace

std::vector<Eigen::VectorXd> HomeCandidates(const robot::ArmDescription& arm) {
  const auto n = static_cast<Eigen::Index>(arm.limits.size());
  Eigen::VectorXd zero = Eigen::VectorXd::Zero(n), middle = zero;
  for (Eigen::Index j = 0; j < n; ++j) {
    const robot::JointLimits& limits = arm.limits[static_cast<std::size_t>(j)];
    zero(j) = std::clamp(0.0, limits.q_min, limits.q_max);
    const bool limited = std::isfinite(limits.q_min) && std::isfinite(limits.q_max);
    middle(j) = limited ? (limits.q_min + limits.q_max) / 2 : zero(j);
  }
  std::vector<Eigen::VectorXd> all = {zero, middle};
  const std::vector<Eigen::VectorXd> random = SampleConfigurations(arm, kRandom);
  all.insert(all.end(), random.begin(), random.end());
  std::vector<std::pair<int, Eigen::VectorXd>> counted;
  for (const Eigen::VectorXd& q : all) counted.emplace_back(CountBelow(arm, q), q);
  std::stable_sort(counted.begin(), counted.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Eigen::VectorXd> sorted;
  for (const auto& [below, q] : counted) {
    // A hundredth is exact enough, and still within the limits.
    Eigen::VectorXd rounded = (q * 100).array().round().matrix() / 100;
    for (Eigen::Index j = 0; j < n; ++j) {
      const robot::JointLimits& limits = arm.limits[static_cast<std::size_t>(j)];
      rounded(j) = std::clamp(rounded(j), limits.q_min, limits.q_max);
    }
    sorted.push_back(rounded);
  }
  return sorted;
}

}  // namespace sidestep::imports
