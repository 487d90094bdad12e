#include "sidestep/sim/tag_camera.h"

#include "sidestep/core/rotation_vector.h"
#include "sidestep/sim/static_cells.h"

namespace sidestep::sim {
namespace {

// Standard deviations along three axes as a covariance in W: across the line of sight, and along.
Eigen::Matrix3d SightCovariance(const Eigen::Vector3d& sight_W,
                                const scenarios::TagSettings& settings) {
  const double d = sight_W.norm();
  const Eigen::Vector3d u = sight_W / d;
  const double across = settings.across_noise * d, along = settings.along_noise_per_m * d * d;
  const Eigen::Matrix3d along_W = u * u.transpose();
  return across * across * (Eigen::Matrix3d::Identity() - along_W) + along * along * along_W;
}

Eigen::Vector3d Normal3(RandomStream& random) {
  const double x = random.Normal(), y = random.Normal(), z = random.Normal();
  return {x, y, z};
}

}  // namespace

TagCamera::TagCamera(const World& world, const GridSpec& grid,
                     const scenarios::TagSettings& settings, double rate_hz, CellRule rule,
                     std::uint64_t seed)
    : world_(world),
      settings_(settings),
      clock_(rate_hz),
      caster_(world.model()),
      p_WStatic_(StaticCells(world, grid, rule)),
      random_(seed, "tags") {}

bool TagCamera::Sees(const scenarios::MovingObstacle& obstacle, const Pose& X_WO) const {
  const Eigen::Vector3d sight_W = X_WO.translation() - settings_.position_m;
  const double d = sight_W.norm();
  if (!(d > 0) || d > settings_.range_m) return false;
  const auto hit = caster_.Cast(world_.data(), settings_.position_m, sight_W / d);
  return !hit || hit->distance_m >= d || GeomOwner(world_.model(), hit->geom) == obstacle.name;
}

ObjectObservation TagCamera::Measure(const scenarios::MovingObstacle& obstacle, const Pose& X_WO) {
  const Eigen::Vector3d sight_W = X_WO.translation() - settings_.position_m;
  const double d = sight_W.norm();
  const Eigen::Vector3d u = sight_W / d;
  const Eigen::Vector3d noise = Normal3(random_);
  const Eigen::Vector3d along = u * u.dot(noise);
  const Eigen::Vector3d error_m =
      settings_.across_noise * d * (noise - along) + settings_.along_noise_per_m * d * d * along;
  const Eigen::Vector3d turn_rad = settings_.rotation_noise_rad * Normal3(random_);

  ObjectObservation observation;
  observation.id = obstacle.name;
  observation.t = world_.time();
  observation.X_WO = Pose(X_WO.rotation() * RotationBy(turn_rad), X_WO.translation() + error_m);
  observation.covariance.topLeftCorner<3, 3>() =
      SightCovariance(observation.X_WO.translation() - settings_.position_m, settings_);
  observation.covariance.bottomRightCorner<3, 3>().diagonal().setConstant(
      settings_.rotation_noise_rad * settings_.rotation_noise_rad);
  observation.shape = obstacle.shape;
  return observation;
}

std::optional<Scan> TagCamera::Read(EpisodeTime) {
  if (!clock_.Take(world_.ticks())) return std::nullopt;
  Scan scan;
  scan.t = world_.time();
  scan.p_CP = p_WStatic_;
  for (const scenarios::MovingObstacle& obstacle : world_.obstacles()) {
    const Pose X_WO = PoseAt(obstacle, scan.t);
    if (Sees(obstacle, X_WO)) scan.objects.push_back(Measure(obstacle, X_WO));
  }
  return scan;
}

std::unique_ptr<robot::Sensor> MakeTagCamera(const scenarios::Scenario& scenario,
                                             const World& world) {
  return std::make_unique<TagCamera>(world, scenario.grid, scenario.sensor.tags.value(),
                                     scenario.sensor.rate_hz, scenario.sensor.cells, scenario.seed);
}

}  // namespace sidestep::sim
