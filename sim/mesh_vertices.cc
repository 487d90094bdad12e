#include "sidestep/sim/mesh_vertices.h"

#include <Eigen/Eigenvalues>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "sidestep/core/input_error.h"

namespace sidestep::sim {

Eigen::Matrix3Xd ReadMeshVertices(const char* text) {
  std::istringstream words(text == nullptr ? "" : text);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    char* end = nullptr;
    numbers.push_back(std::strtod(word.c_str(), &end));
    if (*end != '\0') throw InputError("vertex", "must be numbers, holds '" + word + "'");
  }
  if (numbers.size() < 12 || numbers.size() % 3 != 0) {
    throw InputError("vertex", "must be three numbers each of four vertices or more, are " +
                                   std::to_string(numbers.size()));
  }
  return Eigen::Map<const Eigen::Matrix3Xd>(numbers.data(), 3,
                                            static_cast<Eigen::Index>(numbers.size() / 3));
}

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
