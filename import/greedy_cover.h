#pragma once

#include <Eigen/Core>
#include <vector>

#include "sidestep/import/cover_sphere.h"

namespace sidestep::imports {

/// Balls that a cover may be chosen from: their centres, and how far each is within the solid.
struct CoverCandidates {
  Eigen::Matrix3Xd centers_m;
  Eigen::VectorXd depth_m;  ///< >= 0
};

/// Covers points by balls that stand out of the solid by at most `out_m`: each is as large as its
/// centre is deep, and that more. Always takes the one that covers most of what is left.
/// @return no more than `most` balls; empty if they are not enough.
std::vector<CoverSphere> GreedyCover(const CoverCandidates& candidates,
                                     const Eigen::Matrix3Xd& points_m, double cover_m, double out_m,
                                     int most);

}  // namespace sidestep::imports
