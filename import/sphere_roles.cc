#include "sidestep/import/sphere_roles.h"

#include <algorithm>

#include "sidestep/import/arm_pose.h"
#include "sidestep/import/solid_points.h"

namespace sidestep::imports {
namespace {

constexpr int kConfigurations = 200;
constexpr double kAbove_m = 0.02;  // less than that above the ground is on it: a cell of a map

Pose PoseIn(const std::vector<Pose>& links, int link) {
  return link < 0 ? Pose() : links[static_cast<std::size_t>(link)];
}

// Where the robot stands: at its base's frame, or at the underside of what is fixed to it, if that
// is a foot and not the rounded edge of a mesh.
double GroundOf(const robot::ArmDescription& arm, const std::vector<int>& fixed) {
  const std::vector<Pose> links =
      LinkPosesAt(arm, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(arm.limits.size())));
  double ground = 0;
  for (const int link : fixed) {
    std::vector<Ball> balls;
    for (const robot::LinkSolid& solid : arm.LinkOf(link).solids) AppendBalls(solid, &balls);
    for (const Ball& ball : balls) {
      ground = std::min(ground, (PoseIn(links, link) * ball.p_L).z() - ball.radius_m);
    }
  }
  return ground < -kAbove_m ? ground : 0;
}

}  // namespace

std::vector<int> MountSpheres(const robot::ArmDescription& arm,
                              const std::vector<robot::CollisionSphere>& spheres) {
  const std::vector<int> fixed = FixedLinks(arm);
  const double ground_m = GroundOf(arm, fixed) + kAbove_m;
  std::vector<bool> always_low(spheres.size(), true);
  for (const Eigen::VectorXd& q : SampleConfigurations(arm, kConfigurations)) {
    const std::vector<Pose> links = LinkPosesAt(arm, q);
    for (std::size_t s = 0; s < spheres.size(); ++s) {
      const double z = (PoseIn(links, spheres[s].link) * spheres[s].p_LS).z();
      if (z - spheres[s].radius_m > ground_m) always_low[s] = false;
    }
  }
  std::vector<int> mount;
  for (std::size_t s = 0; s < spheres.size(); ++s) {
    const bool is_fixed = std::find(fixed.begin(), fixed.end(), spheres[s].link) != fixed.end();
    if (is_fixed || always_low[s]) mount.push_back(static_cast<int>(s));
  }
  return mount;
}

Eigen::VectorXd ChooseHome(const robot::ArmDescription& arm,
                           const std::vector<robot::CollisionSphere>& spheres,
                           const std::vector<int>& mount, const LinkPairs& pairs,
                           const std::vector<Eigen::VectorXd>& configurations) {
  const double ground_m = GroundOf(arm, FixedLinks(arm)) + kAbove_m;
  Eigen::VectorXd best = configurations.front();
  std::size_t fewest = spheres.size() + pairs.size() + 1;
  for (const Eigen::VectorXd& q : configurations) {
    const std::vector<Pose> links = LinkPosesAt(arm, q);
    std::size_t taken = pairs.size() - SeparablePairs(arm, spheres, pairs, q).size();
    for (std::size_t s = 0; s < spheres.size(); ++s) {
      const bool stands = std::find(mount.begin(), mount.end(), static_cast<int>(s)) != mount.end();
      const double z = (PoseIn(links, spheres[s].link) * spheres[s].p_LS).z();
      taken += !stands && z - spheres[s].radius_m < ground_m;
    }
    if (taken >= fewest) continue;
    fewest = taken;
    best = q;
  }
  return best;
}

std::vector<int> WithSpheresBelow(const robot::ArmDescription& arm,
                                  const std::vector<robot::CollisionSphere>& spheres,
                                  const std::vector<int>& mount, const Eigen::VectorXd& home) {
  constexpr double kRounding_m = 1e-4;  // of what is written
  const double ground_m = GroundOf(arm, FixedLinks(arm)) + kRounding_m;
  const std::vector<Pose> links = LinkPosesAt(arm, home);
  std::vector<int> all;
  for (std::size_t s = 0; s < spheres.size(); ++s) {
    const double z = (PoseIn(links, spheres[s].link) * spheres[s].p_LS).z();
    const bool stands = std::find(mount.begin(), mount.end(), static_cast<int>(s)) != mount.end();
    if (stands || z - spheres[s].radius_m < ground_m) all.push_back(static_cast<int>(s));
  }
  return all;
}

LinkPairs SeparablePairs(const robot::ArmDescription& arm,
                         const std::vector<robot::CollisionSphere>& spheres, const LinkPairs& pairs,
                         const Eigen::VectorXd& home) {
  const std::vector<Pose> links = LinkPosesAt(arm, home);
  LinkPairs separable;
  for (const robot::LinkPair& pair : pairs) {
    bool both_have_spheres[2] = {false, false}, overlap = false;
    for (const robot::CollisionSphere& a : spheres) {
      both_have_spheres[0] = both_have_spheres[0] || a.link == pair.first;
      both_have_spheres[1] = both_have_spheres[1] || a.link == pair.second;
      if (a.link != pair.first) continue;
      for (const robot::CollisionSphere& b : spheres) {
        if (b.link != pair.second) continue;
        const double apart_m =
            (PoseIn(links, a.link) * a.p_LS - PoseIn(links, b.link) * b.p_LS).norm();
        overlap = overlap || apart_m < a.radius_m + b.radius_m;
      }
    }
    if (both_have_spheres[0] && both_have_spheres[1] && !overlap) separable.push_back(pair);
  }
  return separable;
}

}  // namespace sidestep::imports
