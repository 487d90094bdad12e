#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "sidestep/bench/sweep/shard_file.h"
#include "sidestep/bench/sweep/sweep.h"
#include "sidestep/bench/sweep/sweep_rows.h"
#include "sidestep/cli/checked_robots.h"
#include "sidestep/cli/data_paths.h"

namespace sidestep::cli {

/// A sweep with the programs and files that it is run with.
class SweepRunner {
 public:
  /// @param folder in which the paths of the sweep's scenarios begin.
  /// @param out the folder of its results.
  SweepRunner(const bench::SweepPlan& plan, const std::string& folder, std::string out,
              DataPaths paths);

  const std::string& out() const { return out_; }
  std::string shards() const { return out_ + "/shards"; }
  std::string database() const { return out_ + "/results.db"; }

  /// What resolving showed: each scenario with each value of each axis, the other axes at their
  /// first ones. So every file that the sweep needs was read, and every value judged.
  struct Checked {
    /// A fingerprint of the scenarios, resolved without what is varied, and of all robots.
    std::string inputs;
    std::string description;  ///< of the first scenario that can be run
    bool seed_matters = false;
    int num_checked = 0;
    std::vector<std::string> refused;  ///< of them: what, and why
  };
  /// @throws InputError if nothing can be run.
  Checked Check() const;

  /// @throws InputError if seeds are counted and change nothing.
  void CheckSeeds(const Checked& checked) const;

  /// Why the runs that are there are not those of this program and these inputs, as Run refuses
  /// them; or why nothing can be run any more. Empty where everything is as it was.
  std::string WhatChanged() const;

  /// Makes the folder ready for rows of this program and these inputs.
  /// @param again rows of another build or of other inputs may be there, and do not count.
  /// @throws InputError if they are there otherwise, the folder cannot be written, nothing can be
  /// run, or seeds are counted and change nothing.
  bench::ShardMaker Prepare(bool again) const;

  struct RunOptions {
    bench::ShardName shard;
    int jobs = 1;
    bool again =
        false;  ///< rows of another build or of other inputs do not count, and may be there
  };
  /// Runs what is missing of a shard. @return whether all of it is there.
  /// @throws InputError for a folder that is in use, belongs to other inputs, or cannot be written.
  bool Run(const RunOptions& options) const;

  /// Who made the rows that count: by the folder's plan.json.
  /// @throws InputError if there is none.
  bench::ShardMaker Maker() const;
  bench::SweepRows Rows() const;
  /// Writes the database of the rows that there are.
  void Merge(const bench::SweepRows& rows) const;

  /// One run, to its row; the trace is kept as the sweep wants it.
  bench::RunRow RunOne(std::uint64_t index) const;
  /// What runs this combination again, but for its seed; empty for a search.
  std::string CommandOf(const bench::PlannedRun& run) const;

 private:
  bench::RunIdentity IdentityOf(const bench::PlannedRun& run) const;
  bench::Factors AllFactorsOf(const bench::PlannedRun& run) const;
  std::string ScenarioOf(const bench::PlannedRun& run) const;
  std::string TraceOf(std::uint64_t key) const;
  bool WantsTrace(const std::string& outcome) const;

  const bench::SweepPlan& plan_;
  std::string folder_, out_;
  DataPaths paths_;
  mutable CheckedRobots robots_;  // that were read for earlier runs
  bench::WorldFactory make_world_;
};

}  // namespace sidestep::cli
