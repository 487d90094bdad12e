#include "sidestep/import/link_spheres.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "sidestep/core/input_error.h"
#include "sidestep/import/convex_hull.h"
#include "sidestep/import/solid_points.h"

namespace sidestep::import {
namespace {

constexpr int kMostCells = 64;       // of one solid
constexpr double kFinest_m = 0.055;  // edge of a cube; its ball stands out by a third of it
constexpr double kCoarsest_m = 2;

// Whether a ball is beyond one of the planes around a hull.
bool IsApart(const robot::HullSolid& hull, const Eigen::Vector3d& p, double radius_m) {
  for (const auto& t : hull.triangles.colwise()) {
    const Eigen::Vector3d a = hull.vertices.col(t(0));
    const Eigen::Vector3d normal = (hull.vertices.col(t(1)) - a)
                                       .cross(Eigen::Vector3d(hull.vertices.col(t(2)) - a))
                                       .normalized();
    if (normal.dot(p - a) > radius_m) return true;
  }
  return false;
}

void CoverSolid(const robot::LinkSolid& solid, double edge_m, int link,
                std::vector<robot::CollisionSphere>* spheres) {
  if (const auto* const shape = std::get_if<Shape>(&solid.form)) {
    if (const auto* const sphere = std::get_if<Sphere>(shape)) {
      spheres->push_back({link, solid.X_LS.translation(), sphere->radius_m});
      return;
    }
  }
  std::vector<Ball> balls;
  AppendBalls(solid, &balls);
  Eigen::AlignedBox3d box;
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(balls.size()));
  bool has_radius = false;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const Eigen::Vector3d p_S = solid.X_LS.Inverse() * balls[i].p_L;
    points.col(static_cast<Eigen::Index>(i)) = p_S;
    has_radius = has_radius || balls[i].radius_m > 0;
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(balls[i].radius_m);
    box.extend(p_S - reach);
    box.extend(p_S + reach);
  }
  const std::optional<robot::HullSolid> hull = has_radius ? std::nullopt : ConvexHullOf(points);
  Eigen::Vector3i cells;
  while (true) {
    cells =
        (box.sizes() / edge_m - Eigen::Vector3d::Constant(1e-9)).array().ceil().max(1).cast<int>();
    if (cells.prod() <= kMostCells) break;
    edge_m *= 1.1;
  }
  const Eigen::Vector3d size = box.sizes().cwiseQuotient(cells.cast<double>());
  const double radius_m = size.norm() / 2;
  for (int x = 0; x < cells.x(); ++x) {
    for (int y = 0; y < cells.y(); ++y) {
      for (int z = 0; z < cells.z(); ++z) {
        const Eigen::Vector3d p_S =
            box.min() + size.cwiseProduct(Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5));
        if (hull && IsApart(*hull, p_S, radius_m)) continue;
        spheres->push_back({link, solid.X_LS * p_S, radius_m});
      }
    }
  }
}

std::vector<robot::CollisionSphere> CoverBy(const robot::ArmDescription& arm, double edge_m) {
  std::vector<robot::CollisionSphere> spheres;
  for (int link = -1; link < static_cast<int>(arm.joints.size()); ++link) {
    for (const robot::LinkSolid& solid : arm.LinkOf(link).solids) {
      CoverSolid(solid, edge_m, link, &spheres);
    }
  }
  return spheres;
}

}  // namespace

std::vector<robot::CollisionSphere> CoverArm(const robot::ArmDescription& arm,
                                             const SphereRequest& request) {
  const auto most = static_cast<std::size_t>(request.num_spheres);
  for (double edge_m = kFinest_m; edge_m < kCoarsest_m; edge_m *= 1.1) {
    std::vector<robot::CollisionSphere> spheres = CoverBy(arm, edge_m);
    if (most == 0 || spheres.size() <= most) return spheres;
  }
  throw InputError("--spheres", "are too few: there are " +
                                    std::to_string(CoverBy(arm, kCoarsest_m).size()) + " solids");
}

}  // namespace sidestep::import
