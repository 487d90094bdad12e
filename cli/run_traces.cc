#include "sidestep/cli/run_traces.h"

#include <filesystem>
#include <system_error>

namespace sidestep::cli {

RunTraces::RunTraces(const bench::RunDatabase& database, const std::string& file)
    : database_(database), folder_(std::filesystem::path(file).parent_path().string()) {}

std::optional<std::string> RunTraces::Find(std::int64_t id) const {
  bench::SqlStatement trace =
      database_.sql().Prepare("SELECT trace FROM run_facts WHERE runid = ? AND trace <> ''");
  trace.Bind(1, id);
  if (!trace.Step()) return std::nullopt;
  std::string path = (std::filesystem::path(folder_) / trace.Text(0)).string();
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
  return path;
}

}  // namespace sidestep::cli
