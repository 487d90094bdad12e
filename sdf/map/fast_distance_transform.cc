#include "sdf/map/fast_distance_transform.h"

#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <utility>

#include "core/parallel_for.h"
#include "sdf/map/fast_distance_transform_kernels.h"

namespace sidestep {
namespace {

using fast_transform::CostTables;
using fast_transform::Job;
using fast_transform::kColumnBytes;
using fast_transform::kColumnLanes;
using fast_transform::Scratch;
using fast_transform::SquaredHalfCells;

// The cost of an offset of k cells along one axis.
std::uint32_t AxisCost(std::uint32_t k, DistanceConvention convention) {
  if (convention == DistanceConvention::kBwdist) return k * k;
  return k == 0 ? 0 : 2 * k * (k - 1) + 1;
}

// Memory that is only ever asked for at once, and grows.
class Buffer {
 public:
  template <class T>
  T* Get(std::size_t count) {
    const std::size_t bytes = count * sizeof(T);
    if (bytes > bytes_) {
      // Strides of whole planes touch a new page with each access, so large pages matter.
      constexpr std::size_t kLargePage = std::size_t{1} << 21;
      const std::size_t alignment = bytes < kLargePage ? kColumnBytes : kLargePage;
      const std::size_t size = (bytes + alignment - 1) / alignment * alignment;
      bytes_ = 0;
      data_.reset(std::aligned_alloc(alignment, size));
      if (data_ == nullptr) throw std::bad_alloc();
      if (alignment == kLargePage) madvise(data_.get(), size, MADV_HUGEPAGE);
      bytes_ = size;
    }
    return static_cast<T*>(data_.get());
  }

 private:
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };
  std::unique_ptr<void, Free> data_;
  std::size_t bytes_ = 0;
};

std::size_t DivideUp(std::size_t a, std::size_t b) { return (a + b - 1) / b; }

}  // namespace

class FastDistanceTransform::Memory {
 public:
  Buffer sums, bits, slice_is_free, repeated, rising, falling;
  struct Worker {
    Buffer row, free_side, filled_side, bits, distances;
  };
  std::vector<Worker> workers;

  template <class Lane>
  bool Run(const OccupancyGrid& occupancy, const DistanceTransformOptions& options,
           std::uint32_t far, bool may_saturate, float* distance_m) {
    constexpr std::size_t kLanes = kColumnLanes<Lane>;
    Job<Lane> job;
    job.nx = static_cast<std::size_t>(occupancy.spec.size[0]);
    job.ny = static_cast<std::size_t>(occupancy.spec.size[1]);
    job.nz = static_cast<std::size_t>(occupancy.spec.size[2]);
    job.cells = occupancy.cells.data();
    job.distance_m = distance_m;
    job.convention = options.convention;
    job.half_cell_m = occupancy.spec.cell_m / 2;
    job.max_distance_m = static_cast<float>(options.max_distance_m);
    job.may_saturate = may_saturate;
    job.bypass_cache =
        occupancy.cells.size() * sizeof(float) > (std::size_t{16} << 20) && !getenv("NOBYPASS");
    job.num_columns = DivideUp(job.nx, kLanes);
    job.words_per_row = DivideUp(job.nx, 64);

    const std::size_t longest = std::max({job.nx, job.ny, job.nz});
    job.costs.far = static_cast<Lane>(far);
    const auto cost = [&](std::size_t k) {
      return static_cast<Lane>(
          std::min(far, AxisCost(static_cast<std::uint32_t>(k), options.convention)));
    };
    std::uint32_t* repeat = repeated.Get<std::uint32_t>(longest + 1);
    for (std::size_t k = 0; k <= longest; ++k)
      repeat[k] = cost(k) * (0xffffffffu / static_cast<Lane>(~Lane{0}));
    Lane* rise = rising.Get<Lane>(longest + kLanes);
    for (std::size_t k = 0; k < longest + kLanes; ++k) rise[k] = cost(k + 1);
    Lane* fall = falling.Get<Lane>(longest + kLanes);
    for (std::size_t k = 0; k < longest; ++k) fall[k] = cost(longest - k);
    std::fill_n(fall + longest, kLanes, Lane{0});
    job.costs.repeated = repeat;
    job.costs.rising = rise;
    job.costs.falling_end = fall + longest;

    job.plane_pitch = job.nz * job.num_columns * kLanes + kLanes;
    job.sums = sums.Get<Lane>(job.ny * job.plane_pitch);
    job.bits = bits.Get<std::uint64_t>(job.ny * job.nz * job.words_per_row);
    job.slice_is_free = slice_is_free.Get<std::uint8_t>(job.nz);

    const std::size_t num_workers = static_cast<std::size_t>(options.num_threads);
    if (workers.size() < num_workers) workers.resize(num_workers);
    const auto scratch_of = [&](int w) {
      Worker& worker = workers[static_cast<std::size_t>(w)];
      const std::size_t column = std::max(job.ny, job.nz) * kLanes;
      return Scratch<Lane>{worker.row.Get<Lane>((job.num_columns + 1) * kLanes),
                           worker.free_side.Get<Lane>(job.num_columns * column),
                           worker.filled_side.Get<Lane>(job.num_columns * column),
                           worker.bits.Get<std::uint64_t>(job.ny * job.words_per_row),
                           worker.distances.Get<float>(job.nx)};
    };
    ParallelFor(options.num_threads, static_cast<int>(job.nz),
                [&](int w, int z) { fast_transform::TransformSlice(job, scratch_of(w), z); });
    std::atomic<bool> saturated = false;
    ParallelFor(options.num_threads, static_cast<int>(job.ny), [&](int w, int y) {
      if (!saturated && !fast_transform::TransformPlane(job, scratch_of(w), y)) saturated = true;
    });
    return !saturated;
  }
};

FastDistanceTransform::FastDistanceTransform() : memory_(std::make_unique<Memory>()) {}
FastDistanceTransform::~FastDistanceTransform() = default;
FastDistanceTransform::FastDistanceTransform(FastDistanceTransform&&) noexcept = default;
FastDistanceTransform& FastDistanceTransform::operator=(FastDistanceTransform&&) noexcept = default;

void FastDistanceTransform::Compute(const OccupancyGrid& occupancy,
                                    const DistanceTransformOptions& options,
                                    std::vector<float>& distance_m) {
  distance_m.resize(occupancy.cells.size());
  const std::size_t filled = occupancy.CountFilled();
  if (filled == 0 || filled == occupancy.cells.size()) {
    const float distance =
        std::min(kNoSurfaceDistance_m, static_cast<float>(options.max_distance_m));
    std::fill(distance_m.begin(), distance_m.end(), filled == 0 ? distance : -distance);
    return;
  }
  std::uint32_t reach = 0;
  for (const int size : occupancy.spec.size)
    reach += AxisCost(static_cast<std::uint32_t>(size - 1), options.convention);
  const float limit = static_cast<float>(options.max_distance_m);
  // Smallest sum that is at or beyond the limit.
  std::uint32_t far = reach + 1;
  {
    std::uint32_t lo = 0, hi = far;
    while (lo < hi) {
      const std::uint32_t mid = (lo + hi) / 2;
      const float m = static_cast<float>(
          occupancy.spec.cell_m / 2 *
          std::sqrt(static_cast<float>(SquaredHalfCells(mid, options.convention))));
      if (m >= limit)
        hi = mid;
      else
        lo = mid + 1;
    }
    far = lo;
  }
  if (far <= 0xff && options.min_lane_bits <= 8) {
    memory_->Run<std::uint8_t>(occupancy, options, far, false, distance_m.data());
    return;
  }
  if (options.min_lane_bits <= 16) {
    if (memory_->Run<std::uint16_t>(occupancy, options, std::min(far, 0xffffu), far > 0xffff,
                                    distance_m.data()))
      return;
  }
  memory_->Run<std::uint32_t>(occupancy, options, far, false, distance_m.data());
}

SdfGrid FastDistanceTransform::Compute(const OccupancyGrid& occupancy,
                                       const DistanceTransformOptions& options) {
  std::vector<float> distance_m;
  Compute(occupancy, options, distance_m);
  return SdfGrid(occupancy.spec, std::move(distance_m));
}

}  // namespace sidestep
