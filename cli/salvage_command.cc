#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "sidestep/bench/episode.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/provenance.h"
#include "sidestep/cli/run_folder.h"
#include "sidestep/cli/run_summary.h"
#include "sidestep/core/input_error.h"
#include "sidestep/record/journal.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {
namespace {

struct SalvageOptions {
  std::string folder, out;
};

// What tells no run may be anybody's.
std::pair<bench::RunIdentity, std::map<std::string, std::string>> OriginOf(
    const record::Recording& recording, const std::string& journal) {
  if (recording.joints.empty()) throw InputError(journal, "names no joints");
  try {
    return {IdentityIn(recording.header), VersionsIn(recording.header)};
  } catch (const std::out_of_range&) {
    throw InputError(journal, "does not say what run it is of");
  }
}

int Salvage(const SalvageOptions& options) {
  const std::string journal = options.folder + "/" + kJournalName;
  record::JournalContents contents = record::ReadJournal(journal);
  const std::string out = MakeOutFolder(options.out.empty() ? options.folder : options.out,
                                        {"trace.h5", "result.json"});
  if (!contents.damage.empty()) {
    PrintError("{}: {}; what is before that is kept\n", journal, contents.damage);
  }
  const auto [identity, versions] = OriginOf(contents.recording, journal);
  const scenarios::Scenario scenario =
      scenarios::ParseScenario(contents.recording.scenario_yaml, journal + ": scenario_yaml");
  const bench::EpisodeResult result = bench::CutOffEpisode(std::move(contents.recording));
  WriteResults(result, scenario, identity, versions, out);
  std::error_code error;
  std::filesystem::remove(journal, error);  // read-only media keep it
  PrintOutcome(result, scenario);
  Print("written          {}/result.json, {}/trace.h5\n", out, out);
  return 0;
}

}  // namespace

void AddSalvageCommand(CommandLine& line) {
  auto options = std::make_shared<SalvageOptions>();
  CLI::App* const salvage = line.app.add_subcommand(
      "salvage", "Make trace.h5 and result.json of a run that was killed, from its journal");
  salvage->add_option("DIR", options->folder, "The folder of the run, with its trace.journal")
      ->required();
  salvage->add_option("--out", options->out, "Folder for the results [DIR]");
  salvage->footer(
      "`sidestep run` and `sidestep hardware run` keep what they have recorded in trace.journal,\n"
      "four times a second, until trace.h5 stands.");
  salvage->callback([&line, options] { line.exit_code = Salvage(*options); });
}

}  // namespace sidestep::cli
