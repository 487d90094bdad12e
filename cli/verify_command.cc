#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/bench/database/run_database.h"
#include "sidestep/bench/database/run_database_writer.h"
#include "sidestep/bench/database/table_rows.h"
#include "sidestep/bench/process_pool.h"
#include "sidestep/bench/sweep/shard_file.h"
#include "sidestep/cli/build_id.h"
#include "sidestep/cli/case_row.h"
#include "sidestep/cli/checked_robots.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/jobs_option.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/cli/stop_signals.h"
#include "sidestep/cli/versions.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"
#include "sidestep/core/parse_number.h"
#include "sidestep/core/random.h"

namespace sidestep::cli {
namespace {

struct VerifyOptions {
  std::string database;
  std::vector<std::string> models;
  int sample = 10, seed = 1, jobs = 1;
  bool digest = false;
};

// A row of the database, and how it is made.
struct Recorded {
  std::int64_t id = 0;
  std::string scenario;
  bench::Factors factors;
  std::map<std::string, std::string> values;  // by column, as VerifiedValues has them
};

// Numbers by all their bits, as the fewest digits that give them back.
std::string ValueText(const bench::SqlStatement& row, int column) {
  const char kind = row.Kind(column);
  if (kind == 'r') return ShortestText(row.Number(column));
  return row.Text(column);  // of NULL: empty
}

int GuessesOf(const bench::RunDatabase& database, const std::string& path) {
  const std::string text = database.Fact("search");
  if (text.empty()) return 0;
  const std::optional<int> guesses = NumberIn<int>(text);
  if (!guesses || *guesses < 1) {
    throw InputError(path, "`search` must be a number of guesses, is '" + text + "'");
  }
  return *guesses;
}

class Verification {
 public:
  explicit Verification(const VerifyOptions& options)
      : options_(options),
        paths_(FindDataPaths(options.models)),
        make_world_(SimulatedWorlds(paths_)),
        database_(options.database),
        guesses_(GuessesOf(database_, options.database)) {}

  int Run() {
    const std::vector<Recorded> sample = Sample();
    if (sample.empty()) throw InputError(options_.database, "holds no runs");
    TellCircumstances();
    std::map<std::size_t, std::string> differences;
    const StopSignals signals;
    std::size_t given = 0, compared = 0;
    bench::RunInProcesses(
        {.num_jobs = options_.jobs},
        [&]() -> std::optional<std::uint64_t> {
          if (signals.count() > 0 || given == sample.size()) return {};
          return given++;
        },
        [&](std::uint64_t index) { return DifferencesOf(sample[index]); },
        [&](std::uint64_t index, const bench::ProcessAnswer& answer) {
          ++compared;
          const std::string& text = answer.why_failed.empty() ? answer.text : answer.why_failed;
          if (!text.empty()) differences[index] = text;
        });
    for (const auto& [index, text] : differences) Print("run {}: {}\n", sample[index].id, text);
    Print("{} of {} runs came out the same, bit for bit ({} in the database)\n",
          compared - differences.size(), compared, database_.num_runs());
    return differences.empty() && signals.count() == 0 ? 0 : 1;
  }

 private:
  // Drawn without repetition, so that no part of a sweep is favoured.
  std::vector<Recorded> Sample() const {
    std::vector<std::int64_t> ids;
    bench::SqlStatement all = database_.Select("id");
    while (all.Step()) ids.push_back(all.Integer(0));
    RandomStream random(static_cast<std::uint64_t>(options_.seed), "verify");
    const std::size_t count = std::min(ids.size(), static_cast<std::size_t>(options_.sample));
    for (std::size_t i = 0; i < count; ++i) {
      const auto left = static_cast<double>(ids.size() - i);
      std::swap(ids[i], ids[i + static_cast<std::size_t>(random.Uniform() * left)]);
    }
    ids.resize(count);
    std::sort(ids.begin(), ids.end());
    std::vector<Recorded> sample;
    for (const std::int64_t id : ids) sample.push_back(Read(id));
    return sample;
  }

  Recorded Read(std::int64_t id) const {
    Recorded recorded;
    recorded.id = id;
    for (const auto& [name, value] : database_.facts()) {
      if (name.starts_with("set.")) recorded.factors[name.substr(4)] = value;
    }
    bench::SqlStatement row = database_.Select("*", "id = " + std::to_string(id));
    row.Step();
    for (int c = 0; c < row.num_columns(); ++c) {
      const std::string column = row.ColumnName(c);
      recorded.values[column] = ValueText(row, c);
      for (const bench::FactorColumn& factor : database_.factors()) {
        if (factor.column == column)
          recorded.factors[factor.name] = bench::ValueAsSwept(factor, row, c);
      }
    }
    recorded.factors["seed"] = recorded.values["seed"];
    bench::SqlStatement setup =
        database_.sql().Prepare("SELECT setup FROM experiments WHERE id = ?");
    setup.Bind(1, recorded.values["experimentid"]);
    if (!setup.Step() || setup.Text(0).empty()) {
      throw InputError(options_.database,
                       "does not say how run " + std::to_string(id) + " is made again");
    }
    recorded.scenario = setup.Text(0);
    return recorded;
  }

  // What is not as it was when the runs were made.
  void TellCircumstances() const {
    if (database_.Fact("build_id") != BuildId()) {
      Print("another build of sidestep made them: {}\n", database_.Fact("build_id").substr(0, 12));
    }
    const std::map<std::string, std::string> here = Versions();
    bench::SqlStatement facts = database_.sql().Prepare(
        "SELECT DISTINCT name, value FROM wall_clock_machines WHERE name NOT IN ('hostname', "
        "'cpu')");
    while (facts.Step()) {
      const auto found = here.find(facts.Text(0));
      if (found == here.end() || found->second == facts.Text(1)) continue;
      Print("some were made with {} {}, here it is {}\n", facts.Text(0), facts.Text(1),
            found->second);
    }
  }

  std::string DifferencesOf(const Recorded& recorded) const {
    const bench::RunRow row =
        RunCase(recorded.scenario, recorded.factors, guesses_, paths_, make_world_, &robots_).row;
    std::vector<std::string> different;
    const auto compare = [&](const std::string& column, const std::string& now) {
      const auto then = recorded.values.find(column);
      const std::string before = then == recorded.values.end() ? "" : then->second;
      if (before == now) return;
      different.push_back(fmt::format("{} was {}, is {}", column,
                                      before.empty() ? "nothing" : before,
                                      now.empty() ? "nothing" : now));
    };
    compare("outcome", row.outcome);
    compare("touched", row.touched);
    compare("error", row.error);
    compare("scenario_fingerprint", row.identity.scenario);
    compare("models", row.identity.models);
    for (const auto& [metric, value] : row.metrics) {
      compare(metric, std::isfinite(value) ? ShortestText(value) : "");
    }
    for (const auto& [key, value] : row.drawn)
      compare(bench::DrawnColumn(key), ShortestText(value));
    return Joined(different, "; ");
  }

  const VerifyOptions& options_;
  DataPaths paths_;
  mutable CheckedRobots robots_;  // that were read for earlier runs
  bench::WorldFactory make_world_;
  bench::RunDatabase database_;
  int guesses_;  // of a search
};

int Verify(const VerifyOptions& options) {
  if (options.digest) {
    Print("{}\n", bench::DigestOf(bench::RunDatabase(options.database)));
    return 0;
  }
  return Verification(options).Run();
}

}  // namespace

void AddVerifyCommand(CommandLine& line) {
  auto options = std::make_shared<VerifyOptions>();
  CLI::App* const verify = line.app.add_subcommand(
      "verify",
      "Run some of a database's runs again and compare every bit; exit code 1 if any differs");
  verify
      ->add_option("DB", options->database,
                   "results.db, as `sidestep sweep` writes it, or `sidestep reproduce closed_loop`")
      ->required();
  verify->add_option("--sample", options->sample, "How many runs, drawn at random")
      ->check(NumberFrom(1, 1000000))
      ->capture_default_str();
  verify->add_option("--seed", options->seed, "Of the draw")
      ->check(NumberFrom(0, 2147483647))
      ->capture_default_str();
  AddJobsOption(*verify, options->jobs);
  AddModels(*verify, options->models);
  verify->add_flag("--digest", options->digest,
                   "Instead, print one word for all that is in it but wall-clock times and "
                   "machines: equal for equal results");
  verify->callback([&line, options] { line.exit_code = Verify(*options); });
}

}  // namespace sidestep::cli
