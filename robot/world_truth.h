#pragma once

#include <optional>
#include <vector>

#include "sidestep/core/observations.h"
#include "sidestep/core/samples.h"
#include "sidestep/core/time.h"

namespace sidestep::robot {

/// What a simulator knows and a real world does not tell. Absent on hardware.
class WorldTruth {
 public:
  virtual ~WorldTruth() = default;

  /// Every moving obstacle as it is, was or will be at `t`, in the order of the scenario.
  virtual std::vector<ObjectObservation> ObstaclesAt(EpisodeTime t) const = 0;

  /// Every sample (100 Hz) since the last call. Contacts of all physics steps are in them.
  virtual std::vector<TruthSample> TakeSamples() = 0;

  /// The first contact since the latest sample, if there was one, as a sample of that moment: an
  /// episode may end before the next sample is due. None where contact is judged at samples alone.
  virtual std::optional<TruthSample> ContactSinceLastSample() const { return std::nullopt; }
};

}  // namespace sidestep::robot
