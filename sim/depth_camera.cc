#include "sidestep/sim/depth_camera.h"

#include <cmath>

namespace sidestep::sim {
namespace {

Eigen::Matrix3Xd Columns(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t n = 0; n < points.size(); ++n) {
    columns.col(static_cast<Eigen::Index>(n)) = points[n];
  }
  return columns;
}

}  // namespace

DepthCamera::DepthCamera(const World& world, const scenarios::CameraSettings& settings,
                         double rate_hz, std::uint64_t seed)
    : world_(world),
      settings_(settings),
      clock_(rate_hz),
      caster_(world.model()),
      X_WC_(scenarios::PoseOfCamera(settings.position_m, settings.look_at_m)),
      depth_(seed, "camera depth"),
      dropout_(seed, "camera dropout") {
  const double focal_px = settings.width / 2.0 / std::tan(settings.field_of_view_rad / 2);
  for (int v = 0; v < settings.height; ++v) {
    for (int u = 0; u < settings.width; ++u) {
      rays_C_.emplace_back((u + 0.5 - settings.width / 2.0) / focal_px,
                           (v + 0.5 - settings.height / 2.0) / focal_px, 1);
    }
  }
}

std::optional<Scan> DepthCamera::Read(EpisodeTime) {
  if (!clock_.Take(world_.ticks())) return std::nullopt;
  std::vector<Eigen::Vector3d> hits, free_ends;
  for (const Eigen::Vector3d& ray_C : rays_C_) {
    // Both are drawn for each pixel, whatever it sees, so that a pixel's noise is its own.
    const double noise = settings_.noise_per_m > 0 ? depth_.Normal() : 0;
    if (settings_.pixel_dropout > 0 && dropout_.Uniform() < settings_.pixel_dropout) continue;
    const auto hit =
        caster_.Cast(world_.data(), X_WC_.translation(), X_WC_.Rotate(ray_C).normalized());
    const double depth_m = hit ? hit->distance_m / ray_C.norm() : settings_.range_m;
    if (!hit || depth_m >= settings_.range_m) {
      free_ends.push_back(ray_C * settings_.range_m);
    } else if (caster_.IsFloor(hit->geom) || caster_.IsRobot(hit->geom)) {
      free_ends.push_back(ray_C * depth_m);
    } else {
      hits.push_back(ray_C * (depth_m + settings_.noise_per_m * depth_m * depth_m * noise));
    }
  }
  Scan scan;
  scan.t = world_.time();
  scan.kind = ScanKind::kSurface;
  scan.X_WC = X_WC_;
  scan.p_CP = Columns(hits);
  scan.p_CFree = Columns(free_ends);
  return scan;
}

std::unique_ptr<robot::Sensor> MakeDepthCamera(const scenarios::Scenario& scenario,
                                               const World& world) {
  return std::make_unique<DepthCamera>(world, scenario.sensor.camera.value(),
                                       scenario.sensor.rate_hz, scenario.seed);
}

}  // namespace sidestep::sim
