#include "sidestep/bench/task_pool.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace sidestep::bench {
namespace {

TEST(RunTasks, CallsEachTaskOnceAndPassesAnExceptionOn) {
  for (const int num_jobs : {1, 3, 100}) {
    std::vector<int> calls(50, 0);
    RunTasks(50, num_jobs, [&](int i) { ++calls[static_cast<std::size_t>(i)]; });
    EXPECT_EQ(calls, std::vector<int>(50, 1));
    EXPECT_THROW(RunTasks(50, num_jobs,
                          [](int i) {
                            if (i == 7) throw std::runtime_error("seven");
                          }),
                 std::runtime_error);
  }
  RunTasks(0, 2, [](int) { FAIL(); });
}

TEST(NumProcessors, IsAtLeastOne) { EXPECT_GE(NumProcessors(), 1); }

}  // namespace
}  // namespace sidestep::bench
