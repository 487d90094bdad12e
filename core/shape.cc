#include "sidestep/core/shape.h"

#include <algorithm>
#include <cmath>

#include "sidestep/core/convex_polytope.h"

namespace sidestep {
namespace {

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

double BoxDistance(const Eigen::Vector3d& half, const Eigen::Vector3d& p) {
  const Eigen::Vector3d d = p.cwiseAbs() - half;
  return d.cwiseMax(0).norm() + std::min(d.maxCoeff(), 0.0);
}

double CapsuleDistance(const Capsule& capsule, const Eigen::Vector3d& p) {
  const double half = capsule.length_m / 2;
  const double z = p.z() - std::clamp(p.z(), -half, half);
  return std::hypot(p.x(), p.y(), z) - capsule.radius_m;
}

double CylinderDistance(const Cylinder& cylinder, const Eigen::Vector3d& p) {
  const double radial = std::hypot(p.x(), p.y()) - cylinder.radius_m;
  const double axial = std::abs(p.z()) - cylinder.length_m / 2;
  return std::hypot(std::max(radial, 0.0), std::max(axial, 0.0)) +
         std::min(std::max(radial, axial), 0.0);
}

// With the semi-axes e and the smallest of them m, the nearest point x of the surface satisfies
// p_i - x_i = (s - m^2) p_i / (s + e_i^2 - m^2) for the root s >= 0 of
// sum (e_i p_i / (s + e_i^2 - m^2))^2 = 1. The sum falls strictly with s, and the signed distance
// is (s - m^2) |p_i / (s + e_i^2 - m^2)|. Counting s from the pole keeps all digits near it.
double EllipsoidDistance(const Eigen::Vector3d& axes, const Eigen::Vector3d& p_signed) {
  const Eigen::Array3d p = p_signed.array().abs();
  const Eigen::Array3d ep = axes.array() * p;
  const double m = axes.minCoeff();
  const Eigen::Array3d above_m2 = (axes.array() - m) * (axes.array() + m);  // e^2 - m^2
  const auto along_smallest = [&](const Eigen::Array3d& v) {
    return (above_m2 == 0).select(v, 0).matrix().norm();
  };

  double low = along_smallest(ep);   // the sum is >= 1: already these terms make it so
  double high = ep.matrix().norm();  // the sum is <= 1: every denominator is >= s
  if (low == 0) {
    // On the plane of symmetry across the smallest axis the sum may stay below 1 down to s = 0.
    // Then two points mirrored at that plane are nearest, and p is inside.
    const Eigen::Array3d ratio = (above_m2 == 0).select(0, ep / above_m2);
    const double rest = 1 - ratio.square().sum();
    if (rest > 0) {
      const Eigen::Array3d in_plane = (above_m2 == 0).select(0, m * m * p / above_m2);
      return -std::hypot(in_plane.matrix().norm(), m * std::sqrt(rest));
    }
  }
  for (int i = 0; i < 200; ++i) {
    const double s = low + (high - low) / 2;
    if (s == low || s == high) break;
    ((ep / (s + above_m2)).square().sum() > 1 ? low : high) = s;
  }
  return (high - m * m) * (p / (high + above_m2)).matrix().norm();
}

}  // namespace

double SignedDistance(const Shape& shape, const Eigen::Vector3d& p_OQ) {
  return std::visit(Overloaded{
                        [&](const Box& box) { return BoxDistance(box.size_m / 2, p_OQ); },
                        [&](const Sphere& sphere) { return p_OQ.norm() - sphere.radius_m; },
                        [&](const Capsule& capsule) { return CapsuleDistance(capsule, p_OQ); },
                        [&](const Cylinder& cylinder) { return CylinderDistance(cylinder, p_OQ); },
                        [&](const Ellipsoid& ellipsoid) {
                          return EllipsoidDistance(ellipsoid.semi_axes_m, p_OQ);
                        },
                        [&](const ConvexMesh& mesh) { return mesh.hull->SignedDistance(p_OQ); },
                    },
                    shape);
}

Eigen::Vector3d HalfExtents(const Shape& shape) {
  return std::visit(
      Overloaded{
          [](const Box& box) -> Eigen::Vector3d { return box.size_m / 2; },
          [](const Sphere& sphere) -> Eigen::Vector3d {
            return Eigen::Vector3d::Constant(sphere.radius_m);
          },
          [](const Capsule& c) -> Eigen::Vector3d {
            return {c.radius_m, c.radius_m, c.radius_m + c.length_m / 2};
          },
          [](const Cylinder& c) -> Eigen::Vector3d {
            return {c.radius_m, c.radius_m, c.length_m / 2};
          },
          [](const Ellipsoid& ellipsoid) -> Eigen::Vector3d { return ellipsoid.semi_axes_m; },
          [](const ConvexMesh& mesh) -> Eigen::Vector3d { return mesh.hull->half_extents_m(); },
      },
      shape);
}

double Thickness(const Shape& shape) {
  const ConvexMesh* const mesh = std::get_if<ConvexMesh>(&shape);
  return mesh != nullptr ? mesh->hull->thickness_m() : 2 * HalfExtents(shape).minCoeff();
}

std::string ShapeName(const Shape& shape) {
  return std::visit(
      Overloaded{[](const Box&) { return "box"; }, [](const Sphere&) { return "sphere"; },
                 [](const Capsule&) { return "capsule"; },
                 [](const Cylinder&) { return "cylinder"; },
                 [](const Ellipsoid&) { return "ellipsoid"; },
                 [](const ConvexMesh&) { return "convex_mesh"; }},
      shape);
}

}  // namespace sidestep
