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

#include <cstdint>
#include <limits>

#include "sidestep/bench/micro/furnished_room.h"
#include "sidestep/sdf/map/fast_distance_transform.h"

namespace sidestep::bench {
namespace {

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

void Transform(benchmark::State& state, sdf::DistanceConvention convention,
               double max_distance_cells) {
  const OccupancyGrid grid = FurnishedRoom(static_cast<int>(state.range(0)), kPillar);
  const std::size_t size = grid.cells.size();
  const auto distance_m = hwy::AllocateAligned<float>(size);
  sdf::DistanceTransformOptions options{.convention = convention};
  options.max_distance_m = max_distance_cells * grid.spec.cell_m;
  sdf::FastDistanceTransform transform;
  transform.Compute(grid, options, {distance_m.get(), size});  // Touches all memory once.
  for (auto _ : state) {
    transform.Compute(grid, options, {distance_m.get(), size});
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(size));
  state.counters["filled_%"] = 100.0 * static_cast<double>(grid.CountFilled()) / size;
}

void TransformWithAvx2(benchmark::State& state, sdf::DistanceConvention convention,
                       double max_distance_cells) {
  if ((hwy::SupportedTargets() & HWY_AVX2) == 0) {
    state.SkipWithError("this machine has no AVX2");
    return;
  }
  const OnlyTargets avx2(HWY_AVX2);
  Transform(state, convention, max_distance_cells);
}

void SimpleTransform(benchmark::State& state) {
  const OccupancyGrid grid = FurnishedRoom(static_cast<int>(state.range(0)), kPillar);
  for (auto _ : state) {
    benchmark::DoNotOptimize(sdf::ComputeSignedDistance(grid, sdf::DistanceConvention::kBwdist));
  }
}

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

void Sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Arg(64)->Arg(96)->Arg(128)->Arg(256)->Arg(320)->Unit(benchmark::kMillisecond);
}

constexpr sdf::DistanceConvention kBwdist = sdf::DistanceConvention::kBwdist;
constexpr sdf::DistanceConvention kSurface = sdf::DistanceConvention::kSurface;
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
BENCHMARK(SimpleTransform)->Name("edt/simple")->Arg(96)->Arg(256)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sidestep::bench
