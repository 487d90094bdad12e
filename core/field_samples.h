#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sidestep/core/grid.h"
#include "sidestep/core/time.h"

namespace sidestep {

/// What a distance field said on a grid of points about one moment.
struct FieldVolume {
  EpisodeTime t_seen;  ///< when the field was made: it knows nothing later
  EpisodeTime t;       ///< the moment it was asked about
  /// By GridSpec::Index: 0 is at most 0 m, so within something solid; 255 is the field's largest
  /// distance; evenly between.
  std::vector<std::uint8_t> distance;
};

/// The fields of an episode, one planning cycle after the other, for looking at.
struct FieldSamples {
  GridSpec grid;  ///< its cells' centres are where the fields were asked
  double max_distance_m = 0;
  std::vector<double> ahead_s;       ///< how long after the cycle each was asked about
  std::vector<FieldVolume> volumes;  ///< of each cycle one for each of ahead_s
  std::string why_none;              ///< why there are none; empty if there are
};

}  // namespace sidestep
