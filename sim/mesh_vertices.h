#pragma once

#include <Eigen/Core>

namespace sidestep::sim {

/// Refuses vertices of a convex mesh that MuJoCo would take without a word and make nothing of: of
/// a mesh so small that its size counts as none, so flat that its hull is none, or far away.
/// @throws InputError, of `vertex`.
void CheckMeshVertices(const Eigen::Matrix3Xd& vertices);

}  // namespace sidestep::sim
