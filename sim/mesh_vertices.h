#pragma once

#include <Eigen/Core>
#include <vector>

namespace sidestep::sim {

/// The points of an MJCF mesh's `vertex` list; none for a null text.
/// @throws std::invalid_argument for what is no list of three numbers each.
std::vector<Eigen::Vector3d> VerticesOf(const char* text);

}  // namespace sidestep::sim
