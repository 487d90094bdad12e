#include "sim/geom_distance.h"

#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/convex.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/ellipsoid.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sim/geom_solids.h"
#include "sim/mujoco_pose.h"

namespace sidestep {
namespace {

using FclGeometry = std::unique_ptr<fcl::CollisionGeometryd>;

FclGeometry MakeConvex(const ConvexHull& hull) {
  auto faces = std::make_shared<std::vector<int>>();
  for (const std::array<int, 3>& face : hull.faces) {
    faces->push_back(3);
    faces->insert(faces->end(), face.begin(), face.end());
  }
  return std::make_unique<fcl::Convexd>(
      std::make_shared<const std::vector<Eigen::Vector3d>>(hull.vertices),
      static_cast<int>(hull.faces.size()), faces);
}

// Null for what is not convex and bounded.
FclGeometry MakeFclGeometry(const mjModel& model, int geom) {
  const mjtNum* size = model.geom_size + 3 * geom;
  switch (model.geom_type[geom]) {
    case mjGEOM_SPHERE:
      return std::make_unique<fcl::Sphered>(size[0]);
    case mjGEOM_CAPSULE:
      return std::make_unique<fcl::Capsuled>(size[0], 2 * size[1]);
    case mjGEOM_ELLIPSOID:
      return std::make_unique<fcl::Ellipsoidd>(size[0], size[1], size[2]);
    case mjGEOM_CYLINDER:
      return std::make_unique<fcl::Cylinderd>(size[0], 2 * size[1]);
    case mjGEOM_BOX:
      return std::make_unique<fcl::Boxd>(2 * size[0], 2 * size[1], 2 * size[2]);
    case mjGEOM_MESH:
      return MakeConvex(HullOfMesh(model, model.geom_dataid[geom]));
    default:
      return nullptr;
  }
}

fcl::Transform3d ToFcl(const mjData& data, int geom) {
  fcl::Transform3d X = fcl::Transform3d::Identity();
  X.linear() = GeomRotation(data, geom);
  X.translation() = GeomPosition(data, geom);
  return X;
}

double ConvexDistance(const fcl::CollisionGeometryd& a, const fcl::Transform3d& X_WA,
                      const fcl::CollisionGeometryd& b, const fcl::Transform3d& X_WB) {
  const fcl::DistanceRequestd request(/*enable_nearest_points=*/false,
                                      /*enable_signed_distance=*/false, /*rel_err=*/0,
                                      /*abs_err=*/0, /*distance_tolerance=*/1e-9, fcl::GST_LIBCCD);
  fcl::DistanceResultd result;
  return std::max(0.0, fcl::distance(&a, X_WA, &b, X_WB, request, result));
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
      double reach = 0;
      for (int i = 0; i < model.mesh_vertnum[mesh]; ++i) {
        const Eigen::Map<const Eigen::Vector3f> vertex(vertices + 3 * i);
        reach = std::max(reach, -n.dot(vertex.cast<double>()));
      }
      return reach;
    }
  }
}

double PlaneDistance(const mjModel& model, const mjData& data, int plane, int geom) {
  const Eigen::Vector3d normal_W = GeomRotation(data, plane).col(2);
  const double height = normal_W.dot(GeomPosition(data, geom) - GeomPosition(data, plane));
  return std::max(0.0, height - ReachAgainst(model, data, geom, normal_W));
}

struct Prism {
  FclGeometry geometry;
  Eigen::Vector3d lower_m, upper_m;  // the box around it, in the height field's frame
};

std::vector<Prism> MakePrisms(const mjModel& model, int hfield) {
  std::vector<Prism> prisms;
  for (const ConvexHull& hull : HeightField(model, hfield).Prisms()) {
    Prism prism{MakeConvex(hull), hull.vertices[0], hull.vertices[0]};
    for (const Eigen::Vector3d& vertex : hull.vertices) {
      prism.lower_m = prism.lower_m.cwiseMin(vertex);
      prism.upper_m = prism.upper_m.cwiseMax(vertex);
    }
    prisms.push_back(std::move(prism));
  }
  return prisms;
}

}  // namespace

struct GeomDistance::Solids {
  std::vector<FclGeometry> convex;         ///< one a geom, null for planes and height fields
  std::vector<std::vector<Prism>> prisms;  ///< one list a geom, filled for height fields
};

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

GeomDistance::GeomDistance(const mjModel& model) : model_(model) {
  auto solids = std::make_unique<Solids>();
  solids->convex.resize(static_cast<std::size_t>(model.ngeom));
  solids->prisms.resize(static_cast<std::size_t>(model.ngeom));
  for (int i = 0; i < model.ngeom; ++i) {
    if (model.geom_contype[i] == 0 && model.geom_conaffinity[i] == 0) continue;  // a picture
    const auto index = static_cast<std::size_t>(i);
    solids->convex[index] = MakeFclGeometry(model, i);
    if (model.geom_type[i] == mjGEOM_HFIELD) {
      solids->prisms[index] = MakePrisms(model, model.geom_dataid[i]);
    }
  }
  solids_ = std::move(solids);
}

GeomDistance::~GeomDistance() = default;

double GeomDistance::LowerBound(const mjData& data, int geom1, int geom2) const {
  const double radius1 = model_.geom_rbound[geom1], radius2 = model_.geom_rbound[geom2];
  if (radius1 == 0 || radius2 == 0) return 0;  // unbounded, for MuJoCo
  const double apart = (GeomPosition(data, geom1) - GeomPosition(data, geom2)).norm();
  return std::max(0.0, apart - radius1 - radius2);
}

double GeomDistance::Distance(const mjData& data, int geom1, int geom2) const {
  if (!solids_->convex[static_cast<std::size_t>(geom1)]) std::swap(geom1, geom2);
  const FclGeometry& convex1 = solids_->convex[static_cast<std::size_t>(geom1)];
  if (!convex1) throw std::invalid_argument("GeomDistance: one of two geoms must be convex");
  if (model_.geom_type[geom2] == mjGEOM_PLANE) {
    return PlaneDistance(model_, data, geom2, geom1);
  }
  const fcl::Transform3d X_W1 = ToFcl(data, geom1), X_W2 = ToFcl(data, geom2);
  const FclGeometry& convex2 = solids_->convex[static_cast<std::size_t>(geom2)];
  if (convex2) return ConvexDistance(*convex1, X_W1, *convex2, X_W2);

  const Eigen::Vector3d centre = X_W2.inverse() * X_W1.translation();
  double least = std::numeric_limits<double>::infinity();
  for (const Prism& prism : solids_->prisms[static_cast<std::size_t>(geom2)]) {
    const Eigen::Vector3d nearest = centre.cwiseMax(prism.lower_m).cwiseMin(prism.upper_m);
    if ((nearest - centre).norm() - model_.geom_rbound[geom1] >= least) continue;
    least = std::min(least, ConvexDistance(*convex1, X_W1, *prism.geometry, X_W2));
  }
  return least;
}

}  // namespace sidestep
