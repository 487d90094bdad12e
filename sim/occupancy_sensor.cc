#include "sidestep/sim/occupancy_sensor.h"

#include <utility>

#include "sidestep/sim/noisy_occupancy.h"

namespace sidestep::sim {
namespace {

OccupancyGrid CheckedGrid(const GridSpec& spec) {
  CheckGridSpec(spec);
  return OccupancyGrid(spec);
}

}  // namespace

OccupancySensor::OccupancySensor(const World& world, const GridSpec& spec, double rate_hz,
                                 CellRule rule)
    : world_(world),
      clock_(rate_hz),
      rasteriser_(world.model(), rule),
      geoms_(FindWorldGeoms(world.model())),
      fixed_(CheckedGrid(spec)) {
  std::vector<std::size_t> cells;
  for (const int geom : geoms_.fixed) {
    const std::vector<std::size_t> filled = rasteriser_.Fill(world.data(), geom, &fixed_);
    cells.insert(cells.end(), filled.begin(), filled.end());
  }
  fixed_points_.resize(3, static_cast<Eigen::Index>(cells.size()));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    fixed_points_.col(static_cast<Eigen::Index>(i)) = spec.CenterOf(cells[i]);
  }
}

std::optional<Scan> OccupancySensor::Read(EpisodeTime) {
  if (!clock_.Take(world_.ticks())) return std::nullopt;

  std::vector<std::size_t> cells;
  for (const int geom : geoms_.moving) {
    const std::vector<std::size_t> filled = rasteriser_.Fill(world_.data(), geom, &fixed_);
    cells.insert(cells.end(), filled.begin(), filled.end());
  }
  for (const std::size_t cell : cells) fixed_.cells[cell] = 0;

  Scan scan;
  scan.t = world_.time();
  scan.p_CP.resize(3, fixed_points_.cols() + static_cast<Eigen::Index>(cells.size()));
  scan.p_CP.leftCols(fixed_points_.cols()) = fixed_points_;
  std::array<int, 3> at = {0, 0, 0};
  for (std::size_t n = 0; n < cells.size(); ++n) {
    // Most follow each other in a row, and divisions take long.
    const bool follows = n > 0 && cells[n] == cells[n - 1] + 1 && at[0] + 1 < fixed_.spec.size[0];
    if (follows) {
      ++at[0];
    } else {
      at = fixed_.spec.CellAt(cells[n]);
    }
    scan.p_CP.col(fixed_points_.cols() + static_cast<Eigen::Index>(n)) =
        fixed_.spec.Center(at[0], at[1], at[2]);
  }
  return scan;
}

std::unique_ptr<robot::Sensor> MakeOccupancySensor(const scenarios::Scenario& scenario,
                                                   const World& world) {
  const scenarios::SensorSettings& settings = scenario.sensor;
  std::unique_ptr<robot::Sensor> sensor =
      std::make_unique<OccupancySensor>(world, scenario.grid, settings.rate_hz, settings.cells);
  if (!settings.noise) return sensor;
  return std::make_unique<NoisyOccupancy>(std::move(sensor), scenario.grid, *settings.noise,
                                          scenario.seed);
}

}  // namespace sidestep::sim
