#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "sidestep/bench/reproduce/parallel.h"
#include "sidestep/bench/study.h"
#include "sidestep/bench/study_log.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/versions.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/text_file.h"

namespace sidestep::cli {
namespace {

// Stands in the place of a kind of knowledge: who knows all and has time.
constexpr const char* kSearch = "search";
constexpr std::uintmax_t kMaxScenarioBytes = 1 << 20;

struct StudyOptions {
  std::string scenario;
  std::vector<std::string> settings, knowledge, predictors;
  std::vector<double> speeds;
  int episodes = 0, search = 0, jobs = 1;
  bool resume = false;
  std::string down, across, out = "out/study";
};

using Factors = std::map<std::string, std::string>;

// Every combination of `cases` with the values of one more factor.
std::vector<Factors> Cross(const std::vector<Factors>& cases, const std::string& factor,
                           const std::vector<std::string>& values) {
  if (values.empty()) return cases;
  for (auto value = values.begin(); value != values.end(); ++value) {
    if (std::find(values.begin(), value, *value) != value) {
      throw InputError(factor, "'" + *value + "' is given twice");
    }
  }
  std::vector<Factors> crossed;
  for (const Factors& one : cases) {
    for (const std::string& value : values) {
      crossed.push_back(one);
      crossed.back()[factor] = value;
    }
  }
  return crossed;
}

std::string Short(double value) { return fmt::format("{:.12g}", value); }

// What varies: the file's choices that no setting fixes, then what the flags list.
std::vector<Factors> Cases(const StudyOptions& options, const scenarios::Settings& settings,
                           const DataPaths& paths) {
  std::vector<Factors> cases = {{}};
  for (const auto& [choice, values] :
       scenarios::ScenarioChoices(FindScenario(options.scenario, paths))) {
    if (settings.count(choice) == 0) cases = Cross(cases, choice, values);
  }
  std::vector<std::string> speeds, seeds;
  for (const double speed : options.speeds) speeds.push_back(Short(speed));
  for (int seed = 1; seed <= options.episodes; ++seed) seeds.push_back(std::to_string(seed));
  cases = Cross(cases, "speed_m_s", speeds);
  std::vector<std::string> knowledge = options.knowledge;
  if (std::find(knowledge.begin(), knowledge.end(), kSearch) != knowledge.end()) {
    throw InputError("--knowledge", "'search' is asked for by --search");
  }
  if (options.search > 0) knowledge.push_back(kSearch);
  cases = Cross(cases, "knowledge", knowledge);
  cases = Cross(cases, "predictor", options.predictors);
  return Cross(cases, "seed", seeds);
}

Problem MakeCase(const StudyOptions& options, scenarios::Settings settings, const Factors& factors,
                 const DataPaths& paths) {
  Overrides overrides;
  for (const auto& [factor, value] : factors) {
    if (factor == "speed_m_s") {
      overrides.speed_m_s = std::stod(value);
    } else if (factor == "knowledge") {
      if (value != kSearch) overrides.knowledge = value;
    } else if (factor == "predictor") {
      overrides.predictor = value;
    } else {
      settings[factor] = value;  // the seed and the choices
    }
  }
  overrides.settings = settings;
  return LoadProblem(options.scenario, overrides, paths);
}

// What rows must have in common to stand in one table: all that is not a factor of theirs.
std::string Identity(const StudyOptions& options, const scenarios::Settings& settings,
                     const DataPaths& paths) {
  std::string text = VersionText() + "\n";
  for (const auto& [key, value] : settings) text += key + "=" + value + "\n";
  text += "varied: " + std::string(options.episodes > 0 ? "yes" : "no") + "\n";
  text += "guesses: " + std::to_string(options.search) + "\n";
  return text + ReadTextFile(FindScenario(options.scenario, paths), kMaxScenarioBytes);
}

int Study(const StudyOptions& options) {
  const DataPaths paths = FindDataPaths();
  const scenarios::Settings settings = ParseSettings(options.settings);
  if (options.episodes > 0 && settings.count("seed") != 0) {
    throw InputError("--set seed", "is what --episodes varies");
  }
  const std::vector<Factors> cases = Cases(options, settings, paths);
  for (const std::string* const factor : {&options.down, &options.across}) {
    if (cases.front().count(*factor) == 0) {
      throw InputError(factor == &options.down ? "--down" : "--across",
                       "'" + *factor + "' does not vary in this study");
    }
  }
  for (const Factors& one : cases) {  // complain before the work begins
    const auto seed = one.find("seed");
    if (seed == one.end() || seed->second == "1") MakeCase(options, settings, one, paths);
  }
  const std::string out = MakeOutFolder(options.out, {"study.csv", "study.md"});
  if (!options.resume && std::filesystem::exists(out + "/study.jsonl")) {
    throw InputError("--out", "'" + out +
                                  "' holds a study: go on with it by --resume, or choose another "
                                  "folder");
  }

  bench::StudyLog log(out + "/study.jsonl", Identity(options, settings, paths), options.resume);
  std::vector<bench::StudyRow> rows(cases.size());
  std::mutex finishing;
  std::size_t num_done = 0;
  bench::RunTasks(static_cast<int>(cases.size()), options.jobs, [&](int i) {
    const auto n = static_cast<std::size_t>(i);
    if (const bench::StudyRow* const row = log.Find(cases[n])) {
      rows[n] = *row;
      const std::lock_guard lock(finishing);
      ++num_done;
      return;
    }
    const Problem problem = MakeCase(options, settings, cases[n], paths);
    const auto knowledge = cases[n].find("knowledge");
    const bool search = knowledge != cases[n].end() && knowledge->second == kSearch;
    rows[n] = search
                  ? bench::RunStudySearch(problem.scenario, problem.robot, options.search, cases[n])
                  : bench::RunStudyEpisode(problem.scenario, problem.robot, SimulatedWorlds(paths),
                                           cases[n]);
    const std::lock_guard lock(finishing);
    log.Append(rows[n]);
    ++num_done;
    if (num_done % 50 == 0) PrintError("{} of {}\n", num_done, cases.size());
  });

  WriteFile(out + "/study.csv", bench::StudyCsv(rows));
  const std::string table = bench::OutcomeTable(rows, options.down, options.across);
  WriteFile(out + "/study.md", table);
  Print("{}\nwritten {}/study.csv, {}/study.md\n", table, out, out);
  const bool all_whole = std::none_of(rows.begin(), rows.end(), [](const bench::StudyRow& row) {
    return row.outcome == "failed" || row.outcome == ToString(bench::Outcome::kAborted);
  });
  return all_whole ? 0 : 1;
}

}  // namespace

void AddStudyCommand(CommandLine& line) {
  auto options = std::make_shared<StudyOptions>();
  CLI::App* const study = line.app.add_subcommand(
      "study",
      "Run every combination of a scenario's choices and of the flags below; one row an episode "
      "in study.csv, a table of outcomes in study.md");
  study->add_option("SCENARIO", options->scenario, "A name (see `sidestep list`) or a path")
      ->required();
  study->add_option("--set", options->settings, "KEY=VALUE, as in `sidestep run`; fixes a choice")
      ->allow_extra_args(false);
  study->add_option("--knowledge", options->knowledge, "Kinds of knowledge, with commas")
      ->delimiter(',');
  study->add_option("--predictor", options->predictors, "Predictors, with commas")->delimiter(',');
  study
      ->add_option("--speed", options->speeds, "Speeds of every moving obstacle [m/s], with commas")
      ->delimiter(',')
      ->check(NumberFrom(0.0, 100.0));
  study
      ->add_option("--episodes", options->episodes,
                   "Episodes of each combination, seeds 1, 2, ...: each changes the obstacles' "
                   "speed (x 0.75 to 1.3) and start (0 to 0.5 s later)")
      ->check(NumberFrom(0, 100000));
  study
      ->add_option("--search", options->search,
                   "Also look for a free motion among so many guesses, knowing all: a further "
                   "kind of knowledge, `search`")
      ->check(NumberFrom(0, 100000));
  study->add_option("--down", options->down, "What the table lists down: a choice, speed_m_s, ...")
      ->required();
  study->add_option("--across", options->across, "What it lists across: knowledge, predictor, ...")
      ->required();
  study->add_option("-j,--jobs", options->jobs, "Episodes at a time [1]")
      ->check(NumberFrom(1, 256));
  study->add_flag("--resume", options->resume,
                  "Go on with a study that was interrupted, or that is to have more episodes: "
                  "what its folder holds is not run again");
  study->add_option("--out", options->out, "Folder for the results [out/study]");
  study->callback([&line, options] { line.exit_code = Study(*options); });
}

}  // namespace sidestep::cli
