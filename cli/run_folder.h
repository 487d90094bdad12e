#pragma once

#include <map>
#include <string>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/run_identity.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/record/journal.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {

/// Of a run whose process ended before the run did.
inline constexpr const char* kJournalName = "trace.journal";

/// Writes trace.h5 and result.json into the folder `out`. @return the text of result.json.
std::string WriteResults(const bench::EpisodeResult& result, const scenarios::Scenario& scenario,
                         const bench::RunIdentity& identity,
                         const std::map<std::string, std::string>& versions,
                         const std::string& out);

/// The files of one run: trace.h5 and result.json, and as long as they are not there a journal of
/// what has been recorded so far, which `sidestep salvage` makes them from. A folder that was made
/// for a run that is then refused goes again. As long as this lives, no other run gets the folder:
/// it would replace the results.
class RunFolder {
 public:
  /// @throws InputError if `out` cannot be made a folder, cannot take the files, or another run
  /// writes there.
  RunFolder(const std::string& out, const bench::RunIdentity& identity);

  record::Journal& journal() { return journal_; }

  /// Writes the results, and prints what came of the episode: that and where it is written, or the
  /// whole result.json.
  /// @throws std::runtime_error at the end, with the reason, if the episode was aborted.
  void KeepAndTell(bench::EpisodeResult& result, const scenarios::Scenario& scenario, bool as_json);

 private:
  OutFolder out_;
  const bench::RunIdentity identity_;
  record::Journal journal_;
};

}  // namespace sidestep::cli
