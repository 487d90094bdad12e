// The main scene, run as a person would run it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string Slurp(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

class Walkway : public ::testing::Test {
 protected:
  // Runs an episode into `folder_/name` and reads its result.json.
  Json Run(const std::string& name, const std::vector<std::string>& options) {
    std::vector<std::string> command = {SIDESTEP_PROGRAM, "run", "hsr_walkway", "--out",
                                        (folder_ / name).string()};
    command.insert(command.end(), options.begin(), options.end());
    const Finished finished = RunProgram(command, {}, folder_.string());
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return Json::parse(Slurp(folder_ / name / "result.json"), nullptr, false);
  }

  const TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

class WalkwayAtSpeed : public Walkway, public ::testing::WithParamInterface<std::string> {};

TEST_P(WalkwayAtSpeed, PredictionAndFullKnowledgeTouchNothingAndReachTheGoalInTime) {
  for (const char* const knowledge : {"prediction", "full_knowledge"}) {
    const Json result = Run(knowledge, {"--speed", GetParam(), "--knowledge", knowledge});
    EXPECT_EQ(result["outcome"], "goal") << knowledge;
    EXPECT_TRUE(result["first_contact_s"].is_null()) << knowledge;
    EXPECT_GT(result["min_clearance_m"].get<double>(), 0) << knowledge;
    ASSERT_TRUE(result["time_to_goal_s"].is_number()) << knowledge;
    EXPECT_LE(result["time_to_goal_s"].get<double>(), 3.0) << knowledge;
  }
}

TEST_P(WalkwayAtSpeed, WithoutKnowingThatItMovesTheArmTouchesTheHsr) {
  const Json result = Run("static", {"--speed", GetParam(), "--knowledge", "static"});
  EXPECT_EQ(result["outcome"], "collision");
  EXPECT_TRUE(result["first_contact_s"].is_number());
  EXPECT_LE(result["min_clearance_m"].get<double>(), 0);
}

INSTANTIATE_TEST_SUITE_P(MetresASecond, WalkwayAtSpeed,
                         ::testing::Values("1.0", "1.1", "1.2", "1.3", "1.4", "1.5", "1.6", "1.7",
                                           "1.8", "1.9", "2.0"),
                         [](const auto& test) {
                           std::string name = "v" + test.param;
                           name[2] = '_';
                           return name;
                         });

TEST_F(Walkway, EqualRunsGiveEqualBytesUnderAnyLoad) {
  Json first = Run("first", {});
  std::atomic<bool> stop = false;
  std::vector<std::thread> load;
  for (int i = 0; i < 3; ++i) {
    load.emplace_back([&stop] {
      while (!stop) {
      }
    });
  }
  Json second = Run("second", {});
  stop = true;
  for (std::thread& thread : load) thread.join();

  EXPECT_EQ(Slurp(folder_ / "first/trace.h5"), Slurp(folder_ / "second/trace.h5"));
  EXPECT_TRUE(first.contains("wall_clock"));
  first.erase("wall_clock");
  second.erase("wall_clock");
  EXPECT_EQ(first.dump(), second.dump());
}

TEST_F(Walkway, EveryKindOfKnowledgeRunsAndLeavesNothingElseBehind) {
  for (const char* const knowledge :
       {"static", "execute_and_update", "prediction", "full_knowledge"}) {
    const Json result = Run(knowledge, {"--knowledge", knowledge});
    EXPECT_EQ(result["knowledge"], knowledge);
    EXPECT_GT(result["replans"].get<double>(), 10);
    EXPECT_TRUE(fs::exists(folder_ / knowledge / "trace.h5"));
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 4);
}

TEST_F(Walkway, ReportsEveryStageOfThePlanningCycle) {
  const Json result = Run("stages", {});
  for (const char* const stage :
       {"sense", "map", "segment", "track", "predict", "optimise", "cycle"}) {
    const Json& row = result["wall_clock"]["cycle_cpu"][stage];
    EXPECT_GE(row["p50_ms"].get<double>(), 0) << stage;
    EXPECT_LE(row["p50_ms"], row["p95_ms"]) << stage;
    EXPECT_LE(row["p95_ms"], row["p99_ms"]) << stage;
  }
}

TEST_F(Walkway, PrintsTheResultAsJsonWhenAsked) {
  const Finished finished =
      RunProgram({SIDESTEP_PROGRAM, "run", "hsr_walkway", "--json", "--out", folder_.string()});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.out, Slurp(folder_ / "result.json"));
}

}  // namespace
}  // namespace sidestep
