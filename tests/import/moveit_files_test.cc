#include "sidestep/import/moveit_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <variant>

#include "sidestep/core/convex_polytope.h"
#include "sidestep/core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::imports::moveit_files_test {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const std::string kData = SIDESTEP_SOURCE_DIR "/tests/data/moveit/";

TEST(MoveItScene, IsReadAsMotionBenchMakerWritesIt) {
  const ImportedScene scene = ReadMoveItScene(kData + "scene.yaml");
  ASSERT_EQ(scene.obstacles.size(), 3u);
  EXPECT_EQ(scene.obstacles[0].name, "Can1");
  EXPECT_EQ(std::get<Cylinder>(scene.obstacles[0].shape).radius_m, 0.03);
  EXPECT_EQ(std::get<Cylinder>(scene.obstacles[0].shape).length_m, 0.14);
  EXPECT_EQ(scene.obstacles[1].name, "shelf_top");
  EXPECT_EQ(std::get<Box>(scene.obstacles[1].shape).size_m, Vector3d(1.2, 1, 0.04));
  EXPECT_EQ(scene.obstacles[1].X_WO.translation(), Vector3d(0.6, -1, 0.5));
  // A quarter turn about z, written x, y, z, w.
  const Vector3d x_W = scene.obstacles[1].X_WO.Rotate(Vector3d::UnitX());
  EXPECT_LT((x_W - Vector3d::UnitY()).norm(), 1e-6);
  EXPECT_EQ(std::get<Sphere>(scene.obstacles[2].shape).radius_m, 0.2);
  EXPECT_THAT(scene.left_out, IsEmpty());
  EXPECT_THAT(scene.changed, IsEmpty());
  EXPECT_FALSE(scene.floor_m.has_value());
}

TEST(MoveItScene, IsReadAsMessagesLookInYaml) {
  const ImportedScene scene = ReadMoveItScene(kData + "messages.yaml");
  ASSERT_EQ(scene.obstacles.size(), 4u);
  // The object's pose and that of its part, one after the other.
  EXPECT_EQ(scene.obstacles[0].name, "L_shape");
  EXPECT_EQ(scene.obstacles[1].name, "L_shape_2");
  EXPECT_LT((scene.obstacles[1].X_WO.translation() - Vector3d(1, 0.5, 0.3)).norm(), 1e-12);
  EXPECT_EQ(scene.obstacles[2].name, "wedge_mesh");
  const auto& hull = *std::get<ConvexMesh>(scene.obstacles[2].shape).hull;
  EXPECT_EQ(hull.vertices().size(), 4u);  // the fifth is inside
  EXPECT_EQ(scene.obstacles[3].name, "lump_");
  EXPECT_EQ(std::get<ConvexMesh>(scene.obstacles[3].shape).hull->vertices().size(), 4u);
  EXPECT_THAT(scene.changed, ElementsAre("'wedge.mesh': the convex hull of its mesh",
                                         "'lump!': the convex hull of its mesh"));
  EXPECT_THAT(
      scene.left_out,
      ElementsAre(
          kData + "messages.yaml:37: 'hat': a cone is no shape of scenarios",
          kData + "messages.yaml:47: 'sheet': vertices lie in one plane",
          kData + "messages.yaml:52: 'far': a mesh without inline vertices",
          kData + "messages.yaml:53: 'ground': a plane: give the scenario a floor_m instead"));
}

TEST(MoveItRequest, HasStartAndGoalAsJointsInAnyOrder) {
  const ImportedRequest request = ReadMoveItRequest(kData + "request.yaml");
  ASSERT_TRUE(request.start && request.goal);
  EXPECT_THAT(request.start->names,
              ElementsAre("panda_joint2", "panda_joint1", "panda_joint3", "panda_joint4",
                          "panda_joint5", "panda_joint6", "panda_joint7", "panda_finger_joint1"));
  EXPECT_EQ(request.start->positions[0], -0.785);
  EXPECT_EQ(request.goal->names[0], "panda_joint7");
  EXPECT_EQ(request.goal->positions[0], 0.9);
  EXPECT_FALSE(request.goal_pose.has_value());
}

TEST(MoveItRequest, HasAGoalAsAPose) {
  const ImportedRequest request = ReadMoveItRequest(kData + "pose_request.yaml");
  ASSERT_TRUE(request.goal_pose.has_value());
  EXPECT_FALSE(request.start || request.goal);
  EXPECT_EQ(request.goal_pose->link, "panda_hand");
  // The point of the link that is to be there is 0.1 along its own z axis, which looks down.
  EXPECT_LT((request.goal_pose->X_WL.translation() - Vector3d(0.5, 0.1, 0.6)).norm(), 1e-12);
  EXPECT_EQ(request.left_out.size(), 1u);
}

struct Fault {
  const char* name;
  bool is_request;
  const char* text;
  const char* message;  // after the file's name
};
void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

class Unusable : public ::testing::TestWithParam<Fault> {};

TEST_P(Unusable, IsToldAtItsLine) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "file.yaml").string();
  std::ofstream(path) << GetParam().text;
  try {
    if (GetParam().is_request) {
      ReadMoveItRequest(path);
    } else {
      ReadMoveItScene(path);
    }
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), path + GetParam().message);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Files, Unusable,
    ::testing::Values(
        Fault{"NoWorld", false, "name: a\n", ":1: world: is missing"},
        Fault{"WordForWorld", false, "world: a\n", ":1: world: must be a map, is 'a'"},
        Fault{"NoId", false, "world:\n  collision_objects:\n    - primitives: []\n",
              ":3: world.collision_objects[0].id: is missing"},
        Fault{
            "BoxOfTwoNumbers", false,
            "world:\n  collision_objects:\n    - id: a\n      primitives:\n"
            "        - {type: box, dimensions: [1, 2]}\n",
            ":5: world.collision_objects[0].primitives[0].dimensions: must have 3 numbers, has 2"},
        Fault{"NegativeBox", false,
              "world:\n  collision_objects:\n    - id: a\n      primitives:\n"
              "        - {type: box, dimensions: [1, -2, 1]}\n",
              ":5: world.collision_objects[0].primitives[0].dimensions[1]: must be > 0, is -2"},
        Fault{
            "PosesAreMissing", false,
            "world:\n  collision_objects:\n    - id: a\n      primitives:\n"
            "        - {type: sphere, dimensions: [1]}\n        - {type: sphere, dimensions: [1]}\n"
            "      primitive_poses:\n        - {position: [0, 0, 0]}\n",
            ":8: world.collision_objects[0].primitive_poses: must be as many as primitives, are 1 "
            "of 2"},
        Fault{"Unturned", false,
              "world:\n  collision_objects:\n    - id: a\n      primitives:\n"
              "        - {type: sphere, dimensions: [1]}\n      primitive_poses:\n"
              "        - {orientation: [0, 0, 0, 0]}\n",
              ":7: world.collision_objects[0].primitive_poses[0].orientation: must be a quaternion "
              "x, "
              "y, z, w of length 1, has 0"},
        Fault{
            "TurnedByAWord", false,
            "world:\n  collision_objects:\n    - id: a\n      primitives:\n"
            "        - {type: sphere, dimensions: [1]}\n      primitive_poses:\n"
            "        - {orientation: {x: 0, y: 0, z: are, w: 1}}\n",
            ":7: world.collision_objects[0].primitive_poses[0].orientation.z: must be a number, is "
            "'are'"},
        Fault{"NoGoal", true, "start_state: {}\n", ":1: goal_constraints: must list a goal"},
        Fault{"EmptyGoal", true, "goal_constraints:\n  - name: a\n",
              ":2: goal_constraints[0]: must have joint_constraints, or position_constraints and "
              "orientation_constraints"},
        Fault{"HalfAPose", true,
              "goal_constraints:\n  - position_constraints:\n      - link_name: hand\n",
              ":3: goal_constraints[0].position_constraints: need orientation_constraints beside "
              "them: a pose is whole"},
        Fault{"JointsWithoutPositions", true,
              "start_state:\n  joint_state: {name: [a, b], position: [1]}\ngoal_constraints: []\n",
              ":2: start_state.joint_state.position: must be as many as name, are 1 of 2"},
        Fault{"NoYaml", true, "a: [", ":2: is not valid YAML: end of sequence flow not found"}),
    [](const auto& test) { return test.param.name; });

TEST(FreeName, IsFitForAScenarioAndNotTaken) {
  std::vector<std::string> taken = {"floor"};
  EXPECT_EQ(FreeName("floor", taken), "floor_2");
  EXPECT_EQ(FreeName("Can 1/a", taken), "Can_1_a");
  EXPECT_EQ(FreeName("Can_1_a", taken), "Can_1_a_2");
  EXPECT_EQ(FreeName("Can_1_a", taken), "Can_1_a_3");
  EXPECT_EQ(FreeName("", taken), "thing");
  EXPECT_EQ(FreeName("\xc3\xa9t\xc3\xa9", taken), "__t__");
}

}  // namespace
}  // namespace sidestep::imports::moveit_files_test
