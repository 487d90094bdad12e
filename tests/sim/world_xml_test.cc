#include "sidestep/sim/world_xml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "sidestep/core/convex_polytope.h"
#include "sidestep/core/input_error.h"
#include "sidestep/sim/foreign_model.h"
#include "sidestep/sim/mujoco_pose.h"
#include "sidestep/sim/world.h"
#include "sidestep/sim/world_geoms.h"
#include "tests/sim/small_model.h"
#include "tests/sim/two_link.h"
#include "tests/support/random_points.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::sim::world_xml_test {
namespace {

using Eigen::Vector3d;

struct Built {
  MujocoModelPtr model;
  MujocoDataPtr data;
  explicit Built(const scenarios::Scenario& scenario)
      : model(LoadMujocoModel(BuildWorldXml(scenario, {"foot", "turret"}, kTestModels), "world")),
        data(MakeMujocoData(*model)) {
    mj_forward(model.get(), data.get());
  }
  int Id(mjtObj type, const std::string& name) const {
    return mj_name2id(model.get(), type, name.c_str());
  }
  Pose BodyPose(const std::string& name) const {
    const int body = Id(mjOBJ_BODY, name);
    const mjtNum* q = data->xquat + 4 * body;
    return Pose(Eigen::Quaterniond(q[0], q[1], q[2], q[3]),
                Eigen::Map<const Vector3d>(data->xpos + 3 * body));
  }
};

void ExpectSamePose(const Pose& a, const Pose& b) {
  const Pose difference = a.Inverse() * b;
  EXPECT_LT(difference.translation().norm(), 1e-12);
  EXPECT_LT(difference.rotation().vec().norm(), 1e-12);
}

scenarios::Scenario FullScenario() {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.X_WB = Pose::FromRollPitchYaw({0.1, -0.2, 0.3}, {0.4, 0.5, 0.6});
  scenario.static_obstacles = {
      {"table", Pose::FromRollPitchYaw({0, 0, 0.5}, {1, 2, 0.2}), Box{{0.8, 1.2, 0.4}}},
      {"wall", Pose::Translation({0, -2, 1}), Box{{3, 0.1, 2}}}};
  scenario.mount = "table";
  scenario.floor_m = -0.3;
  scenario.moving_obstacles = {
      Passing("cart", Box{{0.48, 0.55, 1.2}}, {0.4, 2, 0.6}, {0, -1, 0}, 1.4),
      Passing("bead", Sphere{0.15}, {-1, 0, 1}, {1, 0, 0}, 0.5),
      Passing("pill", Capsule{0.1, 0.4}, {-1, 1, 1}, {1, 0, 0}, 0.5),
      Passing("drum", Cylinder{0.2, 0.6}, {-1, -1, 1}, {1, 0, 0}, 0.5),
      Passing("egg", Ellipsoid{{0.1, 0.2, 0.3}}, {-1, 0, 2}, {1, 0, 0}, 0.5)};
  scenario.moving_obstacles[0].appearance = "crate";
  scenario.moving_obstacles[3].rpy_rad = {0.3, 0.2, 0.1};
  return scenario;
}

TEST(WorldXml, PutsEverythingWhereTheScenarioHasIt) {
  const scenarios::Scenario scenario = FullScenario();
  const Built world(scenario);
  ExpectSamePose(world.BodyPose(kRobotBody), scenario.X_WB);
  ExpectSamePose(world.BodyPose("turret"), scenario.X_WB * Pose::Translation({0, 0, 0.3}));
  for (const scenarios::StaticObstacle& box : scenario.static_obstacles) {
    ExpectSamePose(world.BodyPose(box.name), box.X_WO);
    const int geom = world.Id(mjOBJ_GEOM, box.name);
    EXPECT_EQ(world.model->geom_type[geom], mjGEOM_BOX);
    const Vector3d size_m = std::get<Box>(box.shape).size_m;
    EXPECT_LT((2 * Eigen::Map<Vector3d>(world.model->geom_size + 3 * geom) - size_m).norm(), 1e-12);
  }
  for (const scenarios::MovingObstacle& obstacle : scenario.moving_obstacles) {
    ExpectSamePose(world.BodyPose(obstacle.name), PoseAt(obstacle, EpisodeTime(0)));
    EXPECT_GE(world.model->body_mocapid[world.Id(mjOBJ_BODY, obstacle.name)], 0);
    EXPECT_GE(world.Id(mjOBJ_GEOM, obstacle.name), 0);
  }
  EXPECT_EQ(world.data->geom_xpos[3 * world.Id(mjOBJ_GEOM, kFloorGeom) + 2], -0.3);
  EXPECT_EQ(world.model->opt.timestep, 0.001);
}

TEST(WorldXml, MakesSolidsOfTheShapesOfTheScenario) {
  const scenarios::Scenario scenario = FullScenario();
  const Built world(scenario);
  const int types[] = {mjGEOM_BOX, mjGEOM_SPHERE, mjGEOM_CAPSULE, mjGEOM_CYLINDER,
                       mjGEOM_ELLIPSOID};
  for (std::size_t i = 0; i < scenario.moving_obstacles.size(); ++i) {
    const scenarios::MovingObstacle& obstacle = scenario.moving_obstacles[i];
    const int geom = world.Id(mjOBJ_GEOM, obstacle.name);
    EXPECT_EQ(world.model->geom_type[geom], types[i]);
    // MuJoCo's ray from far along each axis meets the surface where core/shape.h has it.
    const Pose X_WO = PoseAt(obstacle, EpisodeTime(0));
    for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, 0, 1)}) {
      const Vector3d from = X_WO * (2 * axis), along = X_WO.Rotate(-axis);
      const double length =
          mju_rayGeom(world.data->geom_xpos + 3 * geom, world.data->geom_xmat + 9 * geom,
                      world.model->geom_size + 3 * geom, from.data(), along.data(), types[i]);
      EXPECT_NEAR(length, 2 - HalfExtents(obstacle.shape).dot(axis), 1e-9) << obstacle.name;
    }
  }
}

ConvexMesh Wedge() {
  const std::vector<Vector3d> vertices = {
      {0, 0, 0}, {0.5, 0, 0}, {0, 0.3, 0}, {0, 0, 0.2}, {0.4, 0.3, 0.1}};
  return {std::make_shared<const ConvexPolytope>(vertices)};
}

// MuJoCo moves and turns what it makes of the vertices; its rays meet the surface where
// core/shape.h has it all the same.
TEST(WorldXml, PutsConvexMeshesWhereTheirVerticesAre) {
  scenarios::Scenario scenario = FullScenario();
  scenario.static_obstacles.push_back(
      {"wedge", Pose::FromRollPitchYaw({0.3, 0.2, 0.1}, {2, -1, 1}), Wedge()});
  scenario.moving_obstacles.push_back(Passing("kite", Wedge(), {-2, 1, 1}, {1, 0, 0}, 0.5));
  scenario.moving_obstacles.back().rpy_rad = {1, -0.5, 0.2};
  const Built world(scenario);
  RandomStream random(1, "rays");
  const auto check = [&](const std::string& name, const Pose& X_WO) {
    const int geom = world.Id(mjOBJ_GEOM, name);
    ASSERT_GE(geom, 0);
    EXPECT_EQ(world.model->geom_type[geom], mjGEOM_MESH);
    ExpectSamePose(world.BodyPose(name), X_WO);
    int num_hits = 0;
    for (int n = 0; n < 300; ++n) {
      const Vector3d from = X_WO * (2 * UniformPoint(random, 1).normalized());
      const Vector3d along =
          (X_WO * (Vector3d(0.15, 0.1, 0.07) + UniformPoint(random, 0.15)) - from).normalized();
      const double length =
          mj_rayMesh(world.model.get(), world.data.get(), geom, from.data(), along.data());
      double nearest_m = 1;
      for (double t = 0; t < 4; t += 0.005) {
        nearest_m =
            std::min(nearest_m, SignedDistance(Wedge(), X_WO.Inverse() * (from + t * along)));
      }
      if (length < 0) {
        EXPECT_GT(nearest_m, -1e-3);
        continue;
      }
      ++num_hits;
      EXPECT_NEAR(SignedDistance(Wedge(), X_WO.Inverse() * (from + length * along)), 0, 1e-6);
    }
    EXPECT_GT(num_hits, 100);
  };
  check("wedge", scenario.static_obstacles.back().X_WO);
  check("kite", PoseAt(scenario.moving_obstacles.back(), EpisodeTime(0)));
}

TEST(WorldXml, WithConvexMeshesIsTakenFromATraceToo) {
  scenarios::Scenario scenario = FullScenario();
  scenario.static_obstacles.push_back({"wedge", Pose(), Wedge()});
  const std::string xml = BuildWorldXml(scenario, {}, kTestModels);
  EXPECT_EQ(LoadForeignModel(xml, "trace")->nmesh, 1);
}

TEST(WorldXml, StandsTheRobotOnAnyObstacle) {
  scenarios::Scenario scenario = FullScenario();
  scenario.static_obstacles.push_back({"wedge", Pose(), Wedge()});
  scenario.mount = "wedge";
  const Built world(scenario);
  EXPECT_TRUE(
      IsExcluded(*world.model, world.Id(mjOBJ_BODY, "foot"), world.Id(mjOBJ_BODY, "wedge")));
}

TEST(WorldXml, KeepsTheRobotsDefaultsToTheRobot) {
  const Built world(FullScenario());
  EXPECT_EQ(world.model->geom_rgba[4 * world.Id(mjOBJ_GEOM, "floor")], 0.5f);  // MuJoCo's grey
  const int bar = world.Id(mjOBJ_GEOM, "bar");
  EXPECT_EQ(world.model->geom_rgba[4 * bar], 0.8f);
  EXPECT_EQ(world.model->dof_damping[0], 0.5);
  EXPECT_EQ(world.model->actuator_forcerange[1], 40);
  EXPECT_EQ(world.model->actuator_forcelimited[0], 1);
}

TEST(WorldXml, DrawsAnAppearanceInsideItsInvisibleShape) {
  const Built world(FullScenario());
  const mjModel& m = *world.model;
  const int contact_geom = world.Id(mjOBJ_GEOM, "cart");
  EXPECT_EQ(m.geom_group[contact_geom], 4);
  EXPECT_EQ(m.geom_contype[contact_geom], 1);

  std::vector<int> pictures;
  for (int i = 0; i < m.ngeom; ++i) {
    if (m.body_rootid[m.geom_bodyid[i]] != world.Id(mjOBJ_BODY, "cart") || i == contact_geom) {
      continue;
    }
    pictures.push_back(i);
    EXPECT_EQ(m.geom_group[i], 2);
    EXPECT_EQ(m.geom_contype[i], 0);
    EXPECT_EQ(m.geom_conaffinity[i], 0);
  }
  ASSERT_THAT(pictures, testing::SizeIs(2));  // the crate's third geom is not drawn
  // It stands on the underside of the shape (z = 0) and looks along -y.
  const Vector3d p_WLid = GeomPosition(*world.data, pictures[1]);
  EXPECT_LT((p_WLid - Vector3d(0.4, 2 - 0.05, 0.2)).norm(), 1e-9);
  EXPECT_EQ(m.geom_rgba[4 * pictures[0]], 0.9f);  // of its material
  EXPECT_EQ(m.geom_rgba[4 * pictures[1] + 2], 1.0f);

  const WorldGeoms geoms = FindWorldGeoms(m);
  EXPECT_THAT(geoms.moving, testing::SizeIs(5));
  EXPECT_THAT(geoms.fixed, testing::SizeIs(2));
  EXPECT_THAT(geoms.floor, testing::SizeIs(1));
  EXPECT_THAT(geoms.robot, testing::SizeIs(4));
}

TEST(WorldXml, ExcludesContactsOfTheMountLinksWithTheMountOnly) {
  const Built world(FullScenario());
  const auto excluded = [&](const char* a, const char* b) {
    return IsExcluded(*world.model, world.Id(mjOBJ_BODY, a), world.Id(mjOBJ_BODY, b));
  };
  EXPECT_TRUE(excluded("foot", "table"));
  EXPECT_TRUE(excluded("table", "turret"));
  EXPECT_FALSE(excluded("bar", "table"));
  EXPECT_FALSE(excluded("foot", "wall"));
}

TEST(WorldXml, AimsItsCamerasAtTheRobotsWorkspace) {
  const scenarios::Scenario scenario = FullScenario();
  const Built world(scenario);
  const Vector3d target = scenario.X_WB * Vector3d(0.35, 0, 0.2);
  for (const char* name : {kOverviewCamera, kTopCamera}) {
    const int camera = world.Id(mjOBJ_CAMERA, name);
    ASSERT_GE(camera, 0);
    const Vector3d p_WEye = Eigen::Map<Vector3d>(world.data->cam_xpos + 3 * camera);
    const Vector3d back(world.data->cam_xmat[9 * camera + 2], world.data->cam_xmat[9 * camera + 5],
                        world.data->cam_xmat[9 * camera + 8]);
    EXPECT_LT((p_WEye - target).normalized().cross(back).norm(), 1e-9) << name;
    EXPECT_GT((p_WEye - target).dot(back), 0) << name;
  }
}

// Files in a folder of models of their own.
class BrokenModel : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(directory_ + "/arm"); }

  std::string MessageFor(const std::string& text) const {
    std::ofstream(directory_ + "/arm/arm.xml") << text;
    scenarios::Scenario scenario = TwoLinkScenario();
    scenario.robot = "arm";
    try {
      BuildWorldXml(scenario, {}, directory_);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(directory_.size());
    }
    return "was accepted";
  }

  const TemporaryFolder folder_;
  const std::string directory_ = folder_.path();
};

TEST_F(BrokenModel, IsRefusedWithItsLine) {
  EXPECT_EQ(MessageFor("<mujoco>\n<worldbody>\n</mujoco>"),
            "/arm/arm.xml:2: is no well-formed XML: mismatched element");
  EXPECT_EQ(MessageFor("<robot/>"), "/arm/arm.xml:1: must be an MJCF file, whose root is <mujoco>");
  EXPECT_EQ(
      MessageFor("<mujoco>\n<asset>\n<texture file='a.png'/></asset></mujoco>"),
      "/arm/arm.xml:3: file: a model must not refer to other files, but for meshes in its folder");
  EXPECT_EQ(MessageFor("<mujoco>\n<include file='other.xml'/></mujoco>"),
            "/arm/arm.xml:2: include: a model must not refer to other files, but for meshes in its "
            "folder");
}

TEST(WorldXml, RefusesTheNameOfAPartOfTheRobot) {
  scenarios::Scenario scenario = FullScenario();
  scenario.moving_obstacles[1].name = "turret";
  scenario.lines["moving_obstacles[1].name"] = 21;
  EXPECT_THAT([&] { BuildWorldXml(scenario, {}, kTestModels); },
              testing::ThrowsMessage<InputError>(
                  "two_link.yaml:21: moving_obstacles[1].name: 'turret' is the name of a part of "
                  "the robot 'two_link'"));
}

TEST(WorldXml, SaysWhichModelIsMissing) {
  scenarios::Scenario scenario = FullScenario();
  scenario.moving_obstacles[0].appearance = "ghost";
  scenario.lines["moving_obstacles[0].appearance"] = 17;
  EXPECT_THAT([&] { BuildWorldXml(scenario, {}, kTestModels); },
              testing::ThrowsMessage<InputError>(
                  testing::StartsWith("two_link.yaml:17: moving_obstacles[0].appearance: ")));
  scenario = FullScenario();
  scenario.robot = "ghost";
  EXPECT_THAT(
      [&] { BuildWorldXml(scenario, {}, kTestModels); },
      testing::ThrowsMessage<InputError>(
          std::string("two_link.yaml:1: robot.model: there is no 'ghost' in ") + kTestModels));
}

// The HSR, which is drawn by many geoms, runs into the Panda, which is drawn by as many.
TEST(WorldXml, MovesToTheBitWithoutPictures) {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.robot = "panda";
  scenario.static_obstacles = {{"table", Pose::Translation({0.6, 0, 0.2}), Box{{0.6, 1.2, 0.4}}}};
  scenario.moving_obstacles = {
      Passing("cart", Box{{0.48, 0.55, 1.2}}, {0.4, 0.9, 0.6}, {0, -1, 0}, 1.4)};
  scenario.moving_obstacles[0].appearance = "hsr";
  const std::string models = SIDESTEP_SOURCE_DIR "/models";
  const auto robot = robot::RobotModel::Load(models, "panda", Pose());
  const Eigen::VectorXd q_start = robot.configurations().at("home");
  const std::string xml = BuildWorldXml(scenario, {}, models);
  World drawn(scenario, xml, LoadMujocoModel(xml, "drawn"), robot.joint_names(), q_start);
  World bare(scenario, xml, LoadMujocoModel(WithoutPictures(xml), "bare"), robot.joint_names(),
             q_start);
  EXPECT_LT(2 * bare.model().ngeom, drawn.model().ngeom + 10);
  int most_contacts = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    drawn.Step(drawn.bias_torque());
    bare.Step(bare.bias_torque());
    most_contacts = std::max(most_contacts, bare.data().ncon);
    ASSERT_EQ(drawn.q(), bare.q()) << tick;
    ASSERT_EQ(drawn.v(), bare.v()) << tick;
    ASSERT_EQ(drawn.data().ncon, bare.data().ncon) << tick;
  }
  EXPECT_GT(most_contacts, 1);
}

TEST(WorldXml, KeepsPicturesThatMayTellMasses) {
  const std::string xml = BuildWorldXml(FullScenario(), {}, kTestModels);
  EXPECT_EQ(WithoutPictures(xml), xml);
}

}  // namespace
}  // namespace sidestep::sim::world_xml_test
