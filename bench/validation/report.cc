#include "sidestep/bench/validation/report.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "sidestep/bench/json_text.h"
#include "sidestep/bench/summary_page.h"
#include "sidestep/bench/validation/support.h"
#include "sidestep/core/csv.h"
#include "sidestep/core/input_error.h"

namespace sidestep::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kLadder[] = {
    "communication_test of libfranka and `ping -i 0.001 -s 1200`, with the machine and the network "
    "that will be used: at least 95 % of packets; below 90 % go no further.",
    "Read only: the robot's state, and the tags in the picture. Guide the arm by hand with a tag "
    "at its gripper: what the camera says and what the joints say differ by at most 10 mm.",
    "Dry run: `sidestep hardware run SCENARIO --dry-run`, real perception and planning, the robot "
    "not moving.",
    "`sidestep hardware go-to-start SCENARIO`, the stop in your hand.",
    "A tenth of the speed (planner.velocity_scale: 0.1, which is of the robot's limits), nothing "
    "near, the stop in your hand.",
    "A virtual obstacle: `sidestep hardware run SCENARIO`, first slow and far, then near.",
    "A soft foam box on a stick at 0.1 m/s, whoever holds it further than 1.2 m from the base, the "
    "stop in another hand.",
    "More speed, one factor at a time. After each, measure how long and how far the arm takes to "
    "stop, put that in place of what was assumed here, and make this report again.",
};

constexpr const char* kNotCertified =
    "This report says what a simulation found. Nothing here is certified: neither the planner nor "
    "the supervisor, the camera or the computer they run on makes a robot safe for people, and the "
    "robot's own monitoring conforms with no safety norm. The external activation device is no "
    "emergency stop. Nobody is within reach of the arm, ever.";

const RunRow* FindRow(const std::string& name, const std::vector<RunRow>& rows) {
  const auto found = std::find_if(rows.begin(), rows.end(),
                                  [&](const RunRow& row) { return NameOf(row) == name; });
  return found == rows.end() ? nullptr : &*found;
}

int CountOf(const std::vector<JudgedItem>& items, ItemVerdict verdict) {
  return static_cast<int>(std::count_if(items.begin(), items.end(), [&](const JudgedItem& item) {
    return item.finding.verdict == verdict;
  }));
}

std::string ItemTable(const std::vector<JudgedItem>& items) {
  std::string text = "| | item | verdict | required | found |\n|---|---|---|---|---|\n";
  for (const auto& [item, finding] : items) {
    const std::string verdict = ToString(finding.verdict);
    const bool stands_out = finding.verdict == ItemVerdict::kFail;
    text += fmt::format("| {} | {} | {} | {} | {} |\n", item.number, item.name,
                        stands_out ? "**" + verdict + "**" : verdict, TableCell(item.requirement),
                        TableCell(finding.evidence));
  }
  return text;
}

std::string WorstCases(const std::vector<JudgedItem>& items, const std::vector<RunRow>& rows) {
  std::string text;
  for (const auto& [item, finding] : items) {
    if (finding.worst.empty()) continue;
    const char* const what = finding.verdict == ItemVerdict::kFail ? "fails in" : "at the worst";
    text += fmt::format("\n**{}. {}**, {}\n\n", item.number, item.name, what);
    for (const NamedCase& one : finding.worst) {
      text += fmt::format("- `{}`: {}\n", one.name, TableCell(one.what));
      const RunRow* const row = FindRow(one.name, rows);
      if (row != nullptr) text += fmt::format("\n      {}\n\n", row->command);
    }
  }
  return text;
}

std::string FailedCases(const std::vector<RunRow>& rows) {
  std::string text;
  for (const RunRow& row : rows) {
    if (row.outcome == kFailed)
      text += fmt::format("- `{}`: {}\n", NameOf(row), TableCell(row.error));
  }
  return text.empty() ? "" : "\nCould not be run:\n\n" + text;
}

}  // namespace

std::span<const char* const> BringUpLadder() { return kLadder; }
const char* NotCertified() { return kNotCertified; }

bool HasFailed(const std::vector<JudgedItem>& items) {
  return CountOf(items, ItemVerdict::kFail) > 0;
}

ItemVerdict OverallVerdict(const std::vector<JudgedItem>& items) {
  if (HasFailed(items)) return ItemVerdict::kFail;
  return CountOf(items, ItemVerdict::kPass) > 0 ? ItemVerdict::kPass : ItemVerdict::kNotRun;
}

std::string VerdictLine(const std::vector<JudgedItem>& items) {
  return fmt::format("{}: of {} items {} pass, {} fail, {} were not run",
                     ToString(OverallVerdict(items)), items.size(),
                     CountOf(items, ItemVerdict::kPass), CountOf(items, ItemVerdict::kFail),
                     CountOf(items, ItemVerdict::kNotRun));
}

std::string ValidationPage(const ValidationTitle& title, const std::vector<JudgedItem>& items,
                           const std::vector<RunRow>& rows) {
  std::string text = fmt::format(
      "# Validation of {} in {}\n\n**{}**\n\n{}\n\n- {} of {} episodes, made by\n\n"
      "      {}\n\n- seen by: {}\n\n## Items\n\n",
      title.planner, TableCell(title.scenario), VerdictLine(items), kNotCertified, rows.size(),
      title.num_cases, title.command, title.sensor);
  text += ItemTable(items);
  text += "\n## The worst cases, and how to run them again\n" + WorstCases(items, rows);
  text +=
      "\n## What was run\n\nHow many episodes of each group reached the goal and touched nothing; "
      "below, how the others ended. Those on the wire are `unjudged`: nobody tells there whether "
      "the arm touched anything.\n\n";
  if (!rows.empty()) text += OutcomeTable(rows, {"group", ""});
  text += FailedCases(rows);
  text += "\nAll of them are in validation.csv.\n\n## From the first packet to full speed\n\n";
  for (std::size_t i = 0; i < std::size(kLadder); ++i) {
    text += fmt::format("{}. {}\n", i + 1, kLadder[i]);
  }
  text += "\n## Where the requirements come from\n\n";
  for (const auto& [item, finding] : items) {
    text += fmt::format("{}. {}: {}\n", item.number, item.name, item.basis);
  }
  return text;
}

std::string ValidationJson(const ValidationTitle& title, const std::vector<JudgedItem>& items,
                           const std::vector<RunRow>& rows) {
  Json json;
  json["format"] = "sidestep-validation-1";
  json["planner"] = title.planner;
  json["scenario"] = title.scenario;
  json["sensor"] = title.sensor;
  json["command"] = title.command;
  json["subject"] = title.subject;
  json["verdict"] = ToString(OverallVerdict(items));
  json["episodes"] = rows.size();
  json["episodes_asked"] = title.num_cases;
  json["items"] = Json::array();
  for (const auto& [item, finding] : items) {
    Json worst = Json::array();
    for (const NamedCase& one : finding.worst) {
      const RunRow* const row = FindRow(one.name, rows);
      worst.push_back({{"case", one.name},
                       {"what", one.what},
                       {"command", row == nullptr ? Json(nullptr) : Json(row->command)}});
    }
    json["items"].push_back({{"number", item.number},
                             {"name", item.name},
                             {"verdict", ToString(finding.verdict)},
                             {"required", item.requirement},
                             {"basis", item.basis},
                             {"evidence", finding.evidence},
                             {"worst", worst}});
  }
  json["ladder"] = kLadder;
  json["not_certified"] = kNotCertified;
  json["versions"] = title.versions;
  return JsonText(json);
}

std::string ValidationCsv(const std::vector<RunRow>& rows) {
  if (rows.empty()) return "";
  std::set<std::string> facts;
  for (const RunRow& row : rows) {
    for (const auto& [fact, value] : row.metrics) facts.insert(fact);
  }
  std::vector<std::string> columns;
  for (const auto& [factor, value] : rows.front().factors) columns.push_back(factor);
  columns.insert(columns.end(), {"outcome", "error"});
  columns.insert(columns.end(), facts.begin(), facts.end());
  columns.emplace_back("command");
  CsvWriter csv(columns);
  for (const RunRow& row : rows) {
    std::vector<std::string> fields;
    for (const auto& [factor, value] : row.factors) fields.push_back(value);
    fields.insert(fields.end(), {row.outcome, row.error});
    for (const std::string& fact : facts) {
      const auto found = row.metrics.find(fact);
      fields.push_back(found == row.metrics.end() ? "" : CsvNumber(found->second));
    }
    fields.push_back(row.command);
    csv.AddRow(fields);
  }
  return csv.text();
}

namespace {

std::vector<RunRow> RowsIn(const CsvFile& file, const std::string& path) {
  const Factors factors = FactorsOf(ValidationCase());
  for (const char* const column : {"case", "outcome", "error", "command"}) {
    if (std::find(file.columns.begin(), file.columns.end(), column) != file.columns.end()) continue;
    throw InputError(path, 1, "header", std::string("has no column '") + column + "'");
  }
  std::vector<RunRow> rows;
  for (const CsvRow& line : file.rows) {
    RunRow& row = rows.emplace_back();
    for (std::size_t i = 0; i < file.columns.size(); ++i) {
      const std::string &column = file.columns[i], &field = line.fields[i];
      if (factors.contains(column)) {
        row.factors[column] = field;
      } else if (column == "outcome") {
        row.outcome = field;
      } else if (column == "error") {
        row.error = field;
      } else if (column == "command") {
        row.command = field;
      } else if (!field.empty()) {
        row.metrics[column] = ParseCsvNumber(field, path, line.line, column);
      }
    }
  }
  return rows;
}

}  // namespace

std::vector<RunRow> ReadValidationCsv(const std::string& path) {
  return RowsIn(ReadCsv(path), path);
}

std::vector<RunRow> ParseValidationCsv(const std::string& text, const std::string& name) {
  return RowsIn(ParseCsv(text, name), name);
}

}  // namespace sidestep::bench
