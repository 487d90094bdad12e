#include "sidestep/hardware/slow_move.h"

#include <algorithm>
#include <cmath>

namespace sidestep::hardware {

Trajectory SlowMove(const robot::RobotModel& robot, const Eigen::VectorXd& from,
                    const Eigen::VectorXd& to) {
  // The polynomial's largest speed is 15/8 of its mean.
  constexpr double kPeak = 15.0 / 8;
  double duration_s = 1;
  for (Eigen::Index j = 0; j < from.size(); ++j) {
    const double v_max = kSlowShare * robot.limits()[static_cast<std::size_t>(j)].v_max;
    duration_s = std::max(duration_s, kPeak * std::abs(to(j) - from(j)) / v_max);
  }
  const Eigen::Index states = 2 + static_cast<Eigen::Index>(std::ceil(duration_s / 0.1));
  Trajectory way;
  way.t_s = Eigen::VectorXd::LinSpaced(states, 0, duration_s);
  way.q.resize(from.size(), states);
  way.v.resize(from.size(), states);
  for (Eigen::Index k = 0; k < states; ++k) {
    const double s = way.t_s(k) / duration_s;
    way.q.col(k) = from + (to - from) * (s * s * s * (10 - 15 * s + 6 * s * s));
    way.v.col(k) = (to - from) * (30 * s * s * (1 - s) * (1 - s) / duration_s);
  }
  return way;
}

}  // namespace sidestep::hardware
