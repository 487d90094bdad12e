#include "sidestep/import/triangle_mesh.h"

#include <Eigen/Geometry>

namespace sidestep::imports {

double SignedVolume_m3(const TriangleMesh& mesh) {
  double six_volumes = 0;
  for (Eigen::Index i = 0; i < mesh.triangles.cols(); ++i) {
    const Eigen::Vector3i corners = mesh.triangles.col(i);
    six_volumes += mesh.vertices.col(corners[0])
                       .dot(mesh.vertices.col(corners[1]).cross(mesh.vertices.col(corners[2])));
  }
  return six_volumes / 6;
}

}  // namespace sidestep::imports
