#pragma once

#include <functional>
#include <memory>
#include <string>

#include "sidestep/cli/tag_camera.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/hardware/fci_driver.h"

namespace sidestep::cli {

/// What a dry run with a camera leaves beside trace.h5 and result.json.
inline constexpr const char* kCameraFolder = "camera";  ///< a LookLog (hardware/look_log.h)
inline constexpr const char* kCalibrationFile = "calibration.yaml";  ///< if there was one
inline constexpr const char* kDryRunVideo = "dry_run.mp4";

struct LookAroundOptions {
  CameraUse camera;
  std::string out;     ///< the folder
  double seconds = 0;  ///< how long; 0: as long as pictures are recorded, or two horizons
  std::function<std::string()> why_stop;  ///< asked again and again; not empty: it ends
};

/// Looks with a camera and plans around what it sees, with a robot that is sent nothing, and leaves
/// the pictures, what was found in them, what was planned, and a video of that.
/// @throws InputError; std::runtime_error, at the end, if it was stopped or failed.
void LookAround(const Problem& problem, const DataPaths& paths, const LookAroundOptions& options,
                std::unique_ptr<hardware::FciDriver> driver);

/// Looks at the recorded pictures of a dry run again. @param out folder for a video; empty: none.
/// @return whether the same is found in them, to the bit. @throws InputError.
bool LookAgain(const DataPaths& paths, const std::string& folder, const std::string& out);

}  // namespace sidestep::cli
