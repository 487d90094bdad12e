#include "sidestep/sim/geom_shift.h"

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

namespace sidestep::sim {
namespace {

constexpr std::size_t kPosition = 3, kFrame = 12;  // numbers

}  // namespace

GeomShift::GeomShift(const mjModel& model, std::vector<int> geoms)
    : model_(model), geoms_(std::move(geoms)) {}

void GeomShift::Begin(const mjData& data) {
  frames_.resize(kFrame * geoms_.size());
  for (std::size_t i = 0; i < geoms_.size(); ++i) {
    const mjtNum* const position = data.geom_xpos + 3 * geoms_[i];
    const mjtNum* const matrix = data.geom_xmat + 9 * geoms_[i];
    std::copy(matrix, matrix + 9,
              std::copy(position, position + 3, frames_.begin() + std::ptrdiff_t(kFrame * i)));
  }
}

// A point x of a geom, |x| <= r from its middle, has come |dp + dR x| <= |dp| + |dR| r, where the
// norm of the matrix is no greater than the root of the sum of its squares.
double GeomShift::Most_m(const mjData& data) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (frames_.size() != kFrame * geoms_.size()) return kInfinity;
  using Vector9 = Eigen::Matrix<double, 9, 1>;
  double most_m = 0;
  for (std::size_t i = 0; i < geoms_.size(); ++i) {
    const mjtNum* const before = frames_.data() + kFrame * i;
    const double way_m = (Eigen::Map<const Eigen::Vector3d>(data.geom_xpos + 3 * geoms_[i]) -
                          Eigen::Map<const Eigen::Vector3d>(before))
                             .norm();
    const double turn = (Eigen::Map<const Vector9>(data.geom_xmat + 9 * geoms_[i]) -
                         Eigen::Map<const Vector9>(before + kPosition))
                            .norm();
    const double radius_m = model_.geom_rbound[geoms_[i]];
    const bool is_unbounded = radius_m == 0;
    if (is_unbounded && turn > 0) return kInfinity;
    most_m = std::max(most_m, way_m + turn * radius_m);
  }
  return most_m;
}

}  // namespace sidestep::sim
