#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "sidestep/core/solid.h"
#include "sidestep/sdf/map/sdf_grid.h"
#include "sidestep/sdf/point_block.h"

/// The SIMD half of PlacedComposite: plain structs and four functions, compiled for several
/// instruction sets. Each does for a block of points, a vector at a time, what SdfGrid::Sample and
/// PlacedComposite::Sample do for one: the same operations in the same order, hence the same bits.
/// Only PlacedComposite and what it is made of include this file.
namespace sidestep::sdf::field_kernels {

/// A grid, ready to be interpolated.
struct Grid {
  const float* distance_m = nullptr;
  std::array<double, 3> first_m{}, last_m{};  ///< the domain, from centre to centre
  double cells_per_m = 0;
  std::array<std::int32_t, 3> last_lower{};  ///< largest index of a lower neighbour along each axis
  std::int32_t stride_y = 0, stride_z = 0;   ///< in values
};

/// Whether the kernels can read this grid: two cells or more along each axis, and fewer than 2^31.
bool IsReadable(const SdfGrid& grid);
/// @param grid must be readable and outlive the view.
Grid ViewOf(const SdfGrid& grid);

/// An object's field, placed in the world.
struct Placed {
  Grid grid_O;
  std::array<double, 9> R_WO{};  ///< row by row
  std::array<double, 3> p_WO{};
  double growth_m = 0;  ///< taken off each distance
};

/// The functions below work on whole vectors, and round `count` up: blocks must be padded.
using Block = PointBlock;
inline constexpr std::size_t kBlockSize = Block::kSize;

/// Samples a grid that does not move, clamped. @return how many of the points lie outside it.
int SampleStatic(const Grid& grid, double max_distance_m, Block& block);

/// Lowers the samples to those of a half-space where that is nearer.
void LowerByHalfSpace(const HalfSpace& half_space, Block& block);

/// Lowers the samples to those of an object where that is nearer.
void LowerByObject(const Placed& object, Block& block);

/// Axis-aligned boxes, one a lane; their number is a multiple of kBoxLanes.
inline constexpr std::size_t kBoxLanes = 16;
struct Boxes {
  std::span<const float> x_low, y_low, z_low, x_high, y_high, z_high;
  std::span<const float> slack_m;
};

/// Marks the boxes that are nearer to p than max(0, reach + slack), or hold p: one bit a box, the
/// lowest first. @param bits has room for one bit a box.
void FindNear(const Boxes& boxes, const std::array<float, 3>& p_m, float reach_m,
              std::span<std::uint64_t> bits);

}  // namespace sidestep::sdf::field_kernels
