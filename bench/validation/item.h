#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/run_row.h"
#include "sidestep/bench/validation/validation_case.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench {

/// Numbers that an item takes from one episode, each by a name of its own; NaN: does not apply.
using Facts = std::map<std::string, double>;

/// An episode that has been run, as items see it.
struct ValidationRun {
  const ValidationCase& one;
  const scenarios::Scenario& scenario;  ///< as run
  const robot::RobotModel& robot;
  const EpisodeResult& result;
};

enum class ItemVerdict { kPass, kFail, kNotRun };
/// "pass", "fail", "not run".
const char* ToString(ItemVerdict verdict);

/// An episode that an item names, because it is the worst or the reason of a failure.
struct NamedCase {
  std::string name;  ///< NameOf
  std::string what;
};

struct ItemFinding {
  ItemVerdict verdict = ItemVerdict::kNotRun;
  std::string evidence;          ///< in plain words, with figures; why it was not run
  std::vector<NamedCase> worst;  ///< a few, the worst first
};

/// What all items judge by: one row an episode, whose metrics are all facts.
struct Evidence {
  const scenarios::Scenario& scenario;  ///< as asked for
  const std::vector<RunRow>& rows;
  /// How much more the program held between episodes at the end of a soak than in its second tenth,
  /// beside the rows, as a share of the most it ever had; none: there was no soak, or not to its
  /// end.
  std::optional<double> memory_growth = {};
};

/// One thing that has to hold before a robot moves.
struct ValidationItem {
  int number = 0;
  const char* name;
  const char* requirement;                 ///< what passes, with its figures
  const char* basis;                       ///< where the figures come from
  Facts (*measure)(const ValidationRun&);  ///< null: it takes nothing from episodes
  ItemFinding (*judge)(const Evidence&);
};

/// Every item, in the order of reports. To add one: items.def.
std::span<const ValidationItem> ValidationItems();

/// Of all items. @throws std::logic_error where two give a fact of the same name.
Facts MeasureFacts(const ValidationRun& run);

}  // namespace sidestep::bench
