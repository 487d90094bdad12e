#pragma once

#include <functional>
#include <map>
#include <string>

#include "sidestep/bench/sweep/sweep.h"
#include "sidestep/bench/sweep/sweep_rows.h"

namespace sidestep::bench {

/// What a merged database says that neither plan nor rows know.
struct MergeOptions {
  std::string path;                          ///< of the database
  std::map<std::string, std::string> facts;  ///< of the table `sidestep`
  std::string version;                       ///< of what made the runs
  /// What runs a combination again, but for its seed; empty: nothing can.
  std::function<std::string(const PlannedRun&)> command;
  /// Where the trace of the run of this key is; empty: it was not kept.
  std::function<std::string(std::uint64_t key)> trace;
  /// What its scenario is to be loaded by: a name, or a path.
  std::function<std::string(const PlannedRun&)> scenario;
};

/// Writes the finished runs of a plan to a database, in the plan's order: the same file, but for
/// the tables of the wall clock, however they were divided into shards and in whatever order they
/// were finished. A run's id is its place in the plan, from 1.
/// @throws InputError if it cannot be written.
void MergeRows(const SweepPlan& plan, const SweepRows& rows, const MergeOptions& options);

}  // namespace sidestep::bench
