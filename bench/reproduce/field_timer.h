#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "sidestep/bench/reproduce/field_scene.h"
#include "sidestep/core/grid.h"
#include "sidestep/core/time.h"
#include "sidestep/sdf/aligned_vector.h"
#include "sidestep/sdf/composite_field.h"
#include "sidestep/sdf/dense_composite.h"
#include "sidestep/sdf/map/fast_distance_transform.h"
#include "sidestep/sdf/map/sdf_grid.h"

namespace sidestep::bench {

/// What making the field of one predicted moment cost [s, CPU], by the ways there are.
struct PredictionTimes {
  double full_s = 0;         ///< the map of that moment, and its exact transform
  double dense_s = 0;        ///< the composite as a grid: copy and min (sdf/dense_composite.h)
  double incremental_s = 0;  ///< the same, from the grid of the moment asked about before
  double lazy_s = 0;         ///< making the composite that is composed when asked
  double query_s = 0;        ///< asking that for one point, mean of many
};

/// One of them of each prediction.
inline std::vector<double> Collect(const std::vector<PredictionTimes>& predictions,
                                   double PredictionTimes::*value) {
  std::vector<double> values;
  for (const PredictionTimes& times : predictions) values.push_back(times.*value);
  return values;
}

/// How far the dense composite is from the exact field of the same moment, at cell centres [m].
struct CompositeError {
  double free_m = 0;    ///< at most, in free cells within the margin of an obstacle
  double inside_m = 0;  ///< at most, in filled cells
};

/// A field scene as a predictor knows it that has seen it twice: the protocol of the published
/// timings. The static part is known; objects are the connected rest of the map at the second
/// moment, matched with those at the first by the nearest centroid, and go on with the velocity
/// between the two. If not as many were seen at the first, all rest. Fields are those of the
/// authors' convention (kBwdist).
class FieldTimer {
 public:
  /// @param margin_m of objects' fields.
  /// @throws std::invalid_argument unless first < second.
  FieldTimer(const scenarios::Scenario& scene, const GridSpec& grid, double margin_m,
             EpisodeTime first, EpisodeTime second);

  /// Making the static field and those of the objects [s, CPU].
  double init_s() const { return init_s_; }
  const std::vector<sdf::MovingField>& objects() const { return objects_; }

  /// Grids are written to memory that is there already.
  PredictionTimes Time(EpisodeTime t);

  /// Whether all of every object lies in the grid at `t`. If not, a composite field still knows
  /// what lies outside, and the exact transform of the grid does not.
  bool HoldsAllObjects(EpisodeTime t) const;
  CompositeError Compare(EpisodeTime t);

 private:
  OccupancyGrid PredictMap(EpisodeTime t) const;
  void ComputeExact(const OccupancyGrid& map);

  double margin_m_;
  OccupancyGrid static_occupancy_;
  std::vector<OccupancyGrid> shapes_O_;
  double init_s_ = 0;
  std::shared_ptr<const sdf::SdfGrid> static_W_;
  std::vector<sdf::MovingField> objects_;
  sdf::FastDistanceTransform transform_;
  sdf::AlignedVector<float> exact_m_, dense_m_;
  std::optional<sdf::DenseSteps> steps_;
  Eigen::Matrix3Xd queries_W_;
};

}  // namespace sidestep::bench
