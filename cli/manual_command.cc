#include <filesystem>
#include <memory>

#include "sidestep/bench/result_file.h"
#include "sidestep/cli/bash_completion.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/man_page.h"
#include "sidestep/cli/versions.h"
#include "sidestep/core/input_error.h"

namespace sidestep::cli {
namespace {

int WriteManual(const CLI::App& program, const std::string& out) {
  std::error_code error;
  for (const char* const folder : {"/man1", "/completions"}) {
    std::filesystem::create_directories(out + folder, error);
    if (error) throw InputError("--out", "'" + out + "' cannot be made a folder");
  }
  for (const auto& [file, text] : ManPages(program, VersionNumber())) {
    bench::WriteTextFile(out + "/man1/" + file, text);
  }
  bench::WriteTextFile(out + "/completions/" + program.get_name(), BashCompletion(program));
  return 0;
}

}  // namespace

void AddManualCommand(CommandLine& line) {
  auto out = std::make_shared<std::string>();
  CLI::App* const manual =
      line.app.add_subcommand("manual", "Write man pages and bash completion, made from --help");
  manual->group("");  // for packagers: not shown
  manual->add_option("--out", *out, "Folder for man1/ and completions/")->required();
  manual->callback([&line, out] { line.exit_code = WriteManual(line.app, *out); });
}

}  // namespace sidestep::cli
