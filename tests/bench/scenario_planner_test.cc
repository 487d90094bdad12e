#include "sidestep/bench/scenario_planner.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "sidestep/core/input_error.h"
#include "tests/support/planar_arm.h"

namespace sidestep::bench::scenario_planner_test {
namespace {

// A scenario whose planner map, in line 7, is this one.
scenarios::Scenario Resolved(const std::string& planner, const scenarios::Settings& settings = {}) {
  const std::string text = R"(description: a planar arm
robot: {model: arm, base: {position_m: [0, 0, 0]}}
task: {start: [-1.1, 0.3], goal: [1.2, -0.2]}
horizon: {duration_s: 3, step_s: 0.1}
workspace: {first_center_m: [-1, -1, -1], cell_m: 0.1, cells: [20, 20, 20]}
knowledge: prediction
planner: {)" + planner + R"(}
replanning: {rate_hz: 10, latency_s: 0.1}
sensor: {name: occupancy, rate_hz: 10}
floor_m: -2
static_boxes: []
moving_obstacles: []
seed: 1
)";
  scenarios::Scenario scenario = scenarios::ParseScenario(text, "mine.yaml", settings);
  ResolvePlanner(scenario);
  return scenario;
}

std::string Complaint(const std::string& planner, const scenarios::Settings& settings = {}) {
  try {
    Resolved(planner, settings);
  } catch (const InputError& error) {
    return error.what();
  }
  return "was accepted";
}

TEST(ScenarioPlanner, HasTheDefaultOfWhatIsNotSet) {
  const auto parameters = Resolved("name: gpmp, epsilon_m: 0.1, qc: 2.0").planner_parameters;
  EXPECT_EQ(parameters.at("qc"), "2");
  EXPECT_EQ(parameters.at("sigma_obs"), "0.05");
  EXPECT_EQ(parameters.at("max_iterations"), "50");
}

TEST(ScenarioPlanner, IsMadeAsTheScenarioSays) {
  const robot::RobotModel arm = MakePlanarArm();
  EXPECT_NO_THROW(MakePlanner(Resolved("name: gpmp, epsilon_m: 0.1, detours: 3"), arm));
  scenarios::Scenario scenario = Resolved("name: straight_line, epsilon_m: 0.1");
  EXPECT_NO_THROW(MakePlanner(scenario, arm));
  scenario.planner_parameters["detours"] = "3";
  EXPECT_THROW(MakePlanner(scenario, arm), std::invalid_argument);
}

TEST(ScenarioPlanner, IsRefusedWithItsLineIfItIsWrong) {
  using ::testing::HasSubstr;
  using ::testing::StartsWith;
  EXPECT_THAT(Complaint("name: chomp, epsilon_m: 0.1"),
              StartsWith("mine.yaml:7: planner.name: must be one of"));
  EXPECT_EQ(Complaint("name: gpmp, epsilon_m: 0.1, sigma_obs: 0"),
            "mine.yaml:7: planner.sigma_obs: must be from 1e-05 to 1000, is 0");
  EXPECT_EQ(Complaint("name: gpmp, epsilon_m: 0.1, n_int: 1.5"),
            "mine.yaml:7: planner.n_int: must be a whole number, is '1.5'");
  EXPECT_EQ(Complaint("name: gpmp, epsilon_m: 0.1", {{"planner.n_int", "010"}}),
            "--set planner.n_int: must be a whole number without leading zeros, is '010'");
  EXPECT_EQ(Complaint("name: gpmp, epsilon_m: 0.1, sigma_obs: 01"),
            "mine.yaml:7: planner.sigma_obs: must be a number without leading zeros, is '01'");
  EXPECT_EQ(Complaint("name: gpmp, epsilon_m: 0.1", {{"planner.n_int", "101"}}),
            "--set planner.n_int: must be from 0 to 100, is 101");
  const std::string unknown = Complaint("name: gpmp, epsilon_m: 0.1, sigma: 1");
  EXPECT_THAT(unknown, StartsWith("mine.yaml:7: planner.sigma: is not a known key (known here: "));
  EXPECT_THAT(unknown, HasSubstr("sigma_goal, sigma_obs, velocity_limits"));
}

TEST(ScenarioPlanner, LeavesOutWhatTheFileSetsOfAnotherPlannerThanThePersonChose) {
  const std::string of_gpmp = "name: gpmp, epsilon_m: 0.1, sigma_obs: 0.2";
  const scenarios::Settings straight = {{"planner.name", "straight_line"}};
  EXPECT_TRUE(Resolved(of_gpmp, straight).planner_parameters.empty());
  const auto parameters = Resolved(of_gpmp, {{"planner.name", "gauss_newton"}}).planner_parameters;
  EXPECT_EQ(parameters.at("sigma_obs"), "0.2");

  const char* const unknown = "is not a known key";
  EXPECT_THAT(Complaint(of_gpmp + ", sigma: 1", straight), ::testing::HasSubstr(unknown));
  EXPECT_THAT(Complaint("name: straight_line, epsilon_m: 0.1, sigma_obs: 0.2"),
              ::testing::StartsWith("mine.yaml:7: planner.sigma_obs: is not a known key"));
  scenarios::Settings both = straight;
  both["planner.qc"] = "2";
  EXPECT_THAT(Complaint(of_gpmp, both), ::testing::StartsWith("--set planner.qc: is not a known"));
}

}  // namespace
}  // namespace sidestep::bench::scenario_planner_test
