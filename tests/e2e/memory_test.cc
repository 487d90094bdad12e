// A worker of a sweep, or a soak, runs thousands of episodes in one process: none of them leaves
// anything behind.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "sidestep/bench/resolve.h"
#include "sidestep/bench/run_row.h"
#include "sidestep/bench/scenario_planner.h"
#include "sidestep/cli/memory_watch.h"
#include "sidestep/sim/model_store.h"
#include "sidestep/sim/simulation.h"

namespace sidestep {
namespace {

const std::string kModels = SIDESTEP_SOURCE_DIR "/models";

// Of one seed, from the file to the row.
void RunOne(const std::string& planner, int seed, const bench::WorldFactory& make_world) {
  scenarios::Scenario scenario =
      scenarios::LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/hsr_walkway.yaml",
                              {{"planner.name", planner},
                               {"horizon.duration_s", "0.8"},
                               {"seed", std::to_string(seed)},
                               {"variations", "{delay_s: [0, 0.1], sideways_m: [-0.1, 0.1]}"}});
  const robot::RobotModel robot = robot::RobotModel::Load(kModels, scenario.robot, scenario.X_WB);
  bench::ResolvePlanner(scenario);
  bench::ResolveTask(scenario, robot);
  const bench::RecordedRun run = bench::RunEpisodeRow(scenario, robot, make_world, {});
  ASSERT_TRUE(run.recording) << run.row.error;
}

// Bytes that an episode leaves.
double LeftByAnEpisode(const std::string& planner, sim::ModelStore* store) {
  const bench::WorldFactory make_world = [&](const scenarios::Scenario& scenario,
                                             const robot::RobotModel& robot) {
    return bench::MakeEpisodeWorld(
        std::make_shared<sim::Simulation>(scenario, robot, kModels, &sim::MakeSensor, store));
  };
  constexpr int kCounted = 80;
  cli::MemoryWatch memory(kCounted);
  for (int seed = 1; seed <= kCounted; ++seed) {
    RunOne(planner, seed, make_world);
    memory.Count(cli::HeldBytes());
  }
  return memory.Growth().value() / (kCounted * 0.8);
}

// What the allocator keeps for the next time comes and goes by some 30 kB, however many there are.
constexpr double kMostBytes = 1000;

TEST(Episodes, LeaveNothingInMemory) {
  EXPECT_LE(LeftByAnEpisode("gpmp_fast", nullptr), kMostBytes);
}

TEST(Episodes, LeaveNothingInMemoryWhereTheirModelsAreKept) {
  sim::ModelStore store;
  EXPECT_LE(LeftByAnEpisode("gpmp_fast", &store), kMostBytes);
}

}  // namespace
}  // namespace sidestep
