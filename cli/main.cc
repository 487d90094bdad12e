#include <algorithm>
#include <csignal>
#include <exception>
#include <sstream>
#include <string>

#include "sidestep/cli/command.h"
#include "sidestep/cli/command_tree.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/shell_quote.h"
#include "sidestep/cli/versions.h"
#include "sidestep/core/input_error.h"

namespace {

constexpr int kDone = 0, kFailed = 1, kBadInput = 2;

// One line, whatever the message holds.
int Complain(std::string message, int exit_code) {
  try {
    sidestep::cli::FinishOutput();  // what was said before comes before
  } catch (const sidestep::InputError&) {
  }
  std::replace(message.begin(), message.end(), '\n', ' ');
  sidestep::cli::PrintErrorText(message + "\n");
  return exit_code;
}

// CLI11 would only say that a command is missing. A word after `app` that is no flag must be one.
void CheckCommandName(const CLI::App& app, const std::string& name) {
  std::string known;
  const auto is_named = [&](const CLI::App* command) { return command->get_name() == name; };
  if (!app.get_subcommands(is_named).empty()) return;
  for (const CLI::App* const command : sidestep::cli::Commands(app)) {
    known += (known.empty() ? "" : ", ") + command->get_name();
  }
  throw sidestep::InputError(app.get_name(),
                             "no command '" + name + "' (there are: " + known + ")");
}

int Run(int argc, char** argv) {
  sidestep::cli::CommandLine line;
  line.text = "sidestep";
  for (int i = 1; i < argc; ++i) line.text += " " + sidestep::cli::ShellQuoted(argv[i]);
  line.app.name("sidestep");
  line.app.set_version_flag("--version", sidestep::cli::VersionText());
  line.app.require_subcommand(1);
  line.app.footer(
      "Exit codes: 0 done, whatever the outcome of the run; 1 a gate failed or a run could not be\n"
      "completed (what there is of it is written); 2 usage, bad input, or results that could not "
      "be\n"
      "written.\n"
      "`sidestep COMMAND --help` tells more.\n"
      "Environment: SIDESTEP_DATA_DIR is a folder with models/ and scenarios/, used instead of "
      "the\n"
      "installed ones; MUJOCO_GL may only be osmesa, or not set.");
  sidestep::cli::AddRunCommand(line);
  sidestep::cli::AddCompareCommand(line);
  sidestep::cli::AddSalvageCommand(line);
  sidestep::cli::AddRenderCommand(line);
  sidestep::cli::AddViewCommand(line);
  sidestep::cli::AddReportCommand(line);
  sidestep::cli::AddReproduceCommand(line);
  sidestep::cli::AddStudyCommand(line);
  sidestep::cli::AddSweepCommand(line);
  sidestep::cli::AddAuditCommand(line);
  sidestep::cli::AddHindsightCommand(line);
  sidestep::cli::AddBenchCommand(line);
  sidestep::cli::AddImportCommand(line);
  sidestep::cli::AddListCommand(line);
  sidestep::cli::AddCheckRobotCommand(line);
  sidestep::cli::AddDoctorCommand(line);
  sidestep::cli::AddFieldCommand(line);
  sidestep::cli::AddNewScenarioCommand(line);
  sidestep::cli::AddImportSceneCommand(line);
  sidestep::cli::AddHardwareCommand(line);
  sidestep::cli::AddFciServerCommand(line);
  sidestep::cli::AddValidateCommand(line);
  sidestep::cli::AddVerifyCommand(line);
  sidestep::cli::AddManualCommand(line);
  const CLI::App* app = &line.app;
  for (int i = 1; i < argc && argv[i][0] != '-' && !sidestep::cli::Commands(*app).empty(); ++i) {
    CheckCommandName(*app, argv[i]);
    app = app->get_subcommand(argv[i]);
  }
  try {
    line.app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    std::ostringstream text;
    line.app.exit(help, text, text);
    sidestep::cli::PrintText(text.str());
    return kDone;
  } catch (const CLI::ParseError& error) {
    return Complain("sidestep: " + std::string(error.what()) + " (see sidestep --help)", kBadInput);
  }
  return line.exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  // Who stops reading what is printed does not stop the work whose results go into files.
  std::signal(SIGPIPE, SIG_IGN);
  // A file that grows too long is an error like a full disk, told in a line.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    const int exit_code = Run(argc, argv);
    sidestep::cli::FinishOutput();
    return exit_code;
  } catch (const sidestep::InputError& error) {
    return Complain(error.what(), kBadInput);
  } catch (const std::exception& error) {
    return Complain(std::string("sidestep: ") + error.what(), kFailed);
  }
}
