#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sidestep/bench/episode_world.h"
#include "sidestep/bench/outcome.h"
#include "sidestep/core/samples.h"
#include "sidestep/record/journal.h"
#include "sidestep/record/recording.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/robot/world_truth.h"
#include "sidestep/scenarios/scenario.h"
#include "sidestep/sdf/distance_field.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::bench {

/// How the scenario's model of the world is made, fed from `world`. Its fields hold no reference to
/// either and tell distances up to `max_distance_m`.
/// @throws InputError for a thing that is known by its shape and too large for a field of its own.
sdf::WorldModelOptions MakeWorldModelOptions(const scenarios::Scenario& scenario,
                                             double max_distance_m, const EpisodeWorld& world);

/// Is shown the field of each planning cycle as the planner saw it, made at time `t`, and the
/// truth, which is null on hardware. Only wall-clock figures may depend on it.
using FieldObserver =
    std::function<void(EpisodeTime t, std::shared_ptr<const sdf::DistanceField> field,
                       const robot::WorldTruth* truth)>;

/// The stages of a planning cycle, in their order.
inline constexpr const char* kCycleStages[] = {"sense", "map",     "segment",
                                               "track", "predict", "optimise"};

/// CPU seconds by stage, and of all of them as "cycle", one entry a planning cycle. What sensing
/// and mapping cost since the cycle before is counted in.
using StageTimes = std::map<std::string, std::vector<double>>;

struct EpisodeResult {
  Outcome outcome = Outcome::kTimeout;
  /// Why it was aborted, or why the robot was never given a plan; else empty. In the recording's
  /// header as "reason", beside "outcome".
  std::string reason;
  record::Recording recording;  ///< its metrics are filled
  StageTimes times;             ///< has every stage, even where there was no planning cycle
  double wall_s = 0;            ///< of the whole episode
  /// Cycles that needed more CPU time than they were charged: that took less than they take.
  int cycles_over_charge = 0;
  int late_plans = 0;  ///< that came after the moment they were made for, and were dropped
  /// Scans by each sensor's name that were left out: captured no later than the one before, or come
  /// too late to be told in the order of capture (bench/scan_order.h).
  std::map<std::string, int> scans_left_out;
  /// How long the robot was kept waiting for each command, in real time; empty in simulation.
  std::vector<double> answers_s;
};

/// What an episode's time goes by.
enum class EpisodeClock {
  kVirtual,  ///< time passes only in what is simulated
  /// As it does: planning has a thread of its own, and a plan that is not there when it was to take
  /// effect is dropped. No two such runs are alike.
  kWall,
  kRobot  ///< the same by the robot's own clock, which nobody can hurry
};

/// How an episode is run, beside what the scenario says.
struct EpisodeOptions {
  FieldObserver observe_field;
  /// Asked again and again why the robot is to stop: once that is not empty it brakes, and when it
  /// rests the episode ends as aborted, for this reason.
  std::function<std::string()> why_stop;
  EpisodeClock clock = EpisodeClock::kVirtual;
  /// Gets what is recorded as it comes; null: there is none.
  record::Journal* journal = nullptr;
  double horizons = 2;  ///< it lasts at most this many
};

/// Runs one closed loop: sense, predict, re-plan, splice, move, until 0.5 s after the goal is
/// reached or, unless the options say otherwise, twice the horizon. On virtual time, unless the
/// latency is measured, everything but `times`, `wall_s` and `cycles_over_charge` is a function of
/// the scenario and the build. A planning cycle begins at multiples of 1 / replan_rate and takes
/// what bench/latency.h says, or on a wall clock what it takes; the next one begins at the first
/// multiple after that.
///
/// What is thrown on the way (by the robot, a sensor, the planner, the observer ...) ends the
/// episode as aborted: what was recorded until then is the result. However it ends, the robot is
/// told to hold.
/// @param scenario with its task resolved (bench/resolve.h).
/// @throws std::invalid_argument for words of the scenario that no module knows, and whatever
/// `make_world` throws: then there was no episode.
EpisodeResult RunEpisode(const scenarios::Scenario& scenario, const robot::RobotModel& robot,
                         const WorldFactory& make_world, const EpisodeOptions& options = {});

/// What is known of an episode whose process ended before it did, from what was recorded until
/// then: it is aborted, and nothing is known of its times.
EpisodeResult CutOffEpisode(record::Recording recording);

/// For whom a part of an episode is of no use. @throws std::runtime_error, with the reason, if it
/// was aborted.
void RequireWhole(const EpisodeResult& result);

}  // namespace sidestep::bench
