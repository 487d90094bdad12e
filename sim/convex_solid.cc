#include "sidestep/sim/convex_solid.h"

#include <algorithm>
#include <cmath>

namespace sidestep::sim {

using Eigen::Vector3d;

Vector3d CoreSupport(const ConvexSolid& solid, const Vector3d& n) {
  const Vector3d& size = solid.size_m;
  switch (solid.core) {
    case ConvexSolid::Core::kPoint:
      return Vector3d::Zero();
    case ConvexSolid::Core::kSegment:
      return {0, 0, std::copysign(size.z(), n.z())};
    case ConvexSolid::Core::kBox:
      return {std::copysign(size.x(), n.x()), std::copysign(size.y(), n.y()),
              std::copysign(size.z(), n.z())};
    case ConvexSolid::Core::kCylinder: {
      const double across = std::hypot(n.x(), n.y());
      const double scale = across > 0 ? size.x() / across : 0.0;
      return {scale * n.x(), scale * n.y(), std::copysign(size.z(), n.z())};
    }
    case ConvexSolid::Core::kEllipsoid: {
      const Vector3d stretched = size.cwiseProduct(n);
      return size.cwiseProduct(stretched) / stretched.norm();
    }
    case ConvexSolid::Core::kHull:
      return *std::max_element(
          solid.vertices.begin(), solid.vertices.end(),
          [&](const Vector3d& p, const Vector3d& q) { return n.dot(p) < n.dot(q); });
  }
  return Vector3d::Zero();
}

}  // namespace sidestep::sim
