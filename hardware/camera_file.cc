#include "sidestep/hardware/camera_file.h"

#include <algorithm>

#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"

namespace sidestep::hardware {

NamedCamera ReadCamera(const YamlReader& map) {
  constexpr int kMostPixels = 8192;
  NamedCamera camera;
  camera.serial = map.GetString("serial");
  robot::CameraIntrinsics& lens = camera.intrinsics;
  for (const auto& [key, pixels] : {std::pair("width", &lens.width), {"height", &lens.height}}) {
    *pixels = map.GetInt(key);
    if (*pixels < 1 || *pixels > kMostPixels) map.Fail(key, "must be from 1 to 8192");
  }
  lens.fx = map.GetPositive("fx");
  lens.fy = map.GetPositive("fy");
  lens.cx = map.GetDouble("cx");
  lens.cy = map.GetDouble("cy");
  const Eigen::VectorXd distortion = map.GetVector("distortion", 5);
  std::copy(distortion.begin(), distortion.end(), lens.distortion.begin());
  map.CheckNoUnknownKeys();
  return camera;
}

std::string ToYaml(const NamedCamera& camera) {
  const robot::CameraIntrinsics& lens = camera.intrinsics;
  return "{serial: \"" + camera.serial + "\", width: " + std::to_string(lens.width) +
         ", height: " + std::to_string(lens.height) + ", fx: " + ShortestText(lens.fx) +
         ", fy: " + ShortestText(lens.fy) + ", cx: " + ShortestText(lens.cx) +
         ", cy: " + ShortestText(lens.cy) + ", distortion: [" +
         Joined(lens.distortion, ", ", &ShortestText) + "]}";
}

}  // namespace sidestep::hardware
