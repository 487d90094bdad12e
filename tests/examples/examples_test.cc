// The examples of docs/adding.md, in a command that was built with them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tests/support/bytes_of.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const fs::path kExamples = fs::path(SIDESTEP_SOURCE_DIR) / "examples";

Finished Sidestep(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), SIDESTEP_PROGRAM);
  return RunProgram(arguments, {"SIDESTEP_DATA_DIR=" SIDESTEP_EXAMPLE_DATA});
}

class Examples : public ::testing::Test {
 protected:
  // Runs an example's scenario with one setting changed.
  nlohmann::json Run(const std::string& setting, const std::string& scenario = "pointer_and_ball") {
    std::vector<std::string> arguments = {"run", scenario, "--out", folder_.string()};
    if (!setting.empty()) arguments.insert(arguments.end(), {"--set", setting});
    const Finished finished = Sidestep(arguments);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return nlohmann::json::parse(BytesOf(folder_ / "result.json"), nullptr, false);
  }

  const TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

struct Kind {
  const char* kind;
  const char* list;  // where its line goes
};
constexpr Kind kKinds[] = {{"planner", "planner/planners.def"},
                           {"predictor", "sdf/prediction/predictors.def"},
                           {"sensor", "sim/sensors.def"},
                           {"metric", "bench/metrics/metrics.def"}};

TEST_F(Examples, AreOneFileAndOneLineEach) {
  for (const auto& [kind, list] : kKinds) {
    const std::string line = BytesOf(kExamples / kind / fs::path(list).filename());
    EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1) << kind;
    const auto files = fs::directory_iterator(kExamples / kind);
    EXPECT_EQ(std::distance(files, fs::directory_iterator()), 2) << kind;
  }
  for (const auto& entry : fs::directory_iterator(kExamples / "scenario")) {
    EXPECT_TRUE(entry.is_regular_file()) << entry.path();
  }
}

TEST_F(Examples, AreEachShownInTheDocumentation) {
  const std::string page = BytesOf(fs::path(SIDESTEP_SOURCE_DIR) / "docs/adding.md");
  for (const auto& entry : fs::recursive_directory_iterator(kExamples)) {
    if (!entry.is_regular_file() || entry.path().filename() == "CMakeLists.txt") continue;
    EXPECT_THAT(page,
                HasSubstr("../" + entry.path().lexically_relative(SIDESTEP_SOURCE_DIR).string()));
  }
  for (const auto& [kind, list] : kKinds) EXPECT_THAT(page, HasSubstr(std::string("../") + list));
}

TEST_F(Examples, AreListedByTheirNames) {
  const std::pair<const char*, const char*> names[] = {
      {"planners", "hold_still"},         {"predictors", "half_speed"}, {"sensors", "blinking"},
      {"metrics", "longest_blindness_s"}, {"robots", "pointer"},        {"robots", "panda_rail"},
      {"scenarios", "pointer_and_ball"}};
  for (const auto& [kind, name] : names) {
    EXPECT_THAT(Sidestep({"list", kind, "--names"}).out, HasSubstr(std::string(name) + "\n"));
  }
}

TEST_F(Examples, RobotScenarioAndMetricRunAsTheyAre) {
  const nlohmann::json result = Run("");
  EXPECT_EQ(result["robot"], "pointer");
  EXPECT_EQ(result["outcome"], "goal");
  EXPECT_NEAR(result["longest_blindness_s"].get<double>(), 1.0 / 30, 0.002);
}

TEST_F(Examples, ARobotOnARailIsPlannedForAndRun) {
  const nlohmann::json result = Run("", "panda_on_a_rail");
  EXPECT_EQ(result["robot"], "panda_rail");
  EXPECT_EQ(result["outcome"], "goal");
  const nlohmann::json unseen = Run("knowledge=static", "panda_on_a_rail");
  EXPECT_EQ(unseen["outcome"], "collision");
}

TEST_F(Examples, ThePlannerHoldsStill) {
  const nlohmann::json result = Run("planner.name=hold_still");
  EXPECT_EQ(result["planner"], "hold_still");
  EXPECT_NEAR(result["goal_error_rad"].get<double>(), 2.4, 0.01);
}

TEST_F(Examples, ThePredictorExpectsHalfTheSpeed) {
  const nlohmann::json full = Run("predictor=two_frame");
  const nlohmann::json half = Run("predictor=half_speed");
  EXPECT_EQ(half["predictor"], "half_speed");
  // The ball runs at 0.5 m/s: half of that is missing after 0.5 s.
  EXPECT_LT(full["prediction_error_500ms_m"].get<double>(), 0.1);
  EXPECT_NEAR(half["prediction_error_500ms_m"].get<double>(), 0.125, 0.06);
}

TEST_F(Examples, TheSensorBlinks) {
  const nlohmann::json result = Run("sensor.name=blinking");
  EXPECT_NEAR(result["longest_blindness_s"].get<double>(), 1 + 1.0 / 30, 0.035);
}

}  // namespace
}  // namespace sidestep
