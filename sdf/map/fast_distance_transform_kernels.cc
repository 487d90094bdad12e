#include "sdf/map/fast_distance_transform_kernels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

// Highway compiles what follows once for each instruction set, each time in a namespace of its own,
// and picks one at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sdf/map/fast_distance_transform_kernels.cc"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sidestep::fast_transform {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class Lane>
using Vectors = hn::CappedTag<Lane, kColumnLanes<Lane>>;

// The cells of one column in one of its rows, as bits, lowest first.
template <class Lane>
std::uint64_t ColumnBits(const std::uint64_t* row_bits, std::size_t column) {
  constexpr std::size_t kLanes = kColumnLanes<Lane>;
  return row_bits[column * kLanes / 64] >> (column * kLanes % 64) &
         (~std::uint64_t{0} >> (64 - kLanes));
}

template <class D>
hn::Mask<D> MaskOf(D d, std::uint64_t bits) {
  std::uint8_t bytes[8];
  std::memcpy(bytes, &bits, sizeof(bytes));
  return hn::LoadMaskBits(d, bytes);
}

template <class D, class V = hn::Vec<D>>
V SaturatedSum(D, V a, V b) {
  if constexpr (sizeof(hn::TFromD<D>) == 4) {
    return hn::Add(a, b);  // `far` leaves room for the sum of two.
  } else {
    return hn::SaturatedAdd(a, b);
  }
}

// Offers source + cost(1), source + cost(2), ... to the rows  first, first + step, ...  of a
// column, `count` at the most, until none of its lanes takes one.
template <class Lane, std::ptrdiff_t step>
void Offer(const Lane* source, std::size_t count, const std::uint32_t* costs) {
  const Vectors<Lane> d;
  const hn::Repartition<std::uint32_t, decltype(d)> d32;
  constexpr std::size_t kPerVector = hn::MaxLanes(Vectors<Lane>());
  constexpr std::size_t kVectors = kColumnLanes<Lane> / kPerVector;
  hn::Vec<decltype(d)> value[kVectors];
  for (std::size_t v = 0; v < kVectors; ++v) value[v] = hn::Load(d, source + v * kPerVector);
  Lane* row = const_cast<Lane*>(source);
  for (std::size_t k = 1; k <= count; ++k) {
    row += step * static_cast<std::ptrdiff_t>(kColumnLanes<Lane>);
    const auto cost = hn::BitCast(d, hn::Set(d32, costs[k]));
    bool taken = false;
    for (std::size_t v = 0; v < kVectors; ++v) {
      const auto old = hn::Load(d, row + v * kPerVector);
      const auto lower = hn::Min(old, SaturatedSum(d, value[v], cost));
      hn::Store(lower, d, row + v * kPerVector);
      taken |= !hn::AllTrue(d, hn::Eq(lower, old));
    }
    if (!taken) break;
  }
}

template <class Lane>
void TransformLines(Lane* column, std::size_t rows, const std::uint32_t* costs) {
  constexpr std::size_t kLanes = kColumnLanes<Lane>;
  for (std::size_t s = rows; s-- > 0;) Offer<Lane, 1>(column + s * kLanes, rows - 1 - s, costs);
  for (std::size_t s = 0; s < rows; ++s) Offer<Lane, -1>(column + s * kLanes, s, costs);
}

// The filled side of a column: it is zero but for stretches of rows, each transformed alone, with
// the zero rows at its ends.
template <class Lane, class HasFilled>
void TransformFilledLines(Lane* column, std::size_t rows, const std::uint32_t* costs,
                          const HasFilled& has_filled) {
  constexpr std::size_t kLanes = kColumnLanes<Lane>;
  for (std::size_t r = 0; r < rows; ++r) {
    if (!has_filled(r)) continue;
    std::size_t end = r + 1;
    while (end < rows && has_filled(end)) ++end;
    const std::size_t begin = r > 0 ? r - 1 : r;
    if (r > 0) std::fill_n(column + begin * kLanes, kLanes, Lane{0});
    if (end < rows) std::fill_n(column + end++ * kLanes, kLanes, Lane{0});
    TransformLines(column + begin * kLanes, end - begin, costs);
    r = end - 1;
  }
}

// Splits a vector row of sums into the two sides; see the header.
template <class Lane>
void Split(const Lane* sums, std::uint64_t bits, Lane* free_side, Lane* filled_side) {
  const Vectors<Lane> d;
  constexpr std::size_t kPerVector = hn::MaxLanes(Vectors<Lane>());
  for (std::size_t i = 0; i < kColumnLanes<Lane>; i += kPerVector) {
    const auto value = hn::LoadU(d, sums + i);
    if (bits == 0) {
      hn::Store(value, d, free_side + i);
    } else {
      const auto filled = MaskOf(d, bits >> i);
      hn::Store(hn::IfThenZeroElse(filled, value), d, free_side + i);
      hn::Store(hn::IfThenElseZero(filled, value), d, filled_side + i);
    }
  }
}

template <class Lane>
hn::Vec<Vectors<Lane>> Merged(const Lane* free_side, const Lane* filled_side, std::uint64_t bits,
                              std::size_t i) {
  const Vectors<Lane> d;
  const auto value = hn::Load(d, free_side + i);
  if (bits == 0) return value;
  return hn::IfThenElse(MaskOf(d, bits >> i), hn::Load(d, filled_side + i), value);
}

// Packs a row of cells into bits. Returns whether any is set.
inline bool PackRow(const std::uint8_t* cells, std::size_t nx, std::uint64_t* bits) {
  const hn::CappedTag<std::uint8_t, 64> d;
  const std::size_t lanes = hn::Lanes(d);
  std::uint64_t any = 0;
  std::size_t i = 0;
  for (; i + 64 <= nx; i += 64) {
    std::uint64_t word = 0;
    for (std::size_t j = 0; j < 64; j += lanes) {
      std::uint8_t bytes[8] = {};
      hn::StoreMaskBits(d, hn::Ne(hn::LoadU(d, cells + i + j), hn::Zero(d)), bytes);
      std::uint64_t part;
      std::memcpy(&part, bytes, sizeof(part));
      word |= part << j;
    }
    bits[i / 64] = word;
    any |= word;
  }
  if (i < nx) {
    std::uint64_t word = 0;
    if (i + lanes <= nx) {
    }
    for (std::size_t j = i; j < nx; ++j) word |= std::uint64_t{cells[j] != 0} << (j - i);
    bits[i / 64] = word;
    any |= word;
  }
  return any != 0;
}

template <class Lane>
void WriteRun(const CostTables<Lane>& costs, bool from_before, bool from_after, std::size_t length,
              Lane* out) {
  const Vectors<Lane> d;
  const std::size_t lanes = hn::Lanes(d);
  const Lane* falling = costs.falling_end - length;
  if (from_before && from_after) {
    for (std::size_t i = 0; i < length; i += lanes)
      hn::StoreU(hn::Min(hn::LoadU(d, costs.rising + i), hn::LoadU(d, falling + i)), d, out + i);
  } else if (from_before || from_after) {
    const Lane* from = from_before ? costs.rising : falling;
    for (std::size_t i = 0; i < length; i += lanes) hn::StoreU(hn::LoadU(d, from + i), d, out + i);
  } else {
    for (std::size_t i = 0; i < length; i += lanes) hn::StoreU(hn::Set(d, costs.far), d, out + i);
  }
}

// The pass along x of one row.
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
  const Vectors<Lane> d;
  for (std::size_t i = 0; i < kColumnLanes<Lane>; i += hn::Lanes(d))
    hn::StoreU(hn::Set(d, job.costs.far), d, row + job.nx + i);
}

template <class Lane>
void Slice(const Job<Lane>& job, const Scratch<Lane>& scratch, std::size_t z) {
  constexpr std::size_t kLanes = kColumnLanes<Lane>;
  constexpr std::size_t kPerVector = hn::MaxLanes(Vectors<Lane>());
  const Vectors<Lane> d;
  const std::size_t words = job.words_per_row;
  const std::size_t pitch = std::max(job.ny, job.nz) * kLanes;  // from column to column
  bool any = false;
  const std::uint64_t* last = nullptr;
  for (std::size_t y = 0; y < job.ny; ++y) {
    std::uint64_t* bits = scratch.bits + y * words;
    const std::size_t offset = y * kLanes;
    if (!PackRow(job.cells + (z * job.ny + y) * job.nx, job.nx, bits)) {
      for (std::size_t c = 0; c < job.num_columns; ++c)
        for (std::size_t i = 0; i < kLanes; i += kPerVector)
          hn::Store(hn::Set(d, job.costs.far), d, scratch.free_side + c * pitch + offset + i);
      continue;
    }
    any = true;
    if (last == nullptr || !std::equal(bits, bits + words, last))
      TransformRow(job, bits, scratch.row);
    last = bits;
    for (std::size_t c = 0; c < job.num_columns; ++c)
      Split(scratch.row + c * kLanes, ColumnBits<Lane>(bits, c),
            scratch.free_side + c * pitch + offset, scratch.filled_side + c * pitch + offset);
  }
  job.slice_is_free[z] = !any;
  if (!any) return;
  for (std::size_t c = 0; c < job.num_columns; ++c) {
    const auto has_filled = [&](std::size_t y) {
      return ColumnBits<Lane>(scratch.bits + y * words, c) != 0;
    };
    TransformLines(scratch.free_side + c * pitch, job.ny, job.costs.repeated);
    TransformFilledLines(scratch.filled_side + c * pitch, job.ny, job.costs.repeated, has_filled);
  }
  for (std::size_t y = 0; y < job.ny; ++y) {
    Lane* out = job.sums + y * job.plane_pitch + z * job.num_columns * kLanes;
    const std::uint64_t* bits = scratch.bits + y * words;
    for (std::size_t c = 0; c < job.num_columns; ++c) {
      const std::uint64_t column_bits = ColumnBits<Lane>(bits, c);
      const std::size_t from = c * pitch + y * kLanes;
      for (std::size_t i = 0; i < kLanes; i += kPerVector)
        hn::Store(Merged(scratch.free_side + from, scratch.filled_side + from, column_bits, i), d,
                  out + c * kLanes + i);
    }
    std::copy_n(bits, words, job.bits + (y * job.nz + z) * words);
  }
}

using FloatTag = hn::Rebind<float, hn::ScalableTag<double>>;

// distances of `Lanes(df)` cells from their sums.
template <class Lane>
class Distances {
 public:
  explicit Distances(const Job<Lane>& job)
      : surface_(job.convention == DistanceConvention::kSurface),
        half_cell_m_(hn::Set(dd_, job.half_cell_m)),
        max_(hn::Set(df_, job.max_distance_m)) {}
  hn::Vec<FloatTag> operator()(const Lane* sums, const std::uint8_t* cells) const {
    const hn::Rebind<Lane, decltype(d32_)> d_lane;
    const hn::Rebind<std::uint8_t, decltype(d32_)> d8;
    hn::Vec<decltype(d32_)> s;
    if constexpr (sizeof(Lane) == 4)
      s = hn::LoadU(d32_, sums);
    else
      s = hn::PromoteTo(d32_, hn::LoadU(d_lane, sums));
    s = surface_ ? hn::Sub(hn::Add(s, s), hn::And(s, hn::Set(d32_, 3))) : hn::ShiftLeft<2>(s);
    const auto half_cells = hn::Sqrt(hn::ConvertTo(df_, hn::BitCast(di_, s)));
    const auto distance =
        hn::Min(hn::DemoteTo(df_, hn::Mul(half_cell_m_, hn::PromoteTo(dd_, half_cells))), max_);
    const auto occ = hn::PromoteTo(d32_, hn::LoadU(d8, cells));
    const auto sign = hn::IfThenElseZero(hn::Ne(occ, hn::Zero(d32_)), hn::Set(d32_, 0x80000000u));
    return hn::Or(distance, hn::BitCast(df_, sign));
  }

 private:
  static constexpr hn::ScalableTag<double> dd_{};
  static constexpr FloatTag df_{};
  static constexpr hn::RebindToUnsigned<FloatTag> d32_{};
  static constexpr hn::RebindToSigned<FloatTag> di_{};
  bool surface_;
  hn::Vec<hn::ScalableTag<double>> half_cell_m_;
  hn::Vec<FloatTag> max_;
};

// Copies a row past the caches, which would be of no use to it: whole cache lines by non-temporal
// stores, the partial ones at its ends, shared with its neighbours, by ordinary ones.
inline void StreamRow(const float* row, std::size_t n, float* out) {
  constexpr std::size_t kLine = 64 / sizeof(float);
  const hn::CappedTag<float, kLine> d;
  const std::size_t misaligned = reinterpret_cast<std::uintptr_t>(out) / sizeof(float) % kLine;
  std::size_t i = std::min(n, (kLine - misaligned) % kLine);
  std::copy_n(row, i, out);
  for (; i + kLine <= n; i += kLine)
    for (std::size_t j = 0; j < kLine; j += hn::Lanes(d))
      hn::Stream(hn::LoadU(d, row + i + j), d, out + i + j);
  std::copy(row + i, row + n, out + i);
}

template <class Lane>
void WriteRow(const Job<Lane>& job, const Distances<Lane>& distances, const Lane* sums,
              const std::uint8_t* cells, float* staging, float* out) {
  const FloatTag df;
  const std::size_t lanes = hn::Lanes(df);
  const std::size_t n = job.nx;
  if (n < lanes) {
    for (std::size_t i = 0; i < n; ++i) {
      const float root = std::sqrt(static_cast<float>(SquaredHalfCells(sums[i], job.convention)));
      const float distance =
          std::min(static_cast<float>(job.half_cell_m * root), job.max_distance_m);
      out[i] = cells[i] != 0 ? -distance : distance;
    }
    return;
  }
  float* row = job.bypass_cache ? staging : out;
  for (std::size_t i = 0; i + lanes <= n; i += lanes)
    hn::StoreU(distances(sums + i, cells + i), df, row + i);
  if (n % lanes != 0)
    hn::StoreU(distances(sums + n - lanes, cells + n - lanes), df, row + n - lanes);
  if (job.bypass_cache) StreamRow(row, n, out);
}

template <class Lane>
bool Plane(const Job<Lane>& job, const Scratch<Lane>& scratch, std::size_t y) {
  constexpr std::size_t kLanes = kColumnLanes<Lane>;
  constexpr std::size_t kPerVector = hn::MaxLanes(Vectors<Lane>());
  const Vectors<Lane> d;
  const std::size_t words = job.words_per_row;
  const std::size_t row_pitch = job.num_columns * kLanes;
  Lane* plane = job.sums + y * job.plane_pitch;
  const std::uint64_t* plane_bits = job.bits + y * job.nz * words;
  for (std::size_t c = 0; c < job.num_columns; ++c) {
    const auto bits_of = [&](std::size_t z) -> std::uint64_t {
      return job.slice_is_free[z] ? 0 : ColumnBits<Lane>(plane_bits + z * words, c);
    };
    const auto has_filled = [&](std::size_t z) { return bits_of(z) != 0; };
    for (std::size_t z = 0; z < job.nz; ++z) {
      if (job.slice_is_free[z]) {
        for (std::size_t i = 0; i < kLanes; i += kPerVector)
          hn::Store(hn::Set(d, job.costs.far), d, scratch.free_side + z * kLanes + i);
      } else {
        Split(plane + z * row_pitch + c * kLanes, bits_of(z), scratch.free_side + z * kLanes,
              scratch.filled_side + z * kLanes);
      }
    }
    TransformLines(scratch.free_side, job.nz, job.costs.repeated);
    TransformFilledLines(scratch.filled_side, job.nz, job.costs.repeated, has_filled);
    const std::size_t valid = std::min(kLanes, job.nx - c * kLanes);
    for (std::size_t i = 0; i < kLanes; i += kPerVector) {
      auto largest = hn::Zero(d);
      for (std::size_t z = 0; z < job.nz; ++z) {
        const auto v =
            Merged(scratch.free_side + z * kLanes, scratch.filled_side + z * kLanes, bits_of(z), i);
        largest = hn::Max(largest, v);
        hn::Store(v, d, plane + z * row_pitch + c * kLanes + i);
      }
      if (job.may_saturate && valid > i) {
        const auto in = hn::FirstN(d, valid - i);
        if (!hn::AllFalse(d, hn::And(in, hn::Eq(largest, hn::Set(d, job.costs.far))))) return false;
      }
    }
  }
  const Distances<Lane> distances(job);
  for (std::size_t z = 0; z < job.nz; ++z) {
    const std::size_t first = (z * job.ny + y) * job.nx;
    WriteRow(job, distances, plane + z * row_pitch, job.cells + first, scratch.distances,
             job.distance_m + first);
  }
  if (job.bypass_cache) hwy::FlushStream();
  return true;
}

void Slice8(const Job<std::uint8_t>& j, const Scratch<std::uint8_t>& s, std::size_t z) {
  Slice(j, s, z);
}
void Slice16(const Job<std::uint16_t>& j, const Scratch<std::uint16_t>& s, std::size_t z) {
  Slice(j, s, z);
}
void Slice32(const Job<std::uint32_t>& j, const Scratch<std::uint32_t>& s, std::size_t z) {
  Slice(j, s, z);
}
bool Plane8(const Job<std::uint8_t>& j, const Scratch<std::uint8_t>& s, std::size_t y) {
  return Plane(j, s, y);
}
bool Plane16(const Job<std::uint16_t>& j, const Scratch<std::uint16_t>& s, std::size_t y) {
  return Plane(j, s, y);
}
bool Plane32(const Job<std::uint32_t>& j, const Scratch<std::uint32_t>& s, std::size_t y) {
  return Plane(j, s, y);
}

}  // namespace HWY_NAMESPACE
}  // namespace sidestep::fast_transform
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sidestep::fast_transform {
HWY_EXPORT(Slice8);
HWY_EXPORT(Slice16);
HWY_EXPORT(Slice32);
HWY_EXPORT(Plane8);
HWY_EXPORT(Plane16);
HWY_EXPORT(Plane32);

void TransformSlice(const Job<std::uint8_t>& job, const Scratch<std::uint8_t>& scratch, int z) {
  HWY_DYNAMIC_DISPATCH(Slice8)(job, scratch, z);
}
void TransformSlice(const Job<std::uint16_t>& job, const Scratch<std::uint16_t>& scratch, int z) {
  HWY_DYNAMIC_DISPATCH(Slice16)(job, scratch, z);
}
void TransformSlice(const Job<std::uint32_t>& job, const Scratch<std::uint32_t>& scratch, int z) {
  HWY_DYNAMIC_DISPATCH(Slice32)(job, scratch, z);
}
bool TransformPlane(const Job<std::uint8_t>& job, const Scratch<std::uint8_t>& scratch, int y) {
  return HWY_DYNAMIC_DISPATCH(Plane8)(job, scratch, y);
}
bool TransformPlane(const Job<std::uint16_t>& job, const Scratch<std::uint16_t>& scratch, int y) {
  return HWY_DYNAMIC_DISPATCH(Plane16)(job, scratch, y);
}
bool TransformPlane(const Job<std::uint32_t>& job, const Scratch<std::uint32_t>& scratch, int y) {
  return HWY_DYNAMIC_DISPATCH(Plane32)(job, scratch, y);
}
}  // namespace sidestep::fast_transform
#endif
