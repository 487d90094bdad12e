#include "sdf/composite_field.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace sidestep {
namespace {

// An object's field, placed for one time.
struct PlacedField {
  PlacedField(const MovingField& object, EpisodeTime t) : field_O(*object.field_O) {
    const Pose X_WO = object.X_WO(t);
    R_WO = X_WO.rotation().toRotationMatrix();
    p_WO = X_WO.translation();
    if (object.growth_m) growth_m = std::clamp(object.growth_m(t), 0.0, object.max_growth_m);
  }

  // Lowers the given answer at Q to that of this object, if that is nearer.
  template <class Gradient>
  void Lower(const Eigen::Vector3d& p_WQ, double& distance_m, Gradient&& gradient_W) const {
    const GridSample sample = field_O.Sample(R_WO.transpose() * (p_WQ - p_WO));
    const double object_m = sample.distance_m - growth_m;
    if (sample.in_grid && object_m < distance_m) {
      distance_m = object_m;
      gradient_W = R_WO * sample.gradient;
    }
  }

  const SdfGrid& field_O;
  Eigen::Matrix3d R_WO;
  Eigen::Vector3d p_WO;
  double growth_m = 0;
};

bool ReachesClampAtItsBorder(const SdfGrid& field, double clamp_m) {
  const auto [nx, ny, nz] = field.spec().size;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      const bool whole_row = j == 0 || j == ny - 1 || k == 0 || k == nz - 1;
      const int step = whole_row || nx == 1 ? 1 : nx - 1;
      for (int i = 0; i < nx; i += step) {
        if (field.At(i, j, k) < clamp_m) return false;
      }
    }
  }
  return true;
}

}  // namespace

CompositeField::CompositeField(std::shared_ptr<const SdfGrid> static_W,
                               std::vector<MovingField> objects, double max_distance_m)
    : static_W_(std::move(static_W)),
      objects_(std::move(objects)),
      max_distance_m_(max_distance_m) {
  if (!static_W_ || !(max_distance_m_ > 0)) {
    throw std::invalid_argument("CompositeField: needs a static grid and a clamp > 0");
  }
  for (const MovingField& object : objects_) {
    if (!object.field_O || !object.X_WO) {
      throw std::invalid_argument("CompositeField: an object needs a field and a pose");
    }
    if (!(object.max_growth_m >= 0)) {
      throw std::invalid_argument("CompositeField: max_growth_m must be >= 0");
    }
    if (!ReachesClampAtItsBorder(*object.field_O, max_distance_m_ + object.max_growth_m)) {
      throw std::invalid_argument("CompositeField: an object's grid has too little padding");
    }
  }
}

DistanceSample CompositeField::SampleStatic(const Eigen::Vector3d& p_WQ) const {
  const GridSample sample = static_W_->Sample(p_WQ);
  if (!sample.in_grid || sample.distance_m >= max_distance_m_) {
    return {max_distance_m_, Eigen::Vector3d::Zero(), sample.in_grid};
  }
  return {sample.distance_m, sample.gradient, true};
}

DistanceSample CompositeField::Sample(const Eigen::Vector3d& p_WQ, EpisodeTime t) const {
  DistanceSample sample = SampleStatic(p_WQ);
  for (const MovingField& object : objects_) {
    PlacedField(object, t).Lower(p_WQ, sample.distance_m, sample.gradient_W);
  }
  return sample;
}

void CompositeField::SampleMany(const Eigen::Matrix3Xd& p_WQ, EpisodeTime t,
                                DistanceSamples& samples) const {
  samples.distance_m.resize(p_WQ.cols());
  samples.gradient_W.resize(3, p_WQ.cols());
  samples.num_outside = 0;
  for (Eigen::Index s = 0; s < p_WQ.cols(); ++s) {
    const DistanceSample sample = SampleStatic(p_WQ.col(s));
    samples.distance_m(s) = sample.distance_m;
    samples.gradient_W.col(s) = sample.gradient_W;
    samples.num_outside += sample.in_grid ? 0 : 1;
  }
  for (const MovingField& object : objects_) {
    const PlacedField placed(object, t);
    for (Eigen::Index s = 0; s < p_WQ.cols(); ++s) {
      placed.Lower(p_WQ.col(s), samples.distance_m(s), samples.gradient_W.col(s));
    }
  }
}

}  // namespace sidestep
