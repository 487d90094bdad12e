// What is made to hold a link holds it: spheres for planners, a capsule for the supervisor.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/import/bounding_capsule.h"
#include "sidestep/import/convex_hull.h"
#include "sidestep/import/link_spheres.h"

namespace sidestep::imports {
namespace {

using Eigen::Vector3d;

Vector3d Draw(RandomStream* random, double most) {
  return {random->Uniform(-most, most), random->Uniform(-most, most), random->Uniform(-most, most)};
}

// One of each form, anywhere.
std::vector<robot::LinkSolid> DrawSolids(RandomStream* random) {
  const auto size = [random] { return random->Uniform(0.02, 0.2); };
  Eigen::Matrix3Xd points(3, 30);
  for (double& value : points.reshaped()) value = random->Uniform(-0.1, 0.1);
  std::vector<robot::LinkSolid> solids(5);
  solids[0].form = Box{{size(), size(), size()}};
  solids[1].form = Sphere{size()};
  solids[2].form = Capsule{size(), size()};
  solids[3].form = Cylinder{size(), size()};
  solids[4].form = *ConvexHullOf(points);
  for (robot::LinkSolid& solid : solids) {
    solid.X_LS = Pose::FromRollPitchYaw(Draw(random, 3), Draw(random, 0.3));
  }
  return solids;
}

// A point within a solid, on its surface most often.
Vector3d DrawPoint(const robot::LinkSolid& solid, RandomStream* random) {
  if (const auto* const hull = std::get_if<robot::HullSolid>(&solid.form)) {
    Vector3d p = Vector3d::Zero();
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      const auto vertex =
          static_cast<Eigen::Index>(random->Uniform() * static_cast<double>(hull->vertices.cols()));
      const double weight = random->Uniform();
      p += weight * hull->vertices.col(vertex);
      sum += weight;
    }
    return solid.X_LS * Vector3d(p / sum);
  }
  const Shape& shape = std::get<Shape>(solid.form);
  const Vector3d half = HalfExtents(shape);
  while (true) {
    Vector3d p = 1.2 * half.cwiseProduct(Draw(random, 1));
    double low = 0, high = 1;  // towards the middle, until it is on the surface
    if (SignedDistance(shape, p) > 0) {
      for (int i = 0; i < 50; ++i) {
        const double middle = (low + high) / 2;
        (SignedDistance(shape, middle * p) > 0 ? high : low) = middle;
      }
      p *= low;
    }
    return solid.X_LS * p;
  }
}

double DistanceTo(const robot::CollisionCapsule& capsule, const Vector3d& p) {
  const Vector3d along = capsule.p_LB - capsule.p_LA;
  const double s = std::clamp((p - capsule.p_LA).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - capsule.p_LA - s * along).norm() - capsule.radius_m;
}

TEST(LinkCover, HoldsEverySolid) {
  constexpr double kCover_m = 0.02;
  RandomStream random(1, "cover");
  for (int trial = 0; trial < 10; ++trial) {
    std::vector<robot::LinkSolid> solids = DrawSolids(&random);
    if (trial % 2 == 0) solids.erase(solids.begin() + 1, solids.begin() + 4 - trial % 3);
    if (trial % 5 == 0) solids.resize(1);
    const robot::CollisionCapsule capsule = CapsuleAround(solids);
    robot::ArmDescription arm;
    arm.links.resize(1);
    arm.links[0].solids = solids;
    const std::vector<robot::CollisionSphere> spheres = CoverArm(arm, {kCover_m, 0});
    EXPECT_GT((capsule.p_LB - capsule.p_LA).norm(), 0);
    for (const robot::LinkSolid& solid : solids) {
      for (int i = 0; i < 200; ++i) {
        const Vector3d p = DrawPoint(solid, &random);
        EXPECT_LT(DistanceTo(capsule, p), 1e-9);
        const bool is_held =
            std::any_of(spheres.begin(), spheres.end(), [&](const robot::CollisionSphere& s) {
              return (p - s.p_LS).norm() <= s.radius_m + kCover_m;
            });
        EXPECT_TRUE(is_held);
      }
    }
  }
}

TEST(LinkCover, OfACylinderIsACapsuleAroundItsAxis) {
  robot::LinkSolid solid;
  solid.form = Cylinder{0.05, 0.6};
  const robot::CollisionCapsule capsule = CapsuleAround({solid});
  EXPECT_LT(capsule.radius_m, 0.06);
  EXPECT_LT((capsule.p_LB - capsule.p_LA).norm(), 0.6);
  EXPECT_GT((capsule.p_LB - capsule.p_LA).norm(), 0.5);
}

}  // namespace
}  // namespace sidestep::imports
