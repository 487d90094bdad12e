#include "sidestep/bench/planning_worker.h"

#include <chrono>
#include <future>
#include <utility>

namespace sidestep::bench {
namespace {

using Result = std::future<planner::CycleResult>;

class InlineWorker final : public PlanningWorker {
 public:
  void Begin(Work work) override { finished_ = work(); }
  bool is_busy() const override { return finished_.has_value(); }
  std::optional<planner::CycleResult> TakeFinished() override {
    return std::exchange(finished_, std::nullopt);
  }

 private:
  std::optional<planner::CycleResult> finished_;
};

class ThreadWorker final : public PlanningWorker {
 public:
  // A cycle is a fraction of a second: to start a thread for it costs nothing beside that.
  void Begin(Work work) override { result_ = std::async(std::launch::async, std::move(work)); }
  bool is_busy() const override { return result_.valid(); }
  std::optional<planner::CycleResult> TakeFinished() override {
    if (!result_.valid()) return std::nullopt;
    if (result_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
    return result_.get();
  }

 private:
  Result result_;  // its destructor waits
};

}  // namespace

std::unique_ptr<PlanningWorker> MakeInlineWorker() { return std::make_unique<InlineWorker>(); }

std::unique_ptr<PlanningWorker> MakeThreadWorker() { return std::make_unique<ThreadWorker>(); }

}  // namespace sidestep::bench
