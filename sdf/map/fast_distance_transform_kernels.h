#pragma once

#include <cstddef>
#include <cstdint>

#include "sdf/map/distance_transform.h"

/// The SIMD half of FastDistanceTransform (fast_distance_transform.h): plain structs that say what
/// to do, and two functions that do it, compiled for several instruction sets. Only
/// fast_distance_transform.cc and its tests include this file.
///
/// # Squares
/// The transform minimises a sum of one cost per axis; a cost depends only on how many cells k
/// apart two cells are along that axis. Any numbers that order the sums as the squared distances
/// are ordered will do, and small ones fit narrow lanes:
///
///  - kBwdist: cost(k) = k^2, the squared distance in cells.
///  - kSurface: from a centre to a cube it is (2k - 1)^2 = 4 k (k - 1) + 1 half cells for k >= 1,
///  and
///    0 for k = 0. A sum over three axes is 8 T + n, with T the sum of the triangular numbers
///    k (k - 1) / 2 and n <= 3 the number of axes with k >= 1. Since n < 4, the sums 4 T + n are in
///    the same order, and they are half as large: cost(k) = 2 k (k - 1) + 1.
///
/// SquaredHalfCells() undoes either. 8-bit lanes then reach 15 and 11 cells, 16-bit ones 255 and
/// 181.
///
/// # One line
/// Both costs are convex and start at 0. A line f of n values is replaced by
///     min over s of  f(s) + cost(|t - s|)
/// in two sweeps, up and down the line. The upward one visits the sources s from the last to the
/// first; each offers f(s) + cost(1), f(s) + cost(2), ... to the values after it *until an offer is
/// not lower than what is there*. Stopping is exact: what is there came from a source s' > s (those
/// have had their turn), and as cost is convex, s' stays at least as good from there on. So a value
/// is visited only by sources that improve it, and once by each that fails; in a grid of real
/// obstacles that is 2 to 4 visits, whatever the distances. The downward sweep runs on the
/// result of the upward one, which is harmless: a way up and then down costs more than the direct
/// one.
///
/// # One signed pass
/// Each cell wants the distance to the other kind of cell. For free cells the filled ones are
/// sources of value 0 and the other way round, so a line is split into two that are transformed
/// alone: the *free side* holds 0 in filled cells, the *filled side* 0 in free ones. The filled
/// side is 0 nearly everywhere, and is touched only where there are filled cells.
///
/// # The grid
/// Lines along x are written from a table, run by run of equal cells. Then TransformSlice takes the
/// lines along y, TransformPlane those along z. A *column* is a bundle of neighbouring lines, as
/// many as fill a cache line (64 bytes), handled by one or a few vectors whatever the instruction
/// set.
namespace sidestep::fast_transform {

inline constexpr std::size_t kColumnBytes = 64;

/// How many lines a column bundles.
template <class Lane>
inline constexpr std::size_t kColumnLanes = kColumnBytes / sizeof(Lane);

/// The squared distance in half cells that a sum of costs stands for.
constexpr std::uint32_t SquaredHalfCells(std::uint32_t sum, DistanceConvention convention) {
  return convention == DistanceConvention::kSurface ? 2 * sum - (sum & 3) : 4 * sum;
}

/// Costs in the form that the kernels read. All are clamped to `far`.
template <class Lane>
struct CostTables {
  /// What stands for "nothing found": no sum that matters is as large. Sums saturate there.
  Lane far = 0;
  /// cost(k) repeated to fill 32 bits, for k = 0 ... the largest size of the grid.
  const std::uint32_t* repeated = nullptr;
  /// Costs of a run of cells counted from the cell before it, cost(1), cost(2), ...
  const Lane* rising = nullptr;
  /// ... and to the cell after it: *falling_end is cost(0), falling_end[-1] is cost(1), ...
  /// Both tables can be read kColumnBytes beyond the longest run.
  const Lane* falling_end = nullptr;
};

/// What the whole transform shares. Sizes and pitches count elements.
template <class Lane>
struct Job {
  std::size_t nx = 0, ny = 0, nz = 0;
  const std::uint8_t* cells = nullptr;  ///< nx x ny x nz, x fastest; not 0 is filled
  float* distance_m = nullptr;          ///< the same shape
  CostTables<Lane> costs;
  DistanceConvention convention = DistanceConvention::kSurface;
  double half_cell_m = 0;
  float max_distance_m = 0;       ///< results are clamped to +- this
  bool may_saturate = false;      ///< whether a sum of `far` must be looked for at all
  bool bypass_cache = false;      ///< write results with non-temporal stores
  std::size_t num_columns = 0;    ///< ceil(nx / kColumnLanes)
  std::size_t words_per_row = 0;  ///< ceil(nx / 64)

  /// Sums after the passes along x and y: [y][z][column][lane], and the distance between two y.
  Lane* sums = nullptr;
  std::size_t plane_pitch = 0;
  /// The cells as bits: [y][z][word], lowest bit first, 0 beyond nx. Like `sums`, not set for the
  /// slices that slice_is_free names.
  std::uint64_t* bits = nullptr;
  std::uint8_t* slice_is_free = nullptr;  ///< [z] 1: no filled cell, all sums are `far`
};

/// Scratch of one worker; it has the columns of one slice or the column of one plane.
template <class Lane>
struct Scratch {
  Lane* row = nullptr;            ///< one line along x: num_columns * kColumnLanes + kColumnLanes
  Lane* free_side = nullptr;      ///< [column][max(ny, nz)][lane]
  Lane* filled_side = nullptr;    ///< the same
  std::uint64_t* bits = nullptr;  ///< [y][word]
  float* distances = nullptr;     ///< a row of them: nx
};

/// The passes along x and y for slice z.
void TransformSlice(const Job<std::uint8_t>& job, const Scratch<std::uint8_t>& scratch, int z);
void TransformSlice(const Job<std::uint16_t>& job, const Scratch<std::uint16_t>& scratch, int z);
void TransformSlice(const Job<std::uint32_t>& job, const Scratch<std::uint32_t>& scratch, int z);

/// The pass along z for plane y, and the distances of that plane. All slices must be done.
/// @return false if a sum saturated: the lanes are too narrow, and the distances are wrong.
bool TransformPlane(const Job<std::uint8_t>& job, const Scratch<std::uint8_t>& scratch, int y);
bool TransformPlane(const Job<std::uint16_t>& job, const Scratch<std::uint16_t>& scratch, int y);
bool TransformPlane(const Job<std::uint32_t>& job, const Scratch<std::uint32_t>& scratch, int y);

}  // namespace sidestep::fast_transform
