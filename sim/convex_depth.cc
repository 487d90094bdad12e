#include "sidestep/sim/convex_depth.h"

#include <algorithm>
#include <array>
#include <limits>
#include <queue>
#include <vector>

#include "sidestep/sim/convex_distance.h"

namespace sidestep::sim {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDepthTolerance_m = 1e-7;
constexpr int kMaxSplits = 4000;

// The point of the difference of two cores that is farthest along n.
struct Corner {
  Vector3d n;  // unit length
  Vector3d point_m;
  double reach_m() const { return n.dot(point_m); }
};

class Difference {
 public:
  Difference(const ConvexSolid& a, const ConvexSolid& b, const Eigen::Isometry3d& X_AB)
      : a_(a), b_(b), X_AB_(X_AB) {}

  Corner Along(const Vector3d& n) const {
    return {n, CoreSupport(a_, n) - X_AB_ * CoreSupport(b_, -(X_AB_.linear().transpose() * n))};
  }

 private:
  const ConvexSolid &a_, &b_;
  const Eigen::Isometry3d& X_AB_;
};

// The greatest that the least element of m x can be, for x >= 0 whose elements add up to 1. A
// linear programme: it is attained where as many rows are equal as elements of x are not 0.
double MostOfLeastRow(const Matrix3d& m) {
  double most = m.colwise().minCoeff().maxCoeff();
  const auto attempt = [&](const Vector3d& x) {
    const double sum = x.sum();
    if (!((x / sum).minCoeff() >= 0)) return;  // NaN, too
    most = std::max(most, (m * (x / sum)).minCoeff());
  };
  for (int column = 0; column < 3; ++column) {
    const int c = (column + 1) % 3, d = (column + 2) % 3;
    for (int row = 0; row < 3; ++row) {
      const int r = (row + 1) % 3, s = (row + 2) % 3;
      Vector3d x = Vector3d::Zero();
      x(c) = m(s, d) - m(r, d);
      x(d) = m(r, c) - m(s, c);
      attempt(x);
    }
  }
  const Vector3d difference1 = (m.row(1) - m.row(0)).transpose();
  const Vector3d difference2 = (m.row(2) - m.row(0)).transpose();
  attempt(difference1.cross(difference2));
  return most;
}

// Directions between three; not more than a quarter of a turn apart.
struct Patch {
  explicit Patch(const std::array<Corner, 3>& three) : corners(three) {
    // A direction n in here is y / |y| for a mean y of the corners' directions, and |y| <= 1. For
    // each mean p of the corners' points the reach along n is at least n.p >= y.p.
    Matrix3d reach_m;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        reach_m(i, j) = corners[static_cast<std::size_t>(i)].n.dot(
            corners[static_cast<std::size_t>(j)].point_m);
      }
    }
    bound_m = std::max(0.0, MostOfLeastRow(reach_m));  // the cores overlap
  }

  std::array<Corner, 3> corners;
  double bound_m;  // no reach in here is less
};

struct HigherBound {
  bool operator()(const Patch& a, const Patch& b) const { return a.bound_m > b.bound_m; }
};

// The least reach of the difference of two cores that overlap.
double LeastReach(const Difference& difference, const Matrix3d& R_AB) {
  double least_m = std::numeric_limits<double>::infinity();
  const auto look = [&](const Vector3d& n) {
    const Corner corner = difference.Along(n);
    least_m = std::min(least_m, corner.reach_m());
    return corner;
  };
  for (int axis = 0; axis < 3; ++axis) {  // most often the answer, for faces of b; a's are below
    look(R_AB.col(axis));
    look(-R_AB.col(axis));
  }
  std::priority_queue<Patch, std::vector<Patch>, HigherBound> patches;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      for (const double z : {-1.0, 1.0}) {
        patches.push(Patch({look({x, 0, 0}), look({0, y, 0}), look({0, 0, z})}));
      }
    }
  }
  for (int split = 0; split < kMaxSplits; ++split) {
    const Patch patch = patches.top();
    if (patch.bound_m >= least_m - kDepthTolerance_m) break;
    patches.pop();
    const auto& c = patch.corners;
    std::size_t far = 0;  // the corner across the longest side
    double least_cosine = 2;
    for (std::size_t i = 0; i < 3; ++i) {
      const double cosine = c[(i + 1) % 3].n.dot(c[(i + 2) % 3].n);
      if (cosine < least_cosine) {
        least_cosine = cosine;
        far = i;
      }
    }
    const Corner &left = c[(far + 1) % 3], &right = c[(far + 2) % 3];
    const Corner middle = look((left.n + right.n).normalized());
    patches.push(Patch({c[far], left, middle}));
    patches.push(Patch({c[far], middle, right}));
  }
  return std::max(0.0, least_m);
}

}  // namespace

double ConvexDepth(const ConvexSolid& a, const ConvexSolid& b, const Eigen::Isometry3d& X_AB) {
  const double radii_m = a.radius_m + b.radius_m;
  const double apart_m = CoreDistance(a, b, X_AB);
  if (apart_m > 0) return std::max(0.0, radii_m - apart_m);
  return radii_m + LeastReach(Difference(a, b, X_AB), X_AB.linear());
}

}  // namespace sidestep::sim
