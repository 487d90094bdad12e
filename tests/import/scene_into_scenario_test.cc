#include "sidestep/import/scene_into_scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "sidestep/core/convex_polytope.h"
#include "sidestep/core/input_error.h"
#include "sidestep/import/draft_scenario.h"
#include "sidestep/import/free_space.h"

namespace sidestep::imports::scene_into_scenario_test {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kData = SIDESTEP_SOURCE_DIR "/tests/data/moveit/";

class SceneIntoScenario : public ::testing::Test {
 protected:
  scenarios::Scenario With(const ImportedScene& scene) const {
    scenarios::Scenario scenario = DraftScenario(robot_);
    PutInto(scene, robot_, scenario);
    return scenario;
  }

  const robot::RobotModel robot_ =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "panda", Pose());
  RandomStream random_{1, "task"};
};

TEST_F(SceneIntoScenario, StandsWhereItStoodWithMeshesAmidTheirFrames) {
  const ImportedScene scene = ReadMoveItScene(kData + "messages.yaml");
  const scenarios::Scenario scenario = With(scene);
  ASSERT_EQ(scenario.static_obstacles.size(), scene.obstacles.size());
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    const scenarios::StaticObstacle &was = scene.obstacles[i], &is = scenario.static_obstacles[i];
    for (const Vector3d& p : {Vector3d(1, 1, 1), Vector3d(0, 2, 0.1), Vector3d(1.05, 1.05, 0.02)}) {
      EXPECT_NEAR(SignedDistance(is.shape, is.X_WO.Inverse() * p),
                  SignedDistance(was.shape, was.X_WO.Inverse() * p), 1e-12);
    }
  }
  EXPECT_EQ(HalfExtents(scenario.static_obstacles[2].shape), Vector3d(0.15, 0.1, 0.05));
}

TEST_F(SceneIntoScenario, WithoutAFloorHasOneBelowAll) {
  ImportedScene scene;
  scene.obstacles = {{"pit", Pose::Translation({0, 2, -3}), Box{{0.2, 0.2, 2}}}};
  EXPECT_NEAR(With(scene).floor_m, -4.05, 1e-12);
  scene.obstacles.clear();
  const scenarios::Scenario alone = With(scene);
  const FreeSpace space(alone, robot_);
  Eigen::VectorXd down(7);
  down << 0, 1.76, 0, -0.07, 0, 1.6, 0;
  EXPECT_GT(space.Clearance(down), 0);
  scene.floor_m = 0.1;
  EXPECT_EQ(With(scene).floor_m, 0.1);
}

TEST_F(SceneIntoScenario, MountsTheRobotOnWhatItsFootIsIn) {
  ImportedScene scene;
  scene.obstacles = {{"shelf", Pose::Translation({1, 0, 0}), Box{{0.2, 0.2, 2}}},
                     {"table", Pose::Translation({0, 0, -0.2}), Box{{1, 1, 0.4}}}};
  EXPECT_EQ(With(scene).mount, "table");
  scene.obstacles.pop_back();
  EXPECT_EQ(With(scene).mount, "");
}

TEST_F(SceneIntoScenario, GivesNoNameOfTheRobotsLinks) {
  ImportedScene scene;
  scene.obstacles = {{"hand", Pose::Translation({3, 0, 0}), Sphere{0.1}},
                     {"link0", Pose::Translation({3, 0, 0}), Sphere{0.1}}};
  const scenarios::Scenario scenario = With(scene);
  EXPECT_EQ(scenario.static_obstacles[0].name, "hand_2");
  EXPECT_EQ(scenario.static_obstacles[1].name, "link0_2");
}

TEST_F(SceneIntoScenario, TakesJointsByTheirNames) {
  scenarios::Scenario scenario = With(ReadMoveItScene(kData + "scene.yaml"));
  const std::vector<std::string> left_out =
      PutInto(ReadMoveItRequest(kData + "request.yaml"), robot_, random_, scenario);
  Eigen::VectorXd q_start(7), q_goal(7);
  q_start << 0, -0.785, 0, -2.356, 0, 1.571, 0.785;
  q_goal << 1, -0.4, 0.1, -2, 0.2, 1.8, 0.9;
  EXPECT_EQ(scenario.q_start, q_start);
  EXPECT_EQ(scenario.q_goal, q_goal);
  EXPECT_THAT(left_out, ElementsAre(kData + "request.yaml:3: start_state.joint_state.name: "
                                            "'panda_finger_joint1' = 0.065 is no joint of panda"));
}

TEST_F(SceneIntoScenario, FindsAFreeConfigurationForAPose) {
  scenarios::Scenario scenario = With(ReadMoveItScene(kData + "scene.yaml"));
  const ImportedRequest request = ReadMoveItRequest(kData + "pose_request.yaml");
  PutInto(request, robot_, random_, scenario);
  const FreeSpace space(scenario, robot_);
  EXPECT_FALSE(scenario.start_name.empty());
  EXPECT_GT(space.Clearance(scenario.q_start), 0);
  EXPECT_GT(space.Clearance(scenario.q_goal), 0);
  const Pose off =
      robot_.ComputeLinkPoses(scenario.q_goal).back().Inverse() * request.goal_pose->X_WL;
  EXPECT_LT(off.translation().norm(), 1e-5);
  EXPECT_LT(off.rotation().vec().norm(), 1e-5);
}

TEST_F(SceneIntoScenario, RefusesWhatNamesNoWholeTask) {
  scenarios::Scenario scenario = With({});
  ImportedRequest request = ReadMoveItRequest(kData + "request.yaml");
  request.goal->names[3] = "panda_joint9";
  EXPECT_THAT([&] { PutInto(request, robot_, random_, scenario); },
              ::testing::ThrowsMessage<InputError>(
                  AllOf(HasSubstr("request.yaml:7: goal_constraints[0].joint_constraints: names no "
                                  "position of panda's joint joint3"))));
  request = ReadMoveItRequest(kData + "pose_request.yaml");
  request.goal_pose->link = "gripper";
  EXPECT_THAT(
      [&] { PutInto(request, robot_, random_, scenario); },
      ::testing::ThrowsMessage<InputError>(HasSubstr(
          ": goal_constraints[0].position_constraints: 'gripper' is none of panda's links")));
  request.goal_pose->link = "hand";
  request.goal_pose->X_WL = Pose::Translation({9, 0, 0});
  EXPECT_THAT([&] { PutInto(request, robot_, random_, scenario); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("no configuration was found")));
}

}  // namespace
}  // namespace sidestep::imports::scene_into_scenario_test
