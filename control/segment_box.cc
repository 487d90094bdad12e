#include "sidestep/control/segment_box.h"

#include <algorithm>
#include <cmath>

namespace sidestep::control {
namespace {

// How far x is outside [-half, half], with its sign.
double Excess(double x, double half) { return x - std::clamp(x, -half, half); }

}  // namespace

double SegmentBoxDistance(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                          const Eigen::Vector3d& half) noexcept {
  const Eigen::Vector3d d = b - a;
  // Half the derivative of the squared distance at a + s d: rises with s, straight between the
  // places where a coordinate enters or leaves the box.
  const auto slope = [&](double s) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) sum += d(i) * Excess(a(i) + s * d(i), half(i));
    return sum;
  };
  double low = 0, high = 1, at_low = slope(0), at_high = slope(1);
  double s = 0;
  if (at_low < 0) {
    s = 1;
    if (at_high > 0) {
      for (int i = 0; i < 3; ++i) {
        if (d(i) == 0) continue;
        for (const double face : {-half(i), half(i)}) {
          const double middle = (face - a(i)) / d(i);
          if (!(middle > low && middle < high)) continue;
          const double at_middle = slope(middle);
          (at_middle < 0 ? low : high) = middle;
          (at_middle < 0 ? at_low : at_high) = at_middle;
        }
      }
      s = at_high > at_low ? low - at_low * (high - low) / (at_high - at_low) : low;
    }
  }
  double squared = 0;
  for (int i = 0; i < 3; ++i) {
    const double excess = Excess(a(i) + s * d(i), half(i));
    squared += excess * excess;
  }
  return std::sqrt(squared);
}

}  // namespace sidestep::control
