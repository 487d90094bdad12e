// Where the camera stands is known.
#include "sidestep/bench/validation/support.h"

namespace sidestep::bench {
namespace {

ItemFinding JudgeCalibration(const Evidence&) {
  return NothingRun(
      "it is of the camera in the laboratory: calibrate it there, and keep some poses out to judge "
      "the result by");
}

}  // namespace

ValidationItem CalibrationItem() {
  return {17,
          "calibration of the camera",
          "5 mm and 0.5 degrees (rms) in poses kept out of it",
          "common practice of eye-to-hand calibration",
          nullptr,
          JudgeCalibration};
}

}  // namespace sidestep::bench
