#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/time.h"
#include "sidestep/record/recording.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// One planning cycle of an episode that failed, looked at again.
struct HindsightCycle {
  EpisodeTime t, t_effect;  ///< as in CycleRecord
  /// As far as was known at that cycle, its plan touches nothing.
  bool was_thought_free = false;
  /// From where the arm was at t_effect, a motion to the goal touches nothing: as far as was known
  /// at that cycle, and in truth, as it came.
  bool knew_a_way = false, had_a_way = false;
  /// Of the best motions that were found from there, each in its world [m].
  double known_clearance_m = 0, true_clearance_m = 0;
};

enum class HindsightVerdict {
  kReached,   ///< nothing failed, so there is nothing to look back at
  kNoWay,     ///< from the first cycle on no way was found
  kNotKnown,  ///< whenever there was a way left, the plan was thought to be free, or no way was
              ///< known
  kKnown      ///< a way was left, and one was known, when the plan was thought to touch something
};

/// "reached", "no way", "not known in time", "known in time".
std::string ToString(HindsightVerdict verdict);

struct Hindsight {
  HindsightVerdict verdict = HindsightVerdict::kReached;
  std::optional<EpisodeTime> contact;  ///< when something was touched first
  std::vector<HindsightCycle> cycles;  ///< those whose plan took effect before that, in order
};

/// Why the episode was aborted, where nothing had been touched: when the link was lost, or a person
/// stopped it, no plan could have reached the goal, so there is nothing to look back at.
std::optional<std::string> WhyCutShort(const record::Recording& recording);

/// Could what failed have been known in time? For each cycle before the first contact (or the end,
/// if the goal was never reached) two long searches (bench/free_path_search.h) begin where the arm
/// was when that cycle's plan took effect: one knows what was known then (bench/recorded_fields.h),
/// the other all that came. That one finds nothing does not prove that there is nothing.
/// @param scenario of the recording, with its task resolved.
/// @throws std::invalid_argument for a recording of another robot, without control samples, of an
/// episode that was cut short (WhyCutShort), or whose fields cannot be made again
/// (WhyNoRecordedFields).
Hindsight LookBack(const record::Recording& recording, const scenarios::Scenario& scenario,
                   const robot::RobotModel& robot, int max_guesses, std::uint64_t seed);

}  // namespace sidestep::bench
