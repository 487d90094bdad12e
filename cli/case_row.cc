#include "sidestep/cli/case_row.h"

#include <optional>

#include "sidestep/cli/provenance.h"
#include "sidestep/cli/run_case.h"
#include "sidestep/core/input_error.h"

namespace sidestep::cli {

bench::RecordedRun RunCase(const std::string& scenario, const bench::Factors& factors, int guesses,
                           const DataPaths& paths, const bench::WorldFactory& make_world,
                           CheckedRobots* robots) {
  std::optional<Problem> problem;
  try {
    problem = LoadCase(scenario, factors, paths, robots);
  } catch (const InputError& error) {
    return {bench::FailedRow({}, FaultByFactor(error.what())), {}};
  }
  bench::RecordedRun run;
  if (IsSearch(factors)) {
    run.row = bench::RunSearchRow(problem->scenario, problem->robot, guesses, {});
  } else {
    run = bench::RunEpisodeRow(problem->scenario, problem->robot, make_world, {});
  }
  run.row.identity = Identify(problem->scenario, paths);
  if (IsSearch(factors)) {
    run.row.identity.method = "search " + std::to_string(guesses);
    run.row.subject.knowledge = kSearch;
  }
  return run;
}

}  // namespace sidestep::cli
