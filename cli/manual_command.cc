#include <memory>

#include "sidestep/cli/bash_completion.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/man_page.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/versions.h"
#include "sidestep/core/atomic_file.h"

namespace sidestep::cli {
namespace {

int WriteManual(const CLI::App& program, const std::string& out) {
  for (const char* const folder : {"/man1", "/completions"}) MakeOutFolder(out + folder, {});
  for (const auto& [file, text] : ManPages(program, VersionNumber())) {
    WriteFile(out + "/man1/" + file, text);
  }
  WriteFile(out + "/completions/" + program.get_name(), BashCompletion(program));
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
