#pragma once

#include <string>
#include <vector>

#include "sidestep/bench/run_row.h"
#include "sidestep/bench/study_page.h"
#include "sidestep/cli/data_paths.h"

namespace sidestep::cli {

/// What a study is of, as it is asked for on the command line.
struct StudySpace {
  std::string scenario;
  std::vector<std::string> settings;  ///< KEY=VALUE; each is a factor of one value
  std::vector<std::string> varied;    ///< cli/varied_keys.h; each is a factor of several
  std::vector<std::string> knowledge, predictors;
  std::vector<double> speeds;
  int episodes = 0;  ///< seeds 1, 2, ... ; 0: the scenario's own
  int search = 0;    ///< guesses; 0: no search
};

/// Every combination: the file's choices that no setting fixes or varies, and what the flags list.
/// @throws InputError for a value that is given twice or unknown.
std::vector<bench::Factors> StudyCases(const StudySpace& space, const DataPaths& paths);

/// Fills what is empty, from what varies beside seeds: the kinds of knowledge or else the
/// predictors go across, and what comes first of the others down.
/// @throws InputError for a name that is no factor, or asked for twice.
bench::TableAxes ChooseAxes(const std::vector<bench::Factors>& cases, bench::TableAxes asked);

}  // namespace sidestep::cli
