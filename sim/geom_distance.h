#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "sidestep/sim/convex_solid.h"

namespace sidestep::sim {

/// Where two solids touch.
struct Touch {
  double depth_m = 0;          ///< MuJoCo's, >= 0; it may jump as the solids move
  Eigen::Vector3d p_WContact;  ///< [m] midway between the surfaces
};

/// Whether two geoms touch or overlap at the poses in `data`; of several contacts, the deepest one.
/// By MuJoCo's own contact functions, but for any two geoms, whatever its filters say: it never
/// looks for contacts between a robot's fixed base and an obstacle that follows a path. Two planes
/// or height fields never touch.
std::optional<Touch> FindTouch(const mjModel& model, const mjData& data, int geom1, int geom2);

/// Measures how far geoms are apart, to 1e-9 m. Sphere, capsule, ellipsoid, cylinder, box and
/// convex mesh: sim/convex_distance.h. A plane: in closed form. A height field: as the prisms under
/// its triangles.
class GeomDistance {
 public:
  /// @param model must outlive this.
  explicit GeomDistance(const mjModel& model);

  /// The least distance between two solids at the poses in `data` [m]; 0 if they overlap.
  /// @throws std::invalid_argument if neither of the two is a bounded convex solid.
  double Distance(const mjData& data, int geom1, int geom2) const;

  /// How deep two solids overlap at the poses in `data` [m]; 0 if they do not. To 1e-7 m, see
  /// sim/convex_depth.h; a plane in closed form; a height field by the one prism that is entered
  /// deepest. @throws as Distance.
  double Depth(const mjData& data, int geom1, int geom2) const;

  /// A quick lower bound of Distance, from spheres around the geoms; a box is taken as it is.
  double LowerBound(const mjData& data, int geom1, int geom2) const;

 private:
  /// What is under one triangle of a height field.
  struct Prism {
    ConvexSolid solid;
    Eigen::Vector3d lower_m, upper_m;  ///< the box around it, in the height field's frame
  };
  static std::vector<Prism> MakePrisms(const mjModel& model, int hfield);
  /// That of a geom from the sphere around another one.
  double BoundFrom(const mjData& data, int geom, int other) const;
  /// Swaps the two where needed, so that the first one is convex.
  const ConvexSolid& ConvexFirst(int* geom1, int* geom2) const;

  const mjModel& model_;
  std::vector<std::optional<ConvexSolid>> convex_;  ///< one a geom; none: a plane, a height field
  std::vector<std::vector<Prism>> prisms_;          ///< one list a geom, filled for height fields
};

}  // namespace sidestep::sim
