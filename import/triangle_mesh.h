#pragma once

#include <Eigen/Core>

namespace sidestep::imports {

/// The surface of a solid, in the frame of what it belongs to [m].
struct TriangleMesh {
  Eigen::Matrix3Xd vertices;
  Eigen::Matrix3Xi triangles;  ///< columns of vertex indices, counter-clockwise seen from outside
};

/// The volume inside a closed mesh [m^3]: negative if it is inside out. By the divergence theorem,
/// the sum of the signed tetrahedra between its triangles and one point.
double SignedVolume_m3(const TriangleMesh& mesh);

}  // namespace sidestep::imports
