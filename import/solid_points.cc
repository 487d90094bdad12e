#include "sidestep/import/solid_points.h"

#include <cmath>

#include "sidestep/core/convex_polytope.h"

namespace sidestep::imports {
namespace {

constexpr double kPi = 3.141592653589793;

struct Appender {
  const Pose& X_LS;
  std::vector<Ball>& balls;

  void Add(const Eigen::Vector3d& p_S, double radius_m = 0) const {
    balls.push_back({X_LS * p_S, radius_m});
  }
  void AddBox(const Eigen::Vector3d& half_m) const {
    for (int corner = 0; corner < 8; ++corner) {
      Add(half_m.cwiseProduct(Eigen::Vector3d(
          (corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1)));
    }
  }

  void operator()(const Box& box) const { AddBox(box.size_m / 2); }
  void operator()(const Sphere& sphere) const { Add({0, 0, 0}, sphere.radius_m); }
  void operator()(const Capsule& capsule) const {
    for (const double end : {-1.0, 1.0}) Add({0, 0, end * capsule.length_m / 2}, capsule.radius_m);
  }
  void operator()(const Cylinder& cylinder) const {
    constexpr int kCorners = 32;
    const double radius = cylinder.radius_m / std::cos(kPi / kCorners);  // circumscribed
    for (int i = 0; i < kCorners; ++i) {
      const double angle = 2 * kPi * i / kCorners;
      for (const double end : {-1.0, 1.0}) {
        Add({radius * std::cos(angle), radius * std::sin(angle), end * cylinder.length_m / 2});
      }
    }
  }
  void operator()(const Ellipsoid& ellipsoid) const { AddBox(ellipsoid.semi_axes_m); }
  void operator()(const ConvexMesh& mesh) const {
    for (const Eigen::Vector3d& vertex : mesh.hull->vertices()) Add(vertex);
  }
};

}  // namespace

void AppendBalls(const robot::LinkSolid& solid, std::vector<Ball>* balls) {
  const Appender append{solid.X_LS, *balls};
  if (const auto* const hull = std::get_if<robot::HullSolid>(&solid.form)) {
    for (const auto& vertex : hull->vertices.colwise()) append.Add(vertex);
    return;
  }
  std::visit(append, std::get<Shape>(solid.form));
}

}  // namespace sidestep::imports
