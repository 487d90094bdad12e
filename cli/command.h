#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace sidestep::cli {

/// What every sub-command shares with main().
struct CommandLine {
  CLI::App app{"Sidestep: plan a robot arm's motion around things that move"};
  std::string text;   ///< as it was typed, quoted for a shell
  int exit_code = 0;  ///< set by the sub-command that ran
};

/// One file a sub-command; each registers itself and sets `exit_code` when it runs. Bad input is
/// thrown as InputError, which main() prints as one line and turns into exit code 2.
void AddRunCommand(CommandLine& line);
void AddImportCommand(CommandLine& line);
void AddListCommand(CommandLine& line);
void AddCompareCommand(CommandLine& line);
void AddAuditCommand(CommandLine& line);
void AddBenchCommand(CommandLine& line);
void AddCheckRobotCommand(CommandLine& line);
void AddSalvageCommand(CommandLine& line);
void AddRenderCommand(CommandLine& line);
void AddViewCommand(CommandLine& line);
void AddReportCommand(CommandLine& line);
void AddReproduceCommand(CommandLine& line);
void AddStudyCommand(CommandLine& line);
void AddSweepCommand(CommandLine& line);
void AddDoctorCommand(CommandLine& line);
void AddHindsightCommand(CommandLine& line);
void AddFieldCommand(CommandLine& line);
void AddFciServerCommand(CommandLine& line);
void AddNewScenarioCommand(CommandLine& line);
void AddImportSceneCommand(CommandLine& line);
void AddHardwareCommand(CommandLine& line);
void AddValidateCommand(CommandLine& line);
void AddVerifyCommand(CommandLine& line);
void AddManualCommand(CommandLine& line);

}  // namespace sidestep::cli
