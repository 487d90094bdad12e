#include "sidestep/sim/rasteriser.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "sidestep/sim/mujoco_pose.h"
#include "sidestep/sim/world_geoms.h"

namespace sidestep::sim {
namespace {

constexpr double kOn = Rasteriser::kOnSurface_m;
constexpr double kOnCoarse = Rasteriser::kOnCoarseSurface_m;
constexpr double kEndless_m = std::numeric_limits<double>::infinity();

bool InHalfOpen(double x, double half) { return x >= -half - kOn && x < half - kOn; }

bool BelongsToSolid(const Eigen::Vector3d& face_normal) {
  constexpr double kZero = 1e-5;  // the vertices are of single precision
  for (const int axis : {2, 1, 0}) {
    if (std::abs(face_normal(axis)) > kZero) return face_normal(axis) < 0;
  }
  return false;
}

struct CellRange {
  std::array<int, 3> first, last;  // inclusive; empty if last < first
};

// The cells whose centres may lie in a box of the geom's frame, or at most `reach_m` beside it
// along each axis of W.
CellRange CellsAround(const Eigen::Matrix3d& R_WG, const Eigen::Vector3d& p_WG,
                      const Eigen::Vector3d& lower, const Eigen::Vector3d& upper, double reach_m,
                      const GridSpec& spec) {
  CellRange range;
  for (int a = 0; a < 3; ++a) {
    double low = p_WG(a) - reach_m, high = p_WG(a) + reach_m;
    for (int b = 0; b < 3; ++b) {
      const double end1 = R_WG(a, b) * lower(b), end2 = R_WG(a, b) * upper(b);
      if (R_WG(a, b) == 0) continue;  // 0 times infinity
      low += std::min(end1, end2);
      high += std::max(end1, end2);
    }
    constexpr double kSlack = 1e-6;  // of a cell; the exact test follows
    const auto i = static_cast<std::size_t>(a);
    const double end = spec.size[i] - 1;
    const double first = std::ceil((low - spec.first_center_m(a)) / spec.cell_m - kSlack);
    const double last = std::floor((high - spec.first_center_m(a)) / spec.cell_m + kSlack);
    range.first[i] = static_cast<int>(std::clamp(first, 0.0, end + 1));
    range.last[i] = static_cast<int>(std::clamp(last, -1.0, end));
  }
  return range;
}

// Fills the cells of a range for whose centres, in W, the test holds.
template <typename Test>
std::vector<std::size_t> FillWhere(const CellRange& range, OccupancyGrid* grid, const Test& test) {
  std::vector<std::size_t> filled;
  const GridSpec& spec = grid->spec;
  for (int k = range.first[2]; k <= range.last[2]; ++k) {
    for (int j = range.first[1]; j <= range.last[1]; ++j) {
      for (int i = range.first[0]; i <= range.last[0]; ++i) {
        const std::size_t cell = spec.Index(i, j, k);
        if (grid->cells[cell] != 0 || !test(spec.Center(i, j, k))) continue;
        grid->cells[cell] = 1;
        filled.push_back(cell);
      }
    }
  }
  return filled;
}

}  // namespace

Rasteriser::Rasteriser(const mjModel& model, CellRule rule) : model_(model), rule_(rule) {
  for (int i = 0; i < model.ngeom; ++i) solids_.push_back(MakeSolid(model, i));
}

std::vector<Rasteriser::HalfSpace> Rasteriser::FacesOf(const ConvexHull& hull) {
  std::vector<HalfSpace> faces;
  for (const std::array<int, 3>& face : hull.faces) {
    const auto vertex = [&](std::size_t i) {
      return hull.vertices[static_cast<std::size_t>(face[i])];
    };
    const Eigen::Vector3d across = (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0));
    if (!(across.norm() > 0)) continue;
    const Eigen::Vector3d normal = across.normalized();
    const double offset = normal.dot(vertex(0));
    // The vertices are of single precision, so the plane of a sliver may be askew and cut into the
    // hull; its neighbours bound the same flat face better.
    const bool supports =
        std::all_of(hull.vertices.begin(), hull.vertices.end(),
                    [&](const auto& v) { return normal.dot(v) <= offset + kOnCoarse; });
    if (supports) faces.push_back({normal, offset});
  }
  return faces;
}

Rasteriser::Solid Rasteriser::MakeSolid(const mjModel& model, int geom) {
  Solid solid;
  solid.shape = ShapeOfGeom(model, geom);
  const Eigen::Map<const Eigen::Vector3d> size(model.geom_size + 3 * geom);
  const auto set_half_extents = [&](double x, double y, double z) {
    solid.upper_m = {x, y, z};
    solid.lower_m = -solid.upper_m;
  };
  switch (model.geom_type[geom]) {
    case mjGEOM_PLANE:
      set_half_extents(kEndless_m, kEndless_m, kEndless_m);
      solid.upper_m.z() = 0;
      break;
    case mjGEOM_HFIELD: {
      solid.height_field.emplace(model, model.geom_dataid[geom]);
      const Eigen::Vector2d& half = solid.height_field->half_size_m();
      solid.lower_m = {-half.x(), -half.y(), solid.height_field->base_m()};
      solid.upper_m = {half.x(), half.y(), solid.height_field->top_m()};
      solid.parts = PartsTouch(solid.height_field->Prisms());
      break;
    }
    case mjGEOM_SPHERE:
      set_half_extents(size(0), size(0), size(0));
      break;
    case mjGEOM_CAPSULE:
      set_half_extents(size(0), size(0), size(0) + size(1));
      break;
    case mjGEOM_CYLINDER:
      set_half_extents(size(0), size(0), size(1));
      break;
    case mjGEOM_MESH: {
      if (model.geom_contype[geom] == 0 && model.geom_conaffinity[geom] == 0) break;  // a picture
      const ConvexHull hull = HullOfMesh(model, model.geom_dataid[geom]);
      solid.lower_m = solid.upper_m = hull.vertices.front();
      for (const Eigen::Vector3d& vertex : hull.vertices) {
        solid.lower_m = solid.lower_m.cwiseMin(vertex);
        solid.upper_m = solid.upper_m.cwiseMax(vertex);
      }
      solid.faces = FacesOf(hull);
      solid.parts = PartsTouch({hull});
      break;
    }
    default:  // box, ellipsoid
      set_half_extents(size(0), size(1), size(2));
  }
  return solid;
}

std::vector<std::size_t> Rasteriser::Fill(const mjData& data, int geom, OccupancyGrid* grid) const {
  return rule_ == CellRule::kTouched ? FillTouched(data, geom, grid)
                                     : FillCentres(data, geom, grid);
}

std::vector<std::size_t> Rasteriser::FillTouched(const mjData& data, int geom,
                                                 OccupancyGrid* grid) const {
  const Solid& solid = solids_[static_cast<std::size_t>(geom)];
  const Eigen::Matrix3d R_WG = GeomRotation(data, geom);
  const Eigen::Vector3d p_WG = GeomPosition(data, geom);
  const double cell_m = grid->spec.cell_m;
  const CellRange range =
      CellsAround(R_WG, p_WG, solid.lower_m, solid.upper_m, cell_m / 2, grid->spec);
  if (solid.shape) return FillWhere(range, grid, CubeTouch(*solid.shape, R_WG, p_WG, cell_m));
  if (model_.geom_type[geom] == mjGEOM_PLANE) {
    const Eigen::Vector3d normal_W = R_WG.col(2);
    const double reach_m = cell_m / 2 * normal_W.cwiseAbs().sum();
    return FillWhere(range, grid, [&](const Eigen::Vector3d& p_WCenter) {
      return normal_W.dot(p_WCenter - p_WG) - reach_m < -kOn;
    });
  }
  Eigen::Isometry3d X_WG = Eigen::Isometry3d::Identity();
  X_WG.linear() = R_WG;
  X_WG.translation() = p_WG;
  return FillWhere(range, grid,
                   [&, X_GW = X_WG.inverse(Eigen::Isometry)](const Eigen::Vector3d& p_WCenter) {
                     return solid.parts(X_GW, p_WCenter, cell_m);
                   });
}

std::vector<std::size_t> Rasteriser::FillCentres(const mjData& data, int geom,
                                                 OccupancyGrid* grid) const {
  const Solid& solid = solids_[static_cast<std::size_t>(geom)];
  const Eigen::Vector3d size = Eigen::Map<const Eigen::Vector3d>(model_.geom_size + 3 * geom);
  const Eigen::Matrix3d R_WG = GeomRotation(data, geom);
  const Eigen::Vector3d p_WG = GeomPosition(data, geom);
  const CellRange range = CellsAround(R_WG, p_WG, solid.lower_m, solid.upper_m, 0, grid->spec);
  const Eigen::Matrix3d R_GW = R_WG.transpose();
  const auto fill_where = [&](const auto& inside) {
    return FillWhere(range, grid, [&](const Eigen::Vector3d& p_WCenter) {
      return inside(R_GW * (p_WCenter - p_WG));
    });
  };
  using Point = Eigen::Vector3d;
  switch (model_.geom_type[geom]) {
    case mjGEOM_PLANE:
      return fill_where([](const Point& p) { return p.z() < -kOn; });
    case mjGEOM_HFIELD:
      return fill_where([&](const Point& p) {
        const HeightField& field = *solid.height_field;
        return InHalfOpen(p.x(), field.half_size_m().x()) &&
               InHalfOpen(p.y(), field.half_size_m().y()) && p.z() >= field.base_m() - kOn &&
               p.z() < field.HeightAt(p.x(), p.y()) - kOnCoarse;
      });
    case mjGEOM_SPHERE:
      return fill_where([&](const Point& p) { return p.norm() < size(0) - kOn; });
    case mjGEOM_CAPSULE:
      return fill_where([&](const Point& p) {
        const double z = p.z() - std::clamp(p.z(), -size(1), size(1));
        return std::hypot(p.x(), p.y(), z) < size(0) - kOn;
      });
    case mjGEOM_ELLIPSOID:
      return fill_where(
          [&](const Point& p) { return p.cwiseQuotient(size).norm() < 1 - kOn / size.minCoeff(); });
    case mjGEOM_CYLINDER:
      return fill_where([&](const Point& p) {
        return InHalfOpen(p.z(), size(1)) && p.head<2>().norm() < size(0) - kOn;
      });
    case mjGEOM_BOX:
      return fill_where([&](const Point& p) {
        return InHalfOpen(p.x(), size(0)) && InHalfOpen(p.y(), size(1)) &&
               InHalfOpen(p.z(), size(2));
      });
    case mjGEOM_MESH:
      return fill_where([&](const Point& p) {
        return std::all_of(solid.faces.begin(), solid.faces.end(), [&](const HalfSpace& face) {
          const double height = face.normal.dot(p) - face.offset_m;
          return height < -kOnCoarse || (height <= kOnCoarse && BelongsToSolid(face.normal));
        });
      });
    default:
      return {};
  }
}

OccupancyGrid RasteriseWorld(const mjModel& model, const mjData& data, const GridSpec& spec,
                             CellRule rule) {
  OccupancyGrid grid(spec);
  const Rasteriser rasteriser(model, rule);
  const WorldGeoms geoms = FindWorldGeoms(model);
  for (const std::vector<int>* solids : {&geoms.fixed, &geoms.moving}) {
    for (const int geom : *solids) rasteriser.Fill(data, geom, &grid);
  }
  return grid;
}

}  // namespace sidestep::sim
