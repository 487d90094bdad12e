#pragma once

#include <memory>
#include <string>

#include "sidestep/core/yaml_reader.h"
#include "sidestep/robot/camera_image.h"
#include "sidestep/robot/frame_source.h"

namespace sidestep::hardware {

/// A camera as files name it: by its serial number, with its lens.
struct NamedCamera {
  std::string serial;
  robot::CameraIntrinsics intrinsics;
};

/// A camera that is open.
struct OpenCamera {
  NamedCamera camera;
  std::unique_ptr<robot::FrameSource> frames;
};

/// Reads such a map. @throws InputError.
NamedCamera ReadCamera(const YamlReader& map);

/// What ReadCamera reads back, as a map in one line.
std::string ToYaml(const NamedCamera& camera);

}  // namespace sidestep::hardware
