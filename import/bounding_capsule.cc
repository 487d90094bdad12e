#include "sidestep/import/bounding_capsule.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sidestep/import/solid_points.h"

namespace sidestep::imports {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

// The middle of a small circle around balls, by steps towards the farthest (M. Badoiu, K. L.
// Clarkson, "Smaller core-sets for balls", SODA 2003).
Vector2d MiddleOf(const std::vector<Ball>& balls, const Matrix3d& axes) {
  const auto place = [&](const Ball& ball) -> Vector2d {
    return (axes.transpose() * ball.p_L).head<2>();
  };
  Vector2d middle = place(balls.front());
  for (int step = 1; step < 300; ++step) {
    const Ball* farthest = nullptr;
    double most = -1;
    for (const Ball& ball : balls) {
      const double reach = (place(ball) - middle).norm() + ball.radius_m;
      if (reach > most) {
        most = reach;
        farthest = &ball;
      }
    }
    middle += (place(*farthest) - middle) / (step + 1);
  }
  return middle;
}

// The capsule along the last of three axes.
robot::CollisionCapsule Along(const std::vector<Ball>& balls, const Matrix3d& axes) {
  const Vector2d middle = MiddleOf(balls, axes);
  const auto across = [&](const Vector3d& p) { return (p.head<2>() - middle).norm(); };
  double radius = 0;
  for (const Ball& ball : balls) {
    radius = std::max(radius, across(axes.transpose() * ball.p_L) + ball.radius_m);
  }
  radius = radius * (1 + 1e-6) + 1e-6;  // beyond rounding
  double first = std::numeric_limits<double>::infinity(), last = -first;
  for (const Ball& ball : balls) {
    const Vector3d p = axes.transpose() * ball.p_L;
    const double room =
        std::sqrt(std::max(0.0, std::pow(radius - ball.radius_m, 2) - std::pow(across(p), 2)));
    first = std::min(first, p.z() + room);
    last = std::max(last, p.z() - room);
  }
  if (last - first < 1e-4) {  // nearly a ball
    const double between = (first + last) / 2;
    first = std::min(first, between - 5e-5);
    last = std::max(last, between + 5e-5);
  }
  robot::CollisionCapsule capsule;
  capsule.p_LA = axes * Vector3d(middle.x(), middle.y(), first);
  capsule.p_LB = axes * Vector3d(middle.x(), middle.y(), last);
  capsule.radius_m = radius;
  return capsule;
}

double VolumeOf(const robot::CollisionCapsule& capsule) {
  const double r = capsule.radius_m;
  return r * r * ((capsule.p_LB - capsule.p_LA).norm() + 4.0 / 3 * r);  // times pi
}

}  // namespace

robot::CollisionCapsule CapsuleAround(const std::vector<robot::LinkSolid>& solids) {
  std::vector<Ball> balls;
  for (const robot::LinkSolid& solid : solids) AppendBalls(solid, &balls);
  Vector3d mean = Vector3d::Zero();
  for (const Ball& ball : balls) mean += ball.p_L / static_cast<double>(balls.size());
  Matrix3d scatter = Matrix3d::Zero();
  for (const Ball& ball : balls) scatter += (ball.p_L - mean) * (ball.p_L - mean).transpose();
  const Matrix3d principal = Eigen::SelfAdjointEigenSolver<Matrix3d>(scatter).eigenvectors();
  robot::CollisionCapsule best;
  double least = std::numeric_limits<double>::infinity();
  for (const Matrix3d& frame : {principal, Matrix3d(Matrix3d::Identity())}) {
    for (int axis = 0; axis < 3; ++axis) {
      Matrix3d axes;
      axes << frame.col((axis + 1) % 3), frame.col((axis + 2) % 3), frame.col(axis);
      const robot::CollisionCapsule capsule = Along(balls, axes);
      if (VolumeOf(capsule) < least) {
        least = VolumeOf(capsule);
        best = capsule;
      }
    }
  }
  return best;
}

}  // namespace sidestep::imports
