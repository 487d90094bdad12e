#pragma once

#include <map>
#include <string>
#include <vector>

namespace sidestep::cli {

/// What a job asks of the cluster beside what it does; empty: the site's own.
struct SlurmRequest {
  std::string time, partition, account;
  std::vector<std::string> more;  ///< further words for sbatch, as they are
  int cpus = 1;                   ///< of each task
};

/// Shards that go into one array of jobs.
struct SlurmArray {
  int offset = 0;            ///< shard = offset + index in the array
  std::vector<int> indices;  ///< ascending
};

/// Divides shards into arrays whose indices are below `max_array_size`.
/// @param shards ascending, from 1.
std::vector<SlurmArray> DivideIntoArrays(const std::vector<int>& shards, int max_array_size);

/// Indices as sbatch takes them: "1-3,7".
std::string ArrayText(const std::vector<int>& indices);

/// The words of sbatch that submit a script as an array, or, without indices, as a job.
/// @param arguments of the script.
std::vector<std::string> SbatchCommand(const SlurmRequest& request, const std::string& name,
                                       const std::string& log, const std::vector<int>& indices,
                                       int throttle, const std::vector<std::string>& after,
                                       const std::string& script,
                                       const std::vector<std::string>& arguments);

/// Runs a command of Slurm. @return what it printed.
/// @throws InputError with what it complained of, or that there is no such program.
std::string RunSlurm(const std::vector<std::string>& words);

/// `MaxArraySize` of what `scontrol show config` prints; 1001, Slurm's default, if it is not there.
int MaxArraySizeIn(const std::string& config);

/// How many tasks of some jobs are in which state, of what `squeue --noheader --array --format=%T`
/// prints.
std::map<std::string, int> StatesIn(const std::string& queue);

}  // namespace sidestep::cli
