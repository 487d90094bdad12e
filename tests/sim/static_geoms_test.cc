#include "sidestep/sim/static_geoms.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "sidestep/core/input_error.h"
#include "sidestep/sim/geom_distance.h"
#include "sidestep/sim/simulation.h"
#include "tests/sim/small_model.h"
#include "tests/sim/two_link.h"
#include "tests/support/bytes_of.h"
#include "tests/support/random_points.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::sim::static_geoms_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const char* const kBodies = R"(
  <geom name='ground' type='plane' size='0 0 1' pos='0 0 -0.2'/>
  <body name='shelf' pos='1 0 0.5' euler='0 0 40'>
    <geom name='board' type='box' size='0.3 0.2 0.01' pos='0 0 0.2' euler='10 20 0'/>
    <geom type='capsule' fromto='0 0 0 0.2 0.1 0.4' size='0.02'/>
    <body pos='0 0 0.6'>
      <geom name='knob' type='sphere' size='0.05'/>
      <geom name='picture' type='sphere' size='0.5' contype='0' conaffinity='0'/>
    </body>
  </body>
  <body name='things' pos='-1 0.5 0.4' quat='0.8 0.2 -0.4 0.4'>
    <geom name='can' type='cylinder' size='0.1 0.2'/>
    <geom name='egg' type='ellipsoid' size='0.1 0.2 0.3' pos='0.6 0 0'/>
    <geom name='wedge' type='mesh' mesh='wedge' pos='0 0.7 0' euler='0 90 10'/>
  </body>
  <body name='door' pos='0 2 1'><joint name='hinge' type='hinge' axis='0 0 1'/>
    <geom type='box' size='0.4 0.02 0.9'/><geom type='sphere' size='0.1' pos='0 0 1'/></body>
  <body name='guide' mocap='true'><geom type='sphere' size='0.1'/></body>
)";
const char* const kAssets =
    "<asset><mesh name='wedge' vertex='0 0 0 0.5 0 0 0 0.3 0 0 0 0.2 0.4 0.3 0.1'/></asset>";

class StaticGeomsTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text) const {
    const std::string path = (folder_.path() / name).string();
    std::ofstream(path) << text;
    return path;
  }
  std::string MessageOf(const std::string& path) const {
    try {
      ReadStaticGeoms(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  const TemporaryFolder folder_;
};

TEST_F(StaticGeomsTest, AreWhereMuJoCoHasThem) {
  const std::string path =
      Write("world.xml", std::string("<mujoco><compiler angle='radian'/>") + kAssets +
                             "<worldbody>" + kBodies + "</worldbody></mujoco>");
  const StaticGeoms geoms = ReadStaticGeoms(path);
  EXPECT_EQ(geoms.floor_m, -0.2);
  EXPECT_THAT(geoms.left_out, ElementsAre(HasSubstr(": body 'door': it moves"),
                                          HasSubstr(": body 'guide': it moves")));
  ASSERT_EQ(geoms.solids.size(), 6u);
  EXPECT_EQ(geoms.solids[1].name, "shelf");  // a geom without a name has its body's

  // A probe that goes round, in the same world.
  SmallModel m(std::string(kBodies) +
                   "<body name='probe' mocap='true'><geom name='probe' type='sphere' size='0.001'/>"
                   "</body>",
               kAssets);
  const GeomDistance distance(*m.model);
  const int probe = m.Geom("probe");
  RandomStream random(1, "points");
  const std::map<std::string, int> ids = {
      {"board", m.Geom("board")}, {"shelf", m.Geom("board") + 1}, {"knob", m.Geom("knob")},
      {"can", m.Geom("can")},     {"egg", m.Geom("egg")},         {"wedge", m.Geom("wedge")}};
  for (const StaticGeom& solid : geoms.solids) {
    for (int n = 0; n < 100; ++n) {
      const Eigen::Vector3d p = solid.placed.X_WO * UniformPoint(random, 0.8);
      m.Place(1, Pose::Translation(p));  // the second of its kind
      const double expected = SignedDistance(solid.placed.shape, solid.placed.X_WO.Inverse() * p);
      if (expected < 0.01) continue;
      EXPECT_NEAR(distance.Distance(*m.data, probe, ids.at(solid.name)), expected - 0.001, 1e-6)
          << solid.name;
    }
  }
}

TEST_F(StaticGeomsTest, MayStandInOtherFiles) {
  Write("wedge.obj",
        "v 0 0 0\nv 0.5 0 0\nv 0 0.3 0\nv 0 0 0.2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  Write("part.xml",
        "<mujoco><asset><mesh name='w' file='wedge.obj'/></asset><worldbody>"
        "<geom name='w' type='mesh' mesh='w' pos='1 0 0'/></worldbody></mujoco>");
  const StaticGeoms geoms = ReadStaticGeoms(
      Write("world.xml", "<mujoco><include file='part.xml'/><worldbody/></mujoco>"));
  ASSERT_EQ(geoms.solids.size(), 1u);
  const PlacedShape& placed = geoms.solids[0].placed;
  const auto distance = [&](const Eigen::Vector3d& p) {
    return SignedDistance(placed.shape, placed.X_WO.Inverse() * p);
  };
  EXPECT_NEAR(distance({0.9, 0.1, 0.1}), 0.1, 1e-6);
  EXPECT_NEAR(distance({1.1, 0.1, -0.2}), 0.2, 1e-6);
  EXPECT_FALSE(geoms.floor_m.has_value());
}

TEST_F(StaticGeomsTest, LeaveOutWhatIsNoShapeOfScenarios) {
  const StaticGeoms geoms = ReadStaticGeoms(
      Write("world.xml",
            "<mujoco><asset><hfield name='h' nrow='3' ncol='3' size='1 1 1 1'/></asset><worldbody>"
            "<geom name='hill' type='hfield' hfield='h'/>"
            "<geom name='low' type='plane' size='1 1 1' pos='0 0 -1'/>"
            "<geom name='high' type='plane' size='1 1 1'/>"
            "<geom name='lower' type='plane' size='1 1 1' pos='0 0 -2'/>"
            "<geom name='slope' type='plane' size='1 1 1' euler='20 0 0'/></worldbody></mujoco>"));
  EXPECT_EQ(geoms.floor_m, 0);
  EXPECT_THAT(geoms.solids, IsEmpty());
  EXPECT_THAT(geoms.left_out, ElementsAre(HasSubstr("geom 'hill': a height field"),
                                          HasSubstr("geom 'lower': a plane below another"),
                                          HasSubstr("geom 'slope': a plane that is not level")));
}

TEST_F(StaticGeomsTest, OfAFileThatIsNoneAreRefusedAtItsLine) {
  const std::string nowhere = (folder_.path() / "nowhere.xml").string();
  EXPECT_EQ(MessageOf(nowhere), nowhere + ": no such file");
  const auto message = [&](const std::string& text) {
    const std::string path = Write("world.xml", text);
    return MessageOf(path).substr(path.size());
  };
  EXPECT_EQ(message("<robot/>"), ":1: must be an MJCF file, whose root is <mujoco>");
  EXPECT_THAT(message("<mujoco>\n<world"), HasSubstr(":2: "));
  EXPECT_THAT(message("<mujoco><worldbody>\n<geom type='box'/></worldbody></mujoco>"),
              HasSubstr(":2: "));
  EXPECT_THAT(message("<mujoco><worldbody>\n<geom type='sphere' size='nan'/></worldbody></mujoco>"),
              HasSubstr(":2: size: must be finite"));
  EXPECT_THAT(message("<mujoco><asset>\n<mesh name='m' file='gone.obj'/></asset></mujoco>"),
              HasSubstr("gone.obj"));
  EXPECT_THAT(
      message(
          "<mujoco><asset>\n<mesh name='m' vertex='0 0 0 1 0 0 0 1 0 1 1 0'/></asset></mujoco>"),
      HasSubstr(":2: vertex: must span a solid, is flatter than 0.01 mm"));
  EXPECT_THAT(message("<mujoco>\n<include file='world.xml'/></mujoco>"),
              HasSubstr("they include each other"));
  EXPECT_THAT(message("<mujoco><worldbody><body><composite type='grid' count='1000 1000 1' "
                      "spacing='1'><geom size='.1'/></composite></body></worldbody></mujoco>"),
              HasSubstr(":1: composite: is not taken"));
}

TEST(FootHeight, IsThatOfTheLowestFixedSolid) {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.floor_m = -5;
  scenario.static_obstacles.clear();
  scenario.moving_obstacles.clear();
  scenario.X_WB = Pose::Translation({0.3, 0.2, 0.7});
  const Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  EXPECT_NEAR(FootHeight(simulation.world()), 0.7, 1e-6);
}

TEST(FootHeight, LeavesRoomBelowARobotOfWhichAllMoves) {
  const TemporaryFolder folder;
  const std::filesystem::path copy = folder.path();
  std::filesystem::copy(kTestModels, copy, std::filesystem::copy_options::recursive);
  const std::string file = copy / "two_link/two_link.xml";
  std::string xml = BytesOf(file);
  const std::size_t foot = xml.find("<geom name=\"foot\"");
  xml.erase(foot, xml.find("/>", foot) + 2 - foot);
  std::ofstream(file) << xml;
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.floor_m = -5;
  scenario.static_obstacles.clear();
  scenario.moving_obstacles.clear();
  scenario.q_start.setZero();
  const Simulation simulation(scenario, robot::RobotModel::Load(copy.string(), "two_link", Pose()),
                              copy.string());
  // Stretched out, the ball of 50 mm at its end is 300 mm above the base.
  EXPECT_NEAR(FootHeight(simulation.world()), 0.25 - 0.02, 1e-6);
}

}  // namespace
}  // namespace sidestep::sim::static_geoms_test
