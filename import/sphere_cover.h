#pragma once

#include <vector>

#include "sidestep/import/cover_sphere.h"
#include "sidestep/import/link_solids.h"

namespace sidestep::imports {

/// What covers are asked for. A tolerance alone: as few spheres as it takes; a number alone: as
/// small a tolerance as they reach; both: as little volume as there is.
struct CoverRequest {
  double cover_m = 0;   ///< no point of a surface sticks out further; 0: as little as can be
  int num_spheres = 0;  ///< of all links together, at most; 0: as many as it takes
  /// By how much the volume of the spheres may exceed that of the solids, as a share, all links
  /// together: of two covers the one with fewer spheres stands out further. Where it cannot be
  /// kept, as for thin plates, the least volume is taken that was found.
  double max_excess = 0.35;
};

/// The spheres of one link, in its frame.
struct LinkCover {
  std::vector<CoverSphere> spheres;
  double solid_m3 = 0;   ///< the volume of the union of its solids
  double sphere_m3 = 0;  ///< and of its spheres
};

struct RobotCover {
  double cover_m = 0;  ///< no point of a surface sticks out further, for certain
  std::vector<LinkCover> links;

  int num_spheres() const;
  /// Of the spheres' volume, all links together, over that of the solids, minus 1.
  double excess() const;
};

/// A link has at most so many spheres.
inline constexpr int kMostSpheresOfALink = 24;

/// Covers the solids of each link with spheres. All of a solid's surface counts, also what another
/// solid of the link hides. The same input gives the same spheres; centres and radii are round
/// numbers of metres, to a hundredth of the tolerance or finer.
/// @return a link's spheres in its place; none for one without solids.
/// @throws InputError `NAME: WHY` for a mesh that is not closed (closed_mesh.h),
///   std::invalid_argument for a request of neither, of less spheres than links with solids, or of
///   numbers that are negative or not finite.
RobotCover CoverLinks(const std::vector<LinkSolids>& links, const CoverRequest& request);

/// How far the solids of a link stick out of spheres, and how much larger those are.
struct CoverCheck {
  double uncovered_m = 0;  ///< no point of a surface sticks out further; negative: all are deeper
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();  ///< where that is, to `precision_m`
  bool on_shape = true;   ///< there is the surface of a shape, else of a mesh
  std::size_t solid = 0;  ///< which one of them
  double solid_m3 = 0, sphere_m3 = 0;
};

/// @param spheres in the link's frame; if there are none, `uncovered_m` is infinite.
/// @param precision_m > 0: what `uncovered_m` may be too large.
/// @throws InputError as CoverLinks, std::invalid_argument for a link without solids.
CoverCheck CheckCover(const LinkSolids& solids, const std::vector<CoverSphere>& spheres,
                      double precision_m);

}  // namespace sidestep::imports
