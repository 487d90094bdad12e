#include "sidestep/import/free_space.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <set>

namespace sidestep::imports {
namespace {

StaticSolids StaticSolidsOf(const scenarios::Scenario& scenario, bool with_mount) {
  StaticSolids solids;
  for (const scenarios::StaticObstacle& fixed : scenario.static_obstacles) {
    if (!with_mount && fixed.name == scenario.mount) continue;
    solids.shapes.push_back({fixed.shape, fixed.X_WO});
  }
  if (with_mount || !scenario.mount.empty()) {
    solids.half_spaces.push_back({Eigen::Vector3d::UnitZ(), scenario.floor_m});
  }
  return solids;
}

double Gap(const robot::RobotModel& robot, const Eigen::Matrix3Xd& p_WS, int a, int b) {
  return (p_WS.col(a) - p_WS.col(b)).norm() - robot.sphere_radii_m()(a) - robot.sphere_radii_m()(b);
}

using Links = std::set<std::pair<int, int>>;

Links LinksKeptApart(const robot::RobotModel& robot) {
  Links links;
  for (const robot::LinkPair& pair : robot.self_collision()) links.emplace(pair.first, pair.second);
  if (!links.empty()) return links;
  for (const robot::CollisionSphere& a : robot.spheres()) {
    for (const robot::CollisionSphere& b : robot.spheres()) {
      if (a.link < b.link) links.emplace(a.link, b.link);
    }
  }
  if (robot.configurations().empty()) return {};
  for (const auto& [name, q] : robot.configurations()) {
    const Eigen::Matrix3Xd p_WS = robot.ComputeSphereCenters(q, false).p_WS;
    for (int a = 0; a < robot.num_spheres(); ++a) {
      for (int b = 0; b < robot.num_spheres(); ++b) {
        const int link_a = robot.spheres()[static_cast<std::size_t>(a)].link;
        const int link_b = robot.spheres()[static_cast<std::size_t>(b)].link;
        if (Gap(robot, p_WS, a, b) < 0) links.erase({link_a, link_b});
      }
    }
  }
  return links;
}

}  // namespace

FreeSpace::FreeSpace(const scenarios::Scenario& scenario, const robot::RobotModel& robot)
    : robot_(robot),
      all_(StaticSolidsOf(scenario, true)),
      but_for_the_mount_(StaticSolidsOf(scenario, false)),
      is_of_mount_(static_cast<std::size_t>(robot.num_spheres()), 0) {
  for (const int sphere : robot.mount_spheres()) is_of_mount_[static_cast<std::size_t>(sphere)] = 1;
  const Links links = LinksKeptApart(robot);
  for (int a = 0; a < robot.num_spheres(); ++a) {
    for (int b = 0; b < robot.num_spheres(); ++b) {
      const std::pair<int, int> pair = {robot.spheres()[static_cast<std::size_t>(a)].link,
                                        robot.spheres()[static_cast<std::size_t>(b)].link};
      if (links.count(pair) > 0) kept_apart_.emplace_back(a, b);
    }
  }
}

double FreeSpace::Clearance(const Eigen::VectorXd& q) const {
  const Eigen::Matrix3Xd p_WS = robot_.ComputeSphereCenters(q, false).p_WS;
  double least_m = std::numeric_limits<double>::infinity();
  for (int s = 0; s < robot_.num_spheres(); ++s) {
    const sdf::ShapeField& field =
        is_of_mount_[static_cast<std::size_t>(s)] != 0 ? but_for_the_mount_ : all_;
    const double distance_m = field.Distance(p_WS.col(s), EpisodeTime(0));
    least_m = std::min(least_m, distance_m - robot_.sphere_radii_m()(s));
  }
  for (const auto& [a, b] : kept_apart_) least_m = std::min(least_m, Gap(robot_, p_WS, a, b));
  return least_m;
}

}  // namespace sidestep::imports
