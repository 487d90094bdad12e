#include "sidestep/import/scene_into_scenario.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>

#include "sidestep/core/convex_polytope.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"
#include "sidestep/import/free_space.h"
#include "sidestep/import/inverse_kinematics.h"

namespace sidestep::imports {
namespace {

using Eigen::Vector3d;

constexpr int kStarts = 100;
constexpr double kBelow_m = 0.05;

// Bounds of a shape are about its frame's origin, so that is put amid its vertices.
void CentreMesh(scenarios::StaticObstacle& obstacle) {
  const ConvexMesh* const mesh = std::get_if<ConvexMesh>(&obstacle.shape);
  if (mesh == nullptr) return;
  Vector3d low = mesh->hull->vertices().front(), high = low;
  for (const Vector3d& vertex : mesh->hull->vertices()) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  const Vector3d centre = (low + high) / 2;
  std::vector<Vector3d> vertices = mesh->hull->vertices();
  for (Vector3d& vertex : vertices) vertex -= centre;
  obstacle.shape = ConvexMesh{std::make_shared<const ConvexPolytope>(vertices)};
  obstacle.X_WO = obstacle.X_WO * Pose::Translation(centre);
}

double LowestPoint(const scenarios::StaticObstacle& obstacle) {
  const Vector3d down_O = obstacle.X_WO.RotateInverse(Vector3d(0, 0, 1)).cwiseAbs();
  return obstacle.X_WO.translation().z() - down_O.dot(HalfExtents(obstacle.shape));
}

// The thing that a mount sphere is deepest in; empty for none.
std::string MountOf(const scenarios::Scenario& scenario, const robot::RobotModel& robot) {
  std::string mount;
  double deepest_m = 0;
  const Eigen::Matrix3Xd p_WS =
      robot.ComputeSphereCenters(Eigen::VectorXd::Zero(robot.num_joints()), false).p_WS;
  for (const int sphere : robot.mount_spheres()) {
    for (const scenarios::StaticObstacle& fixed : scenario.static_obstacles) {
      const double gap_m = SignedDistance(fixed.shape, fixed.X_WO.Inverse() * p_WS.col(sphere)) -
                           robot.sphere_radii_m()(sphere);
      if (gap_m >= deepest_m) continue;
      deepest_m = gap_m;
      mount = fixed.name;
    }
  }
  return mount;
}

// What a robot's names begin with there and not here, or here and not there.
struct Prefix {
  std::string text;
  bool is_theirs = true;

  bool Joins(const std::string& theirs, const std::string& ours) const {
    return is_theirs ? theirs == text + ours : ours == text + theirs;
  }
};

// Which of the robot's names another one's means, by a prefix; -1 for none.
int Match(const Prefix& prefix, const std::string& theirs, const std::vector<std::string>& ours) {
  for (std::size_t i = 0; i < ours.size(); ++i) {
    if (prefix.Joins(theirs, ours[i])) return static_cast<int>(i);
  }
  return -1;
}

// The prefix by which most names are matched, of those that end in _; of equals the first.
Prefix FindPrefix(const std::vector<std::string>& theirs, const std::vector<std::string>& ours) {
  std::vector<Prefix> candidates = {{}};
  for (const std::string& their : theirs) {
    for (const std::string& our : ours) {
      if (their.ends_with("_" + our)) {
        candidates.push_back({their.substr(0, their.size() - our.size()), true});
      } else if (our.ends_with("_" + their)) {
        candidates.push_back({our.substr(0, our.size() - their.size()), false});
      }
    }
  }
  Prefix best;
  std::ptrdiff_t most = -1;
  for (const Prefix& candidate : candidates) {
    const auto is_matched = [&](const std::string& their) {
      return Match(candidate, their, ours) >= 0;
    };
    const std::ptrdiff_t count = std::count_if(theirs.begin(), theirs.end(), is_matched);
    if (count <= most) continue;
    most = count;
    best = candidate;
  }
  return best;
}

Eigen::VectorXd Arrange(const NamedJoints& joints, const robot::RobotModel& robot,
                        std::vector<std::string>& left_out) {
  const std::vector<std::string>& names = robot.joint_names();
  const Prefix prefix = FindPrefix(joints.names, names);
  std::vector<std::optional<double>> q(names.size());
  for (std::size_t i = 0; i < joints.names.size(); ++i) {
    const int joint = Match(prefix, joints.names[i], names);
    if (joint < 0) {
      left_out.push_back(joints.place + ": '" + joints.names[i] + "' = " +
                         ShortestText(joints.positions[i]) + " is no joint of " + robot.name());
      continue;
    }
    std::optional<double>& position = q[static_cast<std::size_t>(joint)];
    if (position) {
      throw InputError(joints.place, "names " + names[static_cast<std::size_t>(joint)] + " twice");
    }
    position = joints.positions[i];
  }
  Eigen::VectorXd positions(robot.num_joints());
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!q[i]) {
      throw InputError(joints.place, "names no position of " + robot.name() + "'s joint " +
                                         names[i] + " (it has " + Joined(joints.names) + ")");
    }
    positions(static_cast<Eigen::Index>(i)) = *q[i];
  }
  return positions;
}

void ChooseNamedStart(const robot::RobotModel& robot, const FreeSpace& space,
                      scenarios::Scenario& scenario) {
  double most_m = 0;
  for (const auto& [name, q] : robot.configurations()) {
    const double clearance_m = space.Clearance(q);
    if (clearance_m <= most_m) continue;
    most_m = clearance_m;
    scenario.start_name = name;
    scenario.q_start = q;
  }
  if (scenario.q_start.size() == 0) {
    throw InputError("--request", "has no start_state, and no configuration of " + robot.name() +
                                      " is free in the scene");
  }
}

}  // namespace

void PutInto(const ImportedScene& scene, const robot::RobotModel& robot,
             scenarios::Scenario& scenario) {
  std::vector<std::string> taken = {"floor", "self", "world", "robot", robot.base()};
  for (const robot::Joint& joint : robot.joints()) taken.push_back(joint.link);
  for (scenarios::StaticObstacle obstacle : scene.obstacles) {
    CentreMesh(obstacle);
    obstacle.name = FreeName(obstacle.name, taken);
    scenario.static_obstacles.push_back(std::move(obstacle));
  }
  if (scene.floor_m) {
    scenario.floor_m = *scene.floor_m;
  } else {
    double lowest_m = scenario.grid.first_center_m.z();
    for (const auto& fixed : scenario.static_obstacles) {
      lowest_m = std::min(lowest_m, LowestPoint(fixed));
    }
    scenario.floor_m = std::floor(100 * (lowest_m - kBelow_m)) / 100;
  }
  scenario.mount = MountOf(scenario, robot);
}

std::vector<std::string> PutInto(const ImportedRequest& request, const robot::RobotModel& robot,
                                 RandomStream& random, scenarios::Scenario& scenario) {
  std::vector<std::string> left_out = request.left_out;
  const FreeSpace space(scenario, robot);
  if (request.start) {
    scenario.q_start = Arrange(*request.start, robot, left_out);
  } else {
    ChooseNamedStart(robot, space, scenario);
  }
  if (request.goal) {
    scenario.q_goal = Arrange(*request.goal, robot, left_out);
    return left_out;
  }
  const NamedTarget& target = *request.goal_pose;
  std::vector<std::string> links;
  for (const robot::Joint& joint : robot.joints()) links.push_back(joint.link);
  const int link = Match(FindPrefix({target.link}, links), target.link, links);
  if (link < 0) {
    throw InputError(target.place, "'" + target.link + "' is none of " + robot.name() +
                                       "'s links: " + Joined(links));
  }
  const auto is_free = [&](const Eigen::VectorXd& q) { return space.Clearance(q) > 0; };
  const auto q = SolvePose(robot, {link, target.X_WL}, scenario.q_start, kStarts, random, is_free);
  if (!q) {
    throw InputError(target.place,
                     "no configuration was found that has " + target.link + " there and is free");
  }
  scenario.q_goal = *q;
  return left_out;
}

}  // namespace sidestep::imports
