#include "sidestep/import/sphere_union.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace sidestep::imports {
namespace {

struct Circle {
  double x = 0, y = 0, radius = 0;
};

// Half the integral of x dy - y dx along an arc.
double SectorOf(const Circle& circle, double from, double to) {
  return circle.radius / 2 *
         (circle.radius * (to - from) + circle.x * (std::sin(to) - std::sin(from)) -
          circle.y * (std::cos(to) - std::cos(from)));
}

// By Green's theorem along the arcs that are in no other circle.
double UnionArea(const std::vector<Circle>& circles,
                 std::vector<std::pair<double, double>>* hidden) {
  constexpr double kTurn = 2 * std::numbers::pi;
  double area = 0;
  for (std::size_t i = 0; i < circles.size(); ++i) {
    const Circle& circle = circles[i];
    hidden->clear();  // arcs from an angle to an angle, both from 0 to a turn
    bool is_hidden = false;
    for (std::size_t k = 0; k < circles.size() && !is_hidden; ++k) {
      if (k == i) continue;
      const Circle& other = circles[k];
      const double dx = other.x - circle.x, dy = other.y - circle.y;
      const double apart = std::sqrt(dx * dx + dy * dy);
      if (apart + circle.radius <= other.radius) {  // of two equal ones, the first counts
        is_hidden = apart > 0 || circle.radius < other.radius || k < i;
        continue;
      }
      if (apart >= circle.radius + other.radius || apart + other.radius <= circle.radius) continue;
      const double cosine =
          (circle.radius * circle.radius + apart * apart - other.radius * other.radius) /
          (2 * circle.radius * apart);
      const double half = std::acos(std::clamp(cosine, -1.0, 1.0));
      double from = std::atan2(dy, dx) - half;
      if (from < 0) from += kTurn;
      const double to = from + 2 * half;
      hidden->emplace_back(from, std::min(to, kTurn));
      if (to > kTurn) hidden->emplace_back(0, to - kTurn);
    }
    if (is_hidden) continue;
    std::sort(hidden->begin(), hidden->end());
    double reached = 0;
    for (const auto& [from, to] : *hidden) {
      if (from > reached) area += SectorOf(circle, reached, from);
      reached = std::max(reached, to);
    }
    if (reached < kTurn) area += SectorOf(circle, reached, kTurn);
  }
  return area;
}

}  // namespace

double UnionVolume_m3(const std::vector<CoverSphere>& spheres, int num_slices) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const CoverSphere& sphere : spheres) {
    low = std::min(low, sphere.center_m.z() - sphere.radius_m);
    high = std::max(high, sphere.center_m.z() + sphere.radius_m);
  }
  if (!(high > low)) return 0;
  const double thickness = (high - low) / num_slices;
  std::vector<Circle> circles;
  std::vector<std::pair<double, double>> hidden;
  double volume = 0;
  for (int slice = 0; slice < num_slices; ++slice) {
    const double z = low + (slice + 0.5) * thickness;
    circles.clear();
    for (const CoverSphere& sphere : spheres) {
      const double off = z - sphere.center_m.z();
      const double square = sphere.radius_m * sphere.radius_m - off * off;
      if (square > 0) {
        circles.push_back({sphere.center_m.x(), sphere.center_m.y(), std::sqrt(square)});
      }
    }
    volume += UnionArea(circles, &hidden) * thickness;
  }
  return volume;
}

}  // namespace sidestep::imports
