#include "sidestep/planner/seeds.h"

#include <bit>
#include <cstdint>
#include <iterator>
#include <utility>

namespace sidestep::planner {
namespace {

constexpr Timing kTimings[] = {Timing::kWholeTime, Timing::kLeaveLate, Timing::kArriveEarly};
constexpr int kNumTimings = static_cast<int>(std::size(kTimings));

EpisodeTime FirstFreeTime(const PlanRequest& request) {
  return request.start + HorizonOffset(request.num_fixed * request.step_s);
}

}  // namespace

// A warm start has less time for detours.
Seeds::Seeds(const PlanRequest& request, int num_detours, Eigen::VectorXd scale)
    : request_(request),
      num_detours_(request.initial ? 0 : num_detours),
      num_direct_(kNumTimings + (request.initial ? 1 : 0)),
      scale_(std::move(scale)),
      random_(std::bit_cast<std::uint64_t>(FirstFreeTime(request).seconds()), "detours") {}

int Seeds::count() const { return num_direct_ + num_detours_; }

Trajectory Seeds::Make(int seed) {
  if (IsDetour(seed)) return MakeDetour(request_, scale_, random_);
  if (request_.initial && seed == 0) return MakeWarmStart(request_);
  return MakeDirectMotion(request_, kTimings[seed - (num_direct_ - kNumTimings)]);
}

}  // namespace sidestep::planner
