#include "sidestep/sdf/composite_field.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <span>
#include <stdexcept>
#include <utility>

namespace sidestep::sdf {
namespace {

double LowestAtItsBorder(const SdfGrid& field) {
  double lowest_m = std::numeric_limits<double>::infinity();
  const auto [nx, ny, nz] = field.spec().size;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      const bool whole_row = j == 0 || j == ny - 1 || k == 0 || k == nz - 1;
      const int step = whole_row || nx == 1 ? 1 : nx - 1;
      for (int i = 0; i < nx; i += step) lowest_m = std::min(lowest_m, double{field.At(i, j, k)});
    }
  }
  return lowest_m;
}

}  // namespace

CompositeField::CompositeField(std::shared_ptr<const SdfGrid> static_W,
                               std::vector<MovingField> objects, double max_distance_m,
                               const StaticSolids& exact)
    : static_W_(std::move(static_W)),
      objects_(std::move(objects)),
      max_distance_m_(max_distance_m),
      exact_(exact) {
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
  }
  // Objects may share a field: each is looked at once.
  struct Seen {
    FieldBound bound;
    double border_m;
  };
  std::map<const SdfGrid*, Seen> seen;
  const bool many = objects_.size() >= PlacedComposite::kMany;
  for (const MovingField& object : objects_) {
    const SdfGrid& field = *object.field_O;
    if (!seen.contains(&field)) {
      seen[&field] = {many ? TightBound(field) : DomainBound(field), LowestAtItsBorder(field)};
    }
    if (!(seen[&field].border_m >= max_distance_m_ + object.max_growth_m)) {
      throw std::invalid_argument("CompositeField: an object's grid has too little padding");
    }
    bounds_.push_back(seen[&field].bound);
  }
}

PlacedComposite CompositeField::PlacedAt(EpisodeTime t) const {
  // Few find room without asking for memory: slices are made by the hundred.
  constexpr std::size_t kFew = 4;
  std::array<PlacedObject, kFew> few;
  std::vector<PlacedObject> many(objects_.size() > kFew ? objects_.size() : 0);
  const std::span<PlacedObject> placed =
      many.empty() ? std::span(few).first(objects_.size()) : std::span(many);
  for (std::size_t n = 0; n < objects_.size(); ++n) {
    const MovingField& object = objects_[n];
    PlacedObject& at_t = placed[n];
    at_t.field_O = object.field_O.get();
    at_t.bound = bounds_[n];
    at_t.X_WO = object.X_WO(t);
    if (object.growth_m) at_t.growth_m = std::clamp(object.growth_m(t), 0.0, object.max_growth_m);
  }
  return {*static_W_, placed, max_distance_m_, &exact_};
}

std::unique_ptr<const FieldSlice> CompositeField::At(EpisodeTime t) const {
  // Made in its place, not moved there.
  return std::unique_ptr<const FieldSlice>(new PlacedComposite(PlacedAt(t)));
}

DistanceSample CompositeField::Sample(const Eigen::Vector3d& p_WQ, EpisodeTime t) const {
  return PlacedAt(t).Sample(p_WQ);
}

void CompositeField::SampleMany(const Eigen::Matrix3Xd& p_WQ, EpisodeTime t,
                                DistanceSamples& samples) const {
  PlacedAt(t).SampleMany(p_WQ, samples);
}

}  // namespace sidestep::sdf
