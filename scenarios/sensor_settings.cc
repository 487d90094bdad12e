#include "sidestep/scenarios/sensor_settings.h"

#include <algorithm>
#include <set>
#include <utility>

#include "sidestep/core/yaml_reader.h"
#include "sidestep/scenarios/bounded_number.h"
#include "sidestep/scenarios/yaml_text.h"

namespace sidestep::scenarios {
namespace {

// Bounds against slips of the pen, generous for any sensor.
constexpr double kMaxSensorRateHz = 1000, kMaxDelay = 10, kMaxNoise = 1;
constexpr int kMaxPixels = 2048;
constexpr double kMaxLogOdds = 100, kMaxDecay = 1e4, kMaxSigmas = 20;
constexpr double kMaxTag_m = 2, kMaxOutlier_m = 10;
constexpr double kMaxDistortion = 1, kMaxExposure = 0.1, kMaxBlur = 10, kMaxGreyNoise = 100;

int CountFrom1(const YamlReader& map, const char* key, int otherwise, int most) {
  if (!map.Has(key)) return otherwise;
  const int value = map.GetInt(key);
  if (value < 1 || value > most) {
    map.Fail(key, "must be from 1 to " + std::to_string(most) + ", is " + std::to_string(value));
  }
  return value;
}

int Pixels(const YamlReader& map, const char* key, int otherwise) {
  return CountFrom1(map, key, otherwise, kMaxPixels);
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
  camera.flying_pixels = AtMost(map, "flying_pixels", camera.flying_pixels, 1);
  camera.edge_m = AtMost(map, "edge_m", camera.edge_m, 100);
  if (map.Has("unseen")) {
    camera.unseen = map.GetChoice("unseen", {"free", "filled", "remembered"});
  }
  if (map.Has("sees_robot")) camera.sees_robot = map.GetBool("sees_robot");
  camera.robot_margin_m = AtMost(map, "robot_margin_m", camera.robot_margin_m, 1);
  if (map.Has("misplaced_m")) camera.misplaced_m = map.GetVector3("misplaced_m");
  map.CheckNoUnknownKeys();
  return camera;
}

TagSettings ReadTagSettings(const YamlReader& map) {
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

SensorSettings ReadSensor(const YamlReader& map) {
  SensorSettings settings;
  settings.name = map.GetString("name");
  if (map.Has("label")) {
    settings.label = map.GetString("label");
    if (settings.label.empty() || !IsPlainName(settings.label)) {
      map.Fail("label", "must be letters, digits, _ and -, is '" + settings.label + "'");
    }
  }
  settings.rate_hz = map.GetPositive("rate_hz");
  if (settings.rate_hz > kMaxSensorRateHz) map.Fail("rate_hz", "must be at most 1000");
  if (map.Has("cells")) {
    const bool centre = map.GetChoice("cells", {"touched", "centre"}) == "centre";
    settings.cells = centre ? CellRule::kCentre : CellRule::kTouched;
  }
  settings.latency_s = AtMost(map, "latency_s", 0, kMaxDelay);
  settings.jitter_s = AtMost(map, "jitter_s", 0, kMaxDelay);
  settings.dropout = AtMost(map, "dropout", 0, 1);
  if (map.Has("noise")) settings.noise = ReadNoise(map.GetMap("noise"));
  if (map.Has("camera")) settings.camera = ReadCamera(map.GetMap("camera"));
  if (map.Has("tags")) settings.tags = ReadTagSettings(map.GetMap("tags"));
  if (map.Has("tag_images")) settings.tag_images = ReadTagImages(map.GetMap("tag_images"));
  map.CheckNoUnknownKeys();
  return settings;
}

// Labels those that would be called like another.
void TellApart(std::vector<SensorSettings>& sensors) {
  std::set<std::string> taken;
  for (const SensorSettings& sensor : sensors) taken.insert(sensor.label);
  for (SensorSettings& sensor : sensors) {
    if (!sensor.label.empty() || taken.insert(sensor.name).second) continue;
    int number = 2;
    do {
      sensor.label = sensor.name + "_" + std::to_string(number++);
    } while (!taken.insert(sensor.label).second);
  }
}

// The keys of one sensor, a line each.
std::vector<std::string> LinesOf(const SensorSettings& settings) {
  std::vector<std::string> lines = {
      "name: " + Quoted(settings.name),
      "rate_hz: " + Number(settings.rate_hz),
      std::string("cells: ") + (settings.cells == CellRule::kCentre ? "centre" : "touched"),
      "latency_s: " + Number(settings.latency_s),
      "jitter_s: " + Number(settings.jitter_s),
      "dropout: " + Number(settings.dropout)};
  if (!settings.label.empty()) lines.push_back("label: " + Quoted(settings.label));
  if (settings.noise) {
    lines.push_back("noise: {false_filled: " + Number(settings.noise->false_filled) +
                    ", false_free: " + Number(settings.noise->false_free) +
                    ", position_noise_m: " + Number(settings.noise->position_noise_m) + "}");
  }
  if (settings.camera) {
    const CameraSettings& camera = *settings.camera;
    lines.push_back(
        "camera: {position_m: " + List(camera.position_m) + ", look_at_m: " +
        List(camera.look_at_m) + ", field_of_view_rad: " + Number(camera.field_of_view_rad) +
        ", width: " + std::to_string(camera.width) + ", height: " + std::to_string(camera.height) +
        ", range_m: " + Number(camera.range_m) + ", noise_per_m: " + Number(camera.noise_per_m) +
        ", pixel_dropout: " + Number(camera.pixel_dropout) +
        ", flying_pixels: " + Number(camera.flying_pixels) + ", edge_m: " + Number(camera.edge_m) +
        ", unseen: " + camera.unseen + ", sees_robot: " + (camera.sees_robot ? "true" : "false") +
        ", robot_margin_m: " + Number(camera.robot_margin_m) +
        ", misplaced_m: " + List(camera.misplaced_m) + "}");
  }
  if (settings.tags) {
    const TagSettings& tags = *settings.tags;
    lines.push_back("tags: {position_m: " + List(tags.position_m) +
                    ", across_noise: " + Number(tags.across_noise) +
                    ", along_noise_per_m: " + Number(tags.along_noise_per_m) +
                    ", rotation_noise_rad: " + Number(tags.rotation_noise_rad) +
                    ", range_m: " + Number(tags.range_m) + ", size_m: " + Number(tags.size_m) +
                    ", partly_hidden: " + Number(tags.partly_hidden) +
                    ", flips: " + Number(tags.flips) + ", outliers: " + Number(tags.outliers) +
                    ", outlier_m: " + Number(tags.outlier_m) + ", swaps: " + Number(tags.swaps) +
                    ", phantoms: " + Number(tags.phantoms) + "}");
  }
  if (settings.tag_images) {
    const TagImageSettings& images = *settings.tag_images;
    const Eigen::Map<const Eigen::VectorXd> distortion(images.distortion.data(), 5);
    lines.push_back(
        "tag_images: {position_m: " + List(images.position_m) + ", look_at_m: " +
        List(images.look_at_m) + ", field_of_view_rad: " + Number(images.field_of_view_rad) +
        ", width: " + std::to_string(images.width) + ", height: " + std::to_string(images.height) +
        ", distortion: " + List(distortion) + ", exposure_s: " + Number(images.exposure_s) +
        ", blur_px: " + Number(images.blur_px) + ", grey_noise: " + Number(images.grey_noise) +
        "}");
  }
  return lines;
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

std::string NameOf(const SensorSettings& sensor) {
  return sensor.label.empty() ? sensor.name : sensor.label;
}

std::vector<SensorSettings> ReadSensors(const YamlReader& top) {
  std::vector<SensorSettings> sensors;
  const auto add = [&](const YamlReader& map, const std::string& path) {
    if (sensors.size() == kMostSensors) {
      top.Fail(path, "is one too many: there may be " + std::to_string(kMostSensors) + " sensors");
    }
    SensorSettings sensor = ReadSensor(map);
    for (const SensorSettings& other : sensors) {
      if (sensor.label.empty() || sensor.label != other.label) continue;
      map.Fail("label", "is that of " + other.path + ", too: '" + sensor.label + "'");
    }
    sensor.path = path;
    sensors.push_back(std::move(sensor));
  };
  const bool has_list = top.Has("sensors");
  if (top.Has("sensor") || !has_list) add(top.GetMap("sensor"), "sensor");
  if (has_list) {
    for (const YamlReader& map : top.GetMaps("sensors")) {
      add(map, "sensors[" + std::to_string(sensors.size() - (top.Has("sensor") ? 1 : 0)) + "]");
    }
  }
  if (sensors.empty()) top.Fail("sensors", "must hold one or more, or `sensor` be given");
  TellApart(sensors);
  return sensors;
}

EvidenceSettings ReadEvidence(const YamlReader& top, const std::vector<SensorSettings>& sensors) {
  EvidenceSettings evidence;
  if (!top.Has("evidence")) return evidence;
  if (std::none_of(sensors.begin(), sensors.end(),
                   [](const SensorSettings& sensor) { return sensor.camera.has_value(); })) {
    top.Fail("evidence", "is of what a depth_camera sees; no sensor has a `camera`", "sensor");
  }
  const YamlReader map = top.GetMap("evidence");
  if (map.Has("single_frames")) evidence.single_frames = map.GetBool("single_frames");
  evidence.hit = PositiveAtMost(map, "hit", evidence.hit, kMaxLogOdds);
  evidence.miss = PositiveAtMost(map, "miss", evidence.miss, kMaxLogOdds);
  if (map.Has("least")) {
    evidence.least = map.GetDouble("least");
    if (!(evidence.least < 0) || evidence.least < -kMaxLogOdds) {
      map.Fail("least",
               "must be < 0 and >= " + Number(-kMaxLogOdds) + ", is " + Number(evidence.least));
    }
  }
  evidence.most = PositiveAtMost(map, "most", evidence.most, kMaxLogOdds);
  evidence.settle_scans = CountFrom1(map, "settle_scans", evidence.settle_scans, 10000);
  evidence.decay_per_s = AtMost(map, "decay_per_s", evidence.decay_per_s, kMaxDecay);
  evidence.noise_sigmas = AtMost(map, "noise_sigmas", evidence.noise_sigmas, kMaxSigmas);
  evidence.average_scans = CountFrom1(map, "average_scans", evidence.average_scans, 10000);
  evidence.least_cells = CountFrom1(map, "least_cells", evidence.least_cells, 10000);
  map.CheckNoUnknownKeys();
  return evidence;
}

std::string ToYaml(const std::vector<SensorSettings>& sensors) {
  std::string text;
  const auto add = [&](const SensorSettings& sensor, const char* first, const char* next) {
    const char* indent = first;
    for (const std::string& line : LinesOf(sensor)) {
      text += std::exchange(indent, next) + line + "\n";
    }
  };
  if (sensors.size() == 1) {
    text = "sensor:\n";
    add(sensors.front(), "  ", "  ");
    return text;
  }
  text = "sensors:\n";
  for (const SensorSettings& sensor : sensors) add(sensor, "  - ", "    ");
  return text;
}

std::string ToYaml(const EvidenceSettings& evidence) {
  return std::string("evidence: {single_frames: ") + (evidence.single_frames ? "true" : "false") +
         ", hit: " + Number(evidence.hit) + ", miss: " + Number(evidence.miss) +
         ", least: " + Number(evidence.least) + ", most: " + Number(evidence.most) +
         ", settle_scans: " + std::to_string(evidence.settle_scans) +
         ", decay_per_s: " + Number(evidence.decay_per_s) +
         ", noise_sigmas: " + Number(evidence.noise_sigmas) +
         ", average_scans: " + std::to_string(evidence.average_scans) +
         ", least_cells: " + std::to_string(evidence.least_cells) + "}\n";
}

}  // namespace sidestep::scenarios
