#include <sys/resource.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/bench/result_file.h"
#include "sidestep/bench/task_pool.h"
#include "sidestep/bench/validation/matrix.h"
#include "sidestep/bench/validation/perception.h"
#include "sidestep/bench/validation/report.h"
#include "sidestep/bench/validation/validation.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/jobs_option.h"
#include "sidestep/cli/memory_watch.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/option_lists.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/provenance.h"
#include "sidestep/cli/run_folder.h"
#include "sidestep/cli/run_summary.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/cli/served_worlds.h"
#include "sidestep/cli/shell_quote.h"
#include "sidestep/cli/stop_signals.h"
#include "sidestep/cli/versions.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"
#include "sidestep/core/text_file.h"
#include "sidestep/planner/registry.h"

namespace sidestep::cli {
namespace {

constexpr const char* kFiles[] = {"validation.md", "validation.json", "validation.csv"};

struct ValidateOptions {
  std::string planner, scenario, out, only;
  std::vector<std::string> settings, models;
  int seeds = 2, jobs = 0;
  std::string soak;  // draws: N or FIRST:LAST; empty: none
  bool resume = false;
  std::string command;
};

struct Draws {
  int first = 1, last = 0;
};

// Of `--soak`: as many from 1 on, or from one to another.
Draws ParseSoak(const std::string& text) {
  constexpr int kMost = 1000000;
  if (text.empty()) return {};
  const auto number = [&](const std::string& word) {
    int value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc() && end == word.data() + word.size() && value >= 1 && value <= kMost) {
      return value;
    }
    throw InputError("--soak", "must be N or FIRST:LAST, from 1 to 1000000, is '" + text + "'");
  };
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return {1, number(text)};
  const Draws draws = {number(text.substr(0, colon)), number(text.substr(colon + 1))};
  if (draws.last < draws.first) throw InputError("--soak", "'" + text + "' ends before it begins");
  return draws;
}

// The most that the program has had so far.
double MostBytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024 * static_cast<double>(usage.ru_maxrss);
}

// Six digits say enough of what was measured; what was counted, and a hash, only the whole number.
std::string FactText(double value) {
  const bool is_whole = value == std::trunc(value) && std::abs(value) <= 0x1p53;
  return FiniteText(is_whole ? "{:.0f}" : "{:.6g}", value);
}

bool IsSoak(const bench::ValidationCase& one) {
  return one.group == bench::validation_group::kSoak;
}

bench::ValidationSubject SubjectOf(const ValidateOptions& options, const DataPaths& paths) {
  CheckWords("PLANNER", {options.planner}, planner::PlannerNames());
  Overrides overrides;
  overrides.settings = ParseSettings(options.settings);
  const std::string file = FindScenario(options.scenario, paths);
  if (scenarios::LoadScenario(file, overrides.settings).robot.empty()) {
    throw InputError("--scenario", "'" + options.scenario + "' has no robot");
  }
  if (!overrides.settings.emplace("planner.name", options.planner).second) {
    throw InputError("--set planner.name", "is given by PLANNER as well");
  }
  Problem problem = LoadProblem(options.scenario, overrides, paths);
  bench::ValidationSubject subject = {std::move(problem.scenario), std::move(problem.robot)};
  bench::CheckSubject(subject);
  return subject;
}

class Validation {
 public:
  Validation(const ValidateOptions& options, DataPaths paths)
      : options_(options),
        paths_(std::move(paths)),
        subject_(SubjectOf(options, paths_)),
        cases_(CasesOf()) {
    worlds_.simulated = SimulatedWorlds(paths_);
    worlds_.wired = [this](const std::string& faults, double lost_share) {
      return ServedWorlds(paths_, faults, lost_share);
    };
  }

  int Run() const { return options_.only.empty() ? RunAll() : RunOne(); }

 private:
  bool HasServer() const { return subject_.robot.name() == "panda"; }

  std::vector<bench::ValidationCase> CasesOf() const {
    std::vector<bench::ValidationCase> cases =
        bench::ValidationMatrix(subject_.scenario, options_.seeds, HasServer());
    const Draws draws = ParseSoak(options_.soak);
    for (bench::ValidationCase& one :
         bench::SoakCases(subject_.scenario, draws.first, draws.last)) {
      cases.push_back(std::move(one));
    }
    return cases;
  }

  std::string ReplayOf(const bench::ValidationCase& one) const {
    std::string command = "sidestep validate " + ShellQuoted(options_.planner) + " --scenario " +
                          ShellQuoted(options_.scenario);
    for (const std::string& setting : options_.settings)
      command += " --set " + ShellQuoted(setting);
    for (const std::string& folder : options_.models) command += " --models " + ShellQuoted(folder);
    if (IsSoak(one)) {
      command += " --soak " + std::to_string(one.draw);
    } else if (one.draw > 2) {
      command += " --seeds " + std::to_string(one.draw);
    }
    const std::string name = NameOf(one);
    return command + " --only " + ShellQuoted(name) + " --out " + ShellQuoted("out/again/" + name);
  }

  // One episode, with its trace.
  int RunOne() const {
    const auto one = std::find_if(cases_.begin(), cases_.end(),
                                  [&](const auto& each) { return NameOf(each) == options_.only; });
    if (one == cases_.end()) {
      throw InputError("--only", "'" + options_.only + "' is no case of this validation: one is " +
                                     NameOf(cases_.front()) + ", validation.csv names all");
    }
    const scenarios::Scenario scenario = ScenarioOf(*one, subject_);
    const OutFolder out(Folder(), {"trace.h5", "result.json"});
    const StopSignals signals;
    bench::ValidationEpisode episode =
        RunValidationCase(*one, subject_, worlds_, [&] { return signals.first(); });
    if (episode.row.outcome == bench::kFailed) throw std::runtime_error(episode.row.error);
    const bench::RunIdentity identity = Identify(scenario, paths_);
    AddProvenance(identity, episode.result.recording);
    WriteResults(episode.result, scenario, identity, VersionsIn(episode.result.recording.header),
                 out.path());
    PrintOutcome(episode.result, scenario);
    for (const auto& [fact, value] : episode.row.metrics) {
      Print("{:<28} {}\n", fact, FactText(value));
    }
    Print("written          {}/result.json, {}/trace.h5\n", out.path(), out.path());
    return 0;
  }

  int RunAll() const {
    const OutFolder out(Folder(), {std::begin(kFiles), std::end(kFiles)});
    const std::map<std::string, bench::RunRow> before = RowsBefore(out.path());
    const StopSignals signals;
    std::optional<double> memory_growth;
    const std::vector<bench::RunRow> rows = RunCases(before, signals, memory_growth);
    const auto failed = std::count_if(rows.begin(), rows.end(), [](const bench::RunRow& row) {
      return row.outcome == bench::kFailed;
    });
    const std::size_t missing = CountMissing(rows);
    const bool is_whole = missing == 0 && failed == 0;
    const std::vector<bench::JudgedItem> items =
        bench::JudgeItems({subject_.scenario, rows, memory_growth}, is_whole);
    const bench::ValidationTitle title = TitleOf();
    WriteFile(out.path() + "/validation.md", ValidationPage(title, items, rows));
    WriteFile(out.path() + "/validation.json", ValidationJson(title, items, rows));
    WriteFile(out.path() + "/validation.csv", bench::ValidationCsv(rows));
    Tell(items);
    Print("written          {0}/validation.md, {0}/validation.json, {0}/validation.csv\n",
          out.path());
    FinishOutput();
    if (failed > 0) PrintError("validate: {} episodes could not be run\n", failed);
    if (missing > 0) {
      PrintError("validate: {} of {} episodes: it was stopped by {}\n", cases_.size() - missing,
                 cases_.size(), signals.first());
    }
    return HasFailed(items) || !is_whole ? 1 : 0;
  }

  std::string Folder() const {
    return options_.out.empty() ? "out/" + subject_.scenario.name + "/validate_" + options_.planner
                                : options_.out;
  }

  bench::ValidationTitle TitleOf() const {
    scenarios::Scenario scenario = subject_.scenario;
    bench::SetLikelySensor(scenario);
    const bool is_other = scenario.sensor.name != subject_.scenario.sensor.name;
    return {options_.planner,
            scenario.name,
            scenario.sensor.name +
                (is_other ? ", because no camera tells the " + subject_.scenario.sensor.name +
                                " that the scenario has"
                          : ""),
            options_.command,
            static_cast<int>(cases_.size()),
            VersionsIn(Provenance(Identify(subject_.scenario, paths_))),
            Subject()};
  }

  std::size_t CountMissing(const std::vector<bench::RunRow>& rows) const {
    std::set<std::string> run;
    for (const bench::RunRow& row : rows) run.insert(row.factors.at("case"));
    const auto is_missing = [&](const auto& one) { return !run.contains(NameOf(one)); };
    return static_cast<std::size_t>(std::count_if(cases_.begin(), cases_.end(), is_missing));
  }

  std::string Subject() const { return bench::RunId(Identify(subject_.scenario, paths_)); }

  // Of a report that is there already, by the names of their cases: they are not run again.
  std::map<std::string, bench::RunRow> RowsBefore(const std::string& out) const {
    std::map<std::string, bench::RunRow> rows;
    const std::string table = out + "/validation.csv", report = out + "/validation.json";
    if (!options_.resume || !std::filesystem::exists(table)) return rows;
    constexpr std::uintmax_t kMostBytes = 1 << 30;
    const auto json = nlohmann::json::parse(ReadTextFile(report, kMostBytes), nullptr, false);
    if (!json.is_object() || json.value("subject", "") != Subject()) {
      throw InputError("--resume", "'" + report +
                                       "' is of another scenario, robot, planner or program: "
                                       "what it found does not count here");
    }
    for (bench::RunRow& row : bench::ReadValidationCsv(table)) {
      if (row.outcome == bench::kFailed) continue;  // that is tried again
      const std::string name = row.factors.at("case");
      rows.emplace(name, std::move(row));
    }
    return rows;
  }

  // In the order of the cases, and what was there before and is no case now; those that were not
  // run to their end are left out.
  // @param memory_growth of a soak (cli/memory_watch.h), as a share of the most that the program
  // had.
  std::vector<bench::RunRow> RunCases(std::map<std::string, bench::RunRow> before,
                                      const StopSignals& signals,
                                      std::optional<double>& memory_growth) const {
    const int count = static_cast<int>(cases_.size());
    // As text, so that what they hold of memory is known.
    std::vector<std::string> done(cases_.size());
    double kept_bytes = 0;
    std::mutex telling;
    int num_done = 0, told = 0;
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      const auto found = before.find(NameOf(cases_[i]));
      if (found == before.end()) continue;
      done[i] = bench::ValidationCsv({found->second});
      before.erase(found);
      ++num_done;
    }
    int num_soaked = 0;
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      num_soaked += IsSoak(cases_[i]) && done[i].empty() ? 1 : 0;
    }
    MemoryWatch memory(num_soaked);
    if (num_done > 0) PrintError("{} of {} episodes, from before\n", num_done, count);
    bench::RunTasks(count, options_.jobs, [&](int i) {
      if (signals.count() > 0 || !done[static_cast<std::size_t>(i)].empty()) return;
      const bench::ValidationCase& one = cases_[static_cast<std::size_t>(i)];
      bench::RunRow row =
          RunValidationCase(one, subject_, worlds_, [&] { return signals.first(); }).row;
      if (signals.count() > 0) return;
      row.command = ReplayOf(one);
      std::string text = bench::ValidationCsv({row});
      row = {};
      const std::lock_guard lock(telling);
      kept_bytes += static_cast<double>(text.capacity());
      done[static_cast<std::size_t>(i)] = std::move(text);
      if (IsSoak(one)) memory.Count(HeldBytes() - kept_bytes);
      const int percent = 100 * ++num_done / count;
      if (percent / 10 == told / 10) return;
      told = percent;
      PrintError("{} of {} episodes\n", num_done, count);
    });
    const std::optional<double> growth = memory.Growth();
    if (growth) memory_growth = *growth / MostBytes();
    std::vector<bench::RunRow> rows;
    for (const std::string& text : done) {
      if (text.empty()) continue;
      rows.push_back(std::move(bench::ParseValidationCsv(text, "a row").front()));
    }
    for (auto& [name, row] : before) rows.push_back(std::move(row));
    return rows;
  }

  void Tell(const std::vector<bench::JudgedItem>& items) const {
    for (const auto& [item, finding] : items) {
      Print("{:>2}  {:<8} {}: {}\n", item.number, ToString(finding.verdict), item.name,
            finding.evidence);
    }
    Print("\n{}\n\nfrom the first packet to full speed:\n", VerdictLine(items));
    int step = 0;
    for (const char* const rung : bench::BringUpLadder()) Print("{:>3}. {}\n", ++step, rung);
    Print("\n{}\n\n", bench::NotCertified());
  }

  const ValidateOptions& options_;
  DataPaths paths_;
  bench::ValidationSubject subject_;
  std::vector<bench::ValidationCase> cases_;
  bench::ValidationWorlds worlds_;
};

}  // namespace

void AddValidateCommand(CommandLine& line) {
  auto options = std::make_shared<ValidateOptions>();
  CLI::App* const validate =
      line.app.add_subcommand("validate",
                              "Whether a planner may be tried on a robot: many episodes, "
                              "obstacles, speeds, faults; a report "
                              "with pass and fail");
  validate->add_option("PLANNER", options->planner, "One of `sidestep list planners`")->required();
  validate
      ->add_option("--scenario", options->scenario,
                   "A name (see `sidestep list`) or a path; supervised by `lab`")
      ->required();
  validate
      ->add_option("--set", options->settings, "KEY=VALUE of the scenario, as for `sidestep run`")
      ->allow_extra_args(false);
  AddModels(*validate, options->models);
  validate
      ->add_option("--seeds", options->seeds,
                   "How often each combination is run, its obstacle coming from elsewhere [2]")
      ->check(NumberFrom(1, 1000));
  validate
      ->add_option("--soak", options->soak,
                   "Also so many episodes at random, an hour or so; N, or draws FIRST:LAST [2000]")
      ->expected(0, 1)
      ->default_str("2000");
  validate->add_flag("--resume", options->resume,
                     "Run only what the report in the folder lacks, and judge both together");
  validate->add_option("--only", options->only,
                       "Run this case of the report alone, and keep its trace.h5 and result.json");
  AddJobsOption(*validate, options->jobs);
  validate->add_option("--out", options->out,
                       "Folder for the report [out/SCENARIO/validate_PLANNER]");
  validate->footer(
      "Exit codes: 0 nothing fails (what was not run is told), 1 an item fails or the work was\n"
      "interrupted, 2 bad input. docs/validation.md says what is required, and why.");
  validate->callback([&line, options] {
    options->command = line.text;
    line.exit_code = Validation(*options, FindDataPaths(options->models)).Run();
  });
}

}  // namespace sidestep::cli
