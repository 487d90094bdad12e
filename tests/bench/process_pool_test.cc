#include "sidestep/bench/process_pool.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>
#include <string>

#include "tests/support/temporary_folder.h"

namespace sidestep::bench::process_pool_test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

using Answers = std::map<std::uint64_t, ProcessAnswer>;

// Of the tasks 0 ... count - 1; each answers once.
Answers RunAll(std::uint64_t count, const ProcessPoolOptions& options,
               const std::function<std::string(std::uint64_t)>& work) {
  Answers answers;
  std::uint64_t given = 0;
  RunInProcesses(
      options,
      [&]() -> std::optional<std::uint64_t> {
        return given == count ? std::nullopt : std::optional(given++);
      },
      work,
      [&](std::uint64_t task, const ProcessAnswer& answer) {
        EXPECT_TRUE(answers.emplace(task, answer).second) << "answered twice: " << task;
      });
  EXPECT_EQ(answers.size(), count);
  return answers;
}

TEST(RunInProcesses, AnswersEachTaskOnceInProcessesThatAreReplaced) {
  for (const int num_jobs : {1, 3}) {
    const Answers answers =
        RunAll(50, {.num_jobs = num_jobs, .tasks_per_process = 10}, [](std::uint64_t task) {
          return std::to_string(getpid()) + " " + std::string(100'000, 'a' + task % 26);
        });
    std::set<std::string> processes;
    for (const auto& [task, answer] : answers) {
      EXPECT_EQ(answer.why_failed, "");
      EXPECT_EQ(answer.text.back(), 'a' + static_cast<char>(task % 26));
      processes.insert(answer.text.substr(0, answer.text.find(' ')));
    }
    EXPECT_GE(processes.size(), 5u);
    EXPECT_FALSE(processes.contains(std::to_string(getpid())));
  }
}

// Ends its process by `signal`, but for the last time: a file tells how often it has been tried.
std::string EndsAtFirst(const std::filesystem::path& tries, int signal, int most) {
  std::error_code error;
  const auto count = std::filesystem::file_size(tries, error);
  if (!error && count >= static_cast<std::uintmax_t>(most)) return "done";
  std::ofstream(tries, std::ios::app) << "x";
  raise(signal);
  return "was not ended";
}

TEST(RunInProcesses, GivesATaskWhoseProcessWasKilledToAnotherOne) {
  const TemporaryFolder folder;
  const Answers answers = RunAll(20, {.num_jobs = 2}, [&](std::uint64_t task) {
    if (task % 5 != 0) return std::string("done");
    return EndsAtFirst(folder.path() / std::to_string(task), SIGKILL, 4);
  });
  for (const auto& [task, answer] : answers) EXPECT_EQ(answer.text, "done") << task;
}

TEST(RunInProcesses, SaysOfATaskThatEndsEveryProcessHowItDoes) {
  const Answers answers = RunAll(6, {.num_jobs = 2}, [&](std::uint64_t task) -> std::string {
    if (task == 1) std::abort();
    if (task == 2) throw std::runtime_error("unexpected");
    if (task == 3) _exit(7);
    if (task == 4) raise(SIGKILL);
    return "done";
  });
  EXPECT_EQ(answers.at(0).text, "done");
  EXPECT_THAT(answers.at(1).why_failed, StartsWith("its process was ended by signal 6"));
  EXPECT_THAT(answers.at(1).why_failed, HasSubstr(", 2 times"));
  EXPECT_THAT(answers.at(2).why_failed, HasSubstr("signal 6"));
  EXPECT_THAT(answers.at(3).why_failed, StartsWith("its process ended with exit code 7"));
  EXPECT_THAT(answers.at(4).why_failed, StartsWith("its process was ended by signal 9"));
  EXPECT_THAT(answers.at(4).why_failed, HasSubstr(", 6 times"));
  EXPECT_TRUE(answers.at(4).was_killed);
  EXPECT_FALSE(answers.at(1).was_killed);
  EXPECT_EQ(answers.at(5).text, "done");
}

TEST(RunInProcesses, LeavesNoProcessBehindWhenItsCallerFails) {
  EXPECT_THROW(RunInProcesses(
                   {.num_jobs = 3}, [] { return std::optional<std::uint64_t>(1); },
                   [](std::uint64_t) { return std::to_string(getpid()); },
                   [](std::uint64_t, const ProcessAnswer&) {
                     throw std::runtime_error("the disk is full");
                   }),
               std::runtime_error);
  // There is no child left to wait for.
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
}

TEST(RunInProcesses, DoesNothingWhereThereIsNothingToDo) {
  RunAll(0, {.num_jobs = 2}, [](std::uint64_t) { return std::string(); });
}

}  // namespace
}  // namespace sidestep::bench::process_pool_test
