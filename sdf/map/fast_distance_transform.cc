#include "sidestep/sdf/map/fast_distance_transform.h"

#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <new>
#include <stdexcept>
#include <utility>

#include "sidestep/sdf/map/fast_distance_transform_kernels.h"
#include "sidestep/sdf/parallel_for.h"

namespace sidestep::sdf {
namespace {

using fast_transform::AxisCost;
using fast_transform::Job;
using fast_transform::kColumnBytes;
using fast_transform::kColumnLanes;
using fast_transform::Scratch;
using fast_transform::SquaredHalfCells;

// Results larger than this are written past the caches: they would not stay there anyway.
constexpr std::size_t kCachedBytes = std::size_t{16} << 20;

std::size_t DivideUp(std::size_t a, std::size_t b) { return (a + b - 1) / b; }

float ToDistance_m(std::uint32_t squared_half_cells, double cell_m) {
  return static_cast<float>(cell_m / 2 * std::sqrt(static_cast<float>(squared_half_cells)));
}

// The lowest sum of costs in `grid` that need not be told from larger ones: beyond the largest in
// the grid, or at the distance where the result is clamped.
template <class Lane>
std::uint32_t FarSum(const GridSpec& grid, const DistanceTransformOptions& options) {
  std::uint32_t lowest = 1;
  std::uint32_t highest = 1;
  for (const int size : grid.size) {
    highest += AxisCost<Lane>(static_cast<std::uint32_t>(size - 1), options.convention);
  }
  while (lowest < highest) {
    const std::uint32_t middle = lowest + (highest - lowest) / 2;
    const std::uint32_t square = SquaredHalfCells<Lane>(middle, options.convention);
    if (ToDistance_m(square, grid.cell_m) >= static_cast<float>(options.max_distance_m)) {
      highest = middle;
    } else {
      lowest = middle + 1;
    }
  }
  return lowest;
}

float NoSurfaceDistance_m(const DistanceTransformOptions& options) {
  return std::min(kNoSurfaceDistance_m, static_cast<float>(options.max_distance_m));
}

void CheckOptions(const DistanceTransformOptions& options) {
  const int bits = options.min_lane_bits;
  if (!(options.max_distance_m > 0) || options.num_threads < 1 ||
      (bits != 8 && bits != 16 && bits != 32)) {
    throw std::invalid_argument(
        "distance transform: needs a largest distance > 0, a thread, lanes of 8, 16 or 32 bits");
  }
}

}  // namespace

class FastDistanceTransform::Workspace {
 public:
  // Returns false if lanes of this width do not suffice.
  template <class Lane>
  bool Run(const OccupancyGrid& occupancy, const DistanceTransformOptions& options,
           float* distance_m);

 private:
  // Memory that grows, and is never initialised.
  class Buffer {
   public:
    template <class T>
    T* Get(std::size_t count) {
      Reserve(count * sizeof(T));
      return static_cast<T*>(data_.get());
    }

   private:
    struct AlignedDelete {
      std::align_val_t alignment;
      void operator()(void* memory) const { ::operator delete(memory, alignment); }
    };

    void Reserve(std::size_t bytes) {
      if (bytes <= capacity_) return;
      // The step from plane to plane leaves a small page each time, so large ones matter.
      constexpr std::size_t kLargePage = std::size_t{1} << 21;
      const std::size_t alignment = bytes < kLargePage ? kColumnBytes : kLargePage;
      const std::size_t size = DivideUp(bytes, alignment) * alignment;
      capacity_ = 0;
      data_.reset();
      const std::align_val_t align{alignment};
      data_ = {::operator new(size, align), AlignedDelete{align}};
      if (alignment == kLargePage) madvise(data_.get(), size, MADV_HUGEPAGE);
      capacity_ = size;
    }

    std::unique_ptr<void, AlignedDelete> data_;
    std::size_t capacity_ = 0;
  };

  template <class Lane>
  void FillCostTables(std::uint32_t far, Job<Lane>& job);
  template <class Lane>
  Scratch<Lane> MakeScratch(const Job<Lane>& job, std::size_t worker);

  Buffer repeated_, rising_, falling_;
  Buffer sums_, bits_, slice_is_free_;
  struct Worker {
    Buffer bits, column_bits, row, free_side, filled_side, plane, column, line, pieces;
  };
  std::vector<Worker> workers_;
};

template <class Lane>
bool FastDistanceTransform::Workspace::Run(const OccupancyGrid& occupancy,
                                           const DistanceTransformOptions& options,
                                           float* distance_m) {
  constexpr std::uint32_t kLargest = std::numeric_limits<Lane>::max();
  const std::uint32_t far = FarSum<Lane>(occupancy.spec, options);
  // Lanes of 8 bits are a waste of time if they may fail; those of 16 bits rarely do.
  if (sizeof(Lane) == 1 && far > kLargest) return false;

  Job<Lane> job;
  job.nx = static_cast<std::size_t>(occupancy.spec.size[0]);
  job.ny = static_cast<std::size_t>(occupancy.spec.size[1]);
  job.nz = static_cast<std::size_t>(occupancy.spec.size[2]);
  job.cells = occupancy.cells.data();
  job.distance_m = distance_m;
  job.convention = options.convention;
  job.half_cell_m = occupancy.spec.cell_m / 2;
  job.max_distance_m = static_cast<float>(options.max_distance_m);
  job.may_saturate = far > kLargest;
  job.bypass_cache = occupancy.cells.size() * sizeof(float) > kCachedBytes;
  job.num_columns = DivideUp(job.nx, kColumnLanes<Lane>);
  job.words_per_row = DivideUp(job.nx, 64);
  FillCostTables(std::min(far, kLargest), job);
  // One cache line more than needed: planes at a distance of a power of two would share cache sets.
  job.plane_pitch = (job.nz * job.num_columns + 1) * kColumnLanes<Lane>;
  job.sums = sums_.Get<Lane>(job.ny * job.plane_pitch);
  job.bits = bits_.Get<std::uint64_t>(job.ny * job.nz * job.words_per_row + 1);
  job.slice_is_free = slice_is_free_.Get<std::uint8_t>(job.nz);

  const std::size_t num_workers = static_cast<std::size_t>(options.num_threads);
  if (workers_.size() < num_workers) workers_.resize(num_workers);
  ParallelFor(options.num_threads, static_cast<int>(job.nz), [&](int worker, int z) {
    TransformSlice(job, MakeScratch(job, static_cast<std::size_t>(worker)),
                   static_cast<std::size_t>(z));
  });
  const auto is_free = [](std::uint8_t value) { return value != 0; };
  if (std::all_of(job.slice_is_free, job.slice_is_free + job.nz, is_free)) {
    std::fill_n(distance_m, occupancy.cells.size(), NoSurfaceDistance_m(options));
    return true;
  }
  // From both ends inwards: a corner is furthest from everything, so if lanes are too narrow it
  // shows at once.
  const auto plane = [&](int i) {
    const std::size_t half = static_cast<std::size_t>(i) / 2;
    return i % 2 == 0 ? half : job.ny - 1 - half;
  };
  std::atomic<bool> saturated = false;
  ParallelFor(options.num_threads, static_cast<int>(job.ny), [&](int worker, int i) {
    const Scratch<Lane> scratch = MakeScratch(job, static_cast<std::size_t>(worker));
    if (!saturated && !TransformPlane(job, scratch, plane(i))) saturated = true;
  });
  return !saturated;
}

template <class Lane>
void FastDistanceTransform::Workspace::FillCostTables(std::uint32_t far, Job<Lane>& job) {
  const std::size_t longest = std::max({job.nx, job.ny, job.nz});
  const auto cost = [&](std::size_t k) {
    const std::uint32_t exact = AxisCost<Lane>(static_cast<std::uint32_t>(k), job.convention);
    return static_cast<Lane>(std::min(far, exact));
  };
  std::uint32_t* repeated = repeated_.Get<std::uint32_t>(longest);
  Lane* rising = rising_.Get<Lane>(longest + kColumnLanes<Lane>);
  Lane* falling = falling_.Get<Lane>(longest + kColumnLanes<Lane>);
  constexpr std::uint32_t kRepeat =
      std::numeric_limits<std::uint32_t>::max() / std::numeric_limits<Lane>::max();
  for (std::size_t k = 0; k < longest; ++k) {
    repeated[k] = kRepeat * cost(k);
    rising[k] = cost(k + 1);
    falling[k] = cost(longest - k);
  }
  std::fill_n(rising + longest, kColumnLanes<Lane>, Lane{0});
  std::fill_n(falling + longest, kColumnLanes<Lane>, Lane{0});
  job.costs = {static_cast<Lane>(far), repeated, rising, falling + longest};
}

template <class Lane>
Scratch<Lane> FastDistanceTransform::Workspace::MakeScratch(const Job<Lane>& job,
                                                            std::size_t worker) {
  Worker& memory = workers_[worker];
  constexpr std::size_t kLanes = kColumnLanes<Lane>;
  const std::size_t sides = kLanes * std::max(job.num_columns * job.ny, job.nz);
  return {memory.bits.Get<std::uint64_t>(job.ny * job.words_per_row),
          memory.column_bits.Get<std::uint64_t>(std::max(job.ny, job.nz)),
          memory.row.Get<Lane>((job.num_columns + 1) * kLanes),
          memory.free_side.Get<Lane>(sides),
          memory.filled_side.Get<Lane>(sides),
          memory.plane.Get<Lane>((job.nz * job.num_columns + 1) * kLanes),
          memory.column.Get<Lane>(kLanes * std::max(job.ny, job.nz)),
          memory.line.Get<std::uint32_t>(std::max(job.ny, job.nz)),
          memory.pieces.Get<fast_transform::EnvelopePiece>(std::max(job.ny, job.nz))};
}

FastDistanceTransform::FastDistanceTransform() : workspace_(std::make_unique<Workspace>()) {}
FastDistanceTransform::~FastDistanceTransform() = default;
FastDistanceTransform::FastDistanceTransform(FastDistanceTransform&&) noexcept = default;
FastDistanceTransform& FastDistanceTransform::operator=(FastDistanceTransform&&) noexcept = default;

void FastDistanceTransform::Compute(const OccupancyGrid& occupancy,
                                    const DistanceTransformOptions& options,
                                    std::span<float> distance_m) {
  CheckTransformInput(occupancy);
  CheckOptions(options);
  if (distance_m.size() != occupancy.cells.size()) {
    throw std::invalid_argument("distance transform: needs room for one distance a cell");
  }
  if (std::memchr(occupancy.cells.data(), 0, occupancy.cells.size()) == nullptr) {
    std::fill(distance_m.begin(), distance_m.end(), -NoSurfaceDistance_m(options));
    return;
  }
  if (options.min_lane_bits <= 8 &&
      workspace_->Run<std::uint8_t>(occupancy, options, distance_m.data())) {
    return;
  }
  if (options.min_lane_bits <= 16 &&
      workspace_->Run<std::uint16_t>(occupancy, options, distance_m.data())) {
    return;
  }
  workspace_->Run<std::uint32_t>(occupancy, options, distance_m.data());
}

SdfGrid FastDistanceTransform::Compute(const OccupancyGrid& occupancy,
                                       const DistanceTransformOptions& options) {
  AlignedVector<float> distance_m(occupancy.cells.size());
  Compute(occupancy, options, distance_m);
  return SdfGrid(occupancy.spec, std::move(distance_m));
}

}  // namespace sidestep::sdf
