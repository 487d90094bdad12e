#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "bench/reproduce/open_loop_experiment.h"
#include "bench/reproduce/open_loop_study.h"
#include "bench/reproduce/published_table.h"
#include "bench/result_file.h"
#include "cli/command.h"
#include "cli/data_paths.h"
#include "cli/number_range.h"
#include "core/input_error.h"
#include "sdf/prediction/registry.h"

namespace sidestep {
namespace {

struct ReproduceOptions {
  std::optional<double> sigma_obs, epsilon_m;
  std::optional<int> num_interpolated;
  std::string speeds, pairs, cases, predictor;
  bool once = false, intended_geometry = false;
  int num_jobs = 1;
  std::string published, out;
};

constexpr int kMaxSpeeds = 10000;

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  if (text.empty() || text.back() == separator) parts.emplace_back();
  return parts;
}

double ParseNumber(const std::string& option, const std::string& text) {
  std::size_t end = 0;
  double value = NAN;
  try {
    value = std::stod(text, &end);
  } catch (const std::exception&) {
    end = 0;
  }
  if (end == 0 || end != text.size() || !std::isfinite(value)) {
    throw InputError(option, "'" + text + "' is not a number");
  }
  return value;
}

// Each speed is the double nearest to its decimal fraction, as if it had been typed: repeated sums
// are off in the last bit, which can put an obstacle into another cell.
std::vector<double> ParseSpeeds(const std::string& text) {
  const std::string option = "--speeds";
  const std::vector<std::string> parts = Split(text, ':');
  if (parts.size() != 1 && parts.size() != 3) {
    throw InputError(option, "must be one speed or FIRST:LAST:STEP, is '" + text + "'");
  }
  const double first = ParseNumber(option, parts[0]);
  const double last = parts.size() == 3 ? ParseNumber(option, parts[1]) : first;
  const double step = parts.size() == 3 ? ParseNumber(option, parts[2]) : 1;
  if (first < 0 || last < first || !(step > 0) || !((last - first) / step < kMaxSpeeds)) {
    throw InputError(option, "needs 0 <= FIRST <= LAST and a STEP > 0, is '" + text + "'");
  }
  std::vector<double> speeds;
  const int count = static_cast<int>(std::floor((last - first) / step + 1e-6)) + 1;
  for (int i = 0; i < count; ++i) {
    char decimal[64];
    std::snprintf(decimal, sizeof decimal, "%.9f", first + i * step);
    speeds.push_back(std::stod(decimal));
  }
  return speeds;
}

// "1,4-6" is 1, 4, 5, 6.
std::vector<int> ParsePairs(const std::string& text, int num_pairs) {
  const std::string option = "--pairs";
  std::vector<int> pairs;
  for (const std::string& part : Split(text, ',')) {
    const std::vector<std::string> ends = Split(part, '-');
    const double first = ParseNumber(option, ends.front());
    const double last = ParseNumber(option, ends.back());
    if (ends.size() > 2 || first != std::floor(first) || last != std::floor(last) || first < 1 ||
        last < first || last > num_pairs) {
      throw InputError(option,
                       "'" + part + "' is no pair or range within 1-" + std::to_string(num_pairs));
    }
    for (int pair = static_cast<int>(first); pair <= static_cast<int>(last); ++pair) {
      if (std::find(pairs.begin(), pairs.end(), pair) != pairs.end()) {
        throw InputError(option, "names pair " + std::to_string(pair) + " twice");
      }
      pairs.push_back(pair);
    }
  }
  return pairs;
}

std::vector<Knowledge> ParseCases(const std::string& text) {
  std::vector<Knowledge> cases;
  for (const std::string& word : Split(text, ',')) {
    try {
      cases.push_back(KnowledgeFromString(word));
    } catch (const std::invalid_argument& error) {
      throw InputError("--case", error.what());
    }
  }
  return cases;
}

// One line that is rewritten on a terminal; elsewhere a line at every tenth of the work.
void ShowProgress(int done, int all) {
  if (isatty(STDERR_FILENO) != 0) {
    std::fprintf(stderr, "\r%d of %d rows%s", done, all, done == all ? "\n" : "");
  } else if (done * 10 / all != (done - 1) * 10 / all) {
    std::fprintf(stderr, "%d of %d rows\n", done, all);
  }
}

void PrintSummary(const OpenLoopStudy& study) {
  std::printf("%-20s %16s %16s %16s %14s\n", "planner knows", "collision-free", "truly free",
              "truly free", "mean GP cost");
  std::printf("%-20s %16s %16s %16s\n", "", "as published", "at the states", "all along");
  for (const auto& [knowledge, unused] : study.rows.front().cases) {
    int free = 0, truly_free_states = 0, truly_free = 0;
    double gp_cost = 0;
    for (const OpenLoopRow& row : study.rows) {
      const OpenLoopRow::Case& entry = row.cases.at(knowledge);
      const bool is_free = entry.result.colliding_states == 0;
      free += is_free ? 1 : 0;
      truly_free_states += is_free && entry.clearance.states_m > 0 ? 1 : 0;
      truly_free += is_free && entry.clearance.motion_m() > 0 ? 1 : 0;
      gp_cost += entry.result.gp_cost / static_cast<double>(study.rows.size());
    }
    std::printf("%-20s %8d of %4zu %16d %16d %14.4f\n", ToString(knowledge).c_str(), free,
                study.rows.size(), truly_free_states, truly_free, gp_cost);
  }
  std::printf(
      "(truly free: of the collision-free, those whose spheres clear the exact boxes, which stand\n"
      "where they were meant to and move between the states)\n");
  if (!study.ignored_spheres.empty()) {
    std::string spheres;
    for (const int s : study.ignored_spheres) spheres += " " + std::to_string(s);
    std::printf("ignored, for they overlap what the robot stands on: spheres%s\n", spheres.c_str());
  }
}

int RunOpenLoopExperiment(const std::string& name, const ReproduceOptions& options) {
  OpenLoopExperiment experiment = MakeOpenLoopExperiment(name);
  if (options.sigma_obs) experiment.sigma_obs = *options.sigma_obs;
  if (options.epsilon_m) experiment.epsilon_m = *options.epsilon_m;
  if (options.num_interpolated) experiment.num_interpolated = *options.num_interpolated;
  if (!options.speeds.empty()) experiment.speeds_m_s = ParseSpeeds(options.speeds);
  OpenLoopStudyOptions study_options;
  if (!options.cases.empty()) study_options.cases = ParseCases(options.cases);
  if (!options.pairs.empty()) {
    study_options.pairs = ParsePairs(options.pairs, static_cast<int>(experiment.pairs.size()));
  }
  if (!options.predictor.empty()) {
    try {
      MakePredictor(options.predictor);
    } catch (const std::invalid_argument& error) {
      throw InputError("--predictor", error.what());
    }
    study_options.predictor = options.predictor;
  }
  study_options.once = options.once;
  study_options.intended_geometry = options.intended_geometry;
  study_options.num_jobs = options.num_jobs;
  // Read before the long work, so that a wrong path is found at once.
  std::optional<CsvTable> published;
  if (!options.published.empty()) published = CsvTable::Read(options.published);
  const std::string out = options.out.empty() ? "out/" + name : options.out;
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (error || !std::filesystem::is_directory(out)) {
    throw InputError("--out", "'" + out + "' cannot be made a folder");
  }

  const OpenLoopStudy study =
      RunOpenLoopStudy(experiment, FindDataPaths().models, study_options, ShowProgress);
  const CsvTable table = MakeOpenLoopTable(study);
  WriteTextFile(out + "/rows.csv", table.ToText());
  PrintSummary(study);
  std::printf("written: %s/rows.csv\n", out.c_str());
  if (!published) return 0;
  const TableComparison comparison = CompareTables(table, *published, options.published);
  std::printf("\nagainst %s: %s", options.published.c_str(), Describe(comparison).c_str());
  return comparison.AllCountsAgree() ? 0 : 1;
}

}  // namespace

void AddReproduceCommand(CommandLine& line) {
  CLI::App* const reproduce = line.app.add_subcommand(
      "reproduce", "Run an experiment of Finean, Merkt & Havoutis (ICAPS 2021) as published");
  reproduce->require_subcommand(1);
  for (const std::string& name : OpenLoopExperimentNames()) {
    auto options = std::make_shared<ReproduceOptions>();
    options->num_jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    CLI::App* const command = reproduce->add_subcommand(
        name, "Open loop: a table of colliding states and costs, row for row");
    command->add_option("--published", options->published,
                        "Compare with this CSV file, row by row; exit 1 if a count differs");
    command->add_option("--sigma-obs", options->sigma_obs, "Sigma of the obstacle cost")
        ->check(NumberFrom(1e-6, 1e6));
    command->add_option("--epsilon", options->epsilon_m, "Safety margin of the obstacle cost [m]")
        ->check(NumberFrom(0.0, 10.0));
    command
        ->add_option("--n-int", options->num_interpolated,
                     "Obstacle costs between two support states")
        ->check(NumberFrom(0, 1000));
    command->add_option("--speeds", options->speeds, "FIRST:LAST:STEP, or one speed [m/s]");
    command->add_option("--pairs", options->pairs, "Pairs of start and goal, as 1,4-6 [all]");
    command->add_option("--case", options->cases,
                        "Kinds of knowledge, comma-separated: static, execute_and_update, "
                        "full_knowledge, prediction");
    command->add_option("--predictor", options->predictor,
                        "How moving things are extrapolated under prediction");
    command->add_flag("--once", options->once,
                      "Solve static and full_knowledge once only, as the paper's text says");
    command->add_flag("--intended-geometry", options->intended_geometry,
                      "Static boxes where they were meant to be, not one cell low");
    command->add_option("-j,--jobs", options->num_jobs, "Threads")->check(NumberFrom(1, 1024));
    command->add_option("--out", options->out, "Folder for rows.csv [out/" + name + "]");
    command->callback(
        [&line, name, options] { line.exit_code = RunOpenLoopExperiment(name, *options); });
  }
}

}  // namespace sidestep
