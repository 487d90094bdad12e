#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

#include "sidestep/cli/slurm.h"
#include "sidestep/cli/sweep_runner.h"

namespace sidestep::cli {

struct SubmitOptions {
  SlurmRequest request;
  bool slurm = false, dry_run = false;
  int shards = 0;    ///< 0: as before, or as many as have runs_per_shard
  int throttle = 0;  ///< shards at a time; 0: as many as the site lets run
};

/// Flags of `sidestep sweep submit`.
void AddSubmitOptions(CLI::App& command, SubmitOptions& options);

/// Hands the missing shards of a sweep to Slurm, and a job that merges them when they have ended.
/// @param file of the sweep, and the further words of `sidestep sweep run` that every shard needs.
/// @throws InputError.
void Submit(const SubmitOptions& options, const bench::SweepPlan& plan, const SweepRunner& runner,
            const std::string& file, const std::vector<std::string>& words);

/// What the queue knows of the jobs that were submitted for this folder: how many tasks are in
/// which state. Empty where there is no queue, or nothing was submitted.
std::map<std::string, int> QueuedTasks(const std::string& out);

}  // namespace sidestep::cli
