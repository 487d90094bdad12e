#include "sidestep/planner/braking.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

namespace sidestep::planner {
namespace {

constexpr double kAccelerationShare = 0.9;
constexpr double kQuickest_s = 0.01;
constexpr double kSameState_s = 1e-6;  // nearer states are one, the earlier
// States of the grid this near to the end of a stop are left out: between two that are close, an
// acceleration is a small difference over a smaller one.
constexpr double kNeighbour_s = 1e-3;

// What a stop may last [s].
struct Bounds {
  double least = kQuickest_s;                             // within the acceleration
  double gentle = kQuickest_s;                            // within a share of it
  double most = std::numeric_limits<double>::infinity();  // within the position limits
};

Bounds StopBoundsOf(const robot::JointLimits& limits, double q, double v) {
  Bounds bounds;
  if (v == 0) return bounds;
  const double quickest_s = std::abs(v) / limits.a_max;
  bounds.least = std::max(kQuickest_s, quickest_s);
  bounds.gentle = std::max(kQuickest_s, quickest_s / kAccelerationShare);
  const double room = v > 0 ? limits.q_max - q : q - limits.q_min;
  bounds.most = 2 * std::max(0.0, room) / std::abs(v);  // it goes half as far as without braking
  return bounds;
}

// How long each joint's stop lasts.
Eigen::VectorXd ChooseTimes(const std::vector<robot::JointLimits>& limits,
                            const TrajectoryPoint& from, double step_s) {
  const Eigen::Index n = from.q.size();
  Eigen::VectorXd own(n);
  Bounds all;
  for (Eigen::Index j = 0; j < n; ++j) {
    const Bounds bounds = StopBoundsOf(limits[static_cast<std::size_t>(j)], from.q(j), from.v(j));
    own(j) = std::max(bounds.least, std::min(bounds.gentle, bounds.most));
    all.least = std::max(all.least, bounds.least);
    all.gentle = std::max(all.gentle, bounds.gentle);
    all.most = std::min(all.most, bounds.most);
  }
  if (all.least > all.most) return own;
  const double whole_steps_s = std::max(1.0, std::ceil(all.gentle / step_s)) * step_s;
  return Eigen::VectorXd::Constant(n, std::min(whole_steps_s, all.most));
}

std::vector<double> SupportTimes(const Eigen::VectorXd& stop_s, double step_s, int num_states) {
  std::vector<double> times(stop_s.begin(), stop_s.end());
  for (int k = 0; k < num_states; ++k) {
    const double t_s = k * step_s;
    const bool has_neighbour = ((stop_s.array() - t_s).abs() < kNeighbour_s).any();
    if (!has_neighbour || k + 1 == num_states) times.push_back(t_s);
  }
  std::sort(times.begin(), times.end());
  const auto same = [](double a, double b) { return b - a < kSameState_s; };
  times.erase(std::unique(times.begin(), times.end(), same), times.end());
  return times;
}

}  // namespace

Trajectory MakeBraking(const std::vector<robot::JointLimits>& limits, const TrajectoryPoint& from,
                       double step_s, int num_states) {
  Eigen::VectorXd stop_s = ChooseTimes(limits, from, step_s);
  const std::vector<double> times = SupportTimes(stop_s, step_s, num_states);
  for (double& s : stop_s) s = *std::prev(std::upper_bound(times.begin(), times.end(), s));
  const Eigen::Index n = from.q.size(), K = static_cast<Eigen::Index>(times.size());
  Trajectory motion{Eigen::VectorXd(K), Eigen::MatrixXd(n, K), Eigen::MatrixXd(n, K)};
  for (Eigen::Index k = 0; k < K; ++k) {
    motion.t_s(k) = times[static_cast<std::size_t>(k)];
    for (Eigen::Index j = 0; j < n; ++j) {
      const double t_s = std::min(motion.t_s(k), stop_s(j));
      motion.q(j, k) = from.q(j) + (t_s - t_s * t_s / (2 * stop_s(j))) * from.v(j);
      motion.v(j, k) = (1 - t_s / stop_s(j)) * from.v(j);
    }
  }
  return motion;
}

}  // namespace sidestep::planner
