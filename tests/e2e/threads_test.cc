// Nothing is shared between episodes: what runs beside one does not change a bit of it.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/resolve.h"
#include "sidestep/record/recording_file.h"
#include "sidestep/sim/simulation.h"
#include "tests/support/temporary_folder.h"

namespace sidestep {
namespace {

namespace fs = std::filesystem;

struct Problem {
  scenarios::Scenario scenario;
  robot::RobotModel robot;
};

const std::string kModels = SIDESTEP_SOURCE_DIR "/models";

Problem Load(const std::string& name, const scenarios::Settings& settings) {
  scenarios::Scenario scenario =
      scenarios::LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/" + name + ".yaml", settings);
  robot::RobotModel robot = robot::RobotModel::Load(kModels, scenario.robot, scenario.X_WB);
  bench::ResolveTask(scenario, robot);
  return {std::move(scenario), std::move(robot)};
}

bench::EpisodeWorld MakeWorld(const scenarios::Scenario& scenario, const robot::RobotModel& robot) {
  return bench::MakeEpisodeWorld(std::make_shared<sim::Simulation>(scenario, robot, kModels));
}

// The bytes of an episode's trace.
std::string Trace(const Problem& problem) {
  const bench::EpisodeResult result =
      bench::RunEpisode(problem.scenario, problem.robot, &MakeWorld);
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "trace.h5";
  record::WriteRecording(result.recording, file.string());
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(TwoEpisodesInTwoThreads, GiveTheSameBitsAsAlone) {
  const Problem first = Load("hsr_walkway", {});
  const Problem second = Load("walkway_behaviours", {{"behaviour", "random_walk"}});
  const std::string first_alone = Trace(first);
  const std::string second_alone = Trace(second);
  ASSERT_NE(first_alone, second_alone);

  std::string first_beside, second_beside;
  std::thread other([&] { first_beside = Trace(first); });
  second_beside = Trace(second);
  other.join();
  EXPECT_EQ(first_beside, first_alone);
  EXPECT_EQ(second_beside, second_alone);
}

}  // namespace
}  // namespace sidestep
