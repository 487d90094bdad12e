#include "sidestep/sdf/parallel_for.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace sidestep::sdf {
namespace {

class ParallelForOnThreads : public ::testing::TestWithParam<int> {};

TEST_P(ParallelForOnThreads, VisitsEachIndexOnce) {
  for (const int count : {0, 1, 2, 1000}) {
    std::vector<int> visits(static_cast<std::size_t>(count), 0);
    ParallelFor(GetParam(), count, [&](int, int i) { ++visits[static_cast<std::size_t>(i)]; });
    EXPECT_EQ(visits, std::vector<int>(static_cast<std::size_t>(count), 1));
  }
}

TEST_P(ParallelForOnThreads, RunsAWorkerOnOneThreadAtATime) {
  std::vector<std::atomic<bool>> busy(static_cast<std::size_t>(GetParam()));
  std::atomic<int> overlaps = 0;
  ParallelFor(GetParam(), 1000, [&](int worker, int) {
    std::atomic<bool>& flag = busy.at(static_cast<std::size_t>(worker));
    if (flag.exchange(true)) ++overlaps;
    flag = false;
  });
  EXPECT_EQ(overlaps, 0);
}

INSTANTIATE_TEST_SUITE_P(Threads, ParallelForOnThreads, ::testing::Values(1, 2, 7));

TEST(ParallelFor, NeedsAThread) {
  EXPECT_THROW(ParallelFor(0, 1, [](int, int) {}), std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::sdf
