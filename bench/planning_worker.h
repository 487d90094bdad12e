#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "sidestep/planner/replan_cycle.h"

namespace sidestep::bench {

/// Does the work of planning cycles, one at a time.
class PlanningWorker {
 public:
  using Work = std::function<planner::CycleResult()>;

  virtual ~PlanningWorker() = default;

  /// Only when it is not busy.
  virtual void Begin(Work work) = 0;

  /// From Begin until the result has been taken.
  virtual bool is_busy() const = 0;

  /// The result, once it is there. @throws what the work threw.
  virtual std::optional<planner::CycleResult> TakeFinished() = 0;
};

/// In the caller's thread: the result is there when Begin returns.
std::unique_ptr<PlanningWorker> MakeInlineWorker();

/// In a thread of its own, so that whoever begins it can go on sensing and sending meanwhile. When
/// it is destroyed it waits for what has begun.
std::unique_ptr<PlanningWorker> MakeThreadWorker();

}  // namespace sidestep::bench
