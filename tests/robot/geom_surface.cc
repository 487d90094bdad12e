#include "tests/robot/geom_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "sidestep/core/convex_polytope.h"

namespace sidestep::robot {
namespace {

constexpr int kSteps = 64;
constexpr double kPi = 3.141592653589793;

// A profile's point: distance from the axis, height along it.
using Profile = std::vector<Eigen::Vector2d>;

void AppendLine(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Profile* profile) {
  for (int i = 0; i <= kSteps; ++i) profile->push_back(from + (to - from) * i / kSteps);
}

void AppendArc(double radius, double height, double from_rad, double to_rad, Profile* profile) {
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = from_rad + (to_rad - from_rad) * i / kSteps;
    profile->push_back({radius * std::cos(angle), height + radius * std::sin(angle)});
  }
}

Eigen::Matrix3Xd Revolve(const Profile& profile) {
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(profile.size()) * kSteps);
  Eigen::Index column = 0;
  for (const Eigen::Vector2d& at : profile) {
    for (int i = 0; i < kSteps; ++i) {
      const double angle = 2 * kPi * i / kSteps;
      points.col(column++) << at.x() * std::cos(angle), at.x() * std::sin(angle), at.y();
    }
  }
  return points;
}

// Points all over triangles, whose corners are columns.
Eigen::Matrix3Xd SampleFaces(const std::vector<Eigen::Matrix3d>& faces) {
  constexpr int kSides = 12;
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Matrix3d& face : faces) {
    for (int i = 0; i <= kSides; ++i) {
      for (int k = 0; i + k <= kSides; ++k) {
        points.push_back(face * Eigen::Vector3d(i, k, kSides - i - k) / kSides);
      }
    }
  }
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    columns.col(static_cast<Eigen::Index>(i)) = points[i];
  }
  return columns;
}

struct Sampler {
  Eigen::Matrix3Xd operator()(const Box& box) const {
    Eigen::Matrix3Xd points(3, 6 * (kSteps + 1) * (kSteps + 1));
    Eigen::Index column = 0;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        for (int i = 0; i <= kSteps; ++i) {
          for (int k = 0; k <= kSteps; ++k) {
            Eigen::Vector3d unit;
            unit(axis) = side;
            unit((axis + 1) % 3) = 2.0 * i / kSteps - 1;
            unit((axis + 2) % 3) = 2.0 * k / kSteps - 1;
            points.col(column++) = unit.cwiseProduct(box.size_m / 2);
          }
        }
      }
    }
    return points;
  }
  Eigen::Matrix3Xd operator()(const Sphere& sphere) const {
    return (*this)(Capsule{sphere.radius_m, 0});
  }
  Eigen::Matrix3Xd operator()(const Capsule& capsule) const {
    const double half = capsule.length_m / 2, r = capsule.radius_m;
    Profile profile;
    AppendArc(r, -half, -kPi / 2, 0, &profile);
    AppendLine({r, -half}, {r, half}, &profile);
    AppendArc(r, half, 0, kPi / 2, &profile);
    return Revolve(profile);
  }
  Eigen::Matrix3Xd operator()(const Cylinder& cylinder) const {
    const double half = cylinder.length_m / 2, r = cylinder.radius_m;
    Profile profile;
    AppendLine({0, -half}, {r, -half}, &profile);
    AppendLine({r, -half}, {r, half}, &profile);
    AppendLine({r, half}, {0, half}, &profile);
    return Revolve(profile);
  }
  Eigen::Matrix3Xd operator()(const Ellipsoid& ellipsoid) const {
    return ellipsoid.semi_axes_m.asDiagonal() * (*this)(Sphere{1.0});
  }
  Eigen::Matrix3Xd operator()(const ConvexMesh& mesh) const {
    std::vector<Eigen::Matrix3d> faces;
    for (const ConvexPolytope::Triangle& triangle : mesh.hull->triangles()) {
      Eigen::Matrix3d& face = faces.emplace_back();
      for (int i = 0; i < 3; ++i) {
        const int corner = triangle.corners[static_cast<std::size_t>(i)];
        face.col(i) = mesh.hull->vertices()[static_cast<std::size_t>(corner)];
      }
    }
    return SampleFaces(faces);
  }
};

// The corners of each triangle of a mesh's hull: see mesh_graph in mjmodel.h.
std::vector<Eigen::Matrix3d> HullFaces(const mjModel& model, int mesh) {
  const int* const graph = model.mesh_graph + model.mesh_graphadr[mesh];
  const int num_vertices = graph[0], num_faces = graph[1];
  const int* const corners = graph + 2 + 3 * num_vertices + 3 * num_faces;
  const float* const vertices = model.mesh_vert + 3 * model.mesh_vertadr[mesh];
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  std::vector<Eigen::Matrix3d> faces(static_cast<std::size_t>(num_faces));
  for (int i = 0; i < 3 * num_faces; ++i) {
    const Eigen::Vector3d corner =
        Eigen::Map<const Eigen::Vector3f>(vertices + 3 * corners[i]).cast<double>();
    faces[static_cast<std::size_t>(i / 3)].col(i % 3) = corner;
    middle += corner / (3 * num_faces);
  }
  for (Eigen::Matrix3d& face : faces) {
    const Eigen::Vector3d normal = (face.col(1) - face.col(0)).cross(face.col(2) - face.col(0));
    if (normal.dot(face.col(0) - middle) < 0) face.col(1).swap(face.col(2));
  }
  return faces;
}

}  // namespace

Eigen::Matrix3Xd SampleSurface(const Shape& shape) { return std::visit(Sampler{}, shape); }

Eigen::Matrix3Xd SampleGeom(const mjModel& model, int geom) {
  if (model.geom_type[geom] != mjGEOM_MESH) return SampleSurface(ShapeOf(model, geom));
  return SampleFaces(HullFaces(model, model.geom_dataid[geom]));
}

double DistanceToGeom(const mjModel& model, int geom, const Eigen::Vector3d& p_GQ) {
  if (model.geom_type[geom] != mjGEOM_MESH) return SignedDistance(ShapeOf(model, geom), p_GQ);
  double highest = -1e9;
  for (const Eigen::Matrix3d& face : HullFaces(model, model.geom_dataid[geom])) {
    const Eigen::Vector3d across = (face.col(1) - face.col(0)).cross(face.col(2) - face.col(0));
    if (across.norm() > 0) {
      highest = std::max(highest, across.normalized().dot(p_GQ - face.col(0)));
    }
  }
  return highest;
}

Shape ShapeOf(const mjModel& model, int geom) {
  const mjtNum* const size = model.geom_size + 3 * geom;
  switch (model.geom_type[geom]) {
    case mjGEOM_BOX:
      return Box{2 * Eigen::Vector3d(size[0], size[1], size[2])};
    case mjGEOM_SPHERE:
      return Sphere{size[0]};
    case mjGEOM_CAPSULE:
      return Capsule{size[0], 2 * size[1]};
    case mjGEOM_CYLINDER:
      return Cylinder{size[0], 2 * size[1]};
    case mjGEOM_ELLIPSOID:
      return Ellipsoid{Eigen::Vector3d(size[0], size[1], size[2])};
    default:
      throw std::invalid_argument("a robot's geoms must be primitives");
  }
}

}  // namespace sidestep::robot
