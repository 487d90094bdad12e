#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/free_path_search.h"
#include "sidestep/core/random.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep {

/// The arm of hardware_single_table under the profile `lab`, with a predictor that sees things
/// turn, and a box that moves at random: within what it is declared to do, or beyond.
enum class Envelope { kWithin, kBeyond };

/// One episode: what happened.
struct SupervisedEpisode {
  std::uint64_t seed = 0;
  std::string motion;                           ///< of the box: "linear", "accelerated", "circle"
  double speed_m_s = 0, acceleration_m_s2 = 0;  ///< the most that the box has
  bench::Outcome outcome = bench::Outcome::kTimeout;
  std::string reason;             ///< why it was aborted
  std::optional<double> goal_s;   ///< when it had arrived
  std::optional<double> touch_s;  ///< when the box was touched first
  double touch_m_s = 0;           ///< the fastest part of the arm then, as it was told
  bool touched_in_motion = false;
  std::map<std::string, int> findings;  ///< "stop_path hold" -> so often
  std::optional<double> too_fast_m_s;   ///< at which obstacle_too_fast was found first
};

class SupervisedEpisodes {
 public:
  /// @param source_dir the root of the tree.
  SupervisedEpisodes(const std::string& source_dir, Envelope envelope);

  SupervisedEpisode Run(std::uint64_t seed) const;
  bench::EpisodeResult RunWhole(const scenarios::Scenario& scenario) const;
  /// Whether it can be done at all, by one who knows where the box will be.
  bench::FreePath Search(std::uint64_t seed, int max_guesses) const;
  /// Its scenario.
  scenarios::Scenario Make(std::uint64_t seed) const;

 private:
  std::string models_;
  Envelope envelope_;
  scenarios::Scenario scenario_;
  robot::RobotModel robot_;
};

}  // namespace sidestep
