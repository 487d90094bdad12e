#include "sidestep/sdf/dense_composite.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

namespace sidestep::sdf {
namespace {

using Overlap = DenseSteps::Overlap;

Overlap FindOverlap(const GridSpec& spec, const MovingField& object, EpisodeTime t) {
  const GridSpec& object_spec = object.field_O->spec();
  const Pose X_WO = object.X_WO(t);
  if (object_spec.cell_m != spec.cell_m || X_WO.rotation().vec().norm() > 1e-12) {
    throw std::invalid_argument("ComposeDense: objects must share the cell edge and the axes");
  }
  const Eigen::Vector3d p_WFirst = X_WO.translation() + object_spec.first_center_m;
  Overlap overlap;
  for (std::size_t a = 0; a < 3; ++a) {
    const Eigen::Index axis = static_cast<Eigen::Index>(a);
    // Where the object's first cell comes to lie; far away is as good as anywhere there.
    const double begin = std::clamp(
        std::round((p_WFirst(axis) - spec.first_center_m(axis)) / spec.cell_m), -1e8, 1e8);
    const int first = static_cast<int>(begin);
    overlap.first[a] = std::clamp(first, 0, spec.size[a]);
    const int end = std::clamp(first + object_spec.size[a], overlap.first[a], spec.size[a]);
    overlap.size[a] = end - overlap.first[a];
    overlap.object_first[a] = overlap.first[a] - first;
  }
  return overlap;
}

// Calls visit(where the row begins in the grid, where in the object's grid, its length).
template <class Visitor>
void ForEachRow(const GridSpec& spec, const GridSpec& object_spec, const Overlap& overlap,
                const Visitor& visit) {
  const auto [i, j, k] = overlap.first;
  const auto [oi, oj, ok] = overlap.object_first;
  const auto [nx, ny, nz] = overlap.size;
  if (nx == 0) return;
  for (int c = 0; c < nz; ++c) {
    for (int b = 0; b < ny; ++b) {
      visit(spec.Index(i, j + b, k + c), object_spec.Index(oi, oj + b, ok + c),
            static_cast<std::size_t>(nx));
    }
  }
}

void Lower(const GridSpec& spec, const SdfGrid& field, const Overlap& overlap,
           std::span<float> distance_m) {
  ForEachRow(spec, field.spec(), overlap, [&](std::size_t to, std::size_t from, std::size_t count) {
    float* const row = &distance_m[to];
    const float* const object_row = &field.distance_m()[from];
    for (std::size_t n = 0; n < count; ++n) row[n] = std::min(row[n], object_row[n]);
  });
}

}  // namespace

void ComposeDense(const SdfGrid& static_W, const std::vector<MovingField>& objects, EpisodeTime t,
                  std::span<float> distance_m) {
  if (distance_m.size() != static_W.distance_m().size()) {
    throw std::invalid_argument("ComposeDense: needs room for one distance a cell");
  }
  std::copy(static_W.distance_m().begin(), static_W.distance_m().end(), distance_m.begin());
  for (const MovingField& object : objects) {
    const Overlap overlap = FindOverlap(static_W.spec(), object, t);
    Lower(static_W.spec(), *object.field_O, overlap, distance_m);
  }
}

SdfGrid ComposeDense(const SdfGrid& static_W, const std::vector<MovingField>& objects,
                     EpisodeTime t) {
  AlignedVector<float> distance_m(static_W.distance_m().size());
  ComposeDense(static_W, objects, t, distance_m);
  return SdfGrid(static_W.spec(), std::move(distance_m));
}

DenseSteps::DenseSteps(std::shared_ptr<const SdfGrid> static_W, std::vector<MovingField> objects)
    : static_W_(std::move(static_W)), objects_(std::move(objects)) {
  if (!static_W_) throw std::invalid_argument("DenseSteps: needs a static grid");
  distance_m_ = static_W_->distance_m();
}

std::span<const float> DenseSteps::At(EpisodeTime t) {
  std::vector<Overlap> overlaps;
  for (const MovingField& object : objects_) {
    overlaps.push_back(FindOverlap(static_W_->spec(), object, t));
  }
  for (std::size_t n = 0; n < lowered_.size(); ++n) {
    const GridSpec& object_spec = objects_[n].field_O->spec();
    ForEachRow(spec(), object_spec, lowered_[n],
               [&](std::size_t to, std::size_t, std::size_t count) {
                 std::copy_n(&static_W_->distance_m()[to], count, &distance_m_[to]);
               });
  }
  for (std::size_t n = 0; n < overlaps.size(); ++n) {
    Lower(spec(), *objects_[n].field_O, overlaps[n], distance_m_);
  }
  lowered_ = std::move(overlaps);
  return distance_m_;
}

}  // namespace sidestep::sdf
