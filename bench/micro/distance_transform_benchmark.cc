// The exact signed distance transform of a furnished room of N^3 cells: edt/full/N, and
// edt/bounded10/N up to 10 cells. Between centres, as other libraries have it; edt/full_surface/N
// and edt/bounded10_surface/N are our own convention, ..._avx2/N are without newer instructions.
//
// Read the CPU times, on one thread, and their medians: --benchmark_repetitions=15
// --benchmark_enable_random_interleaving. The memory is warm, as in a program that transforms its
// map again and again, and the result is aligned to cache lines.

#include <benchmark/benchmark.h>
#include <hwy/aligned_allocator.h>
#include <hwy/targets.h>

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>

#include "sdf/map/fast_distance_transform.h"

namespace sidestep {
namespace {

constexpr double kRoom_m = 3.84;

void AddBox(const Eigen::Vector3d& lower_m, const Eigen::Vector3d& upper_m, OccupancyGrid& grid) {
  const std::array<int, 3> lower = grid.spec.CellOf(lower_m);
  const std::array<int, 3> upper = grid.spec.CellOf(upper_m);
  for (int k = lower[2]; k < upper[2]; ++k) {
    for (int j = lower[1]; j < upper[1]; ++j) {
      for (int i = lower[0]; i < upper[0]; ++i) grid.cells[grid.spec.Index(i, j, k)] = 1;
    }
  }
}

// A table on four legs, a cabinet with shelves, and a pillar of 0.30 x 0.30 x 1.80 m in the paper's
// workspace, a cube of 3.84 m: the static obstacles and the moving one of Finean et al. (ICAPS
// 2021). 1.4 % of the cells are filled.
OccupancyGrid FurnishedRoom(int n) {
  const double cell_m = kRoom_m / n;
  OccupancyGrid grid(GridSpec{Eigen::Vector3d::Constant(cell_m / 2), cell_m, {n, n, n}});
  const double thickness_m = 0.08;
  AddBox({2.4, 1.0, 0.72}, {3.2, 2.8, 0.80}, grid);
  for (const double x : {2.4, 3.2 - thickness_m}) {
    for (const double y : {1.0, 2.8 - thickness_m}) {
      AddBox({x, y, 0}, {x + thickness_m, y + thickness_m, 0.72}, grid);
    }
  }
  AddBox({0.32, 1.32, 0}, {0.40, 2.52, 2.0}, grid);  // Its back.
  for (const double y : {1.32, 2.52 - thickness_m}) {
    AddBox({0.32, y, 0}, {0.92, y + thickness_m, 2.0}, grid);
  }
  for (const double z : {0.0, 0.64, 1.28, 2.0 - thickness_m}) {
    AddBox({0.32, 1.32, z}, {0.92, 2.52, z + thickness_m}, grid);
  }
  AddBox({1.76, 0.40, 0}, {2.06, 0.70, 1.80}, grid);
  return grid;
}

// For as long as it lives, Highway picks none but these instruction sets.
class OnlyTargets {
 public:
  explicit OnlyTargets(std::int64_t targets) { Set(targets); }
  ~OnlyTargets() { Set(0); }

 private:
  static void Set(std::int64_t targets) {
    hwy::SetSupportedTargetsForTest(targets);
    hwy::GetChosenTarget().DeInit();
  }
};

void Transform(benchmark::State& state, DistanceConvention convention, double max_distance_cells) {
  const OccupancyGrid grid = FurnishedRoom(static_cast<int>(state.range(0)));
  const std::size_t size = grid.cells.size();
  const auto distance_m = hwy::AllocateAligned<float>(size);
  DistanceTransformOptions options{.convention = convention};
  options.max_distance_m = max_distance_cells * grid.spec.cell_m;
  FastDistanceTransform transform;
  transform.Compute(grid, options, {distance_m.get(), size});  // Touches all memory once.
  for (auto _ : state) {
    transform.Compute(grid, options, {distance_m.get(), size});
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(size));
  state.counters["filled_%"] = 100.0 * static_cast<double>(grid.CountFilled()) / size;
}

void TransformWithAvx2(benchmark::State& state, DistanceConvention convention,
                       double max_distance_cells) {
  if ((hwy::SupportedTargets() & HWY_AVX2) == 0) {
    state.SkipWithError("this machine has no AVX2");
    return;
  }
  const OnlyTargets avx2(HWY_AVX2);
  Transform(state, convention, max_distance_cells);
}

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

void Sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Arg(64)->Arg(96)->Arg(128)->Arg(256)->Arg(320)->Unit(benchmark::kMillisecond);
}

constexpr DistanceConvention kBwdist = DistanceConvention::kBwdist;
constexpr DistanceConvention kSurface = DistanceConvention::kSurface;
BENCHMARK_CAPTURE(Transform, full, kBwdist, kUnbounded)->Name("edt/full")->Apply(Sizes);
BENCHMARK_CAPTURE(Transform, bounded, kBwdist, 10)->Name("edt/bounded10")->Apply(Sizes);
BENCHMARK_CAPTURE(Transform, full, kSurface, kUnbounded)->Name("edt/full_surface")->Apply(Sizes);
BENCHMARK_CAPTURE(Transform, bounded, kSurface, 10)->Name("edt/bounded10_surface")->Apply(Sizes);
BENCHMARK_CAPTURE(TransformWithAvx2, full, kBwdist, kUnbounded)
    ->Name("edt/full_avx2")
    ->Apply(Sizes);
BENCHMARK_CAPTURE(TransformWithAvx2, bounded, kBwdist, 10)
    ->Name("edt/bounded10_avx2")
    ->Apply(Sizes);

}  // namespace
}  // namespace sidestep
