// Stands for tag_detector.cc and planar_pose.cc where libapriltag and OpenCV are not there.
#include <stdexcept>

#include "sidestep/core/input_error.h"
#include "sidestep/hardware/planar_pose.h"
#include "sidestep/hardware/tag_detector.h"

namespace sidestep::hardware {

TagDetector::TagDetector(const TagDetectorOptions& options) : options_(options) {
  throw InputError("AprilTags",
                   "this build cannot find them: it is without libapriltag-dev and "
                   "libopencv-calib3d-dev");
}
TagDetector::~TagDetector() = default;
void TagDetector::DeleteLibrary::operator()(Library*) const {}  // there is none
std::vector<TagDetection> TagDetector::Detect(const robot::GreyImage&) { return {}; }
bool CanFindTags() { return false; }

std::array<Pose, 2> PosesOfSquare(const Eigen::Matrix<double, 2, 4>&, double) {
  throw std::logic_error("PosesOfSquare: built without OpenCV");
}
HandEye EstimateHandEye(const std::vector<Pose>&, const std::vector<Pose>&) {
  throw std::logic_error("EstimateHandEye: built without OpenCV");
}

}  // namespace sidestep::hardware
