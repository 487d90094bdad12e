// A robot of meshes, in files and by their corners, with a joint that mimics another.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "sidestep/core/input_error.h"
#include "sidestep/sim/arm_file.h"
#include "sidestep/sim/foreign_model.h"
#include "sidestep/sim/ray_caster.h"
#include "sidestep/sim/robot_agreement.h"
#include "sidestep/sim/simulation.h"
#include "sidestep/sim/world_xml.h"
#include "tests/sim/two_link.h"
#include "tests/support/bytes_of.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::sim::mesh_robot_test {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

scenarios::Scenario ClampScenario() {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.name = scenario.robot = "clamp";
  scenario.q_start = Eigen::Vector2d(0, 0.02);
  scenario.floor_m = -2;
  return scenario;
}

robot::RobotModel Clamp(const scenarios::Scenario& scenario) {
  return robot::RobotModel::Load(kTestModels, "clamp", scenario.X_WB);
}

TEST(MeshRobot, IsWholeInTheTextOfItsWorld) {
  const std::string xml = BuildWorldXml(ClampScenario(), {"foot"}, kTestModels);
  EXPECT_THAT(xml, testing::Not(testing::HasSubstr("file=")));
  EXPECT_NE(LoadForeignModel(xml, "trace"), nullptr);
}

// The bar is a block of 0.4 x 0.1 x 0.1 m, for its dent is filled. It is nearest to all these
// balls.
TEST(MeshRobot, IsAsFarFromThingsAsItsHullIs) {
  const Box bar{{0.4, 0.1, 0.1}};
  const Vector3d p_WBar(0.3, 0, 0.3);
  for (const Vector3d& p_WBall : {Vector3d(0.3, 0.4, 0.35), Vector3d(0.2, -0.3, 0.5),
                                  Vector3d(0.25, 0, 0.45), Vector3d(0.3, 0.1, 0.1)}) {
    scenarios::Scenario scenario = ClampScenario();
    scenario.moving_obstacles = {Passing("ball", Sphere{0.03}, p_WBall, {1, 0, 0}, 0)};
    Simulation simulation(scenario, Clamp(scenario), kTestModels);
    const std::vector<TruthSample> samples = simulation.truth().TakeSamples();
    ASSERT_EQ(samples.size(), 1u);
    EXPECT_EQ(samples[0].nearest_robot_part, "bar");
    // The corners are of single precision.
    EXPECT_NEAR(samples[0].clearance_m, SignedDistance(bar, p_WBall - p_WBar) - 0.03, 1e-6);
    EXPECT_FALSE(samples[0].in_contact);
  }
}

TEST(MeshRobot, TouchesWhatIsInItsDent) {
  scenarios::Scenario scenario = ClampScenario();
  scenario.moving_obstacles = {Passing("ball", Sphere{0.03}, {0.3, 0, 0.37}, {1, 0, 0}, 0)};
  Simulation simulation(scenario, Clamp(scenario), kTestModels);
  const std::vector<TruthSample> samples = simulation.truth().TakeSamples();
  ASSERT_EQ(samples.size(), 1u);
  EXPECT_TRUE(samples[0].in_contact);
  EXPECT_NEAR(samples[0].clearance_m, -0.01, 1e-6);
}

// What a camera sees of it, and what it draws, is the hull too.
TEST(MeshRobot, IsMetByRaysWhereItsHullIs) {
  const scenarios::Scenario scenario = ClampScenario();
  Simulation simulation(scenario, Clamp(scenario), kTestModels);
  const World& world = simulation.world();
  const RayCaster caster(world.model());
  for (const double x : {0.15, 0.3, 0.42}) {
    const auto hit = caster.Cast(world.data(), {x, 0.01, 1}, {0, 0, -1});
    ASSERT_TRUE(hit.has_value());
    EXPECT_NEAR(hit->distance_m, 0.65, 1e-6);
    EXPECT_TRUE(caster.IsRobot(hit->geom));
  }
}

double PositionOf(const World& world, const char* joint) {
  const int id = mj_name2id(&world.model(), mjOBJ_JOINT, joint);
  return world.data().qpos[world.model().jnt_qposadr[id]];
}

TEST(MeshRobot, MovesWhatMimicsWithWhatItMimics) {
  const scenarios::Scenario scenario = ClampScenario();
  Simulation simulation(scenario, Clamp(scenario), kTestModels);
  EXPECT_EQ(PositionOf(simulation.world(), "other_grip"), -0.01 - 0.02);
  Trajectory motion;
  constexpr int kStates = 21;
  motion.t_s = Eigen::VectorXd::LinSpaced(kStates, 0, 1);
  motion.q.resize(2, kStates);
  motion.v.resize(2, kStates);
  for (int k = 0; k < kStates; ++k) {
    const double s = motion.t_s(k);
    motion.q.col(k) << s * s * (3 - 2 * s), 0.02 + 0.03 * s * s * (3 - 2 * s);
    motion.v.col(k) << 6 * s * (1 - s), 0.18 * s * (1 - s);
  }
  simulation.robot().Submit(motion, EpisodeTime(0));
  for (int step = 1; step <= 150; ++step) {
    simulation.robot().AdvanceTo(EpisodeTime(0.01 * step));
    const double grip = PositionOf(simulation.world(), "grip");
    EXPECT_NEAR(PositionOf(simulation.world(), "other_grip"), -0.01 - grip, 5e-4) << step;
  }
  EXPECT_NEAR(PositionOf(simulation.world(), "grip"), 0.05, 1e-3);
}

// The clamp's files with a part replaced, and what is said of them.
std::string MessageWith(const std::string& file, const std::string& old_text,
                        const std::string& new_text) {
  const TemporaryFolder folder;
  const fs::path models = folder.path();
  fs::copy(kTestModels + "/clamp", models / "clamp", fs::copy_options::recursive);
  std::string text = BytesOf(models / "clamp" / file);
  const std::size_t at = text.find(old_text);
  if (at == std::string::npos) return file + " has no " + old_text;
  std::ofstream(models / "clamp" / file) << text.replace(at, old_text.size(), new_text);
  const scenarios::Scenario scenario = ClampScenario();
  try {
    const robot::RobotModel robot = robot::RobotModel::Load(models.string(), "clamp", Pose());
    const Simulation simulation(scenario, robot, models.string());
  } catch (const InputError& error) {
    std::string message = error.what();
    for (const std::string& prefix : {(models / "clamp").string() + "/"}) {
      for (std::size_t found; (found = message.find(prefix)) != std::string::npos;) {
        message.erase(found, prefix.size());
      }
    }
    return message;
  }
  return "was accepted";
}

struct Altered {
  const char *name, *file, *old_text, *new_text, *message;
};
std::ostream& operator<<(std::ostream& out, const Altered& altered) { return out << altered.name; }

class AlteredClamp : public ::testing::TestWithParam<Altered> {};

TEST_P(AlteredClamp, IsRefusedAtItsLine) {
  const Altered& p = GetParam();
  EXPECT_THAT(MessageWith(p.file, p.old_text, p.new_text), testing::StartsWith(p.message));
}

INSTANTIATE_TEST_SUITE_P(
    What, AlteredClamp,
    ::testing::Values(
        Altered{"OtherMultiplier", "robot.yaml", "multiplier: -1", "multiplier: -2",
                "clamp.xml:36: joint 'other_grip': must be tied as it mimics by robot.yaml:15: "
                "joint2=\"grip\" polycoef=\"-0.01 -2 0 0 0\""},
        Altered{"OtherOffset", "clamp.xml", "-0.01 -1 0", "-0.02 -1 0",
                "clamp.xml:36: joint 'other_grip': must be tied as it mimics"},
        Altered{"OtherLeader", "clamp.xml", "joint2=\"grip\"", "joint2=\"turn\"",
                "clamp.xml:36: joint 'other_grip': must be tied as it mimics"},
        Altered{"Untied", "clamp.xml",
                "<joint joint1=\"other_grip\" joint2=\"grip\" polycoef=\"-0.01 -1 0 0 0\" "
                "solref=\"0.005 1\"/>",
                "", "clamp.xml:29: joint 'other_grip': must be tied to 'grip', which it mimics"},
        Altered{"TiedBody", "clamp.xml", "<equality>",
                "<equality><weld body1=\"jaw\" body2=\"bar\"/>",
                "clamp.xml:35: weld: ties bodies together"},
        Altered{"MissingFile", "clamp.xml", "bar.obj", "rod.obj",
                "clamp.xml:10: mesh: there is no meshes/rod.obj"},
        Altered{"FileElsewhere", "clamp.xml", "bar.obj", "../../../bar.obj",
                "clamp.xml:10: mesh: '../../../bar.obj' must lie in the model's folder"},
        Altered{"FileOfAnotherKind", "clamp.xml", "file=\"bar.obj\"", "file=\"../clamp.xml\"",
                "clamp.xml:10: mesh: '../clamp.xml' must lie in the model's folder"},
        Altered{"FaceWithoutItsCorner", "meshes/bar.obj", "v 0 -50 -50", "w",
                "clamp.xml:10: mesh 'bar': bar.obj: meshes/bar.obj:21: f: there is no vertex 9"},
        Altered{"CornerThatIsNone", "meshes/bar.obj", "v 0 -50 -50", "v 0 nan 0",
                "clamp.xml:10: mesh 'bar': bar.obj: meshes/bar.obj:2: v: must be three numbers"},
        Altered{"FlatMesh", "clamp.xml", "0.001 0.001 0.001", "0.001 0.001 0", "clamp.xml:10: "},
        Altered{"MeshThatIsNotThere", "clamp.xml", "mesh=\"bar\"", "mesh=\"rod\"",
                "clamp.xml:21: mesh 'rod' not found"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace sidestep::sim::mesh_robot_test
