#include "sidestep/sdf/placed_composite.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "sidestep/sdf/block_samples.h"

namespace sidestep::sdf {
namespace {

using field_kernels::Block;
using field_kernels::kBlockSize;

// What positions may be off by after rounding to float; bounds are that much wider.
constexpr double kFloatRounding_m = 1e-5;

template <class Visitor>
void ForEachCell(const GridSpec& spec, const Visitor& visit) {
  for (int k = 0; k < spec.size[2]; ++k) {
    for (int j = 0; j < spec.size[1]; ++j) {
      for (int i = 0; i < spec.size[0]; ++i) visit(i, j, k);
    }
  }
}

// Of a point to a box, or of two boxes.
double SquaredDistance(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                       const Eigen::Vector3d& box_low, const Eigen::Vector3d& box_high) {
  return (box_low - high).cwiseMax(low - box_high).cwiseMax(0.0).squaredNorm();
}

// The rows of R_WO, and the columns, which are the rows of R_OW.
double DotRow(const std::array<double, 9>& R, std::size_t row, const Eigen::Vector3d& v) {
  return (R[3 * row] * v.x() + R[3 * row + 1] * v.y()) + R[3 * row + 2] * v.z();
}
double DotColumn(const std::array<double, 9>& R, std::size_t column, const Eigen::Vector3d& v) {
  return (R[column] * v.x() + R[column + 3] * v.y()) + R[column + 6] * v.z();
}

}  // namespace

FieldBound TightBound(const SdfGrid& field_O) {
  const GridSpec& spec = field_O.spec();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  FieldBound bound{Eigen::Vector3d::Constant(kInfinity), Eigen::Vector3d::Constant(-kInfinity), 0};
  ForEachCell(spec, [&](int i, int j, int k) {
    if (field_O.At(i, j, k) > 0) return;
    bound.low_O = bound.low_O.cwiseMin(spec.Center(i, j, k));
    bound.high_O = bound.high_O.cwiseMax(spec.Center(i, j, k));
  });
  if (!(bound.low_O.x() <= bound.high_O.x())) return DomainBound(field_O);
  bound.low_O.array() -= spec.cell_m / 2;
  bound.high_O.array() += spec.cell_m / 2;
  ForEachCell(spec, [&](int i, int j, int k) {
    const Eigen::Vector3d center = spec.Center(i, j, k);
    const double to_box_m = std::sqrt(SquaredDistance(center, center, bound.low_O, bound.high_O));
    bound.slack_m = std::max(bound.slack_m, to_box_m - double{field_O.At(i, j, k)});
  });
  bound.slack_m += kFloatRounding_m;
  return bound;
}

FieldBound DomainBound(const SdfGrid& field_O) {
  return {field_O.spec().first_center_m, field_O.last_center_m(),
          -std::numeric_limits<double>::infinity()};
}

PlacedComposite::Object::Object(const PlacedObject& given)
    : field_O(given.field_O),
      readable(field_kernels::IsReadable(*given.field_O)),
      slack_m(given.bound.slack_m + given.growth_m) {
  const Eigen::Matrix3d R_WO = given.X_WO.rotation().toRotationMatrix();
  const Eigen::Vector3d& p_WO = given.X_WO.translation();
  const Eigen::Vector3d center_W = R_WO * (given.bound.low_O + given.bound.high_O) / 2 + p_WO;
  const Eigen::Vector3d half_W = R_WO.cwiseAbs() * (given.bound.high_O - given.bound.low_O) / 2 +
                                 Eigen::Vector3d::Constant(kFloatRounding_m);
  low_W = center_W - half_W;
  high_W = center_W + half_W;
  placed = {field_kernels::ViewOf(*given.field_O),
            {R_WO(0, 0), R_WO(0, 1), R_WO(0, 2), R_WO(1, 0), R_WO(1, 1), R_WO(1, 2), R_WO(2, 0),
             R_WO(2, 1), R_WO(2, 2)},
            {p_WO.x(), p_WO.y(), p_WO.z()},
            given.growth_m};
}

PlacedComposite::PlacedComposite(const SdfGrid& static_W, std::span<const PlacedObject> objects,
                                 double max_distance_m, const ExactSolids* solids)
    : static_W_(static_W),
      static_readable_(field_kernels::IsReadable(static_W)),
      static_view_(field_kernels::ViewOf(static_W)),
      max_distance_m_(max_distance_m),
      solids_(solids) {
  objects_.reserve(objects.size());
  for (const PlacedObject& given : objects) objects_.emplace_back(given);
  if (objects_.size() < kMany) return;

  constexpr std::size_t kLanes = field_kernels::kBoxLanes;
  const std::size_t size = (objects_.size() + kLanes - 1) / kLanes * kLanes;
  constexpr float kFar = 1e18F;  // of the boxes that fill the last vector
  box_lanes_ = std::make_unique<BoxLanes>();
  BoxLanes& box_lanes = *box_lanes_;
  for (AlignedVector<float>& lanes : box_lanes) lanes.assign(size, kFar);
  for (std::size_t n = 0; n < objects_.size(); ++n) {
    for (std::size_t a = 0; a < 3; ++a) {
      const Eigen::Index axis = static_cast<Eigen::Index>(a);
      box_lanes[a][n] = static_cast<float>(objects_[n].low_W(axis) - kFloatRounding_m);
      box_lanes[3 + a][n] = static_cast<float>(objects_[n].high_W(axis) + kFloatRounding_m);
    }
    box_lanes[6][n] = static_cast<float>(objects_[n].slack_m + kFloatRounding_m);
  }
  std::fill(box_lanes[6].begin() + static_cast<std::ptrdiff_t>(objects_.size()), box_lanes[6].end(),
            0.0F);
}

DistanceSample PlacedComposite::Sample(const Eigen::Vector3d& p_WQ) const {
  DistanceSample sample{max_distance_m_, Eigen::Vector3d::Zero(), static_W_.Covers(p_WQ)};
  if (sample.in_grid) {
    const GridSample fixed = static_W_.Sample(p_WQ);
    if (fixed.distance_m < max_distance_m_) sample = {fixed.distance_m, fixed.gradient, true};
  }
  if (solids_ != nullptr) solids_->Lower(p_WQ, sample);
  if (objects_.size() >= kMany) {
    LowerByMany(p_WQ, sample);
  } else {
    for (const Object& object : objects_) Lower(object, p_WQ, sample);
  }
  return sample;
}

bool PlacedComposite::CanBeNearer(const Object& object, double squared_m2, double distance_m) {
  const double reach_m = std::max(distance_m + object.slack_m, 0.0);
  return squared_m2 <= reach_m * reach_m;
}

void PlacedComposite::Lower(const Object& object, const Eigen::Vector3d& p_WQ,
                            DistanceSample& sample) {
  const double squared_m2 = SquaredDistance(p_WQ, p_WQ, object.low_W, object.high_W);
  if (!CanBeNearer(object, squared_m2, sample.distance_m)) return;
  const auto& R_WO = object.placed.R_WO;
  const Eigen::Vector3d p_OQ_W =
      p_WQ - Eigen::Map<const Eigen::Vector3d>(object.placed.p_WO.data());
  const GridSample of_object = object.field_O->Sample(
      {DotColumn(R_WO, 0, p_OQ_W), DotColumn(R_WO, 1, p_OQ_W), DotColumn(R_WO, 2, p_OQ_W)});
  const double distance_m = of_object.distance_m - object.placed.growth_m;
  if (!of_object.in_grid || !(distance_m < sample.distance_m)) return;
  const Eigen::Vector3d& gradient_O = of_object.gradient;
  sample.distance_m = distance_m;
  sample.gradient_W = {DotRow(R_WO, 0, gradient_O), DotRow(R_WO, 1, gradient_O),
                       DotRow(R_WO, 2, gradient_O)};
}

void PlacedComposite::LowerByMany(const Eigen::Vector3d& p_WQ, DistanceSample& sample) const {
  constexpr std::size_t kChunk = 256;  // boxes
  const std::array<float, 3> p = {static_cast<float>(p_WQ.x()), static_cast<float>(p_WQ.y()),
                                  static_cast<float>(p_WQ.z())};
  for (std::size_t begin = 0; begin < objects_.size(); begin += kChunk) {
    const std::size_t count = std::min(kChunk, (*box_lanes_)[0].size() - begin);
    const auto lanes = [&](std::size_t n) {
      return std::span((*box_lanes_)[n]).subspan(begin, count);
    };
    std::array<std::uint64_t, kChunk / 64> bits;
    field_kernels::FindNear({lanes(0), lanes(1), lanes(2), lanes(3), lanes(4), lanes(5), lanes(6)},
                            p, static_cast<float>(sample.distance_m), bits);
    for (std::size_t word = 0; word < bits.size(); ++word) {
      for (std::uint64_t left = bits[word]; left != 0; left &= left - 1) {
        const auto n = static_cast<std::size_t>(std::countr_zero(left));
        Lower(objects_[begin + 64 * word + n], p_WQ, sample);
      }
    }
  }
}

int PlacedComposite::SampleBlock(Block& block) const {
  int num_outside = 0;
  if (static_readable_) {
    num_outside = field_kernels::SampleStatic(static_view_, max_distance_m_, block);
  } else {
    for (std::size_t n = 0; n < block.count; ++n) {
      const GridSample sample = static_W_.Sample(PointOf(block, n));
      const bool counts = sample.in_grid && sample.distance_m < max_distance_m_;
      block.distance_m[n] = counts ? sample.distance_m : max_distance_m_;
      block.gradient_x[n] = counts ? sample.gradient.x() : 0;
      block.gradient_y[n] = counts ? sample.gradient.y() : 0;
      block.gradient_z[n] = counts ? sample.gradient.z() : 0;
      num_outside += sample.in_grid ? 0 : 1;
    }
  }
  if (solids_ != nullptr) solids_->Lower(block);
  if (objects_.empty()) return num_outside;

  const BlockBounds bounds = BoundsOf(block);
  for (const Object& object : objects_) {
    const double squared_m2 = SquaredDistance(bounds.low, bounds.high, object.low_W, object.high_W);
    if (!CanBeNearer(object, squared_m2, bounds.farthest_m)) continue;
    if (object.readable) {
      field_kernels::LowerByObject(object.placed, block);
    } else {
      LowerEach(object, block);
    }
  }
  return num_outside;
}

void PlacedComposite::LowerEach(const Object& object, Block& block) {
  for (std::size_t n = 0; n < block.count; ++n) {
    DistanceSample sample = SampleOf(block, n);
    Lower(object, PointOf(block, n), sample);
    SetSample(sample, n, block);
  }
}

void PlacedComposite::SampleMany(const Eigen::Matrix3Xd& p_WQ, DistanceSamples& samples) const {
  const Eigen::Index size = p_WQ.cols();
  samples.distance_m.resize(size);
  samples.gradient_W.resize(3, size);
  samples.num_outside = 0;
  Block block;
  for (Eigen::Index begin = 0; begin < size; begin += Eigen::Index{kBlockSize}) {
    block.count = static_cast<std::size_t>(std::min(Eigen::Index{kBlockSize}, size - begin));
    for (std::size_t n = 0; n < kBlockSize; ++n) {
      // What is left of the block is filled with its last point.
      const auto column = begin + static_cast<Eigen::Index>(std::min(n, block.count - 1));
      block.x[n] = p_WQ(0, column);
      block.y[n] = p_WQ(1, column);
      block.z[n] = p_WQ(2, column);
    }
    samples.num_outside += SampleBlock(block);
    for (std::size_t n = 0; n < block.count; ++n) {
      const Eigen::Index column = begin + static_cast<Eigen::Index>(n);
      samples.distance_m(column) = block.distance_m[n];
      samples.gradient_W.col(column) << block.gradient_x[n], block.gradient_y[n],
          block.gradient_z[n];
    }
  }
}

void PlacedComposite::SampleMany(const PointColumns& p_WQ, SampleColumns& samples) const {
  const Eigen::Index size = p_WQ.rows();
  samples.distance_m.resize(size);
  samples.gradient_W.resize(size, 3);
  samples.num_outside = 0;
  Block block;
  for (Eigen::Index begin = 0; begin < size; begin += Eigen::Index{kBlockSize}) {
    block.count = static_cast<std::size_t>(std::min(Eigen::Index{kBlockSize}, size - begin));
    const auto read = [&](Eigen::Index axis, double* to) {
      const double* from = p_WQ.data() + axis * size + begin;
      std::fill(std::copy_n(from, block.count, to), to + kBlockSize, from[block.count - 1]);
    };
    read(0, block.x);
    read(1, block.y);
    read(2, block.z);
    samples.num_outside += SampleBlock(block);
    std::copy_n(block.distance_m, block.count, samples.distance_m.data() + begin);
    const auto write = [&](const double* from, Eigen::Index axis) {
      std::copy_n(from, block.count, samples.gradient_W.data() + axis * size + begin);
    };
    write(block.gradient_x, 0);
    write(block.gradient_y, 1);
    write(block.gradient_z, 2);
  }
}

}  // namespace sidestep::sdf
