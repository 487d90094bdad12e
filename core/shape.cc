#include "core/shape.h"

#include <algorithm>
#include <cmath>

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

// The nearest point x of the surface satisfies x_i = e_i^2 p_i / (t + e_i^2) for the largest root t
// of sum (e_i p_i / (t + e_i^2))^2 = 1, which decreases strictly right of t = -e_min^2.
double EllipsoidDistance(const Eigen::Vector3d& axes, const Eigen::Vector3d& p_signed) {
  Eigen::Vector3d p = p_signed.cwiseAbs();
  const double smallest = axes.minCoeff();
  const Eigen::Array3d e2 = axes.array().square();
  const Eigen::Array3d ep = axes.array() * p.array();
  const auto excess = [&](double t) { return (ep / (t + e2)).square().sum() - 1; };
  const bool inside = (p.array() / axes.array()).square().sum() < 1;

  double low = -smallest * smallest;
  // On the plane of symmetry across the smallest axis the sum may stay below 1 down to its pole:
  // then the nearest point leaves that plane, and t is the pole itself.
  double at_pole = -1;
  for (int i = 0; i < 3; ++i) {
    if (e2(i) > e2.minCoeff()) {
      const double term = ep(i) / (low + e2(i));
      at_pole += term * term;
    } else if (ep(i) > 0) {
      at_pole = 1;
    }
  }
  if (at_pole < 0) {
    Eigen::Vector3d x;
    double rest = 1;
    int free_axis = 0;
    for (int i = 0; i < 3; ++i) {
      if (e2(i) > e2.minCoeff()) {
        x(i) = e2(i) * p(i) / (low + e2(i));
        rest -= x(i) * x(i) / e2(i);
      } else {
        x(i) = 0;
        free_axis = i;
      }
    }
    x(free_axis) = axes(free_axis) * std::sqrt(std::max(rest, 0.0));
    return (inside ? -1 : 1) * (p - x).norm();
  }
  double high = ep.matrix().norm();  // excess(high) <= 0, because every denominator exceeds `high`
  for (int i = 0; i < 200 && low < high; ++i) {
    const double t = low + (high - low) / 2;
    if (t == low || t == high) break;
    (excess(t) > 0 ? low : high) = t;
  }
  const Eigen::Vector3d x = (e2 * p.array() / (high + e2)).matrix();
  return (inside ? -1 : 1) * (p - x).norm();
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
      },
      shape);
}

std::string ShapeName(const Shape& shape) {
  return std::visit(
      Overloaded{[](const Box&) { return "box"; }, [](const Sphere&) { return "sphere"; },
                 [](const Capsule&) { return "capsule"; },
                 [](const Cylinder&) { return "cylinder"; },
                 [](const Ellipsoid&) { return "ellipsoid"; }},
      shape);
}

}  // namespace sidestep
