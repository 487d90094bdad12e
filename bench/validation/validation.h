#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sidestep/bench/validation/item.h"

namespace sidestep::bench {

/// Where a validation's arms stand.
struct ValidationWorlds {
  WorldFactory simulated;
  /// At the end of a wire, in lock-step, with the lines under `faults:` of a faults file and the
  /// share of packets that is lost. Empty: there is none for this robot.
  std::function<WorldFactory(const std::string& faults, double lost_share)> wired;
};

/// The subject of a validation.
struct ValidationSubject {
  scenarios::Scenario
      scenario;  ///< with its task resolved, supervised; its seed is that of all draws
  robot::RobotModel robot;
};

/// @throws InputError, naming the scenario's key, for one that cannot be validated: without
/// supervision, or without anything that moves.
void CheckSubject(const ValidationSubject& subject);

/// The scenario of one case.
scenarios::Scenario ScenarioOf(const ValidationCase& one, const ValidationSubject& subject);

/// Runs a case. One that cannot be run is a row that failed. @param why_stop as in EpisodeOptions.
struct ValidationEpisode {
  RunRow row;
  EpisodeResult result;  ///< empty if it failed
};
ValidationEpisode RunValidationCase(const ValidationCase& one, const ValidationSubject& subject,
                                    const ValidationWorlds& worlds,
                                    const std::function<std::string()>& why_stop);

/// What an item found; where it could not be judged because rows are missing, that.
struct JudgedItem {
  ValidationItem item;
  ItemFinding finding;
};

/// @param is_whole whether all cases have been run: else what passes so far does not pass.
std::vector<JudgedItem> JudgeItems(const Evidence& evidence, bool is_whole);

}  // namespace sidestep::bench
