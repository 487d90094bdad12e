#include "sidestep/sim/noisy_occupancy.h"

#include <cmath>
#include <utility>
#include <vector>

namespace sidestep::sim {
namespace {

// How many trials fail before the next success, if each succeeds with probability p > 0; so most
// trials need no random number of their own.
std::size_t Failures(double p, std::size_t most, RandomStream& random) {
  if (p >= 1) return 0;
  const double count = std::floor(std::log1p(-random.Uniform()) / std::log1p(-p));
  return count < static_cast<double>(most) ? static_cast<std::size_t>(count) : most;
}

}  // namespace

NoisyOccupancy::NoisyOccupancy(std::unique_ptr<robot::Sensor> sensor, const GridSpec& grid,
                               const scenarios::OccupancyNoise& noise, std::uint64_t seed)
    : sensor_(std::move(sensor)),
      grid_(grid),
      noise_(noise),
      false_free_(seed, "occupancy false_free"),
      position_(seed, "occupancy position"),
      false_filled_(seed, "occupancy false_filled") {}

std::optional<Scan> NoisyOccupancy::Read(EpisodeTime now) {
  std::optional<Scan> scan = sensor_->Read(now);
  if (!scan) return scan;
  OccupancyGrid filled(grid_);
  std::vector<Eigen::Vector3d> points;
  for (Eigen::Index n = 0; n < scan->p_CP.cols(); ++n) {
    const Eigen::Vector3d p_CP = scan->p_CP.col(n);
    const auto [i, j, k] = grid_.CellOf(scan->X_WC * p_CP);
    if (grid_.Contains(i, j, k)) filled.cells[grid_.Index(i, j, k)] = 1;
    if (noise_.false_free > 0 && false_free_.Uniform() < noise_.false_free) continue;
    points.push_back(p_CP);
    if (noise_.position_noise_m > 0) {
      for (double& x : points.back()) x += noise_.position_noise_m * position_.Normal();
    }
  }
  if (noise_.false_filled > 0) {
    const std::size_t end = filled.cells.size();
    const auto next = [&](std::size_t from) {
      return from + Failures(noise_.false_filled, end - from, false_filled_);
    };
    for (std::size_t cell = next(0); cell < end; cell = next(cell + 1)) {
      if (filled.cells[cell] == 0) points.push_back(scan->X_WC.Inverse() * grid_.CenterOf(cell));
    }
  }
  scan->p_CP.resize(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n) {
    scan->p_CP.col(static_cast<Eigen::Index>(n)) = points[n];
  }
  return scan;
}

}  // namespace sidestep::sim
