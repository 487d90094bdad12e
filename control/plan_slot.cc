#include "sidestep/control/plan_slot.h"

#include <utility>

namespace sidestep::control {
namespace {

// Starts are sums of steps, rounded: what begins a rounding error after a tick begins with it.
constexpr HorizonOffset kStartRounding(1e-9);

}  // namespace

PlanSlot::~PlanSlot() {
  Free(incoming_.load());
  Free(retired_.load());
  Free(known_);
}

void PlanSlot::Put(Trajectory trajectory, EpisodeTime start) {
  Free(retired_.exchange(nullptr, std::memory_order_acquire));
  auto plan = std::make_unique<Plan>();
  plan->trajectory = std::move(trajectory);
  plan->start = start;
  plan->number = ++submitted_;
  // What has not been taken yet comes along.
  plan->before = incoming_.exchange(nullptr, std::memory_order_acquire);
  incoming_.store(plan.release(), std::memory_order_release);
}

void PlanSlot::Recall() noexcept { recalled_.store(submitted_, std::memory_order_release); }

const PlanSlot::Plan* PlanSlot::PlanAt(EpisodeTime t) noexcept {
  if (Plan* const newest = incoming_.exchange(nullptr, std::memory_order_acquire)) {
    Plan* oldest = newest;
    while (oldest->before != nullptr) oldest = oldest->before;
    oldest->before = known_;
    known_ = newest;
  }
  // Once a plan has begun, those put before it are of no more use.
  const std::uint64_t recalled = recalled_.load(std::memory_order_acquire);
  Plan** link = &known_;
  while (*link != nullptr && (*link)->number > recalled) {
    Plan* const plan = *link;
    if (plan->start <= t + kStartRounding) {
      Retire(std::exchange(plan->before, nullptr));
      return plan;
    }
    link = &plan->before;
  }
  Retire(std::exchange(*link, nullptr));
  return nullptr;
}

void PlanSlot::Free(Plan* newest) noexcept {
  while (newest != nullptr) {
    const std::unique_ptr<Plan> plan(newest);
    newest = plan->before;
  }
}

void PlanSlot::Retire(Plan* newest) noexcept {
  if (newest == nullptr) return;
  Plan* oldest = newest;
  while (oldest->before != nullptr) oldest = oldest->before;
  oldest->before = retired_.load(std::memory_order_relaxed);
  while (!retired_.compare_exchange_weak(oldest->before, newest, std::memory_order_release,
                                         std::memory_order_relaxed)) {
  }
}

}  // namespace sidestep::control
