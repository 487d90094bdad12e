#include "sim/occupancy_sensor.h"

#include <stdexcept>

namespace sidestep {
namespace {

Eigen::Vector3d CenterOf(const GridSpec& spec, std::size_t cell) {
  const auto nx = static_cast<std::size_t>(spec.size[0]);
  const auto ny = static_cast<std::size_t>(spec.size[1]);
  return spec.Center(static_cast<int>(cell % nx), static_cast<int>(cell / nx % ny),
                     static_cast<int>(cell / nx / ny));
}

OccupancyGrid CheckedGrid(const GridSpec& spec) {
  CheckGridSpec(spec);
  return OccupancyGrid(spec);
}

}  // namespace

OccupancySensor::OccupancySensor(const World& world, const GridSpec& spec, double rate_hz)
    : world_(world),
      rate_hz_(rate_hz),
      rasteriser_(world.model()),
      geoms_(FindWorldGeoms(world.model())),
      fixed_(CheckedGrid(spec)) {
  if (!(rate_hz > 0)) throw std::invalid_argument("OccupancySensor: the rate must be > 0");
  std::vector<std::size_t> cells;
  for (const int geom : geoms_.fixed) {
    const std::vector<std::size_t> filled = rasteriser_.Fill(world.data(), geom, &fixed_);
    cells.insert(cells.end(), filled.begin(), filled.end());
  }
  fixed_points_.resize(3, static_cast<Eigen::Index>(cells.size()));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    fixed_points_.col(static_cast<Eigen::Index>(i)) = CenterOf(spec, cells[i]);
  }
}

std::int64_t OccupancySensor::TickOfCapture(std::int64_t k) const {
  return World::TickNotBefore(EpisodeTime(static_cast<double>(k) / rate_hz_));
}

EpisodeTime OccupancySensor::NextCapture() const { return World::TimeOf(TickOfCapture(next_)); }

std::optional<Scan> OccupancySensor::Read() {
  if (world_.ticks() < TickOfCapture(next_)) return std::nullopt;
  while (TickOfCapture(next_) <= world_.ticks()) ++next_;

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
  for (std::size_t i = 0; i < cells.size(); ++i) {
    scan.p_CP.col(fixed_points_.cols() + static_cast<Eigen::Index>(i)) =
        CenterOf(fixed_.spec, cells[i]);
  }
  return scan;
}

}  // namespace sidestep
