#include <benchmark/benchmark.h>

#include <random>

#include "sdf/map/distance_transform.h"
#include "sdf/world_model.h"

namespace sidestep {
namespace {

constexpr double kCell_m = 0.04;

// A box of the walkway's size in the middle of a workspace of n^3 cells.
OccupancyGrid BoxInACube(int n) {
  OccupancyGrid grid(GridSpec{.first_center_m = {0, 0, 0}, .cell_m = kCell_m, .size = {n, n, n}});
  for (int k = n / 4; k < 3 * n / 4; ++k) {
    for (int j = n / 2 - 7; j < n / 2 + 7; ++j) {
      for (int i = n / 2 - 6; i < n / 2 + 6; ++i) grid.cells[grid.spec.Index(i, j, k)] = 1;
    }
  }
  return grid;
}

Scan FilledCells(const OccupancyGrid& grid, EpisodeTime t) {
  Scan scan{t, Pose(), Eigen::Matrix3Xd(3, static_cast<int>(grid.CountFilled()))};
  int column = 0;
  for (int k = 0; k < grid.spec.size[2]; ++k) {
    for (int j = 0; j < grid.spec.size[1]; ++j) {
      for (int i = 0; i < grid.spec.size[0]; ++i) {
        if (grid.At(i, j, k)) scan.p_CP.col(column++) = grid.spec.Center(i, j, k);
      }
    }
  }
  return scan;
}

// How long the exact signed distance of a whole grid takes.
void BM_SignedDistance(benchmark::State& state) {
  const OccupancyGrid grid = BoxInACube(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(ComputeSignedDistance(grid));
  state.SetItemsProcessed(state.iterations() * static_cast<int>(grid.spec.num_cells()));
}
BENCHMARK(BM_SignedDistance)
    ->ArgName("cells")
    ->Arg(32)
    ->Arg(96)
    ->Arg(192)
    ->Unit(benchmark::kMillisecond);

// How long one scan takes from its points to a new field.
void BM_ObserveAndMakeField(benchmark::State& state) {
  const OccupancyGrid grid = BoxInACube(96);
  WorldModelOptions options;
  options.grid = grid.spec;
  options.max_distance_m = 0.32;
  const auto world = MakeWorldModel(options);
  Scan scan = FilledCells(grid, EpisodeTime(0));
  for (auto _ : state) {
    world->Observe(scan);
    benchmark::DoNotOptimize(world->MakeField());
    scan.t = scan.t + HorizonOffset(1.0 / 30);
  }
}
BENCHMARK(BM_ObserveAndMakeField)->Unit(benchmark::kMillisecond);

// How long a field takes to answer for all spheres of an arm at once.
void BM_SampleField(benchmark::State& state) {
  const int spheres = static_cast<int>(state.range(0));
  const OccupancyGrid grid = BoxInACube(96);
  WorldModelOptions options;
  options.grid = grid.spec;
  options.max_distance_m = 0.32;
  const auto world = MakeWorldModel(options);
  world->Observe(FilledCells(grid, EpisodeTime(0)));
  const auto field = world->MakeField();

  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 95 * kCell_m);
  const Eigen::Matrix3Xd p_WQ =
      Eigen::Matrix3Xd::NullaryExpr(3, spheres, [&]() { return uniform(random); });
  DistanceSamples samples;
  for (auto _ : state) {
    field->SampleMany(p_WQ, EpisodeTime(0.5), samples);
    benchmark::DoNotOptimize(samples.distance_m.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * spheres);
}
BENCHMARK(BM_SampleField)->ArgName("spheres")->Arg(1)->Arg(32);

}  // namespace
}  // namespace sidestep
