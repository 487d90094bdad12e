#pragma once

#include <Eigen/Core>
#include <vector>

#include "sidestep/robot/arm_description.h"

namespace sidestep::imports {

/// Where an arm may begin: at 0, in the middle of its limits, anywhere within; those first at which
/// the fewest links are low, or below the base.
std::vector<Eigen::VectorXd> HomeCandidates(const robot::ArmDescription& arm);

}  // namespace sidestep::imports
