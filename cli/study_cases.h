#pragma once

#include <string>
#include <vector>

#include "sidestep/bench/sweep/sweep.h"
#include "sidestep/cli/data_paths.h"

namespace sidestep::cli {

/// A sweep as it is asked for on the command line, of one scenario.
struct StudySpace {
  std::string scenario;
  std::vector<std::string> settings;  ///< KEY=VALUE; each is an axis of one value
  std::vector<std::string> varied;    ///< cli/varied_keys.h; each is an axis of several
  std::vector<std::string> knowledge, predictors;
  std::vector<double> speeds;
  int episodes = 0;  ///< seeds 1, 2, ... ; 0: the scenario's own
  int search = 0;    ///< guesses; 0: no search
};

/// Every combination: the file's choices that no setting fixes or varies, and what the flags list.
/// It has neither description nor traces.
/// @throws InputError for a value that is given twice or unknown.
bench::Sweep SweepOf(const StudySpace& space, const DataPaths& paths);

}  // namespace sidestep::cli
