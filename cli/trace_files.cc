#include "sidestep/cli/trace_files.h"

#include <filesystem>
#include <system_error>

#include "sidestep/cli/run_folder.h"
#include "sidestep/core/input_error.h"
#include "sidestep/record/recording_file.h"

namespace sidestep::cli {
namespace {

// Of a run that was killed there is no trace yet.
void CheckIsNotOnlyAJournal(const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  std::error_code error;
  if (std::filesystem::exists(path, error)) return;
  if (!std::filesystem::exists(folder / kJournalName, error)) return;
  throw InputError(path,
                   "no such file, but the journal of a run that was cut off: first "
                   "`sidestep salvage " +
                       (folder.empty() ? "." : folder.string()) + "`");
}

}  // namespace

std::vector<render::NamedRecording> ReadTraces(const std::vector<std::string>& paths) {
  std::vector<render::NamedRecording> traces;
  for (const std::string& path : paths) {
    CheckIsNotOnlyAJournal(path);
    traces.push_back({path, record::ReadRecording(path)});
  }
  return traces;
}

void CheckIsNoTrace(const std::string& output, const std::vector<std::string>& traces) {
  for (const std::string& trace : traces) {
    std::error_code error;
    if (std::filesystem::equivalent(output, trace, error)) {
      throw InputError(output, "is a trace to draw, it must not be written over");
    }
  }
}

}  // namespace sidestep::cli
