#include "sidestep/sdf/distance_field.h"

namespace sidestep::sdf {
namespace {

// Of any field: asks it each time.
class AskingSlice final : public FieldSlice {
 public:
  AskingSlice(const DistanceField& field, EpisodeTime t) : field_(field), t_(t) {}

  int SampleBlock(PointBlock& block) const override {
    const auto size = static_cast<Eigen::Index>(block.count);
    Eigen::Matrix3Xd p_WQ(3, size);
    for (Eigen::Index s = 0; s < size; ++s) p_WQ.col(s) << block.x[s], block.y[s], block.z[s];
    DistanceSamples samples;
    field_.SampleMany(p_WQ, t_, samples);
    for (Eigen::Index s = 0; s < size; ++s) {
      block.distance_m[s] = samples.distance_m(s);
      block.gradient_x[s] = samples.gradient_W(0, s);
      block.gradient_y[s] = samples.gradient_W(1, s);
      block.gradient_z[s] = samples.gradient_W(2, s);
    }
    return samples.num_outside;
  }

 private:
  const DistanceField& field_;
  EpisodeTime t_;
};

}  // namespace

void DistanceField::SampleMany(const Eigen::Matrix3Xd& p_WQ, EpisodeTime t,
                               DistanceSamples& samples) const {
  samples.distance_m.resize(p_WQ.cols());
  samples.gradient_W.resize(3, p_WQ.cols());
  samples.num_outside = 0;
  for (Eigen::Index s = 0; s < p_WQ.cols(); ++s) {
    const DistanceSample sample = Sample(p_WQ.col(s), t);
    samples.distance_m(s) = sample.distance_m;
    samples.gradient_W.col(s) = sample.gradient_W;
    samples.num_outside += sample.in_grid ? 0 : 1;
  }
}

std::unique_ptr<const FieldSlice> DistanceField::At(EpisodeTime t) const {
  return std::make_unique<AskingSlice>(*this, t);
}

}  // namespace sidestep::sdf
