#pragma once

#include <limits>
#include <string>
#include <vector>

#include "sidestep/bench/episode.h"

namespace sidestep::bench {

/// A robot without inertia in a world of shapes, for the loop's own tests: no simulator.
struct KinematicWorld {
  bool moves = true;   ///< false: the robot stays where it is, whatever it is told
  bool sees = true;    ///< false: its sensor never captures anything
  bool judges = true;  ///< false: there is no WorldTruth, as on hardware

  /// Who throws, from `breaks_at_s` on: "robot" (in AdvanceTo; with its last ticks, which nobody
  /// has taken, and a finding of its supervisor), "sensor", "truth"; empty: nobody.
  std::string breaks;
  double breaks_at_s = 0;

  /// From then on the sensor has nothing more to give, though it says that it is overdue.
  double falls_silent_at_s = std::numeric_limits<double>::infinity();

  /// Between these it follows its plans at half their speed, and from then on as late as that made
  /// it.
  double slow_from_s = std::numeric_limits<double>::infinity();
  double slow_until_s = std::numeric_limits<double>::infinity();

  /// Between these its own safety keeps it at rest, and it forgets what it is told to follow.
  double held_from_s = std::numeric_limits<double>::infinity();
  double held_until_s = std::numeric_limits<double>::infinity();

  /// What the loop did: at `when`, it submitted a trajectory to be followed from `start`.
  struct Submission {
    EpisodeTime when, start;
  };
  std::vector<Submission> submissions;
  bool holds = false;   ///< the robot was told to, and to nothing else since
  int empty_reads = 0;  ///< how often the sensor had nothing to give

  /// For RunEpisode; this world, its scenario and its robot must outlive the episode.
  WorldFactory Factory();
};

}  // namespace sidestep::bench
