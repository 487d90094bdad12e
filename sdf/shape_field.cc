#include "sidestep/sdf/shape_field.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "sidestep/sdf/block_samples.h"

namespace sidestep::sdf {
namespace {

// The shapes where they are at one moment.
class ShapeSlice final : public FieldSlice {
 public:
  ShapeSlice(const ExactSolids& still, std::vector<ExactShape> moved, double max_distance_m)
      : still_(still), moved_(std::move(moved)), max_distance_m_(max_distance_m) {}

  int SampleBlock(PointBlock& block) const override {
    for (std::size_t n = 0; n < block.count; ++n) {
      DistanceSample sample{max_distance_m_, Eigen::Vector3d::Zero(), true};
      still_.Lower(PointOf(block, n), sample);
      for (const ExactShape& shape : moved_) shape.Lower(PointOf(block, n), sample);
      SetSample(sample, n, block);
    }
    return 0;
  }

 private:
  const ExactSolids& still_;
  std::vector<ExactShape> moved_;
  double max_distance_m_;
};

}  // namespace

ShapeField::ShapeField(const StaticSolids& still, std::vector<MovingShape> moving,
                       double max_distance_m)
    : still_(still), moving_(std::move(moving)), max_distance_m_(max_distance_m) {
  if (!(max_distance_m_ > 0)) throw std::invalid_argument("ShapeField: needs a clamp > 0");
  for (const MovingShape& moving_shape : moving_) {
    if (!moving_shape.X_WO) throw std::invalid_argument("ShapeField: a shape needs a pose");
  }
}

double ShapeField::Distance(const Eigen::Vector3d& p_WQ, EpisodeTime t) const {
  double least_m = still_.Distance(p_WQ);
  for (const MovingShape& moving : moving_) {
    least_m = std::min(least_m, ExactShape(moving.shape, moving.X_WO(t)).Distance(p_WQ));
  }
  return least_m;
}

DistanceSample ShapeField::Sample(const Eigen::Vector3d& p_WQ, EpisodeTime t) const {
  DistanceSample sample{max_distance_m_, Eigen::Vector3d::Zero(), true};
  still_.Lower(p_WQ, sample);
  for (const MovingShape& moving : moving_) {
    ExactShape(moving.shape, moving.X_WO(t)).Lower(p_WQ, sample);
  }
  return sample;
}

void ShapeField::SampleMany(const Eigen::Matrix3Xd& p_WQ, EpisodeTime t,
                            DistanceSamples& samples) const {
  samples.distance_m.resize(p_WQ.cols());
  samples.gradient_W.resize(3, p_WQ.cols());
  samples.num_outside = 0;
  const std::vector<ExactShape> moved = MovedTo(t);
  for (Eigen::Index s = 0; s < p_WQ.cols(); ++s) {
    DistanceSample sample{max_distance_m_, Eigen::Vector3d::Zero(), true};
    still_.Lower(p_WQ.col(s), sample);
    for (const ExactShape& shape : moved) shape.Lower(p_WQ.col(s), sample);
    samples.distance_m(s) = sample.distance_m;
    samples.gradient_W.col(s) = sample.gradient_W;
  }
}

std::unique_ptr<const FieldSlice> ShapeField::At(EpisodeTime t) const {
  return std::make_unique<ShapeSlice>(still_, MovedTo(t), max_distance_m_);
}

std::vector<ExactShape> ShapeField::MovedTo(EpisodeTime t) const {
  std::vector<ExactShape> moved;
  moved.reserve(moving_.size());
  for (const MovingShape& moving : moving_) moved.emplace_back(moving.shape, moving.X_WO(t));
  return moved;
}

}  // namespace sidestep::sdf
