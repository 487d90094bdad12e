#include "sidestep/sdf/once_per_time.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace sidestep::sdf {
namespace {

TEST(OncePerTime, ComputesEachTimeOnceForAllCopies) {
  int num_computed = 0;
  const OncePerTime<double> square([&](EpisodeTime t) {
    ++num_computed;
    return t.seconds() * t.seconds();
  });
  const std::function<double(EpisodeTime)> copy = square;
  for (int round = 0; round < 50; ++round) {
    for (int step = 0; step < 31; ++step) {
      const double t_s = 0.1 * step;
      EXPECT_EQ((round % 2 == 0 ? square(EpisodeTime(t_s)) : copy(EpisodeTime(t_s))), t_s * t_s);
    }
  }
  EXPECT_EQ(num_computed, 31);
}

TEST(OncePerTime, AnswersRightlyHoweverManyTimesThereAre) {
  const OncePerTime<double> same([](EpisodeTime t) { return t.seconds(); });
  for (int n = 0; n < 20000; ++n) ASSERT_EQ(same(EpisodeTime(n % 7000)), n % 7000);
}

TEST(OncePerTime, MayBeAskedFromManyThreads) {
  std::atomic<int> num_computed = 0;
  const OncePerTime<double> same([&](EpisodeTime t) {
    ++num_computed;
    return t.seconds();
  });
  std::atomic<int> num_wrong = 0;
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread) {
    threads.emplace_back([&] {
      for (int n = 0; n < 5000; ++n) num_wrong += same(EpisodeTime(n % 100)) != n % 100 ? 1 : 0;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(num_wrong, 0);
  EXPECT_EQ(num_computed, 100);
}

}  // namespace
}  // namespace sidestep::sdf
