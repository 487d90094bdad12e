// What a predicted field costs: asked lazily, point by point (query/lazy/objects:M) and in batches
// (query/lazy_batched/objects:M), and as a grid for one time (composite/{dense,incremental}/N)
// beside a plain copy of such a grid (composite/copy/N).
//
// The world of the queries is the furnished room in 96^3 cells with M cubes of 0.2 m that share one
// field, turned every way. The points are those of 256 arms all over the room, 64 in a cube of
// 0.77 m each, so that they come through the whole grid; ..._one_arm/objects:M asks one arm's again
// and again, which stay in the cache. ..._floor/objects:M has the room's floor as a half-space,
// too. The objects stand at one time; composite/place/objects:M is the cost of going to another.

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <vector>

#include "sidestep/bench/micro/furnished_room.h"
#include "sidestep/core/random.h"
#include "sidestep/sdf/composite_field.h"
#include "sidestep/sdf/dense_composite.h"
#include "sidestep/sdf/map/fast_distance_transform.h"
#include "sidestep/sdf/map/object_field.h"

namespace sidestep::bench {
namespace {

constexpr double kClamp_m = 0.4;

std::shared_ptr<const sdf::SdfGrid> RoomField(int n) {
  return std::make_shared<const sdf::SdfGrid>(
      sdf::FastDistanceTransform().Compute(FurnishedRoom(n, {})));
}

sdf::CompositeField CubesInARoom(int num_objects, const StaticSolids& exact = {}) {
  constexpr int kCells = 96;
  const double cell_m = kRoom_m / kCells;
  OccupancyGrid cube({Eigen::Vector3d::Constant(-2 * cell_m), cell_m, {5, 5, 5}});
  std::fill(cube.cells.begin(), cube.cells.end(), 1);
  const auto field_O = std::make_shared<const sdf::SdfGrid>(sdf::MakeObjectField(cube, kClamp_m));
  RandomStream random(7, "poses");
  const auto anywhere = [&](double low, double high) {
    return Eigen::Vector3d(random.Uniform(low, high), random.Uniform(low, high),
                           random.Uniform(low, high));
  };
  std::vector<sdf::MovingField> objects;
  for (int n = 0; n < num_objects; ++n) {
    const Pose X_WO = Pose::FromRollPitchYaw(anywhere(-3, 3), anywhere(0.2, kRoom_m - 0.2));
    objects.push_back({field_O, [X_WO](EpisodeTime) { return X_WO; }});
  }
  return sdf::CompositeField(RoomField(kCells), std::move(objects), kClamp_m, exact);
}

// The arms' points, one arm after the other.
sdf::PointColumns ArmPoints(int num_arms) {
  constexpr int kPoints = 64;
  RandomStream random(8, "points");
  sdf::PointColumns p_WQ(num_arms * kPoints, 3);
  for (int arm = 0; arm < num_arms; ++arm) {
    for (int axis = 0; axis < 3; ++axis) {
      const double low = random.Uniform(0.1, kRoom_m - 0.87);
      for (int n = 0; n < kPoints; ++n) {
        p_WQ(arm * kPoints + n, axis) = random.Uniform(low, low + 0.77);
      }
    }
  }
  return p_WQ;
}

// What one query took.
void CountQueries(Eigen::Index num_points, benchmark::State& state) {
  state.counters["per_query"] =
      benchmark::Counter(static_cast<double>(state.iterations() * num_points),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

StaticSolids Floor() { return {{}, {{Eigen::Vector3d::UnitZ(), 0.1}}}; }

void Lazy(benchmark::State& state, int num_arms, const StaticSolids& exact) {
  const sdf::CompositeField composite = CubesInARoom(static_cast<int>(state.range(0)), exact);
  const sdf::PlacedComposite field = composite.PlacedAt(EpisodeTime(0));
  const Eigen::Matrix3Xd p_WQ = ArmPoints(num_arms).transpose();
  for (auto _ : state) {
    for (Eigen::Index s = 0; s < p_WQ.cols(); ++s) {
      benchmark::DoNotOptimize(field.Sample(p_WQ.col(s)));
    }
  }
  CountQueries(p_WQ.cols(), state);
}

void LazyBatched(benchmark::State& state, int num_arms, const StaticSolids& exact) {
  const sdf::CompositeField composite = CubesInARoom(static_cast<int>(state.range(0)), exact);
  const sdf::PlacedComposite field = composite.PlacedAt(EpisodeTime(0));
  const sdf::PointColumns p_WQ = ArmPoints(num_arms);
  sdf::SampleColumns samples;
  for (auto _ : state) {
    field.SampleMany(p_WQ, samples);
    benchmark::DoNotOptimize(samples.distance_m.data());
    benchmark::ClobberMemory();
  }
  CountQueries(p_WQ.rows(), state);
}

void Place(benchmark::State& state) {
  const sdf::CompositeField composite = CubesInARoom(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(composite.PlacedAt(EpisodeTime(0)));
}

void Objects(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("objects")->Arg(0)->Arg(1)->Arg(8)->Arg(32)->Arg(128);
}
BENCHMARK_CAPTURE(Lazy, far, 256, StaticSolids())
    ->Name("query/lazy")
    ->Apply(Objects)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(LazyBatched, far, 256, StaticSolids())
    ->Name("query/lazy_batched")
    ->Apply(Objects)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Lazy, near, 1, StaticSolids())->Name("query/lazy_one_arm")->Apply(Objects);
BENCHMARK_CAPTURE(LazyBatched, near, 1, StaticSolids())
    ->Name("query/lazy_batched_one_arm")
    ->Apply(Objects);
BENCHMARK_CAPTURE(Lazy, floor, 1, Floor())->Name("query/lazy_one_arm_floor")->Apply(Objects);
BENCHMARK_CAPTURE(LazyBatched, floor, 1, Floor())
    ->Name("query/lazy_batched_one_arm_floor")
    ->Apply(Objects);
BENCHMARK(Place)->Name("composite/place")->Apply(Objects);

// The pillar on its way through the room, a cell a step.
std::vector<sdf::MovingField> Pillar(int n) {
  const double cell_m = kRoom_m / n;
  OccupancyGrid shape(GridSpec{Eigen::Vector3d::Zero(), cell_m, {1, 1, 1}});
  for (int a = 0; a < 3; ++a) {
    shape.spec.size[static_cast<std::size_t>(a)] =
        static_cast<int>(std::lround(kPillarSize_m(a) / cell_m));
  }
  shape.cells.assign(shape.spec.num_cells(), 1);
  const auto field_O =
      std::make_shared<const sdf::SdfGrid>(sdf::MakeObjectField(shape, 10 * cell_m));
  return {{field_O, [cell_m](EpisodeTime t) {
             return Pose::Translation(kPillar + Eigen::Vector3d(cell_m / 2, 0, cell_m / 2) +
                                      Eigen::Vector3d(0, t.seconds() * cell_m, 0));
           }}};
}

EpisodeTime Step(int step, int n) { return EpisodeTime(step % (n / 2)); }

void Copy(benchmark::State& state) {
  const auto room = RoomField(static_cast<int>(state.range(0)));
  sdf::AlignedVector<float> copy = room->distance_m();
  for (auto _ : state) {
    std::copy(room->distance_m().begin(), room->distance_m().end(), copy.begin());
    benchmark::DoNotOptimize(copy.data());
    benchmark::ClobberMemory();
  }
}

void Dense(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const auto room = RoomField(n);
  const std::vector<sdf::MovingField> pillar = Pillar(n);
  sdf::AlignedVector<float> distance_m = room->distance_m();
  int step = 0;
  for (auto _ : state) {
    sdf::ComposeDense(*room, pillar, Step(step++, n), distance_m);
    benchmark::DoNotOptimize(distance_m.data());
    benchmark::ClobberMemory();
  }
}

void Incremental(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  sdf::DenseSteps steps(RoomField(n), Pillar(n));
  int step = 0;
  for (auto _ : state) benchmark::DoNotOptimize(steps.At(Step(step++, n)));
}

void Sizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->Arg(96)->Arg(256)->Unit(benchmark::kMillisecond);
}
BENCHMARK(Copy)->Name("composite/copy")->Apply(Sizes);
BENCHMARK(Dense)->Name("composite/dense")->Apply(Sizes);
BENCHMARK(Incremental)->Name("composite/incremental")->Apply(Sizes);

}  // namespace
}  // namespace sidestep::bench
