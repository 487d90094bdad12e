#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "sidestep/core/time.h"
#include "sidestep/core/trajectory.h"

namespace sidestep::control {

/// Hands plans from one thread, which may take its time, to another, which may not: one slot, no
/// lock, and whoever ticks neither allocates nor frees. A plan that has been replaced goes back the
/// same way, and its memory is freed by the thread that submits.
class PlanSlot {
 public:
  struct Plan {
    Trajectory trajectory;
    EpisodeTime start;
    std::uint64_t number = 0;  ///< of its submission
    Plan* before = nullptr;    ///< submitted before it and still of use
  };

  PlanSlot() = default;
  ~PlanSlot();
  PlanSlot(const PlanSlot&) = delete;
  PlanSlot& operator=(const PlanSlot&) = delete;

  // One thread submits.
  void Put(Trajectory trajectory, EpisodeTime start);
  /// Nothing that was put before is to be followed any more.
  void Recall() noexcept;

  // One thread ticks.
  /// The plan to follow at `t`: of those that have begun, the one that was put last; null if there
  /// is none. It stays valid until the next call.
  const Plan* PlanAt(EpisodeTime t) noexcept;

 private:
  static void Free(Plan* newest) noexcept;
  void Retire(Plan* newest) noexcept;

  std::atomic<Plan*> incoming_{nullptr};    // newest first
  std::atomic<Plan*> retired_{nullptr};     // to be freed by the thread that submits
  std::atomic<std::uint64_t> recalled_{0};  // plans up to this number
  std::uint64_t submitted_ = 0;             // of the thread that submits
  Plan* known_ = nullptr;                   // of the thread that ticks, newest first
};

}  // namespace sidestep::control
