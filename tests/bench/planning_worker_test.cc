#include "sidestep/bench/planning_worker.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <stdexcept>
#include <thread>

namespace sidestep::bench {
namespace {

planner::CycleResult ResultOf(double cost) {
  planner::CycleResult result;
  result.record.cost = cost;
  return result;
}

double TakeCost(PlanningWorker& worker) {
  for (;;) {
    if (const auto result = worker.TakeFinished()) return result->record.cost;
    std::this_thread::yield();
  }
}

TEST(InlineWorker, HasTheResultAtOnce) {
  const auto worker = MakeInlineWorker();
  EXPECT_FALSE(worker->is_busy());
  worker->Begin([] { return ResultOf(7); });
  EXPECT_TRUE(worker->is_busy());
  EXPECT_EQ(worker->TakeFinished()->record.cost, 7);
  EXPECT_FALSE(worker->is_busy());
  EXPECT_FALSE(worker->TakeFinished());
}

TEST(ThreadWorker, LetsTheCallerGoOnUntilTheResultIsThere) {
  const auto worker = MakeThreadWorker();
  for (int i = 0; i < 20; ++i) {
    std::promise<void> go;
    worker->Begin([&go, i] {
      go.get_future().wait();
      return ResultOf(i);
    });
    EXPECT_TRUE(worker->is_busy());
    EXPECT_FALSE(worker->TakeFinished());
    go.set_value();
    EXPECT_EQ(TakeCost(*worker), i);
    EXPECT_FALSE(worker->is_busy());
  }
}

TEST(ThreadWorker, TellsWhatTheWorkThrewToWhoTakesTheResult) {
  const auto worker = MakeThreadWorker();
  worker->Begin([]() -> planner::CycleResult { throw std::runtime_error("no plan"); });
  EXPECT_THROW(TakeCost(*worker), std::runtime_error);
  EXPECT_FALSE(worker->is_busy());
}

TEST(ThreadWorker, WaitsForItsWorkWhenItIsDestroyed) {
  std::atomic<bool> done = false;
  auto worker = MakeThreadWorker();
  worker->Begin([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    done = true;
    return ResultOf(1);
  });
  worker.reset();
  EXPECT_TRUE(done);
}

}  // namespace
}  // namespace sidestep::bench
