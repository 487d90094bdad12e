#include "bench/metrics/registry.h"

#include <array>

#include "bench/metrics/motion_metrics.h"
#include "bench/metrics/prediction_metrics.h"
#include "bench/metrics/safety_metrics.h"

namespace sidestep {
namespace {

template <int kMilliseconds>
double PredictionErrorAfter(const Recording& recording) {
  return PredictionError(recording, HorizonOffset(kMilliseconds / 1000.0));
}

constexpr std::array kMetrics = {
    Metric{"first_contact_s", "s", false, "when the robot first touched anything", &FirstContact},
    Metric{"min_clearance_m", "m", false, "least distance to anything, true shapes, 100 Hz",
           &MinClearance},
    Metric{"time_to_goal_s", "s", true, "when the goal was reached (0.02 rad, 0.05 rad/s)",
           &TimeToGoal},
    Metric{"goal_error_rad", "rad", true, "largest joint error at the end", &GoalError},
    Metric{"gp_cost", "1", true, "smoothness: GP prior cost of the executed motion at 0.1 s",
           &GpCostOfMotion},
    Metric{"jerk_rms", "rad/s^3", true, "commanded jerk over time and joints, to the goal",
           &JerkRms},
    Metric{"tracking_error_rad", "rad", true, "largest joint distance from command to motion",
           &TrackingError},
    Metric{"velocity_use", "1", true, "largest commanded velocity over its limit", &VelocityUse},
    Metric{"replans", "count", false, "planning cycles run", &Replans},
    Metric{"plans_accepted", "count", false, "plans given to the robot", &PlansAccepted},
    Metric{"prediction_error_100ms_m", "m", true,
           "obstacles' distance from where they were expected", &PredictionErrorAfter<100>},
    Metric{"prediction_error_300ms_m", "m", true, "the same, 0.3 s ahead",
           &PredictionErrorAfter<300>},
    Metric{"prediction_error_500ms_m", "m", true, "the same, 0.5 s ahead",
           &PredictionErrorAfter<500>},
    Metric{"prediction_error_1000ms_m", "m", true, "the same, 1 s ahead",
           &PredictionErrorAfter<1000>},
    Metric{"prediction_error_2000ms_m", "m", true, "the same, 2 s ahead",
           &PredictionErrorAfter<2000>},
};

}  // namespace

std::span<const Metric> Metrics() { return kMetrics; }

}  // namespace sidestep
