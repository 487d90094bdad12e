#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "sidestep/core/pose.h"

namespace sidestep::hardware {

/// The two poses X_CT of a square that explain its four corners, the better one first: a square
/// that is nearly frontal looks alike tilted to either side. T: x to the right of the print, y
/// down, z into it.
/// @param corners (x/z, y/z) of an ideal lens, in the order of TagDetection.
/// Source: T. Collins, A. Bartoli, "Infinitesimal plane-based pose estimation", IJCV 109(3), 2014,
/// by OpenCV.
std::array<Pose, 2> PosesOfSquare(const Eigen::Matrix<double, 2, 4>& corners, double size_m);

/// Robot-world/hand-eye calibration of a camera that stands in the world and sees a tag on a hand:
/// X_WC * X_CT[i] = X_WH[i] * X_HT.
struct HandEye {
  Pose X_WC, X_HT;
};
/// A first estimate, that minimises no error that is measured. At least 3 poses that are turned
/// about different axes. Source: M. Shah, "Solving the robot-world/hand-eye calibration problem
/// using the Kronecker product", J. Mechanisms and Robotics 5(3), 2013, by OpenCV.
HandEye EstimateHandEye(const std::vector<Pose>& X_WH, const std::vector<Pose>& X_CT);

}  // namespace sidestep::hardware
