#include "sidestep/scenarios/sensor_settings.h"

#include <algorithm>

#include "sidestep/core/yaml_reader.h"
#include "sidestep/scenarios/yaml_text.h"

namespace sidestep::scenarios {
namespace {

// Bounds against slips of the pen, generous for any sensor.
constexpr double kMaxRateHz = 1000, kMaxDelay = 10, kMaxNoise = 1;
constexpr int kMaxPixels = 2048;
constexpr double kMaxTag_m = 2, kMaxOutlier_m = 10;
constexpr double kMaxDistortion = 1, kMaxExposure = 0.1, kMaxBlur = 10, kMaxGreyNoise = 100;

double AtMost(const YamlReader& map, const char* key, double otherwise, double most) {
  if (!map.Has(key)) return otherwise;
  const double value = map.GetNonNegative(key);
  if (value > most) map.Fail(key, "must be at most " + Number(most) + ", is " + Number(value));
  return value;
}

double PositiveAtMost(const YamlReader& map, const char* key, double otherwise, double most) {
  if (!map.Has(key)) return otherwise;
  map.GetPositive(key);
  return AtMost(map, key, otherwise, most);
}

int Pixels(const YamlReader& map, const char* key, int otherwise) {
  if (!map.Has(key)) return otherwise;
  const int value = map.GetInt(key);
  if (value < 1 || value > kMaxPixels) {
    map.Fail(key,
             "must be from 1 to " + std::to_string(kMaxPixels) + ", is " + std::to_string(value));
  }
  return value;
}

OccupancyNoise ReadNoise(const YamlReader& map) {
  OccupancyNoise noise;
  noise.false_filled = AtMost(map, "false_filled", noise.false_filled, 1);
  noise.false_free = AtMost(map, "false_free", noise.false_free, 1);
  noise.position_noise_m = AtMost(map, "position_noise_m", noise.position_noise_m, kMaxNoise);
  map.CheckNoUnknownKeys();
  return noise;
}

// Where a camera stands and looks.
template <class Settings>
void ReadView(const YamlReader& map, Settings* camera) {
  camera->position_m = map.GetVector3("position_m");
  camera->look_at_m = map.GetVector3("look_at_m");
  if (!((camera->look_at_m - camera->position_m).norm() > 1e-6)) {
    map.Fail("look_at_m", "must differ from position_m", "position_m");
  }
}

CameraSettings ReadCamera(const YamlReader& map) {
  CameraSettings camera;
  ReadView(map, &camera);
  camera.field_of_view_rad = PositiveAtMost(map, "field_of_view_rad", camera.field_of_view_rad, 3);
  camera.width = Pixels(map, "width", camera.width);
  camera.height = Pixels(map, "height", camera.height);
  camera.range_m = PositiveAtMost(map, "range_m", camera.range_m, 100);
  camera.noise_per_m = AtMost(map, "noise_per_m", camera.noise_per_m, kMaxNoise);
  camera.pixel_dropout = AtMost(map, "pixel_dropout", camera.pixel_dropout, 1);
  if (map.Has("unseen")) {
    camera.unseen = map.GetChoice("unseen", {"free", "filled", "remembered"});
  }
  map.CheckNoUnknownKeys();
  return camera;
}

TagSettings ReadTags(const YamlReader& map) {
  TagSettings tags;
  tags.position_m = map.GetVector3("position_m");
  tags.across_noise = AtMost(map, "across_noise", tags.across_noise, kMaxNoise);
  tags.along_noise_per_m = AtMost(map, "along_noise_per_m", tags.along_noise_per_m, kMaxNoise);
  tags.rotation_noise_rad = AtMost(map, "rotation_noise_rad", tags.rotation_noise_rad, kMaxNoise);
  tags.range_m = PositiveAtMost(map, "range_m", tags.range_m, 100);
  tags.size_m = AtMost(map, "size_m", tags.size_m, kMaxTag_m);
  tags.partly_hidden = AtMost(map, "partly_hidden", tags.partly_hidden, 1);
  tags.flips = AtMost(map, "flips", tags.flips, 1);
  tags.outliers = AtMost(map, "outliers", tags.outliers, 1);
  tags.outlier_m = PositiveAtMost(map, "outlier_m", tags.outlier_m, kMaxOutlier_m);
  tags.swaps = AtMost(map, "swaps", tags.swaps, 1);
  tags.phantoms = AtMost(map, "phantoms", tags.phantoms, 1);
  map.CheckNoUnknownKeys();
  return tags;
}

TagImageSettings ReadTagImages(const YamlReader& map) {
  TagImageSettings images;
  ReadView(map, &images);
  images.field_of_view_rad = PositiveAtMost(map, "field_of_view_rad", images.field_of_view_rad, 2);
  images.width = Pixels(map, "width", images.width);
  images.height = Pixels(map, "height", images.height);
  if (map.Has("distortion")) {
    const Eigen::VectorXd distortion = map.GetVector("distortion", 5);
    if (distortion.cwiseAbs().maxCoeff() > kMaxDistortion) {
      map.Fail("distortion", "must be numbers from -1 to 1");
    }
    std::copy(distortion.begin(), distortion.end(), images.distortion.begin());
  }
  images.exposure_s = AtMost(map, "exposure_s", images.exposure_s, kMaxExposure);
  images.blur_px = AtMost(map, "blur_px", images.blur_px, kMaxBlur);
  images.grey_noise = AtMost(map, "grey_noise", images.grey_noise, kMaxGreyNoise);
  map.CheckNoUnknownKeys();
  return images;
}

}  // namespace

Pose PoseOfCamera(const Eigen::Vector3d& position_m, const Eigen::Vector3d& look_at_m) {
  const Eigen::Vector3d forward = (look_at_m - position_m).normalized();
  Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ());
  if (right.norm() < 1e-6) right = Eigen::Vector3d::UnitX();
  right.normalize();
  Eigen::Matrix3d R_WC;
  R_WC << right, forward.cross(right), forward;
  return Pose(Eigen::Quaterniond(R_WC), position_m);
}

SensorSettings ReadSensorSettings(const YamlReader& map) {
  SensorSettings settings;
  settings.name = map.GetString("name");
  settings.rate_hz = map.GetPositive("rate_hz");
  if (settings.rate_hz > kMaxRateHz) map.Fail("rate_hz", "must be at most 1000");
  if (map.Has("cells")) {
    const bool centre = map.GetChoice("cells", {"touched", "centre"}) == "centre";
    settings.cells = centre ? CellRule::kCentre : CellRule::kTouched;
  }
  settings.latency_s = AtMost(map, "latency_s", 0, kMaxDelay);
  settings.jitter_s = AtMost(map, "jitter_s", 0, kMaxDelay);
  settings.dropout = AtMost(map, "dropout", 0, 1);
  if (map.Has("noise")) settings.noise = ReadNoise(map.GetMap("noise"));
  if (map.Has("camera")) settings.camera = ReadCamera(map.GetMap("camera"));
  if (map.Has("tags")) settings.tags = ReadTags(map.GetMap("tags"));
  if (map.Has("tag_images")) settings.tag_images = ReadTagImages(map.GetMap("tag_images"));
  map.CheckNoUnknownKeys();
  return settings;
}

std::string ToYaml(const SensorSettings& settings) {
  std::string text = "sensor:\n  name: " + Quoted(settings.name) +
                     "\n  rate_hz: " + Number(settings.rate_hz) +
                     "\n  cells: " + (settings.cells == CellRule::kCentre ? "centre" : "touched") +
                     "\n  latency_s: " + Number(settings.latency_s) +
                     "\n  jitter_s: " + Number(settings.jitter_s) +
                     "\n  dropout: " + Number(settings.dropout) + "\n";
  if (settings.noise) {
    text += "  noise: {false_filled: " + Number(settings.noise->false_filled) +
            ", false_free: " + Number(settings.noise->false_free) +
            ", position_noise_m: " + Number(settings.noise->position_noise_m) + "}\n";
  }
  if (settings.camera) {
    const CameraSettings& camera = *settings.camera;
    text +=
        "  camera: {position_m: " + List(camera.position_m) +
        ", look_at_m: " + List(camera.look_at_m) +
        ", field_of_view_rad: " + Number(camera.field_of_view_rad) +
        ", width: " + std::to_string(camera.width) + ", height: " + std::to_string(camera.height) +
        ", range_m: " + Number(camera.range_m) + ", noise_per_m: " + Number(camera.noise_per_m) +
        ", pixel_dropout: " + Number(camera.pixel_dropout) + ", unseen: " + camera.unseen + "}\n";
  }
  if (settings.tags) {
    const TagSettings& tags = *settings.tags;
    text += "  tags: {position_m: " + List(tags.position_m) +
            ", across_noise: " + Number(tags.across_noise) +
            ", along_noise_per_m: " + Number(tags.along_noise_per_m) +
            ", rotation_noise_rad: " + Number(tags.rotation_noise_rad) +
            ", range_m: " + Number(tags.range_m) + ", size_m: " + Number(tags.size_m) +
            ", partly_hidden: " + Number(tags.partly_hidden) + ", flips: " + Number(tags.flips) +
            ", outliers: " + Number(tags.outliers) + ", outlier_m: " + Number(tags.outlier_m) +
            ", swaps: " + Number(tags.swaps) + ", phantoms: " + Number(tags.phantoms) + "}\n";
  }
  if (settings.tag_images) {
    const TagImageSettings& images = *settings.tag_images;
    const Eigen::Map<const Eigen::VectorXd> distortion(images.distortion.data(), 5);
    text += "  tag_images: {position_m: " + List(images.position_m) +
            ", look_at_m: " + List(images.look_at_m) +
            ", field_of_view_rad: " + Number(images.field_of_view_rad) +
            ", width: " + std::to_string(images.width) +
            ", height: " + std::to_string(images.height) + ", distortion: " + List(distortion) +
            ", exposure_s: " + Number(images.exposure_s) + ", blur_px: " + Number(images.blur_px) +
            ", grey_noise: " + Number(images.grey_noise) + "}\n";
  }
  return text;
}

}  // namespace sidestep::scenarios
