#include "sidestep/import/triangle_mesh.h"

#include <Eigen/Geometry>

namespace sidestep::imports {

double SignedVolume_m3(const TriangleMesh& mesh) {
  double six_volumes = 0;
  for (const auto& t : mesh.triangles.colwise()) {
    const auto corner = [&](int k) -> Eigen::Vector3d {  // seen from one of them: far off it rounds
      return mesh.vertices.col(t(k)) - mesh.vertices.col(0);
    };
    six_volumes += corner(0).dot(corner(1).cross(corner(2)));
  }
  return six_volumes / 6;
}

}  // namespace sidestep::imports
