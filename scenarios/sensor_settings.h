#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/cell_touch.h"
#include "sidestep/core/pose.h"
#include "sidestep/core/yaml_reader.h"

namespace sidestep::scenarios {

/// What an occupancy sensor gets wrong.
struct OccupancyNoise {
  double false_filled = 0;      ///< probability that a free cell is reported filled, each scan
  double false_free = 0;        ///< probability that a filled cell is not reported, each scan
  double position_noise_m = 0;  ///< standard deviation of each point along each axis
};

/// A camera that measures depth. It looks along the line from where it stands to a point; its image
/// is upright.
struct CameraSettings {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< in W
  Eigen::Vector3d look_at_m = Eigen::Vector3d::Zero();
  double field_of_view_rad = 1.2;  ///< horizontal
  int width = 160, height = 120;   ///< pixels
  double range_m = 5;              ///< farther things are not measured
  double noise_per_m = 0;          ///< depth z has the standard deviation noise_per_m z^2 (stereo)
  double pixel_dropout = 0;        ///< probability that a pixel has no depth
  /// Probability that a pixel at an edge of depth measures somewhere between near and far.
  double flying_pixels = 0;
  /// Neighbouring pixels whose depths differ by more than this have an edge between them. A pixel
  /// between two edges, in depth as in the image, is dropped; 0: none is.
  double edge_m = 0.1;
  std::string unseen = "remembered";  ///< a word of sdf/map/evidence_map.h
  /// The robot's pixels are measured like all others, and what is within this of where the robot's
  /// model was at the time of capture is taken for the robot; else they are known to be its own.
  bool sees_robot = false;
  double robot_margin_m = 0.03;
  /// Where it truly stands, from where it is believed to stand.
  Eigen::Vector3d misplaced_m = Eigen::Vector3d::Zero();
};

/// What it takes for a camera's cell to be filled or free: sdf/map/evidence_map.h has the meaning.
struct EvidenceSettings {
  bool single_frames = false;  ///< each image is taken at its word, and the rest does not count
  double hit = 0.7, miss = 1.4, least = -2.8, most = 2.8;  ///< log-odds
  int settle_scans = 60;
  double decay_per_s = 30;
  double noise_sigmas = 4;
  int average_scans = 60;
  int least_cells = 6;
};

/// A camera that finds tags on the moving things and says where they are. At distance d the error
/// of a position has these standard deviations, across and along the line of sight; their growth
/// with d and d^2 is that of any pinhole camera with corners found to a fixed part of a pixel.
struct TagSettings {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< of the camera, in W
  double across_noise = 0.001;                           ///< times d
  double along_noise_per_m = 0.002;                      ///< times d^2
  double rotation_noise_rad = 0;                         ///< about each axis
  double range_m = 5;                                    ///< farther things are not found
  double size_m = 0;         ///< the edge of a tag, all of which must be in sight; 0: its middle
  double partly_hidden = 0;  ///< probability that it is found, badly, if only a part of it is
  // What goes wrong at times. Probabilities: for each tag in each scan, of swaps and phantoms for
  // each scan.
  double flips = 0;        ///< it is turned by the other pose that explains what is seen
  double outliers = 0;     ///< it is anywhere within outlier_m of where it is
  double outlier_m = 0.5;  ///< > 0
  double swaps = 0;        ///< two tags are taken for each other
  double phantoms = 0;     ///< one is found where there is none
};

/// A colour or infrared camera whose pictures are searched for the tags that are printed on boxes,
/// with the lens and the errors of its pictures. Defaults are those of the colour camera of a
/// RealSense D435i; its angle from the data sheet, blur and noise from a study of tags.
struct TagImageSettings {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< in W
  Eigen::Vector3d look_at_m = Eigen::Vector3d::Zero();
  double field_of_view_rad = 1.211;       ///< horizontal, without distortion
  int width = 1280, height = 720;         ///< pixels
  std::array<double, 5> distortion = {};  ///< k1, k2, p1, p2, k3 (robot/camera_image.h)
  double exposure_s = 0.008;              ///< around the time of capture
  double blur_px = 0.7;                   ///< standard deviation of the lens
  double grey_noise = 3;                  ///< standard deviation of each pixel, of 255
};

/// A sensor as the scenario describes it.
struct SensorSettings {
  std::string name = "occupancy";  ///< of its kind
  std::string label = {};          ///< what it is called, if not as its kind is
  double rate_hz = 0;
  /// Which cells a solid fills. A camera's are those that hold a point of a surface, whatever it
  /// says.
  CellRule cells = CellRule::kTouched;
  // How what it captures arrives, whatever the sensor.
  double latency_s = 0;  ///< from capture to arrival, at least
  double jitter_s = 0;   ///< further delay, uniform in [0, jitter_s)
  double dropout = 0;    ///< probability that a scan never arrives
  // What only some sensors have.
  std::optional<OccupancyNoise> noise;
  std::optional<CameraSettings> camera;
  std::optional<TagSettings> tags;
  std::optional<TagImageSettings> tag_images;
  std::string path = "sensor";  ///< in the file: `sensor`, or `sensors[0]`
};

/// The pose X_WC of a camera that looks from one point to another, its image upright (where it
/// looks straight up or down: its right along x). Its frame C: x to the right of the image, y down,
/// z forward.
Pose PoseOfCamera(const Eigen::Vector3d& position_m, const Eigen::Vector3d& look_at_m);

/// What a sensor is called.
std::string NameOf(const SensorSettings& sensor);

/// The most sensors that a scenario may have.
inline constexpr std::size_t kMostSensors = 8;

/// Reads the map `sensor` and the list `sensors`: one of them must be there, and no two sensors
/// have the same label. One without a label is called as its kind is, with a number from the second
/// of that kind on. @throws InputError FILE:LINE: KEY: WHY.
std::vector<SensorSettings> ReadSensors(const YamlReader& top);

/// Reads `evidence`, if it is there. @throws InputError, also where no sensor has a camera.
EvidenceSettings ReadEvidence(const YamlReader& top, const std::vector<SensorSettings>& sensors);

/// The lines of YAML that the two above read back to equal values.
std::string ToYaml(const std::vector<SensorSettings>& sensors);
std::string ToYaml(const EvidenceSettings& evidence);

}  // namespace sidestep::scenarios
