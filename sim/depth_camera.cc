#include "sidestep/sim/depth_camera.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
      p_WC_(settings.position_m + settings.misplaced_m),
      depth_(seed, "camera depth"),
      dropout_(seed, "camera dropout"),
      flying_(seed, "camera flying pixels") {
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
  // Depth by pixel: as it is, and whether something solid is measured there.
  constexpr double kNothing = std::numeric_limits<double>::infinity();
  std::vector<double> depths_m(rays_C_.size(), kNothing);
  std::vector<bool> is_measured(rays_C_.size(), false);
  for (std::size_t n = 0; n < rays_C_.size(); ++n) {
    const Eigen::Vector3d& ray_C = rays_C_[n];
    const auto hit = caster_.Cast(world_.data(), p_WC_, X_WC_.Rotate(ray_C).normalized());
    if (!hit || hit->distance_m / ray_C.norm() >= settings_.range_m) continue;
    depths_m[n] = hit->distance_m / ray_C.norm();
    const bool is_own = !settings_.sees_robot && caster_.IsRobot(hit->geom);
    is_measured[n] = !is_own && !caster_.IsFloor(hit->geom);
  }
  DepthImage image{settings_.width, settings_.height, depths_m};
  if (settings_.flying_pixels > 0) MakeFly(depths_m, is_measured, &image);
  std::vector<bool> is_lost(rays_C_.size(), false);
  for (std::size_t n = 0; n < rays_C_.size(); ++n) {
    // Both are drawn for each pixel, whatever it sees, so that a pixel's noise is its own.
    const double noise = settings_.noise_per_m > 0 ? depth_.Normal() : 0;
    is_lost[n] = settings_.pixel_dropout > 0 && dropout_.Uniform() < settings_.pixel_dropout;
    double& depth_m = image.depths_m[n];
    if (is_measured[n]) depth_m += settings_.noise_per_m * depth_m * depth_m * noise;
  }
  const std::vector<bool> flies = FindFlyingPixels(image, settings_.edge_m);
  Scan scan;
  std::vector<Eigen::Vector3d> hits, free_ends;
  for (std::size_t n = 0; n < rays_C_.size(); ++n) {
    if (is_lost[n]) continue;
    if (is_measured[n]) {
      if (flies[n]) continue;
      hits.push_back(rays_C_[n] * image.depths_m[n]);
      scan.rays.push_back(static_cast<int>(n));
    } else {
      free_ends.push_back(rays_C_[n] * std::min(depths_m[n], settings_.range_m));
    }
  }
  scan.t = world_.time();
  scan.kind = ScanKind::kSurface;
  scan.X_WC = X_WC_;
  scan.p_CP = Columns(hits);
  scan.p_CFree = Columns(free_ends);
  return scan;
}

void DepthCamera::MakeFly(const std::vector<double>& depths_m, std::vector<bool>& is_measured,
                          DepthImage* image) {
  const auto width = static_cast<std::size_t>(settings_.width);
  for (std::size_t n = 0; n < depths_m.size(); ++n) {
    const double share = flying_.Uniform(), draw = flying_.Uniform();
    if (draw >= settings_.flying_pixels) continue;
    std::optional<std::size_t> across;
    if ((n + 1) % width != 0 && HasEdge(depths_m[n], depths_m[n + 1])) across = n + 1;
    if (n + width < depths_m.size() && HasEdge(depths_m[n], depths_m[n + width])) {
      across = n + width;
    }
    if (!across || !(is_measured[n] || is_measured[*across])) continue;
    const double other_m = std::min(depths_m[*across], settings_.range_m);
    const double own_m = std::min(depths_m[n], settings_.range_m);
    image->depths_m[n] = own_m + share * (other_m - own_m);
    is_measured[n] = true;
  }
}

bool DepthCamera::HasEdge(double a_m, double b_m) const {
  const double far_m = std::min(std::max(a_m, b_m), settings_.range_m);
  return far_m - std::min(a_m, b_m) > settings_.edge_m;
}

std::unique_ptr<robot::Sensor> MakeDepthCamera(const scenarios::Scenario& scenario,
                                               const World& world) {
  return std::make_unique<DepthCamera>(world, scenario.sensor.camera.value(),
                                       scenario.sensor.rate_hz, scenario.seed);
}

}  // namespace sidestep::sim
