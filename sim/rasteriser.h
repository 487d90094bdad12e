#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "sidestep/core/cell_touch.h"
#include "sidestep/core/grid.h"
#include "sidestep/core/shape.h"
#include "sidestep/sim/geom_solids.h"
#include "sidestep/sim/parts_touch.h"

namespace sidestep::sim {

/// Ground-truth occupancy. Under kTouched a cell is filled iff a solid reaches into it (see
/// CubeTouch and PartsTouch), under kCentre iff its centre is inside a solid.
///
/// Under kCentre, a centre exactly on a surface: flat faces are half-open. A box holds [-h, h)
/// along each of its own axes, a cylinder [-h, h) along its own, a plane or a height field what is
/// strictly below it; a face of a mesh belongs to it iff the last of its outward normal's
/// components, z before y before x, that is not zero is negative, which for a mesh of a box is the
/// box's rule. So bodies that share a face share no cell, and a box of 12 cells fills 12, wherever
/// it stands. Curved surfaces are outside. What lies within kOnSurface_m of a surface counts as on
/// it, or rounding errors would decide; within kOnCoarseSurface_m for meshes and height fields,
/// whose vertices are of single precision.
class Rasteriser {
 public:
  static constexpr double kOnSurface_m = 1e-9;
  static constexpr double kOnCoarseSurface_m = 1e-6;

  /// @param model must outlive this.
  Rasteriser(const mjModel& model, CellRule rule);

  /// Fills the cells of one geom at its pose in `data`, of any type MuJoCo simulates: a plane fills
  /// all below it, a mesh its convex hull, a height field what is between base and surface. Looks
  /// only at cells of the box around the geom.
  /// @return the cells (GridSpec::Index) that were free before, ascending.
  std::vector<std::size_t> Fill(const mjData& data, int geom, OccupancyGrid* grid) const;

 private:
  /// What a face of a mesh bounds: normal . p <= offset.
  struct HalfSpace {
    Eigen::Vector3d normal;
    double offset_m;
  };
  struct Solid {
    std::optional<Shape> shape;        ///< if core/shape.h has it
    std::vector<HalfSpace> faces;      ///< of a mesh
    PartsTouch parts;                  ///< of a mesh, a height field
    Eigen::Vector3d lower_m, upper_m;  ///< the box around it, in the geom's frame
    std::optional<HeightField> height_field;
  };
  static std::vector<HalfSpace> FacesOf(const ConvexHull& hull);
  static Solid MakeSolid(const mjModel& model, int geom);

  std::vector<std::size_t> FillTouched(const mjData& data, int geom, OccupancyGrid* grid) const;
  std::vector<std::size_t> FillCentres(const mjData& data, int geom, OccupancyGrid* grid) const;

  const mjModel& model_;
  CellRule rule_;
  std::vector<Solid> solids_;  ///< one a geom
};

/// Every solid but the robot and the floor at the poses in `data`: what an ideal sensor would map.
/// The floor is left out because ground removal comes first in any real pipeline, and because
/// fields know it exactly.
OccupancyGrid RasteriseWorld(const mjModel& model, const mjData& data, const GridSpec& spec,
                             CellRule rule);

}  // namespace sidestep::sim
