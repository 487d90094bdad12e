#include "sidestep/sdf/field_kernels.h"

#include <cstring>
#include <limits>

// Highway compiles what follows once for each instruction set, each time in a namespace of its own;
// the end of the file picks one of them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sidestep/sdf/field_kernels.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sidestep::sdf::field_kernels {
namespace HWY_NAMESPACE {
namespace {  // position-independent code inlines nothing that others could replace
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;
using D32 = hn::Rebind<std::int32_t, D>;
using D64 = hn::Rebind<std::int64_t, D>;
constexpr std::size_t kLanes = hn::MaxLanes(D());
static_assert(Block::kVector % kLanes == 0);

struct Point {
  V x, y, z;
};

// Two neighbouring values for each lane.
struct Pair {
  V lower, upper;
};

Pair LoadPairs(const float* values, hn::Vec<D32> index) {
  const D d;
#if HWY_TARGET <= HWY_AVX2  // Those have gathers.
  const hn::Rebind<std::uint64_t, D> du64;
  const hn::Rebind<std::uint32_t, D> du32;
  const hn::Rebind<float, D> df32;
  const auto offset = hn::ShiftLeft<2>(hn::PromoteTo(D64(), index));
  const auto pairs = hn::GatherOffset(du64, reinterpret_cast<const std::uint64_t*>(values), offset);
  const auto to_double = [&](auto bits) {
    return hn::PromoteTo(d, hn::BitCast(df32, hn::TruncateTo(du32, bits)));
  };
  return {to_double(pairs), to_double(hn::ShiftRight<32>(pairs))};
#else
  HWY_ALIGN std::int32_t at[kLanes];
  HWY_ALIGN double lower[kLanes], upper[kLanes];
  hn::Store(index, D32(), at);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    lower[lane] = values[at[lane]];
    upper[lane] = values[at[lane] + 1];
  }
  return {hn::Load(d, lower), hn::Load(d, upper)};
#endif
}

M IsCovered(const Grid& grid, const Point& p) {
  const D d;
  const auto between = [&](V value, std::size_t axis) {
    return hn::And(hn::Ge(value, hn::Set(d, grid.first_m[axis])),
                   hn::Le(value, hn::Set(d, grid.last_m[axis])));
  };
  return hn::And(between(p.x, 0), hn::And(between(p.y, 1), between(p.z, 2)));
}

// SdfGrid::Interpolate. Lanes that are not covered are taken for the first corner.
template <bool kWithGradient>
V Interpolate(const Grid& grid, const Point& p, M covered, Point& gradient) {
  const D d;
  const D32 d32;
  const V cells_per_m = hn::Set(d, grid.cells_per_m);
  const V one = hn::Set(d, 1.0);
  const auto split = [&](V value, std::size_t axis, V& fraction) {
    const V from_first = hn::Sub(value, hn::Set(d, grid.first_m[axis]));
    const V u = hn::IfThenElseZero(covered, hn::Mul(from_first, cells_per_m));
    const auto lower = hn::Min(hn::DemoteTo(d32, u), hn::Set(d32, grid.last_lower[axis]));
    fraction = hn::Min(hn::Sub(u, hn::PromoteTo(d, lower)), one);
    return lower;
  };
  V fx, fy, fz;
  const auto i = split(p.x, 0, fx);
  const auto j = split(p.y, 1, fy);
  const auto k = split(p.z, 2, fz);
  const auto index = hn::Add(
      i, hn::Add(hn::Mul(j, hn::Set(d32, grid.stride_y)), hn::Mul(k, hn::Set(d32, grid.stride_z))));
  const Pair d00 = LoadPairs(grid.distance_m, index);
  const Pair d10 = LoadPairs(grid.distance_m + grid.stride_y, index);
  const Pair d01 = LoadPairs(grid.distance_m + grid.stride_z, index);
  const Pair d11 = LoadPairs(grid.distance_m + grid.stride_z + grid.stride_y, index);

  const auto between = [](V low, V fraction, V step) {
    return hn::Add(low, hn::Mul(fraction, step));
  };
  const V dx00 = hn::Sub(d00.upper, d00.lower), dx10 = hn::Sub(d10.upper, d10.lower);
  const V dx01 = hn::Sub(d01.upper, d01.lower), dx11 = hn::Sub(d11.upper, d11.lower);
  const V e00 = between(d00.lower, fx, dx00), e10 = between(d10.lower, fx, dx10);
  const V e01 = between(d01.lower, fx, dx01), e11 = between(d11.lower, fx, dx11);
  const V dy0 = hn::Sub(e10, e00), dy1 = hn::Sub(e11, e01);
  const V e0 = between(e00, fy, dy0), e1 = between(e01, fy, dy1);
  const V dz = hn::Sub(e1, e0);
  if constexpr (kWithGradient) {
    const V dx0 = between(dx00, fy, hn::Sub(dx10, dx00)),
            dx1 = between(dx01, fy, hn::Sub(dx11, dx01));
    gradient.x = hn::Mul(between(dx0, fz, hn::Sub(dx1, dx0)), cells_per_m);
    gradient.y = hn::Mul(between(dy0, fz, hn::Sub(dy1, dy0)), cells_per_m);
    gradient.z = hn::Mul(dz, cells_per_m);
  }
  return between(e0, fz, dz);
}

Point LoadPoint(const double* x, const double* y, const double* z, std::size_t n) {
  const D d;
  return {hn::Load(d, x + n), hn::Load(d, y + n), hn::Load(d, z + n)};
}

template <bool kWithGradients>
int SampleStatic(const Grid& grid, double max_distance_m, Block& block) {
  const D d;
  const V clamp = hn::Set(d, max_distance_m);
  int num_outside = 0;
  for (std::size_t n = 0; n < block.count; n += kLanes) {
    const Point p = LoadPoint(block.x, block.y, block.z, n);
    const M covered = IsCovered(grid, p);
    Point gradient;
    const V distance = Interpolate<kWithGradients>(grid, p, covered, gradient);
    const M valid = hn::And(covered, hn::Lt(distance, clamp));
    hn::Store(hn::IfThenElse(valid, distance, clamp), d, block.distance_m + n);
    if constexpr (kWithGradients) {
      hn::Store(hn::IfThenElseZero(valid, gradient.x), d, block.gradient_x + n);
      hn::Store(hn::IfThenElseZero(valid, gradient.y), d, block.gradient_y + n);
      hn::Store(hn::IfThenElseZero(valid, gradient.z), d, block.gradient_z + n);
    }
    const M is_point = hn::FirstN(d, block.count - n);
    num_outside += static_cast<int>(hn::CountTrue(d, hn::AndNot(covered, is_point)));
  }
  return num_outside;
}

int SampleStaticBlock(const Grid& grid, double max_distance_m, Block& block) {
  return block.with_gradients ? SampleStatic<true>(grid, max_distance_m, block)
                              : SampleStatic<false>(grid, max_distance_m, block);
}

// (a0 x + a1 y) + a2 z, as PlacedComposite has it.
V Dot(double a0, double a1, double a2, const Point& p) {
  const D d;
  return hn::Add(hn::Add(hn::Mul(hn::Set(d, a0), p.x), hn::Mul(hn::Set(d, a1), p.y)),
                 hn::Mul(hn::Set(d, a2), p.z));
}

template <bool kWithGradients>
void Lower(const Placed& object, Block& block) {
  const D d;
  const std::array<double, 9>& R = object.R_WO;
  for (std::size_t n = 0; n < block.count; n += kLanes) {
    const Point p_W = LoadPoint(block.x, block.y, block.z, n);
    const Point p_OQ_W = {hn::Sub(p_W.x, hn::Set(d, object.p_WO[0])),
                          hn::Sub(p_W.y, hn::Set(d, object.p_WO[1])),
                          hn::Sub(p_W.z, hn::Set(d, object.p_WO[2]))};
    const Point p_O = {Dot(R[0], R[3], R[6], p_OQ_W), Dot(R[1], R[4], R[7], p_OQ_W),
                       Dot(R[2], R[5], R[8], p_OQ_W)};
    const M covered = IsCovered(object.grid_O, p_O);
    if (hn::AllFalse(d, covered)) continue;
    Point gradient_O;
    const V distance = hn::Sub(Interpolate<kWithGradients>(object.grid_O, p_O, covered, gradient_O),
                               hn::Set(d, object.growth_m));
    const V present = hn::Load(d, block.distance_m + n);
    const M nearer = hn::And(covered, hn::Lt(distance, present));
    if (hn::AllFalse(d, nearer)) continue;
    const auto replace = [&](V value, double* in_block) {
      hn::Store(hn::IfThenElse(nearer, value, hn::Load(d, in_block + n)), d, in_block + n);
    };
    replace(distance, block.distance_m);
    if constexpr (kWithGradients) {
      replace(Dot(R[0], R[1], R[2], gradient_O), block.gradient_x);
      replace(Dot(R[3], R[4], R[5], gradient_O), block.gradient_y);
      replace(Dot(R[6], R[7], R[8], gradient_O), block.gradient_z);
    }
  }
}

void LowerBlock(const Placed& object, Block& block) {
  block.with_gradients ? Lower<true>(object, block) : Lower<false>(object, block);
}

void LowerBlockByHalfSpace(const HalfSpace& half_space, Block& block) {
  const D d;
  const Eigen::Vector3d& n_W = half_space.normal_W;
  for (std::size_t n = 0; n < block.count; n += kLanes) {
    const Point p_W = LoadPoint(block.x, block.y, block.z, n);
    const V distance =
        hn::Sub(Dot(n_W.x(), n_W.y(), n_W.z(), p_W), hn::Set(d, half_space.offset_m));
    const V present = hn::Load(d, block.distance_m + n);
    const M nearer = hn::Lt(distance, present);
    if (hn::AllFalse(d, nearer)) continue;
    const auto replace = [&](V value, double* in_block) {
      hn::Store(hn::IfThenElse(nearer, value, hn::Load(d, in_block + n)), d, in_block + n);
    };
    replace(distance, block.distance_m);
    if (!block.with_gradients) continue;
    replace(hn::Set(d, n_W.x()), block.gradient_x);
    replace(hn::Set(d, n_W.y()), block.gradient_y);
    replace(hn::Set(d, n_W.z()), block.gradient_z);
  }
}

void FindNearBoxes(const Boxes& boxes, const std::array<float, 3>& p_m, float reach_m,
                   std::span<std::uint64_t> bits) {
  const hn::CappedTag<float, kBoxLanes> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto zero = hn::Zero(d);
  std::memset(bits.data(), 0, bits.size_bytes());
  for (std::size_t n = 0; n < boxes.slack_m.size(); n += lanes) {
    const auto past = [&](float value, std::span<const float> low, std::span<const float> high) {
      const auto v = hn::Set(d, value);
      const auto out = hn::Max(hn::Sub(hn::Load(d, &low[n]), v), hn::Sub(v, hn::Load(d, &high[n])));
      const auto distance = hn::Max(out, zero);
      return hn::Mul(distance, distance);
    };
    const auto square = hn::Add(
        past(p_m[0], boxes.x_low, boxes.x_high),
        hn::Add(past(p_m[1], boxes.y_low, boxes.y_high), past(p_m[2], boxes.z_low, boxes.z_high)));
    const auto reach = hn::Max(hn::Add(hn::Set(d, reach_m), hn::Load(d, &boxes.slack_m[n])), zero);
    const auto near = hn::Le(square, hn::Mul(reach, reach));
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, near, bytes);
    std::uint64_t word;
    std::memcpy(&word, bytes, sizeof(word));
    bits[n / 64] |= word << (n % 64);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace sidestep::sdf::field_kernels
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sidestep::sdf::field_kernels {

HWY_EXPORT(SampleStaticBlock);
HWY_EXPORT(LowerBlock);
HWY_EXPORT(LowerBlockByHalfSpace);
HWY_EXPORT(FindNearBoxes);

bool IsReadable(const SdfGrid& grid) {
  const auto [nx, ny, nz] = grid.spec().size;
  return nx > 1 && ny > 1 && nz > 1 &&
         grid.spec().num_cells() <=
             static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
}

Grid ViewOf(const SdfGrid& grid) {
  Grid view;
  view.distance_m = grid.distance_m().data();
  for (std::size_t a = 0; a < 3; ++a) {
    const Eigen::Index axis = static_cast<Eigen::Index>(a);
    view.first_m[a] = grid.spec().first_center_m(axis);
    view.last_m[a] = grid.last_center_m()(axis);
    view.last_lower[a] = grid.spec().size[a] - 2;
  }
  view.cells_per_m = grid.cells_per_m();
  view.stride_y = grid.spec().size[0];
  view.stride_z = grid.spec().size[0] * grid.spec().size[1];
  return view;
}

int SampleStatic(const Grid& grid, double max_distance_m, Block& block) {
  return HWY_DYNAMIC_DISPATCH(SampleStaticBlock)(grid, max_distance_m, block);
}

void LowerByHalfSpace(const HalfSpace& half_space, Block& block) {
  HWY_DYNAMIC_DISPATCH(LowerBlockByHalfSpace)(half_space, block);
}

void LowerByObject(const Placed& object, Block& block) {
  HWY_DYNAMIC_DISPATCH(LowerBlock)(object, block);
}

void FindNear(const Boxes& boxes, const std::array<float, 3>& p_m, float reach_m,
              std::span<std::uint64_t> bits) {
  HWY_DYNAMIC_DISPATCH(FindNearBoxes)(boxes, p_m, reach_m, bits);
}

}  // namespace sidestep::sdf::field_kernels
#endif  // HWY_ONCE
