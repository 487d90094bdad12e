#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace sidestep::bench {

/// What came of a task that was given to a process.
struct ProcessAnswer {
  std::string text;        ///< what the task returned
  std::string why_failed;  ///< instead: how its process ended, each time that it was tried
  /// It was killed, which says nothing of the task.
  bool was_killed = false;
};

struct ProcessPoolOptions {
  int num_jobs = 1;  ///< processes at a time
  /// A process that has done so many tasks is replaced by a new one, so that what they lose of
  /// memory does not add up.
  int tasks_per_process = 1000;
  /// Times that a task is given to a further process, because the one that had it was killed
  /// (SIGKILL, SIGTERM: by a person, or for want of memory); or else ended (a crash): once.
  int most_kills = 5;
};

/// Runs tasks in processes that are forked off this one, which should have no other thread: what
/// one of them does to its memory, or what becomes of it, is nothing to the others.
/// @param next the next task, or none; asked in this process when one is free to do it.
/// @param work is called in a process of its own. What it throws ends that process.
/// @param done is called in this process with each task, once, in the order in which they end. What
///   it throws is thrown here, after those at work have been ended.
/// @param begin_process is called first of all in each process, to leave what is not its own.
void RunInProcesses(const ProcessPoolOptions& options,
                    const std::function<std::optional<std::uint64_t>()>& next,
                    const std::function<std::string(std::uint64_t)>& work,
                    const std::function<void(std::uint64_t, const ProcessAnswer&)>& done,
                    const std::function<void()>& begin_process = {});

}  // namespace sidestep::bench
