#include "sidestep/cli/run_folder.h"

#include <string>

#include "sidestep/bench/result_file.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/provenance.h"
#include "sidestep/cli/run_summary.h"
#include "sidestep/cli/versions.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/record/recording_file.h"

namespace sidestep::cli {

std::string WriteResults(const bench::EpisodeResult& result, const scenarios::Scenario& scenario,
                         const bench::RunIdentity& identity,
                         const std::map<std::string, std::string>& versions,
                         const std::string& out) {
  record::WriteRecording(result.recording, out + "/trace.h5");
  std::string json = bench::ResultJson(result, scenario, identity, versions);
  WriteFile(out + "/result.json", json);
  return json;
}

RunFolder::RunFolder(const std::string& out, const bench::RunIdentity& identity)
    : out_(out, {"trace.h5", "result.json", kJournalName}),
      identity_(identity),
      journal_(out_.path() + "/" + kJournalName, Provenance(identity),
               [](const std::string& why) { PrintError("{}; the run goes on\n", why); }) {
  out_.Lock();  // the journal begins with the first thing that it keeps
}

void RunFolder::KeepAndTell(bench::EpisodeResult& result, const scenarios::Scenario& scenario,
                            bool as_json) {
  AddProvenance(identity_, result.recording);
  std::string json;
  try {
    json = WriteResults(result, scenario, identity_, Versions(), out_.path());
  } catch (const InputError& error) {
    if (!as_json) PrintOutcome(result, scenario);
    if (!journal_.Close()) throw;
    throw InputError(std::string(error.what()) + "; " + kJournalName + " holds the run",
                     "`sidestep salvage " + out_.path() + " --out DIR`");
  }
  journal_.Remove();
  if (as_json) {
    PrintText(json);
  } else {
    PrintOutcome(result, scenario);
    Print("written          {}/result.json, {}/trace.h5\n", out_.path(), out_.path());
  }
  bench::RequireWhole(result);  // what there is has been written
}

}  // namespace sidestep::cli
