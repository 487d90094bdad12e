#include "sidestep/sim/geom_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sidestep/sim/convex_depth.h"
#include "sidestep/sim/convex_distance.h"
#include "sidestep/sim/geom_solids.h"
#include "sidestep/sim/mujoco_pose.h"

namespace sidestep::sim {
namespace {

ConvexSolid FromHull(const ConvexHull& hull) {
  ConvexSolid solid;
  solid.core = ConvexSolid::Core::kHull;
  solid.vertices = hull.vertices;
  return solid;
}

std::optional<ConvexSolid> FromGeom(const mjModel& model, int geom) {
  const Eigen::Map<const Eigen::Vector3d> size(model.geom_size + 3 * geom);
  using Core = ConvexSolid::Core;
  switch (model.geom_type[geom]) {
    case mjGEOM_SPHERE:
      return ConvexSolid{Core::kPoint, {0, 0, 0}, {}, size(0)};
    case mjGEOM_CAPSULE:
      return ConvexSolid{Core::kSegment, {0, 0, size(1)}, {}, size(0)};
    case mjGEOM_ELLIPSOID:
      return ConvexSolid{Core::kEllipsoid, size, {}, 0};
    case mjGEOM_CYLINDER:
      return ConvexSolid{Core::kCylinder, {size(0), 0, size(1)}, {}, 0};
    case mjGEOM_BOX:
      return ConvexSolid{Core::kBox, size, {}, 0};
    case mjGEOM_MESH:
      return FromHull(HullOfMesh(model, model.geom_dataid[geom]));
    default:
      return std::nullopt;
  }
}

Eigen::Isometry3d GeomFrame(const mjData& data, int geom) {
  Eigen::Isometry3d X_WG = Eigen::Isometry3d::Identity();
  X_WG.linear() = GeomRotation(data, geom);
  X_WG.translation() = GeomPosition(data, geom);
  return X_WG;
}

// How far a geom reaches from its own centre against the unit vector n_W.
double ReachAgainst(const mjModel& model, const mjData& data, int geom,
                    const Eigen::Vector3d& n_W) {
  const Eigen::Vector3d n = GeomRotation(data, geom).transpose() * n_W;
  const Eigen::Map<const Eigen::Vector3d> size(model.geom_size + 3 * geom);
  switch (model.geom_type[geom]) {
    case mjGEOM_SPHERE:
      return size(0);
    case mjGEOM_CAPSULE:
      return size(0) + size(1) * std::abs(n.z());
    case mjGEOM_ELLIPSOID:
      return n.cwiseProduct(size).norm();
    case mjGEOM_CYLINDER:
      return size(0) * n.head<2>().norm() + size(1) * std::abs(n.z());
    case mjGEOM_BOX:
      return n.cwiseAbs().dot(size);
    default: {  // a mesh
      const int mesh = model.geom_dataid[geom];
      const float* vertices = model.mesh_vert + 3 * model.mesh_vertadr[mesh];
      double reach = -std::numeric_limits<double>::infinity();  // its centre may be outside
      for (int i = 0; i < model.mesh_vertnum[mesh]; ++i) {
        const Eigen::Map<const Eigen::Vector3f> vertex(vertices + 3 * i);
        reach = std::max(reach, -n.dot(vertex.cast<double>()));
      }
      return reach;
    }
  }
}

// Less than 0 if they overlap.
double HeightOver(const mjModel& model, const mjData& data, int plane, int geom) {
  const Eigen::Vector3d normal_W = GeomRotation(data, plane).col(2);
  const double height = normal_W.dot(GeomPosition(data, geom) - GeomPosition(data, plane));
  return height - ReachAgainst(model, data, geom, normal_W);
}

}  // namespace

std::optional<Touch> FindTouch(const mjModel& model, const mjData& data, int geom1, int geom2) {
  if (model.geom_type[geom1] > model.geom_type[geom2]) std::swap(geom1, geom2);
  const mjfCollision collide = mjCOLLISIONFUNC[model.geom_type[geom1]][model.geom_type[geom2]];
  if (collide == nullptr) return std::nullopt;
  std::array<mjContact, mjMAXCONPAIR> contacts;
  const int count = collide(&model, &data, contacts.data(), geom1, geom2, /*margin=*/0);
  std::optional<Touch> deepest;
  for (int i = 0; i < count; ++i) {
    const mjContact& contact = contacts[static_cast<std::size_t>(i)];
    if (contact.dist > 0 || (deepest && -contact.dist <= deepest->depth_m)) continue;
    deepest = Touch{-contact.dist, Eigen::Map<const Eigen::Vector3d>(contact.pos)};
  }
  return deepest;
}

std::vector<GeomDistance::Prism> GeomDistance::MakePrisms(const mjModel& model, int hfield) {
  std::vector<Prism> prisms;
  for (const ConvexHull& hull : HeightField(model, hfield).Prisms()) {
    Prism prism{FromHull(hull), hull.vertices[0], hull.vertices[0]};
    for (const Eigen::Vector3d& vertex : hull.vertices) {
      prism.lower_m = prism.lower_m.cwiseMin(vertex);
      prism.upper_m = prism.upper_m.cwiseMax(vertex);
    }
    prisms.push_back(std::move(prism));
  }
  return prisms;
}

GeomDistance::GeomDistance(const mjModel& model)
    : model_(model),
      convex_(static_cast<std::size_t>(model.ngeom)),
      prisms_(static_cast<std::size_t>(model.ngeom)) {
  for (int i = 0; i < model.ngeom; ++i) {
    if (model.geom_contype[i] == 0 && model.geom_conaffinity[i] == 0) continue;  // a picture
    const auto index = static_cast<std::size_t>(i);
    convex_[index] = FromGeom(model, i);
    if (model.geom_type[i] == mjGEOM_HFIELD) {
      prisms_[index] = MakePrisms(model, model.geom_dataid[i]);
    }
  }
}

double GeomDistance::BoundFrom(const mjData& data, int geom, int other) const {
  const Eigen::Vector3d apart = GeomPosition(data, other) - GeomPosition(data, geom);
  const double radius = model_.geom_rbound[other];
  if (model_.geom_type[geom] != mjGEOM_BOX) return apart.norm() - model_.geom_rbound[geom] - radius;
  const Eigen::Vector3d p = GeomRotation(data, geom).transpose() * apart;
  const Eigen::Map<const Eigen::Vector3d> half_m(model_.geom_size + 3 * geom);
  return (p.cwiseAbs() - half_m).cwiseMax(0).norm() - radius;
}

double GeomDistance::LowerBound(const mjData& data, int geom1, int geom2) const {
  if (model_.geom_rbound[geom1] == 0 || model_.geom_rbound[geom2] == 0) {
    return 0;  // unbounded, for MuJoCo
  }
  return std::max({0.0, BoundFrom(data, geom1, geom2), BoundFrom(data, geom2, geom1)});
}

const ConvexSolid& GeomDistance::ConvexFirst(int* geom1, int* geom2) const {
  if (!convex_[static_cast<std::size_t>(*geom1)]) std::swap(*geom1, *geom2);
  const std::optional<ConvexSolid>& convex = convex_[static_cast<std::size_t>(*geom1)];
  if (!convex) throw std::invalid_argument("GeomDistance: one of two geoms must be convex");
  return *convex;
}

double GeomDistance::Distance(const mjData& data, int geom1, int geom2) const {
  const ConvexSolid& convex1 = ConvexFirst(&geom1, &geom2);
  if (model_.geom_type[geom2] == mjGEOM_PLANE) {
    return std::max(0.0, HeightOver(model_, data, geom2, geom1));
  }
  const Eigen::Isometry3d X_21 = GeomFrame(data, geom2).inverse() * GeomFrame(data, geom1);
  const std::optional<ConvexSolid>& convex2 = convex_[static_cast<std::size_t>(geom2)];
  if (convex2) return ConvexDistance(*convex2, convex1, X_21);

  const Eigen::Vector3d centre = X_21.translation();
  double least = std::numeric_limits<double>::infinity();
  for (const Prism& prism : prisms_[static_cast<std::size_t>(geom2)]) {
    const Eigen::Vector3d nearest = centre.cwiseMax(prism.lower_m).cwiseMin(prism.upper_m);
    if ((nearest - centre).norm() - model_.geom_rbound[geom1] >= least) continue;
    least = std::min(least, ConvexDistance(prism.solid, convex1, X_21));
  }
  return least;
}

double GeomDistance::Depth(const mjData& data, int geom1, int geom2) const {
  const ConvexSolid& convex1 = ConvexFirst(&geom1, &geom2);
  if (model_.geom_type[geom2] == mjGEOM_PLANE) {
    return std::max(0.0, -HeightOver(model_, data, geom2, geom1));
  }
  const Eigen::Isometry3d X_21 = GeomFrame(data, geom2).inverse() * GeomFrame(data, geom1);
  const std::optional<ConvexSolid>& convex2 = convex_[static_cast<std::size_t>(geom2)];
  if (convex2) return ConvexDepth(*convex2, convex1, X_21);

  double most = 0;
  for (const Prism& prism : prisms_[static_cast<std::size_t>(geom2)]) {
    most = std::max(most, ConvexDepth(prism.solid, convex1, X_21));
  }
  return most;
}

}  // namespace sidestep::sim
