#include "sidestep/sim/mesh_vertices.h"

#include <Eigen/Eigenvalues>

#include "sidestep/core/input_error.h"

namespace sidestep::sim {

void CheckMeshVertices(const Eigen::Matrix3Xd& vertices) {
  constexpr double kFarthest_m = 100, kFlat_m = 1e-5;
  if (!(vertices.cwiseAbs().maxCoeff() <= kFarthest_m)) {
    throw InputError("vertex", "must be within 100 m");
  }
  const Eigen::Matrix3Xd about = vertices.colwise() - vertices.rowwise().mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(about * about.transpose());
  const Eigen::Matrix3Xd along = axes.eigenvectors().transpose() * about;
  if ((along.rowwise().maxCoeff() - along.rowwise().minCoeff()).minCoeff() < kFlat_m) {
    throw InputError("vertex", "must span a solid, is flatter than 0.01 mm");
  }
}

}  // namespace sidestep::sim
