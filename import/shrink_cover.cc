#include "sidestep/import/shrink_cover.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace sidestep::imports {
namespace {

constexpr int kDirections = 96;
constexpr double kLastStep = 0.0005;  // of a typical radius
constexpr double kFirstPenalty = 0.2,
                 kLastPenalty = 200;  // of the sum of squares of what sticks out

// Evenly over a sphere, along a spiral of golden angles.
Eigen::Matrix3Xd EvenDirections(int count) {
  constexpr double kGoldenAngle = std::numbers::pi * (3 - 2.2360679774997896964);
  Eigen::Matrix3Xd directions(3, count);
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, across = std::sqrt(1 - z * z);
    directions.col(i) << across * std::cos(i * kGoldenAngle), across * std::sin(i * kGoldenAngle),
        z;
  }
  return directions;
}

// Makes `owner` that of each point that is less far out of it. Two loops over lists that share no
// memory: of these the compiler works on whole vectors.
void TakeNearer(const float* __restrict out, int owner, std::size_t count, float* __restrict least,
                int* __restrict owners) {
  for (std::size_t j = 0; j < count; ++j) owners[j] = out[j] < least[j] ? owner : owners[j];
  for (std::size_t j = 0; j < count; ++j) least[j] = out[j] < least[j] ? out[j] : least[j];
}

// The spheres as unknowns, a column each: the centre and the radius, in units of `scale_m`.
using Unknowns = Eigen::Matrix4Xd;

class Descent {
 public:
  Descent(const Eigen::Matrix3Xd& points_m, double cover_m, double scale_m)
      : points_((points_m.transpose() / scale_m).cast<float>()),
        cover_(cover_m / scale_m),
        directions_(EvenDirections(kDirections)),
        least_(static_cast<std::size_t>(points_.rows())),
        owner_(least_.size()) {}

  void Run(Unknowns* x, int steps, double first_step) {
    Unknowns mean = Unknowns::Zero(4, x->cols()), square = mean, gradient = mean;
    double mean_share = 1, square_share = 1;
    for (int step = 0; step < steps; ++step) {
      const double progress = static_cast<double>(step) / steps;
      const double rate = first_step * std::pow(kLastStep / first_step, progress);
      const double penalty = kFirstPenalty * std::pow(kLastPenalty / kFirstPenalty, progress);
      gradient.setZero();
      AddVolume(*x, &gradient);
      AddPenalty(*x, penalty, &gradient);
      constexpr double kMean = 0.8, kSquare = 0.95;
      mean = kMean * mean + (1 - kMean) * gradient;
      square = kSquare * square + (1 - kSquare) * gradient.cwiseAbs2();
      mean_share *= kMean;
      square_share *= kSquare;
      *x -= rate * (mean.array() / (1 - mean_share) /
                    ((square.array() / (1 - square_share)).sqrt() + 1e-3))
                       .matrix();
      x->row(3) = x->row(3).cwiseMax(1e-3);
    }
  }

 private:
  // d V / d r is the free area, d V / d c the integral of the normal over it.
  void AddVolume(const Unknowns& x, Unknowns* gradient) const {
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      const double radius = x(3, i);
      near_.clear();
      for (Eigen::Index k = 0; k < x.cols(); ++k) {
        const double reach = radius + x(3, k);
        if (k != i && (x.col(k) - x.col(i)).head<3>().squaredNorm() < reach * reach) {
          near_.push_back(k);
        }
      }
      Eigen::Vector4d sum = Eigen::Vector4d::Zero();
      for (Eigen::Index d = 0; d < kDirections; ++d) {
        const Eigen::Vector3d p = x.col(i).head<3>() + radius * directions_.col(d);
        bool is_free = true;
        for (std::size_t n = 0; n < near_.size() && is_free; ++n) {
          const auto other = x.col(near_[n]);
          is_free = (p - other.head<3>()).squaredNorm() >= other[3] * other[3];
        }
        if (!is_free) continue;
        sum.head<3>() += directions_.col(d);
        sum[3] += 1;
      }
      gradient->col(i) += 4 * std::numbers::pi * radius * radius / kDirections * sum;
    }
  }

  // Of the sum over all points of the square of what sticks out.
  void AddPenalty(const Unknowns& x, double penalty, Unknowns* gradient) {
    const std::size_t count = owner_.size();
    std::fill(least_.begin(), least_.end(), std::numeric_limits<float>::infinity());
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      const Eigen::Vector4f sphere = x.col(i).cast<float>();
      out_ = ((points_.col(0) - sphere[0]).square() + (points_.col(1) - sphere[1]).square() +
              (points_.col(2) - sphere[2]).square())
                 .sqrt() -
             sphere[3];
      TakeNearer(out_.data(), static_cast<int>(i), count, least_.data(), owner_.data());
    }
    const double factor = 2 * penalty;
    for (std::size_t j = 0; j < count; ++j) {
      const double excess = static_cast<double>(least_[j]) - cover_;
      if (!(excess > 0)) continue;
      const Eigen::Index i = owner_[j];
      const Eigen::Vector3d away =
          x.col(i).head<3>() -
          points_.row(static_cast<Eigen::Index>(j)).matrix().transpose().cast<double>();
      const double apart = away.norm();
      if (apart > 0) gradient->col(i).head<3>() += factor * excess / apart * away;
      (*gradient)(3, i) -= factor * excess;
    }
  }

  Eigen::Array<float, Eigen::Dynamic, 3> points_;  // single precision is enough on the way
  double cover_;
  Eigen::Matrix3Xd directions_;
  Eigen::ArrayXf out_;        // how far each point is out of one sphere ...
  std::vector<float> least_;  // ... and of that which it sticks out of least ...
  std::vector<int> owner_;    // ... which is this
  mutable std::vector<Eigen::Index> near_;
};

// Makes the nearest sphere of each point that sticks out larger.
void Close(const Eigen::Matrix3Xd& points_m, double cover_m, std::vector<CoverSphere>* spheres) {
  for (const auto& p : points_m.colwise()) {
    CoverSphere* nearest = nullptr;
    double least_m = std::numeric_limits<double>::infinity();
    for (CoverSphere& sphere : *spheres) {
      const double out_m = (p - sphere.center_m).norm() - sphere.radius_m;
      if (out_m >= least_m) continue;
      least_m = out_m;
      nearest = &sphere;
    }
    if (nearest != nullptr && least_m > cover_m) nearest->radius_m += least_m - cover_m;
  }
}

}  // namespace

std::vector<CoverSphere> Tighten(const Eigen::Matrix3Xd& points_m, double cover_m,
                                 const std::vector<CoverSphere>& spheres) {
  // By how many spheres each point is covered.
  std::vector<int> covered(static_cast<std::size_t>(points_m.cols()));
  const auto for_each_covered = [&](const CoverSphere& sphere, const auto& use) {
    const double reach_m = sphere.radius_m + cover_m + 1e-9 * sphere.radius_m;
    for (Eigen::Index j = 0; j < points_m.cols(); ++j) {
      const double apart = (points_m.col(j) - sphere.center_m).squaredNorm();
      if (apart <= reach_m * reach_m) use(covered[static_cast<std::size_t>(j)], apart);
    }
  };
  for (const CoverSphere& sphere : spheres) {
    for_each_covered(sphere, [](int& count, double) { ++count; });
  }
  std::vector<CoverSphere> kept;
  for (const CoverSphere& sphere : spheres) {
    double needed = -1;
    for_each_covered(sphere, [&](const int& count, double apart) {
      if (count == 1) needed = std::max(needed, apart);
    });
    for_each_covered(sphere, [](int& count, double) { --count; });
    if (needed < 0) continue;
    CoverSphere tight = sphere;
    tight.radius_m =
        std::clamp(std::sqrt(needed) - cover_m, 1e-3 * sphere.radius_m, sphere.radius_m);
    for_each_covered(tight, [](int& count, double) { ++count; });
    kept.push_back(tight);
  }
  return kept.empty() ? std::vector<CoverSphere>{spheres.front()} : kept;
}

std::vector<CoverSphere> ShrinkCover(const Eigen::Matrix3Xd& points_m, double cover_m,
                                     std::vector<CoverSphere> spheres, int steps,
                                     double first_step) {
  double scale_m = 0;
  for (const CoverSphere& sphere : spheres) scale_m += sphere.radius_m;
  scale_m /= static_cast<double>(spheres.size());
  Unknowns x(4, static_cast<Eigen::Index>(spheres.size()));
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    const CoverSphere& sphere = spheres[static_cast<std::size_t>(i)];
    x.col(i) << sphere.center_m / scale_m, sphere.radius_m / scale_m;
  }
  Descent(points_m, cover_m, scale_m).Run(&x, steps, first_step);
  for (Eigen::Index i = 0; i < x.cols(); ++i) {
    spheres[static_cast<std::size_t>(i)] = {scale_m * x.col(i).head<3>(), scale_m * x(3, i)};
  }
  Close(points_m, cover_m, &spheres);
  return Tighten(points_m, cover_m, spheres);
}

}  // namespace sidestep::imports
