#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sidestep/bench/reproduce/open_loop_experiment.h"
#include "sidestep/bench/reproduce/published_maps.h"
#include "sidestep/sdf/distance_field.h"

namespace sidestep::bench {

/// What a planner believes under `prediction` in the open-loop protocol. At solve `now` it has seen
/// the occupancy of steps 0 ... now, once each and nothing else; the product's own segmentation,
/// tracking and prediction make a composite field of them, which is frozen at the time of each
/// step, as the protocol has it. At solve 0 nothing is known to move.
///
/// Distances are of the same convention as the true maps, so that a perfect prediction would be
/// full knowledge. Immutable; safe from many threads.
class PredictedMaps {
 public:
  /// @param predictor a name of sdf/prediction/registry.h.
  /// @param max_distance_m where fields are clamped: no cost may reach further.
  /// @throws std::invalid_argument for an unknown predictor.
  PredictedMaps(const OpenLoopExperiment& experiment, const PublishedMaps& maps,
                sdf::DistanceConvention convention, const std::string& predictor,
                double max_distance_m, int num_jobs);

  /// The belief at solve `now` for step k, at one of the experiment's speeds.
  const sdf::DistanceField& At(double speed_m_s, int now, int k) const;

 private:
  int num_states_;
  // By speed; within it, `now` runs slower than k.
  std::map<double, std::vector<std::unique_ptr<const sdf::DistanceField>>> fields_;
};

}  // namespace sidestep::bench
