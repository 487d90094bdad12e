#include "sidestep/planner/self_clearance.h"

#include <algorithm>
#include <limits>

namespace sidestep::planner {

SelfClearance::SelfClearance(const robot::RobotModel& robot) : robot_(robot) {
  const std::vector<robot::CollisionSphere>& spheres = robot.spheres();
  for (const robot::LinkPair& links : robot.self_collision()) {
    std::vector<std::pair<int, int>>& pairs = pairs_.emplace_back();
    for (int a = 0; a < robot.num_spheres(); ++a) {
      for (int b = 0; b < robot.num_spheres(); ++b) {
        if (spheres[a].link == links.first && spheres[b].link == links.second) {
          pairs.emplace_back(a, b);
        }
      }
    }
  }
}

LinkGap SelfClearance::Find(int pair, const Eigen::Matrix3Xd& p_WS) const {
  const Eigen::VectorXd& radius_m = robot_.sphere_radii_m();
  LinkGap nearest{-1, -1, std::numeric_limits<double>::infinity()};
  for (const auto& [a, b] : pairs_[pair]) {
    const double gap_m = (p_WS.col(a) - p_WS.col(b)).norm() - radius_m(a) - radius_m(b);
    if (gap_m < nearest.gap_m) nearest = {a, b, gap_m};
  }
  return nearest;
}

double SelfClearance::Least(const Eigen::Matrix3Xd& p_WS) const {
  double least_m = std::numeric_limits<double>::infinity();
  for (int pair = 0; pair < num_pairs(); ++pair) {
    least_m = std::min(least_m, Find(pair, p_WS).gap_m);
  }
  return least_m;
}

}  // namespace sidestep::planner
