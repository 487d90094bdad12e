#include "tests/support/supervised_episode.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <variant>

#include "sidestep/bench/resolve.h"
#include "sidestep/bench/validation/random_obstacle.h"
#include "sidestep/bench/validation/support.h"
#include "sidestep/record/questions.h"
#include "sidestep/sim/simulation.h"

namespace sidestep {
namespace {

constexpr double kHorizons = 3;   // who waits for a box to pass needs longer than two
constexpr double kGivesUp_s = 5;  // who has not moved for so long

bench::ObstacleRange RangeOf(Envelope envelope) {
  return envelope == Envelope::kWithin ? bench::ObstacleRange{0.1, 0.48, 1.9}
                                       : bench::ObstacleRange{0.1, 1.5, 10};
}

void Describe(const scenarios::Motion& motion, SupervisedEpisode& episode) {
  if (const auto* const linear = std::get_if<scenarios::LinearMotion>(&motion)) {
    episode.motion = "linear";
    episode.speed_m_s = linear->speed_m_s;
  } else if (const auto* const changing = std::get_if<scenarios::AcceleratedMotion>(&motion)) {
    episode.motion = "accelerated";
    episode.speed_m_s =
        changing->acceleration_m_s2 < 0 ? changing->speed_m_s : changing->max_speed_m_s;
    episode.acceleration_m_s2 = std::abs(changing->acceleration_m_s2);
  } else if (const auto* const circle = std::get_if<scenarios::CircleMotion>(&motion)) {
    episode.motion = "circle";
    episode.speed_m_s = circle->speed_m_s;
    episode.acceleration_m_s2 = circle->speed_m_s * circle->speed_m_s / circle->radius_m;
  }
}

scenarios::Scenario LoadBase(const std::string& source_dir) {
  return scenarios::LoadScenario(
      source_dir + "/scenarios/hardware_single_table.yaml",
      {{"predictor", "kalman_turn"},
       {"sensor",
        "{name: tags, rate_hz: 30, tags: {position_m: [2, 0, 2], across_noise: 0, "
        "along_noise_per_m: 0}}"}});
}

}  // namespace

SupervisedEpisodes::SupervisedEpisodes(const std::string& source_dir, Envelope envelope)
    : models_(source_dir + "/models"),
      envelope_(envelope),
      scenario_(LoadBase(source_dir)),
      robot_(robot::RobotModel::Load(models_, scenario_.robot, scenario_.X_WB)) {
  bench::ResolveTask(scenario_, robot_);
}

scenarios::Scenario SupervisedEpisodes::Make(std::uint64_t seed) const {
  RandomStream random(seed, "supervised episodes");
  scenarios::Scenario scenario = scenario_;
  bench::SetRandomMotion(RangeOf(envelope_), random, scenario);
  return scenario;
}

bench::EpisodeResult SupervisedEpisodes::RunWhole(const scenarios::Scenario& scenario) const {
  const robot::RobotInterface* arm = nullptr;
  const auto make_world = [&](const scenarios::Scenario& of, const robot::RobotModel& model) {
    bench::EpisodeWorld world =
        bench::MakeEpisodeWorld(std::make_shared<sim::Simulation>(of, model, models_));
    arm = world.robot;
    return world;
  };
  bench::EpisodeOptions options;
  options.horizons = kHorizons;
  double moved_s = 0;
  options.why_stop = [&]() -> std::string {
    const JointState state = arm->Read();
    if (bench::IsMoving(state.v)) moved_s = state.t.seconds();
    return state.t.seconds() > moved_s + kGivesUp_s ? "it does not get on" : "";
  };
  return bench::RunEpisode(scenario, robot_, make_world, options);
}

SupervisedEpisode SupervisedEpisodes::Run(std::uint64_t seed) const {
  const scenarios::Scenario scenario = Make(seed);
  const bench::EpisodeResult result = RunWhole(scenario);
  SupervisedEpisode episode;
  episode.seed = seed;
  Describe(scenario.moving_obstacles.front().motion, episode);
  episode.outcome = result.outcome;
  episode.reason = result.reason;
  const double reached_s = result.recording.metrics.at("time_to_goal_s");
  if (std::isfinite(reached_s)) episode.goal_s = reached_s;
  for (const SafetyEvent& event : result.recording.safety) {
    ++episode.findings[event.check + " " + event.reaction];
    if (event.check == "obstacle_too_fast" && !episode.too_fast_m_s)
      episode.too_fast_m_s = event.value;
  }
  const auto& truth = result.recording.truth;
  const auto touched = std::find_if(truth.begin(), truth.end(),
                                    [](const TruthSample& sample) { return sample.in_contact; });
  if (touched == truth.end()) return episode;
  const EpisodeTime t = record::FirstTouch(result.recording)->t;
  episode.touch_s = t.seconds();
  if (bench::IsBase(robot_, *touched)) return episode;
  for (const ControlSample& tick : result.recording.control) {
    if (std::abs((tick.t - t).seconds()) >= 2e-3) continue;
    if (bench::IsToldToMove(tick)) episode.touched_in_motion = true;
    episode.touch_m_s = std::max(episode.touch_m_s, bench::FastestSphere_m_s(robot_, tick));
  }
  return episode;
}

bench::FreePath SupervisedEpisodes::Search(std::uint64_t seed, int max_guesses) const {
  return bench::SearchFreePath(Make(seed), robot_, max_guesses, seed);
}

}  // namespace sidestep
