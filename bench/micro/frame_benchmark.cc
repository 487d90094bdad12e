// What one scan costs, from its points to objects and tracks: frame/rasterise_segment_track/N of
// solids, frame/depth_image/N/evidence of a depth image of 160 x 120 pixels, taken at its word or
// weighed.
//
// The pillar of the furnished room walks to and fro along y at 30 scans a second; the room rests.
// The tracker knows both already.

#include <benchmark/benchmark.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "sidestep/bench/micro/furnished_room.h"
#include "sidestep/core/random.h"
#include "sidestep/sdf/map/cells_on_line.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::bench {
namespace {

constexpr double kScanPeriod_s = 1.0 / 30;

// The pose of a camera whose image is upright: x to the right, y down, z forward.
Pose LookingAt(const Eigen::Vector3d& p_WCamera, const Eigen::Vector3d& p_WMiddle) {
  const Eigen::Vector3d forward = (p_WMiddle - p_WCamera).normalized();
  const Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  Eigen::Matrix3d R_WC;
  R_WC << right, forward.cross(right), forward;
  return Pose(Eigen::Quaterniond(R_WC), p_WCamera);
}

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

// What a camera sees of the same, from a corner under the ceiling.
std::vector<Scan> RoundOfImages(int n, double noise_per_m) {
  const GridSpec grid = RoomGrid(n);
  const Pose X_WC = LookingAt(Eigen::Vector3d(3.7, 3.7, 2.2), Eigen::Vector3d(1.6, 1.6, 0.6));
  RandomStream random(1, "depth");
  std::vector<Scan> scans;
  for (Scan& solid : Round(n)) {
    OccupancyGrid filled(grid);
    for (Eigen::Index c = 0; c < solid.p_CP.cols(); ++c) {
      const auto [i, j, k] = grid.CellOf(solid.p_CP.col(c));
      filled.cells[grid.Index(i, j, k)] = 1;
    }
    Scan& scan = scans.emplace_back();
    std::vector<Eigen::Vector3d> hits, free_ends;
    for (int v = 0; v < 120; ++v) {
      for (int u = 0; u < 160; ++u) {
        const Eigen::Vector3d ray_C((u - 79.5) / 117, (v - 59.5) / 117, 1);
        const double reach_m = 6;
        std::optional<double> part;
        sdf::VisitCellsOnLine(grid, X_WC.translation(), X_WC * (reach_m * ray_C),
                              [&](std::size_t cell, double enter, double leave) {
                                if (filled.cells[cell] != 0) part = (enter + leave) / 2;
                                return !part;
                              });
        const double z_m = part.value_or(1) * reach_m;
        if (!part) {
          free_ends.push_back(ray_C * z_m);
          continue;
        }
        hits.push_back(ray_C * z_m * (1 + noise_per_m * z_m * random.Normal()));
        scan.rays.push_back(160 * v + u);
      }
    }
    scan.kind = ScanKind::kSurface;
    scan.sensor = "camera";
    scan.X_WC = X_WC;
    const auto columns = [](const std::vector<Eigen::Vector3d>& points) {
      Eigen::Matrix3Xd all(3, static_cast<Eigen::Index>(points.size()));
      for (std::size_t c = 0; c < points.size(); ++c) {
        all.col(static_cast<Eigen::Index>(c)) = points[c];
      }
      return all;
    };
    scan.p_CP = columns(hits);
    scan.p_CFree = columns(free_ends);
  }
  return scans;
}

void Watch(benchmark::State& state, std::vector<Scan> scans,
           const sdf::WorldModelOptions& options) {
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
void Frame(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  sdf::WorldModelOptions options;
  options.grid = RoomGrid(n);
  options.max_distance_m = 0.4;
  Watch(state, Round(n), options);
}
BENCHMARK(Frame)
    ->Name("frame/rasterise_segment_track")
    ->Arg(96)
    ->Arg(256)
    ->Unit(benchmark::kMillisecond);

void DepthImage(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const double noise_per_m = 0.002;
  sdf::WorldModelOptions options;
  options.grid = RoomGrid(n);
  options.max_distance_m = 0.4;
  if (state.range(1) != 0) {
    options.evidence = {0.7, 1.4, -2.8, 2.8, 60, 30, 4, 60, 6};
    options.views["camera"].noise_per_m = noise_per_m;
  }
  Watch(state, RoundOfImages(n, noise_per_m), options);
}
BENCHMARK(DepthImage)
    ->Name("frame/depth_image")
    ->ArgNames({"", "evidence"})
    ->Args({96, 0})
    ->Args({96, 1})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace sidestep::bench
