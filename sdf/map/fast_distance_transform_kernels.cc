#include "sidestep/sdf/map/fast_distance_transform_kernels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

// Highway compiles what follows once for each instruction set, each time in a namespace of its own;
// the end of the file picks one of them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sidestep/sdf/map/fast_distance_transform_kernels.cc"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sidestep::sdf::fast_transform {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A row of a column (its lanes at one place along the lines) is kVectors vectors of kPerVector.
template <class Lane>
using VectorTag = hn::CappedTag<Lane, kColumnLanes<Lane>>;
template <class Lane>
constexpr std::size_t kPerVector = hn::MaxLanes(VectorTag<Lane>());
template <class Lane>
constexpr std::size_t kVectors = kColumnLanes<Lane> / kPerVector<Lane>;

// The mask of the lowest bits.
template <class D>
hn::Mask<D> MaskOf(D d, std::uint64_t bits) {
  std::uint8_t bytes[sizeof(bits)];
  std::memcpy(bytes, &bits, sizeof(bits));
  return hn::LoadMaskBits(d, bytes);
}

template <class V>
V AddSaturated(V a, V b) {
  if constexpr (sizeof(hn::TFromV<V>) == 4) {
    return hn::Add(a, b);  // CostTables leave room for it.
  } else {
    return hn::SaturatedAdd(a, b);
  }
}

template <class Lane>
void FillRow(Lane value, Lane* row) {
  const VectorTag<Lane> d;
  for (std::size_t v = 0; v < kVectors<Lane>; ++v) {
    hn::Store(hn::Set(d, value), d, row + v * kPerVector<Lane>);
  }
}

// Fetches the cache lines of an array that will soon be written: rows of different planes lie far
// apart, so the machine does not foresee it.
template <class T>
void Prefetch(const T* begin, const T* end) {
  for (; begin < end; begin += 64 / sizeof(T)) hwy::Prefetch(begin);
}

// --- One column ----------------------------------------------------------------------------------

// Offers source + cost(1), source + cost(2), ... to the `count` rows that follow `source` upwards
// (direction 1) or downwards (-1), until none of a row's lanes takes one. Returns how many rows
// did.
template <int direction, class Lane>
std::size_t Offer(Lane* source, std::size_t count, const std::uint32_t* costs) {
  const VectorTag<Lane> d;
  const hn::Repartition<std::uint32_t, decltype(d)> d32;
  hn::Vec<decltype(d)> value[kVectors<Lane>];
  for (std::size_t v = 0; v < kVectors<Lane>; ++v) {
    value[v] = hn::Load(d, source + v * kPerVector<Lane>);
  }
  Lane* row = source;
  for (std::size_t k = 1; k <= count; ++k) {
    row += direction * static_cast<std::ptrdiff_t>(kColumnLanes<Lane>);
    const auto cost = hn::BitCast(d, hn::Set(d32, costs[k]));
    bool taken = false;
    for (std::size_t v = 0; v < kVectors<Lane>; ++v) {
      const auto old = hn::Load(d, row + v * kPerVector<Lane>);
      const auto lower = hn::Min(old, AddSaturated(value[v], cost));
      hn::Store(lower, d, row + v * kPerVector<Lane>);
      taken |= !hn::AllTrue(d, hn::Eq(lower, old));
    }
    if (!taken) return k - 1;
  }
  return count;
}

// The sweeps upwards and downwards. Gives up, and returns false, when they take too long.
template <class Lane>
bool SweepColumn(Lane* column, std::size_t rows, const std::uint32_t* costs) {
  constexpr std::size_t kLanes = kColumnLanes<Lane>;
  const std::size_t limit = kMaxOffersPerRow * rows;
  std::size_t taken = 0;
  for (std::size_t s = rows; s-- > 0 && taken <= limit;) {
    taken += Offer<1>(column + s * kLanes, rows - 1 - s, costs);
  }
  for (std::size_t s = 0; s < rows && taken <= limit; ++s) {
    taken += Offer<-1>(column + s * kLanes, s, costs);
  }
  return taken <= limit;
}

template <class Lane>
void TransformColumn(const Job<Lane>& job, const Scratch<Lane>& scratch, Lane* column,
                     std::size_t rows) {
  constexpr std::size_t kLanes = kColumnLanes<Lane>;
  // A row takes at most one offer from each other row, so short columns are always in time.
  const bool may_give_up = rows > kMaxOffersPerRow;
  if (may_give_up) std::copy_n(column, rows * kLanes, scratch.column);
  if (SweepColumn(column, rows, job.costs.repeated)) return;
  std::copy_n(scratch.column, rows * kLanes, column);
  const auto cost = [&](std::uint32_t k) { return AxisCost<Lane>(k, job.convention); };
  TransformColumnByEnvelopes(column, rows, kLanes, job.costs.far, cost, scratch.line,
                             scratch.pieces);
}

// The same of the filled side, which is set only in rows with filled cells. Each stretch of such
// rows is transformed alone, with the rows at its ends, where it is 0.
template <class Lane>
void TransformFilledSide(const Job<Lane>& job, const Scratch<Lane>& scratch, Lane* column,
                         std::size_t rows) {
  constexpr std::size_t kLanes = kColumnLanes<Lane>;
  for (std::size_t r = 0; r < rows; ++r) {
    if (scratch.column_bits[r] == 0) continue;
    std::size_t begin = r;
    while (r < rows && scratch.column_bits[r] != 0) ++r;
    if (begin > 0) FillRow(Lane{0}, column + --begin * kLanes);
    if (r < rows) FillRow(Lane{0}, column + r * kLanes);
    TransformColumn(job, scratch, column + begin * kLanes, std::min(r + 1, rows) - begin);
  }
}

// The two sides of a row of sums. The filled side is only set if any of its bits is.
template <class Lane>
void Split(const Lane* sums, std::uint64_t bits, Lane* free_side, Lane* filled_side) {
  const VectorTag<Lane> d;
  for (std::size_t i = 0; i < kColumnLanes<Lane>; i += kPerVector<Lane>) {
    const auto value = hn::Load(d, sums + i);
    if (bits == 0) {
      hn::Store(value, d, free_side + i);
    } else {
      const auto filled = MaskOf(d, bits >> i);
      hn::Store(hn::IfThenZeroElse(filled, value), d, free_side + i);
      hn::Store(hn::IfThenElseZero(filled, value), d, filled_side + i);
    }
  }
}

// The opposite of Split, one vector of it.
template <class Lane>
hn::Vec<VectorTag<Lane>> Merge(const Lane* free_side, const Lane* filled_side, std::uint64_t bits,
                               std::size_t i) {
  const VectorTag<Lane> d;
  const auto value = hn::Load(d, free_side + i);
  if (bits == 0) return value;
  return hn::IfThenElse(MaskOf(d, bits >> i), hn::Load(d, filled_side + i), value);
}

// --- Along x -------------------------------------------------------------------------------------

// 64 cells as bits.
inline std::uint64_t Pack64(const std::uint8_t* cells) {
  const hn::CappedTag<std::uint8_t, 64> d;
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < 64; i += hn::Lanes(d)) {
    std::uint8_t bytes[sizeof(word)] = {};
    hn::StoreMaskBits(d, hn::Ne(hn::LoadU(d, cells + i), hn::Zero(d)), bytes);
    std::uint64_t part;
    std::memcpy(&part, bytes, sizeof(part));
    word |= part << i;
  }
  return word;
}

// A row of cells as bits, 0 beyond its end. Returns whether any is set.
inline bool PackRow(const std::uint8_t* cells, std::size_t nx, std::uint64_t* bits) {
  std::uint64_t any = 0;
  const std::size_t whole = nx / 64;
  for (std::size_t w = 0; w < whole; ++w) {
    bits[w] = Pack64(cells + w * 64);
    any |= bits[w];
  }
  const std::size_t rest = nx % 64;
  if (rest > 0) {
    if (whole > 0) {
      bits[whole] = Pack64(cells + nx - 64) >> (64 - rest);
    } else {
      std::uint8_t padded[64] = {};
      std::memcpy(padded, cells, rest);
      bits[0] = Pack64(padded);
    }
    any |= bits[whole];
  }
  return any != 0;
}

// Writes the costs of a run of equal cells: to the nearer of the cell before it and the cell after
// it, where there are such. May write up to a vector too much.
template <class Lane>
void WriteRun(const CostTables<Lane>& costs, bool has_before, bool has_after, std::size_t length,
              Lane* run) {
  const VectorTag<Lane> d;
  const Lane* rising = costs.rising;
  const Lane* falling = costs.falling_end - length;
  for (std::size_t i = 0; i < length; i += kPerVector<Lane>) {
    auto cost = hn::Set(d, costs.far);
    if (has_before) cost = hn::LoadU(d, rising + i);
    if (has_after) cost = hn::Min(cost, hn::LoadU(d, falling + i));
    hn::StoreU(cost, d, run + i);
  }
}

// The pass along x of one row; beyond its end the sums are `far`.
template <class Lane>
void TransformRow(const Job<Lane>& job, const std::uint64_t* bits, Lane* row) {
  std::size_t begin = 0;
  std::uint64_t before = bits[0] & 1;
  for (std::size_t w = 0; w < job.words_per_row; ++w) {
    std::uint64_t changes = bits[w] ^ (bits[w] << 1 | before);
    before = bits[w] >> 63;
    for (; changes != 0; changes &= changes - 1) {
      const std::size_t end = w * 64 + static_cast<std::size_t>(std::countr_zero(changes));
      if (end >= job.nx) break;
      WriteRun(job.costs, begin > 0, true, end - begin, row + begin);
      begin = end;
    }
  }
  WriteRun(job.costs, begin > 0, false, job.nx - begin, row + begin);
  const VectorTag<Lane> d;
  for (std::size_t i = 0; i < kColumnLanes<Lane>; i += kPerVector<Lane>) {
    hn::StoreU(hn::Set(d, job.costs.far), d, row + job.nx + i);
  }
}

// --- A slice: x and y ----------------------------------------------------------------------------

inline bool AnySet(const std::uint64_t* bits, std::size_t words) {
  return std::any_of(bits, bits + words, [](std::uint64_t word) { return word != 0; });
}

// The bits of one row of a column.
template <class Lane>
std::uint64_t ColumnBits(const std::uint64_t* bits, std::size_t column) {
  constexpr std::size_t kLanes = kColumnLanes<Lane>;
  const std::size_t first = column * kLanes;
  return bits[first / 64] >> first % 64 & ~std::uint64_t{0} >> (64 - kLanes);
}

// The address of the sums of row y of slice z.
template <class Lane>
Lane* SumsOf(const Job<Lane>& job, std::size_t y, std::size_t z) {
  return job.sums + y * job.plane_pitch + z * job.num_columns * kColumnLanes<Lane>;
}

// The cells of a slice as bits. Returns whether any is set.
template <class Lane>
bool PackSlice(const Job<Lane>& job, std::size_t z, std::uint64_t* bits) {
  const std::uint8_t* cells = job.cells + z * job.ny * job.nx;
  bool any = false;
  for (std::size_t y = 0; y < job.ny; ++y) {
    any |= PackRow(cells + y * job.nx, job.nx, bits + y * job.words_per_row);
  }
  return any;
}

// The pass along x of a slice, into the two sides of its columns.
template <class Lane>
void TransformRows(const Job<Lane>& job, const Scratch<Lane>& scratch, std::size_t z) {
  constexpr std::size_t kLanes = kColumnLanes<Lane>;
  const std::size_t words = job.words_per_row;
  const std::size_t column_size = job.ny * kLanes;
  const std::uint64_t* transformed = nullptr;  // The bits that scratch.row belongs to.
  for (std::size_t y = 0; y < job.ny; ++y) {
    if (!job.bypass_cache) {
      Prefetch(SumsOf(job, y, z), SumsOf(job, y, z) + job.num_columns * kLanes);
    }
    const std::uint64_t* bits = scratch.bits + y * words;
    Lane* free_side = scratch.free_side + y * kLanes;
    Lane* filled_side = scratch.filled_side + y * kLanes;
    if (!AnySet(bits, words)) {
      for (std::size_t c = 0; c < job.num_columns; ++c) {
        FillRow(job.costs.far, free_side + c * column_size);
      }
      continue;
    }
    if (transformed == nullptr || !std::equal(bits, bits + words, transformed)) {
      TransformRow(job, bits, scratch.row);
      transformed = bits;
    }
    for (std::size_t c = 0; c < job.num_columns; ++c) {
      Split(scratch.row + c * kLanes, ColumnBits<Lane>(bits, c), free_side + c * column_size,
            filled_side + c * column_size);
    }
  }
}

// Puts the two sides of a slice's columns together, row by row.
template <class Lane>
void WriteSums(const Job<Lane>& job, const Scratch<Lane>& scratch, std::size_t z) {
  constexpr std::size_t kLanes = kColumnLanes<Lane>;
  const VectorTag<Lane> d;
  for (std::size_t y = 0; y < job.ny; ++y) {
    const std::uint64_t* bits = scratch.bits + y * job.words_per_row;
    Lane* sums = SumsOf(job, y, z);
    for (std::size_t c = 0; c < job.num_columns; ++c) {
      const std::uint64_t column_bits = ColumnBits<Lane>(bits, c);
      const std::size_t from = (c * job.ny + y) * kLanes;
      for (std::size_t i = 0; i < kLanes; i += kPerVector<Lane>) {
        const auto sum =
            Merge(scratch.free_side + from, scratch.filled_side + from, column_bits, i);
        if (job.bypass_cache) {
          hn::Stream(sum, d, sums + c * kLanes + i);
        } else {
          hn::Store(sum, d, sums + c * kLanes + i);
        }
      }
    }
    std::copy_n(bits, job.words_per_row, job.bits + (y * job.nz + z) * job.words_per_row);
  }
  if (job.bypass_cache) hwy::FlushStream();
}

template <class Lane>
void Slice(const Job<Lane>& job, const Scratch<Lane>& scratch, std::size_t z) {
  job.slice_is_free[z] = !PackSlice(job, z, scratch.bits);
  if (job.slice_is_free[z]) return;
  TransformRows(job, scratch, z);
  const std::size_t column_size = job.ny * kColumnLanes<Lane>;
  for (std::size_t c = 0; c < job.num_columns; ++c) {
    for (std::size_t y = 0; y < job.ny; ++y) {
      scratch.column_bits[y] = ColumnBits<Lane>(scratch.bits + y * job.words_per_row, c);
    }
    TransformColumn(job, scratch, scratch.free_side + c * column_size, job.ny);
    TransformFilledSide(job, scratch, scratch.filled_side + c * column_size, job.ny);
  }
  WriteSums(job, scratch, z);
}

// --- A plane: z and the distances ----------------------------------------------------------------

// As many floats as a vector holds doubles.
using FloatTag = hn::Rebind<float, hn::ScalableTag<double>>;
constexpr std::size_t kFloats = hn::MaxLanes(FloatTag());

// Distances of kFloats cells from their sums.
template <class Lane>
class ToDistance {
 public:
  explicit ToDistance(const Job<Lane>& job)
      : surface_(job.convention == DistanceConvention::kSurface),
        is_clamped_(std::isfinite(job.max_distance_m)),
        far_(hn::Set(d_, job.costs.far)),
        half_cell_m_(hn::Set(dd_, job.half_cell_m)),
        max_distance_m_(hn::Set(df_, job.max_distance_m)) {}

  // The root is rounded to float, then scaled in double: as ComputeSignedDistance does.
  hn::Vec<FloatTag> operator()(const Lane* sums) const {
    if (is_clamped_ && hn::AllTrue(d_, hn::Eq(hn::LoadU(d_, sums), far_))) return max_distance_m_;
    const auto half_cells = hn::Sqrt(hn::ConvertTo(df_, hn::BitCast(di_, Squares(sums))));
    const auto distance_m = hn::Mul(half_cell_m_, hn::PromoteTo(dd_, half_cells));
    return hn::Min(hn::DemoteTo(df_, distance_m), max_distance_m_);
  }

  // Negative where the bit is set.
  hn::Vec<FloatTag> operator()(const Lane* sums, std::uint64_t bits) const {
    const auto distance = (*this)(sums);
    return hn::IfThenElse(MaskOf(df_, bits), hn::Neg(distance), distance);
  }

 private:
  using D32 = hn::RebindToUnsigned<FloatTag>;
  using D16 = hn::Rebind<std::uint16_t, FloatTag>;
  using D8 = hn::Rebind<std::uint8_t, FloatTag>;

  // SquaredHalfCells() of a vector.
  hn::Vec<D32> Squares(const Lane* sums) const {
    if constexpr (sizeof(Lane) == 4) {
      return hn::LoadU(d32_, sums);
    } else {
      const D16 d16;
      hn::Vec<D16> sum;
      if constexpr (sizeof(Lane) == 2) {
        sum = hn::LoadU(d16, sums);
      } else {
        sum = hn::PromoteTo(d16, hn::LoadU(D8(), sums));
      }
      const auto wide = hn::PromoteTo(d32_, sum);
      if (!surface_) return hn::ShiftLeft<2>(wide);
      // n * 0xaaab >> 17 is n / 3 for all n of 16 bits.
      const auto n = hn::Sub(sum, hn::Set(d16, 1));
      const auto third = hn::ShiftRight<1>(hn::MulHigh(n, hn::Set(d16, 0xaaab)));
      const auto t = hn::PromoteTo(d32_, third);
      return hn::Add(wide, hn::Add(t, hn::ShiftLeft<2>(t)));
    }
  }

  static constexpr hn::Rebind<Lane, FloatTag> d_{};
  static constexpr FloatTag df_{};
  static constexpr hn::ScalableTag<double> dd_{};
  static constexpr D32 d32_{};
  static constexpr hn::RebindToSigned<FloatTag> di_{};
  bool surface_;
  bool is_clamped_;
  hn::Vec<hn::Rebind<Lane, FloatTag>> far_;
  hn::Vec<hn::ScalableTag<double>> half_cell_m_;
  hn::Vec<FloatTag> max_distance_m_;
};

// The bits from bit i of a row on; at least 57 of them.
inline std::uint64_t BitsFrom(const std::uint64_t* bits, std::size_t i) {
  std::uint64_t word;
  std::memcpy(&word, reinterpret_cast<const std::uint8_t*>(bits) + i / 8, sizeof(word));
  return word >> i % 8;
}

// Writes the distances of a row; `bits` is null if none of its cells is filled. All but the ends of
// the row are written in whole cache lines, which the ends share with other rows.
template <class Lane>
void WriteDistances(const Job<Lane>& job, const ToDistance<Lane>& to_distance, const Lane* sums,
                    const std::uint64_t* bits, float* out) {
  constexpr std::size_t kLine = 64 / sizeof(float);
  const FloatTag df;
  const auto distances = [&](std::size_t i) {
    return bits == nullptr ? to_distance(sums + i) : to_distance(sums + i, BitsFrom(bits, i));
  };
  const auto write_part = [&](std::size_t i, std::size_t end) {
    for (; i < end; i += kFloats) {
      float part[kFloats];
      hn::StoreU(distances(i), df, part);
      std::copy_n(part, std::min(kFloats, end - i), out + i);
    }
  };
  const std::size_t misaligned = reinterpret_cast<std::uintptr_t>(out) / sizeof(float) % kLine;
  const std::size_t begin = std::min(job.nx, (kLine - misaligned) % kLine);
  const std::size_t end = begin + (job.nx - begin) / kLine * kLine;
  write_part(0, begin);
  // Half of a vector of 128 bits can't be streamed.
  if (job.bypass_cache && kFloats * sizeof(float) >= 16) {
    for (std::size_t i = begin; i < end; i += kFloats) hn::Stream(distances(i), df, out + i);
  } else {
    for (std::size_t i = begin; i < end; i += kFloats) hn::Store(distances(i), df, out + i);
  }
  write_part(end, job.nx);
}

// Column c of plane y before the pass along z, split in its two sides.
template <class Lane>
void ReadColumn(const Job<Lane>& job, const Scratch<Lane>& scratch, std::size_t y, std::size_t c) {
  constexpr std::size_t kLanes = kColumnLanes<Lane>;
  const std::uint64_t* bits = job.bits + y * job.nz * job.words_per_row;
  for (std::size_t z = 0; z < job.nz; ++z) {
    if (!job.bypass_cache) {
      const float* out = job.distance_m + (z * job.ny + y) * job.nx;
      Prefetch(out + c * kLanes, out + std::min((c + 1) * kLanes, job.nx));
    }
    if (job.slice_is_free[z]) {
      scratch.column_bits[z] = 0;
      FillRow(job.costs.far, scratch.free_side + z * kLanes);
    } else {
      scratch.column_bits[z] = ColumnBits<Lane>(bits + z * job.words_per_row, c);
      Split(SumsOf(job, y, z) + c * kLanes, scratch.column_bits[z], scratch.free_side + z * kLanes,
            scratch.filled_side + z * kLanes);
    }
  }
}

// Puts its two sides together in scratch.plane. Returns whether a sum saturated.
template <class Lane>
bool WriteColumn(const Job<Lane>& job, const Scratch<Lane>& scratch, std::size_t c) {
  constexpr std::size_t kLanes = kColumnLanes<Lane>;
  const VectorTag<Lane> d;
  for (std::size_t i = 0; i < kLanes; i += kPerVector<Lane>) {
    auto largest = hn::Zero(d);
    for (std::size_t z = 0; z < job.nz; ++z) {
      const auto sum = Merge(scratch.free_side + z * kLanes, scratch.filled_side + z * kLanes,
                             scratch.column_bits[z], i);
      hn::Store(sum, d, scratch.plane + (z * job.num_columns + c) * kLanes + i);
      largest = hn::Max(largest, sum);
    }
    const std::size_t x = c * kLanes + i;
    if (job.may_saturate && x < job.nx) {
      const auto is_far = hn::Eq(largest, hn::Set(d, job.costs.far));
      if (!hn::AllFalse(d, hn::And(is_far, hn::FirstN(d, job.nx - x)))) return true;
    }
  }
  return false;
}

template <class Lane>
bool Plane(const Job<Lane>& job, const Scratch<Lane>& scratch, std::size_t y) {
  for (std::size_t c = 0; c < job.num_columns; ++c) {
    ReadColumn(job, scratch, y, c);
    TransformColumn(job, scratch, scratch.free_side, job.nz);
    TransformFilledSide(job, scratch, scratch.filled_side, job.nz);
    if (WriteColumn(job, scratch, c)) return false;
  }
  const ToDistance<Lane> to_distance(job);
  const std::size_t row_pitch = job.num_columns * kColumnLanes<Lane>;
  for (std::size_t z = 0; z < job.nz; ++z) {
    const std::uint64_t* bits = job.bits + (y * job.nz + z) * job.words_per_row;
    const bool any_filled = !job.slice_is_free[z] && AnySet(bits, job.words_per_row);
    WriteDistances(job, to_distance, scratch.plane + z * row_pitch, any_filled ? bits : nullptr,
                   job.distance_m + (z * job.ny + y) * job.nx);
  }
  if (job.bypass_cache) hwy::FlushStream();
  return true;
}

void Slice8(const Job<std::uint8_t>& job, const Scratch<std::uint8_t>& scratch, std::size_t z) {
  Slice(job, scratch, z);
}
void Slice16(const Job<std::uint16_t>& job, const Scratch<std::uint16_t>& scratch, std::size_t z) {
  Slice(job, scratch, z);
}
void Slice32(const Job<std::uint32_t>& job, const Scratch<std::uint32_t>& scratch, std::size_t z) {
  Slice(job, scratch, z);
}
bool Plane8(const Job<std::uint8_t>& job, const Scratch<std::uint8_t>& scratch, std::size_t y) {
  return Plane(job, scratch, y);
}
bool Plane16(const Job<std::uint16_t>& job, const Scratch<std::uint16_t>& scratch, std::size_t y) {
  return Plane(job, scratch, y);
}
bool Plane32(const Job<std::uint32_t>& job, const Scratch<std::uint32_t>& scratch, std::size_t y) {
  return Plane(job, scratch, y);
}

}  // namespace HWY_NAMESPACE
}  // namespace sidestep::sdf::fast_transform
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sidestep::sdf::fast_transform {

HWY_EXPORT(Slice8);
HWY_EXPORT(Slice16);
HWY_EXPORT(Slice32);
HWY_EXPORT(Plane8);
HWY_EXPORT(Plane16);
HWY_EXPORT(Plane32);

void TransformSlice(const Job<std::uint8_t>& job, const Scratch<std::uint8_t>& scratch,
                    std::size_t z) {
  HWY_DYNAMIC_DISPATCH(Slice8)(job, scratch, z);
}
void TransformSlice(const Job<std::uint16_t>& job, const Scratch<std::uint16_t>& scratch,
                    std::size_t z) {
  HWY_DYNAMIC_DISPATCH(Slice16)(job, scratch, z);
}
void TransformSlice(const Job<std::uint32_t>& job, const Scratch<std::uint32_t>& scratch,
                    std::size_t z) {
  HWY_DYNAMIC_DISPATCH(Slice32)(job, scratch, z);
}
bool TransformPlane(const Job<std::uint8_t>& job, const Scratch<std::uint8_t>& scratch,
                    std::size_t y) {
  return HWY_DYNAMIC_DISPATCH(Plane8)(job, scratch, y);
}
bool TransformPlane(const Job<std::uint16_t>& job, const Scratch<std::uint16_t>& scratch,
                    std::size_t y) {
  return HWY_DYNAMIC_DISPATCH(Plane16)(job, scratch, y);
}
bool TransformPlane(const Job<std::uint32_t>& job, const Scratch<std::uint32_t>& scratch,
                    std::size_t y) {
  return HWY_DYNAMIC_DISPATCH(Plane32)(job, scratch, y);
}

}  // namespace sidestep::sdf::fast_transform
#endif  // HWY_ONCE
