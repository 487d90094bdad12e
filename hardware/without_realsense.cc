// Stands for realsense_camera.cc where librealsense2 is not there.
#include "sidestep/core/input_error.h"
#include "sidestep/hardware/realsense_camera.h"

namespace sidestep::hardware {

OpenCamera OpenRealSense(const RealSenseOptions&) {
  throw InputError("--camera", "this build is without librealsense2");
}

}  // namespace sidestep::hardware
