#include "sidestep/core/shape_gradient.h"

#include <algorithm>
#include <cmath>

#include "sidestep/core/convex_polytope.h"

namespace sidestep {
namespace {

// v / |v|, or `otherwise` where v has no direction.
Eigen::Vector3d Direction(const Eigen::Vector3d& v, const Eigen::Vector3d& otherwise) {
  const double length = v.norm();
  return length > 0 ? Eigen::Vector3d(v / length) : otherwise;
}

struct Gradient {
  const Eigen::Vector3d& p;

  Eigen::Vector3d operator()(const Box& box) const {
    const Eigen::Vector3d d = p.cwiseAbs() - box.size_m / 2;
    Eigen::Index nearest_face;
    if (d.maxCoeff(&nearest_face) <= 0) {
      return std::copysign(1.0, p(nearest_face)) * Eigen::Vector3d::Unit(nearest_face);
    }
    Eigen::Vector3d out = d.cwiseMax(0);
    for (int a = 0; a < 3; ++a) out(a) = std::copysign(out(a), p(a));
    return out / out.norm();
  }

  Eigen::Vector3d operator()(const Sphere&) const { return Direction(p, Eigen::Vector3d::UnitX()); }

  Eigen::Vector3d operator()(const Capsule& capsule) const {
    const double half_m = capsule.length_m / 2;
    return Direction({p.x(), p.y(), p.z() - std::clamp(p.z(), -half_m, half_m)},
                     Eigen::Vector3d::UnitX());
  }

  Eigen::Vector3d operator()(const Cylinder& cylinder) const {
    const Eigen::Vector3d along(0, 0, std::copysign(1.0, p.z()));
    const Eigen::Vector3d across = Direction({p.x(), p.y(), 0}, Eigen::Vector3d::UnitX());
    const double radial_m = std::hypot(p.x(), p.y()) - cylinder.radius_m;
    const double axial_m = std::abs(p.z()) - cylinder.length_m / 2;
    if (radial_m > 0 && axial_m > 0) {
      return (radial_m * across + axial_m * along) / std::hypot(radial_m, axial_m);
    }
    return radial_m > axial_m ? across : along;
  }

  Eigen::Vector3d operator()(const Ellipsoid& ellipsoid) const {
    const double step_m = 1e-5 * ellipsoid.semi_axes_m.minCoeff();
    Eigen::Vector3d slope;
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3d step = step_m * Eigen::Vector3d::Unit(a);
      slope(a) = SignedDistance(ellipsoid, p + step) - SignedDistance(ellipsoid, p - step);
    }
    return Direction(slope, Eigen::Vector3d::UnitX());
  }

  Eigen::Vector3d operator()(const ConvexMesh& mesh) const {
    return mesh.hull->Nearest(p).gradient;
  }
};

}  // namespace

Eigen::Vector3d DistanceGradient(const Shape& shape, const Eigen::Vector3d& p_OQ) {
  return std::visit(Gradient{p_OQ}, shape);
}

}  // namespace sidestep
