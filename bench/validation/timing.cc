#include "sidestep/bench/validation/timing.h"

#include "sidestep/bench/validation/named_row.h"

namespace sidestep::bench {
namespace {

constexpr Timing kTimings[] = {
    {.name = "nominal"},
    {.name = "planner_x2", .cycle_factor = 2},
    {.name = "planner_x4", .cycle_factor = 4},
    {.name = "loss_1", .lost_share = 0.01},
    {.name = "loss_5", .lost_share = 0.05},
};

}  // namespace

std::span<const Timing> Timings() { return kTimings; }

const Timing& TimingOf(const std::string& name) { return RowNamed(Timings(), "timing", name); }

}  // namespace sidestep::bench
