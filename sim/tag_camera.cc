#include "sidestep/sim/tag_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

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

// A point in a ball about the origin, evenly.
Eigen::Vector3d InBall(double radius_m, RandomStream& random) {
  Eigen::Vector3d p;
  do {
    for (double& x : p) x = random.Uniform(-1, 1);
  } while (p.norm() > 1);
  return radius_m * p;
}

// A vector across `sight_W`, of any direction.
Eigen::Vector3d Across(const Eigen::Vector3d& sight_W, double length_m, RandomStream& random) {
  const double angle = random.Uniform(-std::numbers::pi, std::numbers::pi);
  const Eigen::Vector3d right = sight_W.unitOrthogonal();
  const Eigen::Vector3d up = sight_W.normalized().cross(right);
  return length_m * (std::cos(angle) * right + std::sin(angle) * up);
}

// The other pose that explains a tag in the middle of the face that looks at the camera.
Pose Flipped(const Pose& X_WO, const Shape& shape, const Eigen::Vector3d& p_WCamera) {
  const Eigen::Vector3d to_camera = (p_WCamera - X_WO.translation()).normalized();
  const Eigen::Vector3d to_camera_O = X_WO.rotation().conjugate() * to_camera;
  Eigen::Index axis = 0;
  to_camera_O.cwiseAbs().maxCoeff(&axis);
  const Eigen::Vector3d outward_O =
      std::copysign(1.0, to_camera_O(axis)) * Eigen::Vector3d::Unit(axis);
  const Eigen::Vector3d n = X_WO.rotation() * outward_O;
  const Eigen::Vector3d p_WFace = X_WO.translation() + HalfExtents(shape)(axis) * n;
  const Eigen::Vector3d sight = (p_WCamera - p_WFace).normalized();
  const Eigen::Vector3d turn_axis = n.cross(sight);
  if (turn_axis.norm() < 1e-9) return X_WO;  // Frontal: the two poses are one.
  const double lean = std::atan2(turn_axis.norm(), n.dot(sight));
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(2 * lean, turn_axis.normalized()));
  return {turn * X_WO.rotation(), p_WFace - HalfExtents(shape)(axis) * (turn * n)};
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
      grid_(grid),
      random_(seed, "tags"),
      hidden_(seed, "tags hidden"),
      flips_(seed, "tags flips"),
      outliers_(seed, "tags outliers"),
      swaps_(seed, "tags swaps"),
      phantoms_(seed, "tags phantoms") {}

bool TagCamera::IsInSight(const scenarios::MovingObstacle& obstacle,
                          const Eigen::Vector3d& p_W) const {
  const Eigen::Vector3d sight_W = p_W - settings_.position_m;
  const double d = sight_W.norm();
  const auto hit = caster_.Cast(world_.data(), settings_.position_m, sight_W / d);
  return !hit || hit->distance_m >= d || GeomOwner(world_.model(), hit->geom) == obstacle.name;
}

double TagCamera::ShareInSight(const scenarios::MovingObstacle& obstacle, const Pose& X_WO) const {
  const Eigen::Vector3d sight_W = X_WO.translation() - settings_.position_m;
  const double d = sight_W.norm();
  if (!(d > 0) || d > settings_.range_m) return 0;
  const double middle = IsInSight(obstacle, X_WO.translation()) ? 1 : 0;
  if (settings_.size_m == 0) return middle;
  // Upright, as far as it can be.
  Eigen::Vector3d right = sight_W.cross(Eigen::Vector3d::UnitZ());
  right = right.norm() < 1e-6 * d ? Eigen::Vector3d::UnitX() : right.normalized();
  const Eigen::Vector3d up = right.cross(sight_W / d);
  double in_sight = middle;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      const Eigen::Vector3d corner = settings_.size_m * (x * right + y * up);
      in_sight += IsInSight(obstacle, X_WO.translation() + corner) ? 1 : 0;
    }
  }
  return in_sight / 5;
}

bool TagCamera::Finds(const scenarios::MovingObstacle& obstacle, const Pose& X_WO, bool* is_whole) {
  const double share = ShareInSight(obstacle, X_WO);
  *is_whole = share == 1;
  if (share == 0 || share == 1) return share == 1;
  return settings_.partly_hidden > 0 && hidden_.Uniform() < settings_.partly_hidden;
}

void TagCamera::Misplace(bool is_whole, ObjectObservation* observation) {
  Pose& X_WO = observation->X_WO;
  if (!is_whole) {
    const Eigen::Vector3d sight_W = X_WO.translation() - settings_.position_m;
    const double off_m = settings_.size_m / 2 * hidden_.Uniform();
    X_WO = Pose(X_WO.rotation(), X_WO.translation() + Across(sight_W, off_m, hidden_));
  }
  if (settings_.flips > 0 && flips_.Uniform() < settings_.flips) {
    X_WO = Flipped(X_WO, observation->shape, settings_.position_m);
  }
  if (settings_.outliers > 0 && outliers_.Uniform() < settings_.outliers) {
    X_WO = Pose(X_WO.rotation(), X_WO.translation() + InBall(settings_.outlier_m, outliers_));
  }
}

void TagCamera::Swap(std::vector<ObjectObservation>* objects) {
  if (settings_.swaps == 0 || objects->size() < 2 || swaps_.Uniform() >= settings_.swaps) return;
  const auto any = [&](std::size_t count) {
    return std::min(static_cast<std::size_t>(swaps_.Uniform() * static_cast<double>(count)),
                    count - 1);
  };
  const std::size_t a = any(objects->size());
  std::size_t b = any(objects->size() - 1);
  if (b >= a) ++b;
  std::swap((*objects)[a].X_WO, (*objects)[b].X_WO);
  std::swap((*objects)[a].covariance, (*objects)[b].covariance);
}

// Somewhere in the grid, turned about z as may be, under the name of any obstacle.
void TagCamera::AddPhantom(std::vector<ObjectObservation>* objects) {
  const std::vector<scenarios::MovingObstacle>& known = world_.obstacles();
  if (settings_.phantoms == 0 || known.empty() || phantoms_.Uniform() >= settings_.phantoms) return;
  const double which = phantoms_.Uniform() * static_cast<double>(known.size());
  Eigen::Vector3d p_W = grid_.first_center_m;
  for (int a = 0; a < 3; ++a) {
    p_W(a) += grid_.cell_m * grid_.size[static_cast<std::size_t>(a)] * phantoms_.Uniform();
  }
  const double yaw_rad = phantoms_.Uniform(-std::numbers::pi, std::numbers::pi);
  objects->push_back(Measure(known[std::min(static_cast<std::size_t>(which), known.size() - 1)],
                             Pose::FromRollPitchYaw({0, 0, yaw_rad}, p_W), &phantoms_));
}

ObjectObservation TagCamera::Measure(const scenarios::MovingObstacle& obstacle, const Pose& X_WO,
                                     RandomStream* random) const {
  const Eigen::Vector3d sight_W = X_WO.translation() - settings_.position_m;
  const double d = sight_W.norm();
  const Eigen::Vector3d u = sight_W / d;
  const Eigen::Vector3d noise = Normal3(*random);
  const Eigen::Vector3d along = u * u.dot(noise);
  const Eigen::Vector3d error_m =
      settings_.across_noise * d * (noise - along) + settings_.along_noise_per_m * d * d * along;
  const Eigen::Vector3d turn_rad = settings_.rotation_noise_rad * Normal3(*random);

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
    bool is_whole = true;
    if (!Finds(obstacle, X_WO, &is_whole)) continue;
    scan.objects.push_back(Measure(obstacle, X_WO, &random_));
    Misplace(is_whole, &scan.objects.back());
  }
  Swap(&scan.objects);
  AddPhantom(&scan.objects);
  return scan;
}

std::unique_ptr<robot::Sensor> MakeTagCamera(const scenarios::Scenario& scenario,
                                             const World& world) {
  return std::make_unique<TagCamera>(world, scenario.grid, scenario.sensor.tags.value(),
                                     scenario.sensor.rate_hz, scenario.sensor.cells, scenario.seed);
}

}  // namespace sidestep::sim
