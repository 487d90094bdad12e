#pragma once

#include <cstddef>
#include <cstdint>

#include "sidestep/sdf/map/distance_transform.h"
#include "sidestep/sdf/map/fast_distance_transform_envelope.h"

/// The SIMD half of FastDistanceTransform: plain structs that say what to do, and two functions
/// that do it, compiled for several instruction sets. Only fast_distance_transform.cc includes this
/// file.
///
/// # Sums
/// The transform minimises, over all cells of the other kind, a sum of one cost per axis, which
/// depends on how many cells k two cells are apart along it. With lanes of 32 bits the sum is the
/// squared distance in half cells, as in ComputeSquaredDistance. But any costs will do whose sums
/// are ordered as the squares are, and lanes of 8 and 16 bits reach furthest with small ones:
///
///  - kBwdist: cost k^2. 8 bits reach 15 cells, 16 bits 255.
///  - kSurface: the squares are 0 for k = 0, else (2k - 1)^2 = 8 T + 1 with the triangular number
///    T = k (k - 1) / 2. A sum over the axes is 8 T + n, where T is the sum of theirs and n = 1, 2
///    or 3 the number of axes with k > 0. The sums 3 T + n come in the same order, so the cost is
///    3 T + 1. 8 bits reach 13 cells, 16 bits 209.
///
/// SquaredHalfCells() takes them back.
///
/// # One line
/// A line f of n values is replaced by  min over s of f(s) + cost(|t - s|)  in two sweeps, one up
/// the line and one down. The sweep upwards visits the sources s from the last to the first; each
/// offers f(s) + cost(1), f(s) + cost(2), ... to the values that follow, *until one does not take
/// the offer* because it is lower already. No later value would take it either: what is there comes
/// from a source s' > s (only those have had their turn), and as the costs are convex, s' stays
/// ahead of s from there on. So the work is the number of offers taken, plus one for each source:
/// little where obstacles have faces, whatever the distances are. The sweep downwards runs on
/// the result of the one upwards, which does no harm: a way up and then down costs more than the
/// direct one.
///
/// # One signed pass
/// Each cell looks for the other kind of cell. Among the sources of a free cell, filled cells count
/// as 0, and the other way round. So a line is split in two, each with its own kind of cells and 0
/// elsewhere, and each is transformed alone: the *free side* and the *filled side*. Most lines have
/// no filled cell, and then no filled side.
///
/// # The grid
/// Along x, the costs are written from tables, run by run of equal cells. TransformSlice does that
/// and goes on along y, TransformPlane along z. Lines along y and z are handled in bundles of
/// neighbours, as many as fill a cache line, whatever the width of the vectors: a *column*. The
/// lines of one column are the lanes of its *rows*.
namespace sidestep::sdf::fast_transform {

inline constexpr std::size_t kColumnBytes = 64;

/// How many lines a column bundles.
template <class Lane>
inline constexpr std::size_t kColumnLanes = kColumnBytes / sizeof(Lane);

/// The sweeps can take n^2 steps for n rows. A column whose rows have taken more offers than this
/// on average is done again by TransformLineByEnvelope, in n log n slower ones. It takes both a
/// line and a void of many hundred cells to get there.
inline constexpr std::size_t kMaxOffersPerRow = 512;

/// The cost of being k cells apart along one axis.
template <class Lane>
constexpr std::uint32_t AxisCost(std::uint32_t k, DistanceConvention convention) {
  constexpr bool wide = sizeof(Lane) == 4;
  if (convention == DistanceConvention::kBwdist) return wide ? 4 * k * k : k * k;
  if (k == 0) return 0;
  return wide ? (2 * k - 1) * (2 * k - 1) : 3 * (k * (k - 1) / 2) + 1;
}

/// The squared distance in half cells that a sum of costs stands for; `sum` > 0.
template <class Lane>
constexpr std::uint32_t SquaredHalfCells(std::uint32_t sum, DistanceConvention convention) {
  if (sizeof(Lane) == 4) return sum;
  if (convention == DistanceConvention::kBwdist) return 4 * sum;
  return sum + 5 * ((sum - 1) / 3);
}

/// Costs in the form that the kernels read. None is above `far`.
template <class Lane>
struct CostTables {
  /// Stands for "nothing found yet". Sums of 8 and 16 bits saturate; with 32 bits, twice this fits.
  Lane far = 0;
  /// The costs of 0, 1, ..., each repeated to fill 32 bits.
  const std::uint32_t* repeated = nullptr;
  /// The costs along a run of cells of going to the cell before it: those of 1, 2, ...
  const Lane* rising = nullptr;
  /// And to the cell after it: falling_end[-1] is that of 1, falling_end[-2] that of 2, ... Both
  /// can be read for any run of the grid and kColumnBytes beyond its end.
  const Lane* falling_end = nullptr;
};

/// What the whole transform shares.
template <class Lane>
struct Job {
  std::size_t nx = 0, ny = 0, nz = 0;
  const std::uint8_t* cells = nullptr;  ///< [z][y][x] not 0: filled
  float* distance_m = nullptr;          ///< [z][y][x] the result
  CostTables<Lane> costs;
  DistanceConvention convention = DistanceConvention::kSurface;
  double half_cell_m = 0;
  float max_distance_m = 0;       ///< the result is clamped to +- this
  bool may_saturate = false;      ///< whether final sums must be checked
  bool bypass_cache = false;      ///< write the large arrays by non-temporal stores
  std::size_t num_columns = 0;    ///< ceil(nx / kColumnLanes)
  std::size_t words_per_row = 0;  ///< ceil(nx / 64)

  /// Between the two functions. The first two are not set for free slices.
  Lane* sums = nullptr;         ///< [y][z][column][lane] over x and y
  std::size_t plane_pitch = 0;  ///< of `sums`, from y to y + 1
  std::uint64_t* bits =
      nullptr;  ///< [y][z][word] the cells, lowest bit first; readable one word beyond
  std::uint8_t* slice_is_free = nullptr;  ///< [z] whether it has no filled cell
};

/// What each worker has for itself. Arrays of lanes are aligned to kColumnBytes.
template <class Lane>
struct Scratch {
  std::uint64_t* bits = nullptr;         ///< [y][word]
  std::uint64_t* column_bits = nullptr;  ///< [y or z]
  Lane* row = nullptr;                   ///< [num_columns + 1][lane]
  Lane* free_side = nullptr;             ///< [column][y][lane] or [z][lane]
  Lane* filled_side = nullptr;           ///< the same
  Lane* plane = nullptr;                 ///< [z][column][lane], readable one column beyond
  Lane* column = nullptr;                ///< [y or z][lane]
  std::uint32_t* line = nullptr;         ///< [y or z]
  EnvelopePiece* pieces = nullptr;       ///< [y or z]
};

/// The passes along x and y in slice z.
void TransformSlice(const Job<std::uint8_t>& job, const Scratch<std::uint8_t>& scratch,
                    std::size_t z);
void TransformSlice(const Job<std::uint16_t>& job, const Scratch<std::uint16_t>& scratch,
                    std::size_t z);
void TransformSlice(const Job<std::uint32_t>& job, const Scratch<std::uint32_t>& scratch,
                    std::size_t z);

/// The pass along z in plane y, and its distances. Needs all slices.
/// @return false if a sum saturated: then the lanes are too narrow and the result is of no use.
bool TransformPlane(const Job<std::uint8_t>& job, const Scratch<std::uint8_t>& scratch,
                    std::size_t y);
bool TransformPlane(const Job<std::uint16_t>& job, const Scratch<std::uint16_t>& scratch,
                    std::size_t y);
bool TransformPlane(const Job<std::uint32_t>& job, const Scratch<std::uint32_t>& scratch,
                    std::size_t y);

}  // namespace sidestep::sdf::fast_transform
