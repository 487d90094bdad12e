#include "sidestep/cli/sweep_submit.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "sidestep/bench/json_text.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/shell_quote.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/text_file.h"

namespace sidestep::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kRunsPerShard = 1000;  // some minutes of work
constexpr std::uintmax_t kMaxJobsBytes = 1 << 24;

std::string JobsFile(const std::string& out) { return out + "/slurm/jobs.json"; }

struct Submitted {
  int shards = 0;
  std::vector<std::string> jobs;
};

Submitted ReadSubmitted(const std::string& out) {
  std::error_code error;
  if (!fs::exists(JobsFile(out), error)) return {};
  const auto json =
      nlohmann::json::parse(ReadTextFile(JobsFile(out), kMaxJobsBytes), nullptr, false);
  try {
    return {json.at("shards").get<int>(), json.at("jobs").get<std::vector<std::string>>()};
  } catch (const nlohmann::json::exception&) {
    throw InputError(JobsFile(out), "is not of this version of sidestep: remove it");
  }
}

std::string ThisProgram() { return fs::read_symlink("/proc/self/exe").string(); }

// A script for sbatch; exec, so that its signals come to the program.
std::string Script(const std::vector<std::string>& words, const std::string& after_words) {
  return "#!/bin/sh\n# Written by sidestep sweep submit.\nexec " +
         Joined(words, " ", [](const std::string& word) { return ShellQuoted(word); }) +
         after_words + "\n";
}

// "123;cluster" of --parsable.
std::string JobIn(const std::string& printed) {
  return printed.substr(0, printed.find_first_of(";\n"));
}

std::vector<int> MissingShards(const bench::SweepPlan& plan, const bench::SweepRows* rows,
                               int shards) {
  std::vector<bool> is_missing(static_cast<std::size_t>(shards), false);
  for (std::uint64_t i = 0; i < plan.num_runs(); ++i) {
    if (rows == nullptr || !rows->Has(i)) {
      is_missing[i % static_cast<std::uint64_t>(shards)] = true;
    }
  }
  std::vector<int> missing;
  for (int shard = 1; shard <= shards; ++shard) {
    if (is_missing[static_cast<std::size_t>(shard - 1)]) missing.push_back(shard);
  }
  return missing;
}

}  // namespace

void AddSubmitOptions(CLI::App& command, SubmitOptions& options) {
  command.add_flag("--slurm", options.slurm, "By sbatch, as an array of jobs")->required();
  command
      .add_option("--shards", options.shards,
                  "Into how many parts the runs are divided [as before, or one for each 1000 runs]")
      ->check(NumberFrom(1, 100000));
  command.add_option("--at-a-time", options.throttle, "At most so many shards at a time")
      ->check(NumberFrom(1, 100000));
  command.add_option("--time", options.request.time, "Time limit of a shard, as sbatch takes it");
  command.add_option("--partition", options.request.partition, "As sbatch takes it");
  command.add_option("--account", options.request.account, "As sbatch takes it");
  command
      .add_option("--sbatch", options.request.more,
                  "A further word for sbatch, e.g. --sbatch=--mem=4G; may be repeated")
      ->allow_extra_args(false);
  command.add_flag("--dry-run", options.dry_run, "Print the commands instead");
}

void Submit(const SubmitOptions& options, const bench::SweepPlan& plan, const SweepRunner& runner,
            const std::string& file, const std::vector<std::string>& words) {
  const std::string out = fs::absolute(runner.out()).lexically_normal().string();
  const Submitted before = ReadSubmitted(out);
  const auto by_size = static_cast<int>((plan.num_runs() + kRunsPerShard - 1) / kRunsPerShard);
  const int shards = options.shards > 0  ? options.shards
                     : before.shards > 0 ? before.shards
                                         : std::clamp(by_size, 1, 100'000);
  if (!QueuedTasks(out).empty()) {
    throw InputError(
        out, "jobs of it are in the queue: wait for them, or scancel " + Joined(before.jobs, " "));
  }
  std::error_code error;
  std::optional<bench::SweepRows> rows;
  if (fs::exists(out + "/plan.json", error)) rows.emplace(runner.Rows());
  const std::vector<int> missing = MissingShards(plan, rows ? &*rows : nullptr, shards);
  if (missing.empty()) {
    Print("nothing is missing: sidestep sweep merge {}\n", ShellQuoted(file));
    return;
  }
  const std::string logs = out + "/slurm";
  MakeOutFolder(logs, {"shard.sh", "merge.sh", "jobs.json"});
  std::vector<std::string> run = {
      ThisProgram(), "sweep", "run", fs::absolute(file).string(),
      "--out",       out,     "-j",  std::to_string(options.request.cpus)};
  run.insert(run.end(), words.begin(), words.end());
  WriteFile(logs + "/shard.sh", Script(run, " --shard $((SLURM_ARRAY_TASK_ID + $1))/$2"));
  std::vector<std::string> merge = {ThisProgram(), "sweep", "merge", fs::absolute(file).string(),
                                    "--out",       out};
  merge.insert(merge.end(), words.begin(), words.end());
  WriteFile(logs + "/merge.sh", Script(merge, ""));
  const auto submit = [&](const std::vector<std::string>& command) {
    if (!options.dry_run) return JobIn(RunSlurm(command));
    Print("{}\n", Joined(command, " ", [](const std::string& word) { return ShellQuoted(word); }));
    return std::string("JOB");
  };
  const int max_array_size = options.dry_run
                                 ? MaxArraySizeIn("")
                                 : MaxArraySizeIn(RunSlurm({"scontrol", "show", "config"}));
  const std::string name = "sidestep-" + plan.sweep().name;
  std::vector<std::string> jobs;
  for (const SlurmArray& array : DivideIntoArrays(missing, max_array_size)) {
    jobs.push_back(submit(SbatchCommand(options.request, name, logs + "/%A_%a.log", array.indices,
                                        options.throttle, {}, logs + "/shard.sh",
                                        {std::to_string(array.offset), std::to_string(shards)})));
  }
  SlurmRequest one = options.request;
  one.cpus = 1;
  const std::string merging = submit(SbatchCommand(one, name + "-merge", logs + "/merge-%j.log", {},
                                                   0, jobs, logs + "/merge.sh", {}));
  jobs.push_back(merging);
  if (options.dry_run) return;
  WriteFile(JobsFile(out), bench::JsonText({{"shards", shards}, {"jobs", jobs}}));
  Print("submitted {} of {} shards as job{} {}; then job {} merges them into {}/results.db\n",
        missing.size(), shards, jobs.size() > 2 ? "s" : "",
        Joined(std::vector<std::string>(jobs.begin(), jobs.end() - 1)), merging, out);
}

std::map<std::string, int> QueuedTasks(const std::string& out) {
  const Submitted submitted = ReadSubmitted(out);
  if (submitted.jobs.empty()) return {};
  std::map<std::string, int> states;
  for (const std::string& job : submitted.jobs) {
    try {
      for (const auto& [state, count] : StatesIn(
               RunSlurm({"squeue", "--noheader", "--array", "--format=%T", "--jobs=" + job}))) {
        states[state] += count;
      }
    } catch (const InputError&) {
      // Of a job that has ended long ago squeue knows nothing, and says so.
    }
  }
  return states;
}

}  // namespace sidestep::cli
