#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "sidestep/bench/validation/validation.h"

namespace sidestep::bench {

/// What a report is of.
struct ValidationTitle {
  std::string planner, scenario;  ///< names
  std::string sensor;             ///< that the arm saw by
  std::string command;            ///< what makes the report, quoted for a shell
  int num_cases = 0;              ///< that were to be run
  std::map<std::string, std::string> versions;
  /// RunId of the scenario as asked for: of its text, the robot and the program.
  std::string subject = {};
};

/// How many items fail, pass and were not run, in a line.
std::string VerdictLine(const std::vector<JudgedItem>& items);
bool HasFailed(const std::vector<JudgedItem>& items);
/// Of all of them: fail if one does, not run if none passes.
ItemVerdict OverallVerdict(const std::vector<JudgedItem>& items);

/// The steps from a first packet to full speed in a laboratory, in their order.
std::span<const char* const> BringUpLadder();
/// What none of this is.
const char* NotCertified();

/// A page in Markdown. Rows' commands run their cases again.
std::string ValidationPage(const ValidationTitle& title, const std::vector<JudgedItem>& items,
                           const std::vector<RunRow>& rows);
/// The same for programs (docs/validation.md).
std::string ValidationJson(const ValidationTitle& title, const std::vector<JudgedItem>& items,
                           const std::vector<RunRow>& rows);
/// All rows, with a column for each factor and each fact.
std::string ValidationCsv(const std::vector<RunRow>& rows);
/// The rows of such a file. @throws InputError FILE:LINE: WHY.
std::vector<RunRow> ReadValidationCsv(const std::string& path);
/// The same of its text. @param name stands for the file in messages.
std::vector<RunRow> ParseValidationCsv(const std::string& text, const std::string& name);

}  // namespace sidestep::bench
