#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/bench/run_row.h"
#include "sidestep/bench/study_log.h"
#include "sidestep/bench/study_page.h"
#include "sidestep/bench/task_pool.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/jobs_option.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/provenance.h"
#include "sidestep/cli/run_case.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/cli/study_cases.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/record/recording_file.h"
#include "sidestep/scenarios/variations.h"

namespace sidestep::cli {
namespace {

constexpr std::size_t kFailuresShown = 5;

struct StudyOptions {
  StudySpace space;
  int jobs = 0;
  bool resume = false;
  bench::TableAxes axes;
  std::string traces = "none", out;
  std::vector<std::string> models;
  std::string command;  // as it was typed
};

bool IsFailure(const bench::RunRow& row) { return row.outcome != ToString(bench::Outcome::kGoal); }

class Study {
 public:
  Study(const StudyOptions& options, DataPaths paths)
      : options_(options), paths_(std::move(paths)), cases_(StudyCases(options.space, paths_)) {}

  int Run() {
    const bench::TableAxes axes = ChooseAxes(cases_, options_.axes);
    const bench::StudySubject subject = CheckBeforeTheWork();
    out_ = MakeOutFolder(options_.out.empty() ? "out/study/" + subject.scenario : options_.out,
                         {"study.csv", "study.md"});
    bench::StudyLog log(out_ + "/study.jsonl", options_.resume);
    CheckResumed(log);
    if (options_.traces != "none") MakeOutFolder(out_ + "/traces", {});
    const std::vector<bench::RunRow> rows = RunCases(log);
    WriteFile(out_ + "/study.csv", bench::RunsCsv(rows));
    WriteFile(out_ + "/study.md", bench::StudyPage(subject, rows, axes));
    Print("{}\nwritten {}/study.csv, {}/study.md\n", bench::OutcomeTable(rows, axes), out_, out_);
    PrintFailures(rows);
    const bool all_whole = std::none_of(rows.begin(), rows.end(), [](const bench::RunRow& row) {
      return row.outcome == bench::kFailed || row.outcome == ToString(bench::Outcome::kAborted);
    });
    return all_whole ? 0 : 1;
  }

 private:
  Problem Load(const bench::Factors& factors) const {
    return LoadCase(options_.space.scenario, factors, paths_);
  }
  bench::RunIdentity IdentityOf(const bench::Factors& factors,
                                const scenarios::Scenario& scenario) const {
    bench::RunIdentity identity = Identify(scenario, paths_);
    if (IsSearch(factors)) identity.method = "search " + std::to_string(options_.space.search);
    return identity;
  }
  void ForAll(const std::function<void(std::size_t)>& task) const {
    bench::RunTasks(static_cast<int>(cases_.size()), options_.jobs,
                    [&](int i) { task(static_cast<std::size_t>(i)); });
  }

  // Complains where no combination makes sense, and where seeds would be counted for nothing. Of
  // those that differ only by their seeds the first stands for all. Returns what the first says.
  bench::StudySubject CheckBeforeTheWork() const {
    std::exception_ptr first_error;
    std::optional<bench::StudySubject> subject;
    bool seed_matters = false;
    for (const bench::Factors& one : cases_) {
      const auto seed = one.find("seed");
      if (options_.space.episodes > 0 && seed->second != "1") continue;
      try {
        const Problem problem = Load(one);
        if (!subject) {
          subject = {problem.scenario.name, problem.scenario.description, options_.command};
        }
        seed_matters = seed_matters || !scenarios::WhatTheSeedChanges(problem.scenario).empty();
      } catch (const InputError& error) {
        if (!first_error) first_error = std::current_exception();
      }
    }
    if (!subject) std::rethrow_exception(first_error);
    if (options_.space.episodes > 0 && !seed_matters) {
      throw InputError("--episodes",
                       "a seed changes nothing in this scenario: it has no variations, nothing "
                       "walks at random, and its sensor is perfect");
    }
    return *subject;
  }

  // Rows of something else must not stand in one table with those to come, and none that is there
  // may be left out of it.
  void CheckResumed(const bench::StudyLog& log) const {
    const auto fail = [&](const std::string& what) {
      throw InputError(out_ + "/study.jsonl",
                       what + "choose another folder by --out, or remove this one");
    };
    const std::set<bench::Factors> asked(cases_.begin(), cases_.end());
    for (const auto& [factors, row] : log.rows()) {
      if (asked.count(factors) > 0) continue;
      std::string episode;
      for (const auto& [factor, value] : factors) {
        episode += (episode.empty() ? "" : ", ") + factor + " " + value;
      }
      fail("holds an episode that is not asked for (" + episode + "): ask for it too, ");
    }
    ForAll([&](std::size_t i) {
      const bench::RunRow* const row = log.Find(cases_[i]);
      if (row == nullptr) return;
      const bench::RunIdentity now = IdentityOf(cases_[i], Load(cases_[i]).scenario);
      const bench::RunIdentity& then = row->identity;
      const char* changed = nullptr;
      if (then.build != now.build) changed = "another build of sidestep";
      if (then.models != now.models) changed = "another robot (its files have changed)";
      if (then.method != now.method) changed = "another --search";
      if (then.scenario != now.scenario) changed = "another scenario";
      if (changed == nullptr) return;
      fail(std::string("holds rows of ") + changed + ": ");
    });
  }

  std::vector<bench::RunRow> RunCases(bench::StudyLog& log) const {
    std::vector<bench::RunRow> rows(cases_.size());
    std::mutex finishing;
    std::size_t num_done = 0;
    ForAll([&](std::size_t i) {
      const bench::RunRow* const known = log.Find(cases_[i]);
      rows[i] = known != nullptr && !LacksTrace(*known) ? *known : RunCase(cases_[i]);
      rows[i].command = RunCommandOf(options_.space.scenario, cases_[i]);
      const bool was_refused = rows[i].identity.build.empty();
      // Each to a folder of its own, so that none takes the place of another.
      if (!rows[i].command.empty() && !was_refused) {
        rows[i].command += " --out out/again/" + RunId(rows[i].identity);
      }
      if (std::filesystem::exists(out_ + "/" + TraceOf(rows[i]))) rows[i].trace = TraceOf(rows[i]);
      const std::lock_guard lock(finishing);
      if (known == nullptr && !was_refused) log.Append(rows[i]);
      if (++num_done % 50 == 0) PrintError("{} of {}\n", num_done, cases_.size());
    });
    return rows;
  }

  // A combination that is refused is a row too.
  bench::RunRow RunCase(const bench::Factors& factors) const {
    std::optional<Problem> problem;
    try {
      problem = Load(factors);
    } catch (const InputError& error) {
      return bench::FailedRow(factors, error.what());
    }
    bench::RecordedRun episode;
    if (IsSearch(factors)) {
      episode.row =
          bench::RunSearchRow(problem->scenario, problem->robot, options_.space.search, factors);
    } else {
      episode =
          bench::RunEpisodeRow(problem->scenario, problem->robot, SimulatedWorlds(paths_), factors);
    }
    episode.row.identity = IdentityOf(factors, problem->scenario);
    KeepTrace(episode);
    return std::move(episode.row);
  }

  bool WantsTrace(const bench::RunRow& row) const {
    return options_.traces == "all" || (options_.traces == "failures" && IsFailure(row));
  }
  std::string TraceOf(const bench::RunRow& row) const {
    return "traces/" + bench::RunId(row.identity) + ".h5";
  }
  bool LacksTrace(const bench::RunRow& row) const {
    return WantsTrace(row) && !IsSearch(row.factors) &&
           !std::filesystem::exists(out_ + "/" + TraceOf(row));
  }
  void KeepTrace(bench::RecordedRun& episode) const {
    if (!episode.recording || !WantsTrace(episode.row)) return;
    AddProvenance(episode.row.identity, *episode.recording);
    record::WriteRecording(*episode.recording, out_ + "/" + TraceOf(episode.row));
  }

  void PrintFailures(const std::vector<bench::RunRow>& rows) const {
    std::size_t count = 0;
    for (const bench::RunRow& row : rows) {
      if (!IsFailure(row) || row.command.empty()) continue;
      if (count == 0) Print("run again what did not reach the goal, e.g.\n");
      if (++count <= kFailuresShown) Print("  {}\n", row.command);
    }
    if (count > kFailuresShown) Print("  ({} in all: study.csv)\n", count);
  }

  const StudyOptions& options_;
  DataPaths paths_;
  std::vector<bench::Factors> cases_;
  std::string out_;
};

}  // namespace

void AddStudyCommand(CommandLine& line) {
  auto options = std::make_shared<StudyOptions>();
  CLI::App* const study = line.app.add_subcommand(
      "study",
      "Run every combination of a scenario's choices and of the flags below; one row an episode "
      "in study.csv, a table of outcomes in study.md");
  StudySpace& space = options->space;
  study->add_option("SCENARIO", space.scenario, "A name (see `sidestep list`) or a path")
      ->required();
  study->add_option("--set", space.settings, "KEY=VALUE, as in `sidestep run`; fixes a choice")
      ->allow_extra_args(false);
  AddModels(*study, options->models);
  study
      ->add_option("--vary", space.varied,
                   "KEY=VALUE,VALUE,...: any key of --set, with several values; some options of a "
                   "choice. Keys that vary together: KEY/OTHER=VALUE/VALUE,VALUE/VALUE,...; may be "
                   "repeated")
      ->allow_extra_args(false);
  study->add_option("--knowledge", space.knowledge, "Kinds of knowledge, with commas")
      ->delimiter(',');
  study->add_option("--predictor", space.predictors, "Predictors, with commas")->delimiter(',');
  study->add_option("--speed", space.speeds, "Speeds of every moving obstacle [m/s], with commas")
      ->delimiter(',')
      ->check(NumberFrom(0.0, 100.0));
  study
      ->add_option(
          "--episodes", space.episodes,
          "Episodes of each combination, seeds 1, 2, ...: what a seed changes the scenario "
          "says (variations, random walks, the sensor's noise)")
      ->check(NumberFrom(1, 100000));
  study
      ->add_option("--search", space.search,
                   "Also look for a free motion among so many guesses, knowing all: a further "
                   "kind of knowledge, `search`")
      ->check(NumberFrom(1, 100000));
  study->add_option("--down", options->axes.down,
                    "What the table lists down: a choice, speed_m_s, what --vary names, ... [what "
                    "varies]");
  study->add_option("--across", options->axes.across,
                    "What it lists across: knowledge, predictor, ... [what varies]");
  AddJobsOption(*study, options->jobs);
  study
      ->add_option("--traces", options->traces,
                   "Traces to keep: none, failures (all that did not reach the goal), all; of an "
                   "episode that --resume finds without one, it is made by running it again [none]")
      ->check(CLI::IsMember({"none", "failures", "all"}));
  study->add_flag("--resume", options->resume,
                  "Go on with a study that was interrupted, or that is to have more episodes: "
                  "what its folder holds is not run again");
  study->add_option("--out", options->out, "Folder for the results [out/study/SCENARIO]");
  study->callback([&line, options] {
    options->command = line.text;
    line.exit_code = Study(*options, FindDataPaths(options->models)).Run();
  });
}

}  // namespace sidestep::cli
