#include <fmt/core.h>

#include <charconv>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sidestep/bench/database/run_csv.h"
#include "sidestep/bench/database/run_database.h"
#include "sidestep/bench/sweep/sweep.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/jobs_option.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/cli/sweep_runner.h"
#include "sidestep/cli/sweep_submit.h"
#include "sidestep/cli/sweep_summary.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kRefusedShown = 5;
constexpr std::size_t kValuesShown = 12;
constexpr int kMostShards = 100'000;

struct SweepOptions {
  std::string file, out, shard;
  std::vector<std::string> models;
  int jobs = 1;
  bool again = false, csv = false;
  SubmitOptions submit;
};

// A path, or the name of one that comes with Sidestep.
std::string FindSweep(const std::string& name, const DataPaths& paths) {
  if (name.find('/') != std::string::npos || name.ends_with(".yaml")) return name;
  const std::string folder = paths.scenarios + "/sweeps";
  const std::string file = folder + "/" + name + ".yaml";
  if (fs::exists(file)) return file;
  throw InputError("FILE", "no sweep '" + name + "' comes with Sidestep (there are: " +
                               Joined(scenarios::ScenarioNames(folder)) +
                               "); a path has a / or ends in .yaml");
}

// A sweep that a command was asked for, and where its results are.
class Asked {
 public:
  explicit Asked(const SweepOptions& options)
      : paths_(FindDataPaths(options.models)),
        file_(FindSweep(options.file, paths_)),
        plan_(bench::ReadSweep(file_)),
        runner_(plan_, fs::path(file_).parent_path().string(),
                options.out.empty() ? "out/sweep/" + plan_.sweep().name : options.out, paths_) {}

  const std::string& file() const { return file_; }
  const bench::SweepPlan& plan() const { return plan_; }
  const SweepRunner& runner() const { return runner_; }

 private:
  DataPaths paths_;
  std::string file_;
  bench::SweepPlan plan_;
  SweepRunner runner_;
};

bench::ShardName ParseShard(const std::string& text) {
  if (text.empty()) return {};
  bench::ShardName shard;
  const char* const end = text.data() + text.size();
  const auto number = std::from_chars(text.data(), end, shard.number);
  const bool has_slash = number.ec == std::errc() && number.ptr < end && *number.ptr == '/';
  const auto of = has_slash ? std::from_chars(number.ptr + 1, end, shard.of) : number;
  if (!has_slash || of.ec != std::errc() || of.ptr != end || shard.of < 1 ||
      shard.of > kMostShards || shard.number < 1 || shard.number > shard.of) {
    throw InputError("--shard", "must be I/N with 1 <= I <= N <= 100000, is '" + text + "'");
  }
  return shard;
}

void PrintPlan(const bench::SweepPlan& plan) {
  const bench::Sweep& sweep = plan.sweep();
  const auto listed = [](const std::vector<std::string>& values) {
    const std::vector<std::string> some(
        values.begin(),
        values.begin() + static_cast<std::ptrdiff_t>(std::min(values.size(), kValuesShown)));
    return Joined(some) +
           (values.size() > kValuesShown ? fmt::format(", ... ({})", values.size()) : "");
  };
  Print("{}\n\nscenarios: {}\n", sweep.description.empty() ? sweep.name : sweep.description,
        listed(sweep.scenarios));
  for (const auto& [key, value] : sweep.settings) Print("fixed: {} = {}\n", key, value);
  for (const bench::SweepAxis& axis : sweep.axes) Print("{}: {}\n", axis.name, listed(axis.values));
  Print("seeds: {}\n", sweep.seeds.size() == 1
                           ? std::to_string(sweep.seeds.front())
                           : fmt::format("{} ({} to {})", sweep.seeds.size(), sweep.seeds.front(),
                                         sweep.seeds.back()));
  const auto counted = [](std::uint64_t number, const char* what) {
    return fmt::format("{} {}{}", number, what, number == 1 ? "" : "s");
  };
  Print("\n{}: {}, each with {}; plan {}\n", counted(plan.num_runs(), "run"),
        counted(plan.num_combinations(), "combination"), counted(sweep.seeds.size(), "seed"),
        plan.Hash());
}

int Plan(const SweepOptions& options) {
  const Asked asked(options);
  PrintPlan(asked.plan());
  const SweepRunner::Checked checked = asked.runner().Check();
  Print("{} combinations tried: {}\n", checked.num_checked,
        checked.refused.empty() ? "all can be run"
                                : fmt::format("{} cannot be run, and will be rows that say why",
                                              checked.refused.size()));
  for (std::size_t i = 0; i < std::min(checked.refused.size(), kRefusedShown); ++i) {
    Print("  {}\n", checked.refused[i]);
  }
  asked.runner().CheckSeeds(checked);
  return 0;
}

// What a person should know of the rows. @return whether everything is as it should be.
bool TellRows(const bench::SweepPlan& plan, const bench::SweepRows& rows) {
  for (const std::string& line : rows.damage()) PrintError("{}\n", line);
  if (rows.num_of_other_makers() > 0) {
    PrintError("{} rows by another build or of other inputs do not count\n",
               rows.num_of_other_makers());
  }
  if (rows.num_unasked() > 0) {
    PrintError("{} rows of runs that this plan does not hold do not count\n", rows.num_unasked());
  }
  for (const std::uint64_t index : rows.contradicted()) {
    PrintError("run {} was made twice and did not repeat: the first row counts\n", index + 1);
  }
  return rows.num_done() == plan.num_runs() && rows.contradicted().empty();
}

// That the runs are no longer those that would be made. @return whether they still are.
bool TellChange(const SweepRunner& runner) {
  const std::string change = runner.WhatChanged();
  if (!change.empty()) PrintError("{}\n", change);
  return change.empty();
}

void PrintOutcomes(const bench::SweepRows& rows) {
  for (const auto& [outcome, count] : rows.outcomes()) Print("{:<15} {}\n", outcome, count);
}

int Status(const SweepOptions& options) {
  const Asked asked(options);
  const bench::SweepRows rows = asked.runner().Rows();
  const bool is_same = TellChange(asked.runner());
  const bool is_whole = TellRows(asked.plan(), rows);
  Print("{} of {} runs are finished, {} are missing\n", rows.num_done(), asked.plan().num_runs(),
        asked.plan().num_runs() - rows.num_done());
  PrintOutcomes(rows);
  for (const bench::ShardName& shard : rows.being_written()) {
    Print("shard {}/{} is being written\n", shard.number, shard.of);
  }
  for (const auto& [state, count] : QueuedTasks(asked.runner().out())) {
    Print("in Slurm's queue: {} {}\n", count, state);
  }
  return is_same && is_whole ? 0 : 1;
}

int SubmitShards(const SweepOptions& options) {
  const Asked asked(options);
  if (!options.submit.dry_run) asked.runner().Prepare(options.again);
  std::vector<std::string> words;
  for (const std::string& folder : options.models) {
    words.insert(words.end(), {"--models", fs::absolute(folder).string()});
  }
  Submit(options.submit, asked.plan(), asked.runner(), asked.file(), words);
  return 0;
}

int MergeOf(const Asked& asked, const SweepOptions& options) {
  const bench::SweepRows rows = asked.runner().Rows();
  const bool is_whole = TellRows(asked.plan(), rows);
  asked.runner().Merge(rows);
  const bench::RunDatabase database(asked.runner().database());
  if (options.csv) bench::WriteRunCsv(database, asked.runner().out() + "/results.csv");
  TellSummary(database, ChooseAxes(asked.plan().sweep(), {}), "sidestep sweep run " + options.file,
              asked.runner().out());
  Print("written {}: {} of {} runs\n", asked.runner().database(), rows.num_done(),
        asked.plan().num_runs());
  return is_whole ? 0 : 1;
}

int Merge(const SweepOptions& options) {
  const Asked asked(options);
  const bool is_same = TellChange(asked.runner());
  const int exit_code = MergeOf(asked, options);
  return is_same ? exit_code : 1;
}

int Run(const SweepOptions& options) {
  const bench::ShardName shard = ParseShard(options.shard);
  const Asked asked(options);
  const bool is_whole = asked.runner().Run({shard, options.jobs, options.again});
  if (!is_whole) return 1;
  if (shard.of > 1) {
    Print("shard {}/{} is finished\n", shard.number, shard.of);
    return 0;
  }
  return MergeOf(asked, options);
}

CLI::App* AddSub(CLI::App& sweep, const char* name, const char* what,
                 const std::shared_ptr<SweepOptions>& options) {
  CLI::App* const sub = sweep.add_subcommand(name, what);
  sub->add_option("FILE", options->file,
                  "A sweep file, or the name of one that comes with Sidestep (scenarios/sweeps)")
      ->required();
  sub->add_option("--out", options->out, "Folder for the results [out/sweep/NAME]");
  AddModels(*sub, options->models);
  return sub;
}

void AddCsv(CLI::App& command, SweepOptions& options) {
  command.add_flag("--csv", options.csv, "Also write results.csv: a line a run, every column");
}

void AddAgain(CLI::App& command, SweepOptions& options) {
  command.add_flag(
      "--again", options.again,
      "Where the folder holds runs of another build or of changed scenarios or robots: "
      "run them again");
}

}  // namespace

void AddSweepCommand(CommandLine& line) {
  auto options = std::make_shared<SweepOptions>();
  CLI::App* const sweep = line.app.add_subcommand(
      "sweep", "Run every combination that a sweep file asks for, on one machine or many");
  sweep->require_subcommand(1);
  CLI::App* const plan =
      AddSub(*sweep, "plan", "Say what would be run, and what of it cannot be", options);
  plan->callback([&line, options] { line.exit_code = Plan(*options); });
  CLI::App* const run = AddSub(
      *sweep, "run", "Run what is missing; the whole sweep, then merge it, or one shard", options);
  AddJobsOption(*run, options->jobs);
  run->add_option(
      "--shard", options->shard,
      "I/N: every N-th run from the I-th on, into a file of its own; `sweep merge` puts "
      "the shards together");
  AddAgain(*run, *options);
  AddCsv(*run, *options);
  run->callback([&line, options] { line.exit_code = Run(*options); });
  CLI::App* const submit = AddSub(
      *sweep, "submit", "Hand what is missing to a cluster, and the merge after it", options);
  AddSubmitOptions(*submit, options->submit);
  submit
      ->add_option("-j,--jobs", options->jobs, "Episodes at a time in each shard, a core each [1]")
      ->check(NumberFrom(1, 256));
  AddAgain(*submit, *options);
  submit->callback([&line, options] { line.exit_code = SubmitShards(*options); });
  CLI::App* const status =
      AddSub(*sweep, "status", "Say how many runs are finished, failed, missing", options);
  status->callback([&line, options] { line.exit_code = Status(*options); });
  CLI::App* const merge = AddSub(*sweep, "merge",
                                 "Put the shards together in results.db; exit code 1 if some are "
                                 "missing",
                                 options);
  AddCsv(*merge, *options);
  merge->callback([&line, options] { line.exit_code = Merge(*options); });
}

}  // namespace sidestep::cli
