#include "sidestep/bench/resolve.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/core/input_error.h"

namespace sidestep::bench::resolve_test {
namespace {

const std::string kSource = SIDESTEP_SOURCE_DIR;

scenarios::Scenario Walkway() {
  return scenarios::LoadScenario(kSource + "/scenarios/hsr_walkway.yaml");
}

robot::RobotModel RobotOf(const scenarios::Scenario& scenario) {
  return robot::RobotModel::Load(kSource + "/models", scenario.robot, scenario.X_WB);
}

std::string Complaint(scenarios::Scenario scenario) {
  const robot::RobotModel robot = RobotOf(scenario);
  try {
    ResolveTask(scenario, robot);
  } catch (const InputError& error) {
    return error.what();
  }
  return "was accepted";
}

TEST(ResolveTask, LooksUpNamedConfigurations) {
  scenarios::Scenario scenario = Walkway();
  const robot::RobotModel robot = RobotOf(scenario);
  ResolveTask(scenario, robot);
  Eigen::VectorXd right_ready(7), table_forward(7);
  right_ready << -1.57, -0.785, 0, -2.356, 0, 1.57, 0.785;
  table_forward << 0, 0.94, -0.07, -1.27, 0.07, 2.21, 0.70;
  EXPECT_EQ(scenario.q_start, right_ready);
  EXPECT_EQ(scenario.q_goal, table_forward);
}

TEST(ResolveTask, LetsTheRobotStandOnItsMount) {
  // The Panda's lowest sphere reaches into the table below it; without a mount that is an error.
  scenarios::Scenario scenario = Walkway();
  EXPECT_EQ(Complaint(scenario), "was accepted");
  scenario.mount = "";
  EXPECT_THAT(Complaint(scenario), ::testing::HasSubstr("inside 'near_table'"));
}

TEST(ResolveTask, RefusesAnUnknownNameAndListsTheKnownOnes) {
  scenarios::Scenario scenario = Walkway();
  scenario.goal_name = "table_fwd";
  EXPECT_THAT(
      Complaint(scenario),
      ::testing::AllOf(::testing::HasSubstr("hsr_walkway.yaml:14: task.goal: 'table_fwd' is "
                                            "no configuration of panda (known: "),
                       ::testing::HasSubstr("table_forward")));
}

TEST(ResolveTask, RefusesTheWrongNumberOfJoints) {
  scenarios::Scenario scenario = Walkway();
  scenario.start_name = "";
  scenario.q_start = Eigen::VectorXd::Zero(6);
  EXPECT_THAT(Complaint(scenario),
              ::testing::EndsWith("task.start: must have 7 joint positions, has 6"));
}

TEST(ResolveTask, RefusesAJointOutsideItsLimits) {
  scenarios::Scenario scenario = Walkway();
  scenario.goal_name = "";
  scenario.q_goal = Eigen::VectorXd::Zero(7);  // a Panda's joint 4 stays below -0.0698
  EXPECT_THAT(Complaint(scenario), ::testing::HasSubstr("task.goal: "));
  EXPECT_THAT(Complaint(scenario),
              ::testing::EndsWith("= 0.0000 rad is outside its limits [-3.0718, -0.0698]"));
}

TEST(ResolveTask, RefusesAStartInsideAnObstacle) {
  scenarios::Scenario scenario = Walkway();
  std::get<scenarios::LinearMotion>(scenario.moving_obstacles[0].motion).start_m = {0, -0.3, 0.9};
  EXPECT_THAT(Complaint(scenario), ::testing::AllOf(::testing::HasSubstr("task.start: the robot's"),
                                                    ::testing::EndsWith("inside 'hsr'")));
}

// A Panda bolted to the floor.
scenarios::Scenario OnTheFloor() {
  scenarios::Scenario scenario = Walkway();
  scenario.X_WB = Pose();
  scenario.mount = "";
  scenario.static_obstacles.clear();
  scenario.moving_obstacles.clear();
  scenario.start_name = "ready";
  return scenario;
}

TEST(ResolveTask, LetsTheRobotStandOnTheFloorWithoutAMount) {
  scenarios::Scenario scenario = OnTheFloor();
  scenario.goal_name = "ready";
  EXPECT_EQ(Complaint(scenario), "was accepted");
  // The mount is what it stands on, if there is one: then its foot may not be in the floor.
  scenario.static_obstacles = {{"plate", Pose::Translation({0, 0, -0.5}), Box{{1, 1, 1}}}};
  scenario.mount = "plate";
  EXPECT_THAT(Complaint(scenario), ::testing::EndsWith("inside 'floor'"));
}

class BadTask : public ::testing::TestWithParam<std::string> {};

std::vector<std::string> BadTasks() {
  return scenarios::ScenarioNames(kSource + "/tests/data/bad_tasks");
}

TEST_P(BadTask, IsRefusedAsItsFirstLineExpects) {
  const std::string folder = kSource + "/tests/data/bad_tasks/";
  const std::string path = folder + GetParam() + ".yaml";
  std::string expected;
  std::ifstream stream(path);
  ASSERT_TRUE(std::getline(stream, expected));
  ASSERT_EQ(expected.rfind("# expect: ", 0), 0u) << "the first line must say what is expected";
  EXPECT_EQ(Complaint(scenarios::LoadScenario(path)), folder + expected.substr(10));
}

INSTANTIATE_TEST_SUITE_P(Data, BadTask, ::testing::ValuesIn(BadTasks()),
                         [](const auto& test) { return test.param; });

TEST(ResolveTask, RefusesAStartOrGoalBelowTheFloor) {
  scenarios::Scenario scenario = OnTheFloor();
  scenario.goal_name = "";
  scenario.q_goal.resize(7);
  scenario.q_goal << 0, 1.5, 0, -0.9, 0, 2.2, 0.785;
  EXPECT_THAT(Complaint(scenario),
              ::testing::AllOf(::testing::HasSubstr("hsr_walkway.yaml:14: task.goal: the robot's"),
                               ::testing::EndsWith("mm inside 'floor'")));
  std::swap(scenario.start_name, scenario.goal_name);
  scenario.q_start = scenario.q_goal;
  EXPECT_THAT(Complaint(scenario),
              ::testing::AllOf(::testing::HasSubstr("hsr_walkway.yaml:13: task.start: the robot's"),
                               ::testing::EndsWith("mm inside 'floor'")));
  scenario.floor_m = -0.5;
  EXPECT_EQ(Complaint(scenario), "was accepted");
}

}  // namespace
}  // namespace sidestep::bench::resolve_test
