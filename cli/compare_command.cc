#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "sidestep/bench/database/run_files.h"
#include "sidestep/bench/metrics/robot_limit_metrics.h"
#include "sidestep/bench/result_file.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/machine.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"
#include "sidestep/core/parse_number.h"

namespace sidestep::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostDifferences = 5;  // that get a column of their own

struct CompareOptions {
  std::vector<std::string> folders;
  std::string out;
};

std::string ParameterOf(const bench::StoredResult& result, const std::string& key) {
  const auto found = result.parameters.find(key);
  return found == result.parameters.end() ? "-" : found->second;
}

std::string Number(const bench::StoredResult& result, const char* metric, double scale,
                   const char* format) {
  return FiniteText(format, scale * result.row.metrics.at(metric));
}

// The parameters in which some result differs from the first; a text says nothing of a run.
std::vector<std::string> FindDifferences(const std::vector<bench::StoredResult>& results) {
  std::set<std::string> keys;
  for (const bench::StoredResult& result : results) {
    for (const auto& [key, value] : result.parameters) keys.insert(key);
  }
  keys.erase("description");
  keys.erase("knowledge");  // has a column in any case
  std::erase_if(keys, [&](const std::string& key) {
    return std::all_of(results.begin(), results.end(), [&](const bench::StoredResult& result) {
      return ParameterOf(result, key) == ParameterOf(results.front(), key);
    });
  });
  std::vector<std::string> sorted(keys.begin(), keys.end());
  std::stable_partition(sorted.begin(), sorted.end(), [](const std::string& key) {
    return key == "name" || key == "robot.model" || key == "planner.name" || key == "predictor" ||
           key == "seed";
  });
  return sorted;
}

// The last words of a path that no other path ends in.
std::string ShortName(const std::string& key, const std::vector<std::string>& keys) {
  for (std::size_t dot = key.rfind('.'); dot != std::string::npos; dot = key.rfind('.', dot - 1)) {
    const std::string end = key.substr(dot);
    const auto has_end = [&](const std::string& other) { return ("." + other).ends_with(end); };
    if (std::count_if(keys.begin(), keys.end(), has_end) == 1) return end.substr(1);
    if (dot == 0) break;
  }
  return key;
}

// A number that is no whole one, to four digits.
std::string RoundedNumber(const std::string& word) {
  const std::optional<double> number = NumberIn<double>(word);
  const bool is_fraction = number && word.find_first_of(".e") != std::string::npos;
  return is_fraction ? fmt::format("{:.4g}", *number) : word;
}

// The same of each number of a list, [0.1,2].
std::string Rounded(const std::string& value) {
  if (!value.starts_with('[')) return RoundedNumber(value);
  std::string rounded, word;
  for (const char c : value) {
    const bool is_between = c == '[' || c == ',' || c == ']';
    if (!is_between) {
      word += c;
      continue;
    }
    rounded += RoundedNumber(word) + c;
    word.clear();
  }
  return rounded + word;
}

// The values of a parameter, one a result: with as few digits as tell them apart.
std::vector<std::string> ShortValues(const std::vector<bench::StoredResult>& results,
                                     const std::string& key) {
  std::vector<std::string> values, rounded;
  for (const bench::StoredResult& result : results) {
    values.push_back(ParameterOf(result, key));
    rounded.push_back(Rounded(values.back()));
  }
  const auto count = [](const std::vector<std::string>& texts) {
    return std::set<std::string>(texts.begin(), texts.end()).size();
  };
  return count(rounded) == count(values) ? rounded : values;
}

using Line = std::vector<std::string>;

void PrintTable(const std::vector<Line>& lines, std::size_t num_words) {
  std::vector<std::size_t> widths(lines.front().size(), 0);
  for (const Line& line : lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  for (const Line& line : lines) {
    std::string text;
    for (std::size_t i = 0; i < line.size(); ++i) {
      const std::string padding(widths[i] - line[i].size(), ' ');
      text += i < num_words ? line[i] + padding : padding + line[i];  // numbers to the right
      if (i + 1 < line.size()) text += "  ";
    }
    Print("{}\n", text.substr(0, text.find_last_not_of(' ') + 1));
  }
}

std::vector<bench::StoredResult> ReadResults(const std::vector<std::string>& folders) {
  std::vector<bench::StoredResult> results;
  for (const std::string& folder : folders) {
    if (fs::is_regular_file(folder)) {
      throw InputError("DIR", "'" + folder + "' is a file: name the folder that a run left");
    }
    results.push_back(bench::ReadResult(folder + "/result.json"));
  }
  return results;
}

void PrintResults(const std::vector<std::string>& folders,
                  const std::vector<bench::StoredResult>& results,
                  const std::vector<std::string>& differences) {
  const std::size_t num_shown = std::min(differences.size(), kMostDifferences);
  Line heads = {"folder", "planner knows"}, units = {"", ""};
  std::vector<std::vector<std::string>> shown;
  for (std::size_t i = 0; i < num_shown; ++i) {
    heads.push_back(ShortName(differences[i], differences));
    shown.push_back(ShortValues(results, differences[i]));
  }
  heads.insert(heads.end(), {"outcome", "would trip"});
  units.resize(heads.size());
  const std::size_t num_words = heads.size();
  for (const char* const head : {"contact", "clearance", "goal", "GP cost", "jerk RMS", "cycle"}) {
    heads.emplace_back(head);
  }
  for (const char* const unit :
       {"at [s]", "least [mm]", "after [s]", "", "[rad/s^3]", "[ms CPU]"}) {
    units.emplace_back(unit);
  }
  std::vector<Line> lines = {heads, units};
  for (std::size_t n = 0; n < results.size(); ++n) {
    const bench::StoredResult& result = results[n];
    const bench::RunRow& row = result.row;
    const bench::Outcome outcome = bench::OutcomeFromString(row.outcome).value();
    Line& line = lines.emplace_back(Line{folders[n], row.subject.knowledge});
    for (const std::vector<std::string>& values : shown) line.push_back(OneLine(values[n]));
    line.push_back(bench::Tell(outcome, row.touched, bench::Ending(row.metrics)));
    line.push_back(bench::TellTrips(row.metrics));
    line.push_back(Number(result, "first_contact_s", 1, "{:.2f}"));
    line.push_back(Number(result, "min_clearance_m", 1e3, "{:.0f}"));
    line.push_back(Number(result, "time_to_goal_s", 1, "{:.2f}"));
    line.push_back(Number(result, "gp_cost", 1, "{:.1f}"));
    line.push_back(Number(result, "jerk_rms", 1, "{:.0f}"));
    line.push_back(FiniteText("{:.1f}", row.clock.cycle_p50_ms));
  }
  PrintTable(lines, num_words);
  for (std::size_t i = num_shown; i < differences.size(); ++i) {
    Print("{}{}{}", i == num_shown ? "also different: " : ", ", differences[i],
          i + 1 == differences.size() ? "\n" : "");
  }
}

// The trace beside a result.json, as it is found from the folder of the tables.
std::string TraceFrom(const std::string& out, const std::string& folder) {
  const fs::path trace = fs::absolute(folder) / "trace.h5";
  std::error_code error;
  if (!fs::exists(trace, error)) return "";
  return trace.lexically_normal().lexically_proximate(fs::absolute(out).lexically_normal());
}

void WriteResults(const std::vector<std::string>& folders,
                  const std::vector<bench::StoredResult>& results,
                  std::vector<std::string> differences, const std::string& out) {
  std::erase_if(differences, [](const std::string& key) { return key == "name" || key == "seed"; });
  const auto is_another = [&](const bench::StoredResult& result) {
    return result.row.subject.knowledge != results.front().row.subject.knowledge;
  };
  if (std::any_of(results.begin(), results.end(), is_another))
    differences.emplace_back("knowledge");
  std::vector<bench::SingleRun> runs;
  for (std::size_t n = 0; n < results.size(); ++n) {
    bench::SingleRun& run = runs.emplace_back();
    run.row = results[n].row;
    for (const std::string& key : differences) {
      run.row.factors[key] = ParameterOf(results[n], key);
    }
    run.row.trace = TraceFrom(out, folders[n]);
    run.scenario = results[n].scenario;
    run.seed = results[n].seed;
    run.machine = MachineIn(results[n].versions);
  }
  bench::RunFilesHead head = {
      {{"title", "comparison"}, {"description", "Runs of " + Joined(folders)}}, {}};
  const auto is_of_one_build = [&](const bench::StoredResult& result) {
    return result.row.identity.build == results.front().row.identity.build;
  };
  if (std::all_of(results.begin(), results.end(), is_of_one_build)) {
    head.facts["build_id"] = results.front().row.identity.build;
    head.version = "sidestep " + results.front().versions.at("sidestep");
  }
  bench::WriteRunFiles(out, head, runs);
  Print("written {0}/results.db, {0}/results.csv\n", out);
}

int Compare(const CompareOptions& options) {
  const std::vector<bench::StoredResult> results = ReadResults(options.folders);
  const std::vector<std::string> differences = FindDifferences(results);
  std::string out;
  if (!options.out.empty()) out = MakeOutFolder(options.out, {"results.db", "results.csv"});
  PrintResults(options.folders, results, differences);
  if (!out.empty()) WriteResults(options.folders, results, differences, out);
  return 0;
}

}  // namespace

void AddCompareCommand(CommandLine& line) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* const compare = line.app.add_subcommand(
      "compare",
      "Print the results of several runs as one table, with whatever differs "
      "between their scenarios");
  compare->add_option("DIR", options->folders, "Folders written by `sidestep run`")->required();
  compare->add_option("--out", options->out,
                      "Also write them into this folder as a sweep's results: results.db, which "
                      "`sidestep report` reads, and results.csv");
  compare->callback([&line, options] { line.exit_code = Compare(*options); });
}

}  // namespace sidestep::cli
