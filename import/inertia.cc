#include "sidestep/import/inertia.h"

#include <Eigen/Eigenvalues>

#include "sidestep/core/number_text.h"

namespace sidestep::imports {
namespace {

constexpr double kLeast = 1e-12;    // kg m^2; MuJoCo takes no less than 1e-14
constexpr double kRounding = 1e-6;  // of the greatest moment: what written digits leave

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>;

std::string Moments(const Eigen::Vector3d& m) {
  return ShortestText(m(0)) + ", " + ShortestText(m(1)) + ", " + ShortestText(m(2));
}

}  // namespace

std::string WhyNoInertia(const Eigen::Matrix3d& I) {
  const Eigen::Vector3d moments = Solver(I).eigenvalues();  // ascending
  if (!(moments(0) > kLeast)) {
    return "must be positive definite; its principal moments are " + Moments(moments);
  }
  if (moments(0) + moments(1) < moments(2) * (1 - kRounding)) {
    return "is none of a solid: of its principal moments " + Moments(moments) +
           " the greatest exceeds the sum of the others";
  }
  return "";
}

Eigen::Matrix3d RepairedInertia(const Eigen::Matrix3d& I) {
  const Solver solver(I);
  Eigen::Vector3d moments = solver.eigenvalues();
  moments = moments.cwiseMax(std::max(1e-9, 1e-6 * moments(2)));
  const double missing = moments(2) - moments(0) - moments(1);
  if (missing > 0) moments.head<2>().array() += missing / 2 * (1 + 1e-9);
  return solver.eigenvectors() * moments.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace sidestep::imports
