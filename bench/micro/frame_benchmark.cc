// What one scan costs, from its points to objects and tracks: frame/rasterise_segment_track/N.
//
// The pillar of the furnished room walks to and fro along y at 30 scans a second; the room rests.
// The tracker knows both already.

#include <benchmark/benchmark.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "sidestep/bench/micro/furnished_room.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::bench {
namespace {

constexpr double kScanPeriod_s = 1.0 / 30;

Eigen::Matrix3Xd CentersOf(const OccupancyGrid& grid) {
  Eigen::Matrix3Xd p_WP(3, static_cast<Eigen::Index>(grid.CountFilled()));
  Eigen::Index n = 0;
  for (int k = 0; k < grid.spec.size[2]; ++k) {
    for (int j = 0; j < grid.spec.size[1]; ++j) {
      for (int i = 0; i < grid.spec.size[0]; ++i) {
        if (grid.At(i, j, k)) p_WP.col(n++) = grid.spec.Center(i, j, k);
      }
    }
  }
  return p_WP;
}

// The pillar on its way to y = 3.4 m and back, at 1 m/s. What rests comes first in each scan.
std::vector<Scan> Round(int n) {
  const Eigen::Matrix3Xd room = CentersOf(FurnishedRoom(n, {}));
  std::vector<Scan> scans;
  constexpr int kSteps = 90;
  for (int step = 0; step < 2 * kSteps; ++step) {
    const double y_m = 0.4 + kScanPeriod_s * (step < kSteps ? step : 2 * kSteps - step);
    OccupancyGrid pillar = FurnishedRoom(n, Eigen::Vector3d(1.76, y_m, 0));
    const OccupancyGrid empty_room = FurnishedRoom(n, {});
    for (std::size_t c = 0; c < pillar.cells.size(); ++c) pillar.cells[c] ^= empty_room.cells[c];
    const Eigen::Matrix3Xd moving = CentersOf(pillar);
    Scan& scan = scans.emplace_back();
    scan.p_CP.resize(3, room.cols() + moving.cols());
    scan.p_CP << room, moving;
  }
  return scans;
}

void Frame(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  std::vector<Scan> scans = Round(n);
  sdf::WorldModelOptions options;
  options.grid = RoomGrid(n);
  options.max_distance_m = 0.4;
  const auto world = sdf::MakeWorldModel(options);
  std::size_t frame = 0;
  const auto observe = [&] {
    Scan& scan = scans[frame % scans.size()];
    scan.t = EpisodeTime(static_cast<double>(frame++) * kScanPeriod_s);
    world->Observe(scan);
  };
  while (frame < scans.size()) observe();
  world->TakeTimes();
  for (auto _ : state) observe();
  const sdf::WorldModelTimes times = world->TakeTimes();
  const auto microseconds = [&](double seconds) {
    return benchmark::Counter(1e6 * seconds, benchmark::Counter::kAvgIterations);
  };
  state.counters["map_us"] = microseconds(times.map_s);
  state.counters["segment_us"] = microseconds(times.segment_s);
  state.counters["track_us"] = microseconds(times.track_s);
  state.counters["objects"] =
      static_cast<double>((world->MakeField(), world->DescribeObjects({EpisodeTime(0)}).size()));
}
BENCHMARK(Frame)
    ->Name("frame/rasterise_segment_track")
    ->Arg(96)
    ->Arg(256)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sidestep::bench
