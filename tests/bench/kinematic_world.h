#pragma once

#include <vector>

#include "sidestep/bench/episode.h"

namespace sidestep::bench {

/// A robot without inertia in a world of shapes, for the loop's own tests: no simulator.
struct KinematicWorld {
  bool moves = true;   ///< false: the robot stays where it is, whatever it is told
  bool sees = true;    ///< false: its sensor never captures anything
  bool judges = true;  ///< false: there is no WorldTruth, as on hardware

  /// What the loop did: at `when`, it submitted a trajectory to be followed from `start`.
  struct Submission {
    EpisodeTime when, start;
  };
  std::vector<Submission> submissions;

  /// For RunEpisode; this world, its scenario and its robot must outlive the episode.
  WorldFactory Factory();
};

}  // namespace sidestep::bench
