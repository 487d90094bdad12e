#include "sidestep/bench/safety_watch.h"

#include "sidestep/bench/episode.h"

namespace sidestep::bench {
namespace {

sdf::WorldModelOptions OptionsFor(const scenarios::Scenario& scenario, const EpisodeWorld& world) {
  // Its fields are not asked for: what is near them is of no interest.
  sdf::WorldModelOptions options = MakeWorldModelOptions(scenario, scenario.grid.cell_m, world);
  options.knowledge = sdf::Knowledge::kPrediction;
  options.growth_sigmas = options.stray_s = 0;
  options.remembers_lost = true;
  return options;
}

}  // namespace

SafetyWatch::SafetyWatch(const scenarios::Scenario& scenario, const EpisodeWorld& world)
    : model_(sdf::MakeWorldModel(OptionsFor(scenario, world))) {}

ObstacleReport SafetyWatch::Observe(std::span<const Scan> scans) {
  model_->Observe(scans);
  return {scans.front().t, model_->MovingNow()};
}

}  // namespace sidestep::bench
