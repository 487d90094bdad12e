#include "sidestep/scenarios/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "sidestep/core/convex_polytope.h"
#include "sidestep/core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::scenarios::scenario_test {
namespace {

const std::string kFolder = SIDESTEP_SOURCE_DIR "/scenarios";

struct Variant {
  std::string scenario;
  Settings settings;
};
std::ostream& operator<<(std::ostream& stream, const Variant& variant) {
  stream << variant.scenario;
  for (const auto& [choice, chosen] : variant.settings) stream << "_" << choice << "_" << chosen;
  return stream;
}

// Every scenario with each option of its choices.
std::vector<Variant> Variants() {
  std::vector<Variant> variants;
  for (const std::string& name : ScenarioNames(kFolder)) {
    variants.push_back({name, {}});
    for (const auto& [choice, options] : ScenarioChoices(kFolder + "/" + name + ".yaml")) {
      for (const std::string& option : options) variants.push_back({name, {{choice, option}}});
    }
  }
  return variants;
}

class EveryScenario : public ::testing::TestWithParam<Variant> {};

TEST_P(EveryScenario, LoadsAndReadsBackAsItWasWritten) {
  const Scenario scenario =
      LoadScenario(kFolder + "/" + GetParam().scenario + ".yaml", GetParam().settings);
  const std::string yaml = ToYaml(scenario);
  const Scenario again = ParseScenario(yaml, "written.yaml");
  EXPECT_EQ(ToYaml(again), yaml);
  EXPECT_EQ(again.name, GetParam().scenario);
  EXPECT_EQ(again.grid, scenario.grid);
  ASSERT_EQ(again.moving_obstacles.size(), scenario.moving_obstacles.size());
  for (std::size_t i = 0; i < scenario.moving_obstacles.size(); ++i) {
    for (const double t_s : {0.0, 0.7, 3.0}) {
      const EpisodeTime t(t_s);
      EXPECT_EQ(PoseAt(again.moving_obstacles[i], t).translation(),
                PoseAt(scenario.moving_obstacles[i], t).translation());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, EveryScenario, ::testing::ValuesIn(Variants()),
                         [](const auto& test) { return ::testing::PrintToString(test.param); });

TEST(Scenario, EveryValueSurvivesWritingAndReading) {
  const std::string text = R"(
name: odd
description: "quotes \" and \\ and: colons"
robot: {model: wam, base: {position_m: [0.1, 0.2, 0.3], rpy_rad: [0.1, -0.2, 0.3]}}
task: {start: [0.1, 0.2], goal: [0.3333333333333333, -0.2], dwell_s: 0.3}
horizon: {duration_s: 2.5, step_s: 0.25}
workspace: {first_center_m: [-0.5, 0.25, 0], cell_m: 0.03, cells: [10, 11, 12]}
floor_m: -0.6
static_world: exact
static_boxes:
  - {name: slanted, center_m: [1, 2, 3], rpy_rad: [0, 0.4, 0], size_m: [0.1, 0.2, 0.3]}
static_obstacles:
  - {name: crate, shape: {box: {size_m: [0.1, 0.2, 0.3]}}, position_m: [1, 2, 3], rpy_rad: [1, 0.4, 0]}
  - name: wedge
    position_m: [2, 3, 1]
    shape: {convex_mesh: {vertices_m: [[0, 0, 0], [0.3, 0, 0], [0.1, 0, 0], [0, 0.2, 0], [0, 0, 0.7]]}}
moving_obstacles:
  - {name: a, shape: {capsule: {radius_m: 0.1, length_m: 0.5}}, rpy_rad: [0, 1.5, 0],
     motion: {linear: {start_m: [0, 0, 0], direction: [3, 4, 0], speed_m_s: 0.7, stop_at_s: 2}}}
  - {name: b, shape: {cylinder: {radius_m: 0.1, length_m: 0.5}}, appearance: hsr,
     motion: {waypoints: {points: [{position_m: [0, 0, 0]}, {position_m: [1, 0, 0]}],
                          speed_m_s: 0.1}}}
  - {name: c, shape: {ellipsoid: {semi_axes_m: [0.1, 0.2, 0.3]}},
     motion: {linear: {start_m: [0, 0, 0], direction: [0, 0, 1], speed_m_s: 0}}}
  - {name: d, shape: {convex_mesh: {vertices_m: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}},
     motion: {linear: {start_m: [0, 0, 0], direction: [0, 0, 1], speed_m_s: 0}}}
planner: {name: gpmp, epsilon_m: 0.1, sigma_obs: 0.2, n_int: 19, qc: 2, velocity_scale: 0.75,
          acceleration_scale: 0.25, max_iterations: 7, growth_sigmas: 1.5, growth_limit_m: 0.07,
          velocity_limits: false}
knowledge: static
predictor: stationary
replanning: {rate_hz: 4, latency_s: 0.07}
sensor:
  name: occupancy
  rate_hz: 15
  cells: centre
  latency_s: 0.05
  jitter_s: 0.01
  dropout: 0.2
  noise: {false_filled: 0.001, false_free: 0.02, position_noise_m: 0.003}
  camera: {position_m: [1, 2, 3], look_at_m: [0.5, 0, 0], field_of_view_rad: 0.9, width: 32,
           height: 24, range_m: 3.5, noise_per_m: 0.004, pixel_dropout: 0.1, flying_pixels: 0.3,
           edge_m: 0.2, unseen: filled, sees_robot: true, robot_margin_m: 0.04,
           misplaced_m: [0.01, 0, -0.02]}
  tags: {position_m: [3, 2, 1], across_noise: 0.005, along_noise_per_m: 0.006,
         rotation_noise_rad: 0.007, range_m: 2.5}
sensors:
  - {name: occupancy, rate_hz: 20}
  - {name: tags, label: left, rate_hz: 25, tags: {position_m: [0, 2, 1]}}
evidence: {single_frames: true, hit: 0.5, miss: 0.6, least: -3, most: 4, settle_scans: 5, decay_per_s: 2,
           noise_sigmas: 3, average_scans: 7, least_cells: 9}
seed: 42
)";
  const Scenario scenario = ParseScenario(text, "odd.yaml");
  const Scenario again = ParseScenario(ToYaml(scenario), "again.yaml");
  EXPECT_EQ(again.description, "quotes \" and \\ and: colons");
  EXPECT_LT((again.X_WB.rotation().coeffs() - scenario.X_WB.rotation().coeffs()).norm(), 1e-15);
  EXPECT_EQ(again.q_goal, scenario.q_goal);
  EXPECT_EQ(again.dwell_s, 0.3);
  EXPECT_EQ(again.planner_parameters, scenario.planner_parameters);
  EXPECT_EQ(again.planner_parameters.at("n_int"), "19");
  EXPECT_EQ(again.velocity_scale, 0.75);
  EXPECT_EQ(again.acceleration_scale, 0.25);
  EXPECT_EQ(again.growth_sigmas, 1.5);
  EXPECT_EQ(again.growth_limit_m, 0.07);
  EXPECT_FALSE(again.velocity_limits);
  EXPECT_TRUE(again.acceleration_limits);
  EXPECT_EQ(again.latency_s, 0.07);
  EXPECT_EQ(again.seed, 42u);
  EXPECT_EQ(again.static_world, StaticWorld::kExact);
  EXPECT_EQ(again.sensor.cells, CellRule::kCentre);
  EXPECT_EQ(ToYaml(SensorsOf(again)), ToYaml(SensorsOf(scenario)));
  EXPECT_EQ(again.sensor.dropout, 0.2);
  EXPECT_EQ(again.sensor.noise->position_noise_m, 0.003);
  EXPECT_EQ(again.sensor.camera->look_at_m, Eigen::Vector3d(0.5, 0, 0));
  EXPECT_EQ(again.sensor.camera->height, 24);
  EXPECT_EQ(again.sensor.camera->unseen, "filled");
  EXPECT_EQ(again.sensor.camera->flying_pixels, 0.3);
  EXPECT_EQ(again.sensor.camera->edge_m, 0.2);
  EXPECT_TRUE(again.sensor.camera->sees_robot);
  EXPECT_EQ(again.sensor.camera->robot_margin_m, 0.04);
  EXPECT_EQ(again.sensor.camera->misplaced_m, Eigen::Vector3d(0.01, 0, -0.02));
  ASSERT_EQ(again.more_sensors.size(), 2u);
  EXPECT_EQ(NameOf(again.sensor), "occupancy");
  EXPECT_EQ(NameOf(again.more_sensors[0]), "occupancy_2") << "called like another";
  EXPECT_EQ(NameOf(again.more_sensors[1]), "left");
  EXPECT_EQ(again.more_sensors[1].rate_hz, 25);
  EXPECT_TRUE(again.evidence.single_frames);
  EXPECT_EQ(again.evidence.hit, 0.5);
  EXPECT_EQ(again.evidence.miss, 0.6);
  EXPECT_EQ(again.evidence.least, -3);
  EXPECT_EQ(again.evidence.most, 4);
  EXPECT_EQ(again.evidence.settle_scans, 5);
  EXPECT_EQ(again.evidence.decay_per_s, 2);
  EXPECT_EQ(again.evidence.noise_sigmas, 3);
  EXPECT_EQ(again.evidence.average_scans, 7);
  EXPECT_EQ(again.evidence.least_cells, 9);
  EXPECT_EQ(again.sensor.tags->rotation_noise_rad, 0.007);
  ASSERT_EQ(again.static_obstacles.size(), 3u);
  EXPECT_EQ(again.static_obstacles[0].path, "static_boxes[0]");
  EXPECT_EQ(again.static_obstacles[1].path, "static_obstacles[0]");
  EXPECT_EQ(std::get<Box>(again.static_obstacles[1].shape).size_m, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(again.static_obstacles[2].X_WO.translation(), Eigen::Vector3d(2, 3, 1));
  // The corners alone, as they were given.
  const std::vector<Eigen::Vector3d> corners = {{0, 0, 0}, {0.3, 0, 0}, {0, 0.2, 0}, {0, 0, 0.7}};
  EXPECT_EQ(std::get<ConvexMesh>(again.static_obstacles[2].shape).hull->vertices(), corners);
  EXPECT_EQ(std::get<ConvexMesh>(again.moving_obstacles[3].shape).hull->vertices().size(), 4u);
  EXPECT_EQ(std::get<LinearMotion>(again.moving_obstacles[0].motion).stop_at_s, 2);
  EXPECT_EQ(std::get<Cylinder>(again.moving_obstacles[1].shape).length_m, 0.5);
  EXPECT_EQ(std::get<Ellipsoid>(again.moving_obstacles[2].shape).semi_axes_m,
            Eigen::Vector3d(0.1, 0.2, 0.3));
  const Eigen::Vector3d direction =
      std::get<LinearMotion>(again.moving_obstacles[0].motion).direction;
  EXPECT_LT((direction - Eigen::Vector3d(0.6, 0.8, 0)).norm(), 1e-15);
}

TEST(Scenario, ThatNamesNoPredictorFiltersForAConstantVelocity) {
  std::string text = ToYaml(LoadScenario(kFolder + "/hsr_walkway.yaml"));
  const std::size_t line = text.find("predictor: ");
  text.erase(line, text.find('\n', line) + 1 - line);
  EXPECT_EQ(ParseScenario(text, "without.yaml").predictor, "kalman_cv");
}

TEST(Scenario, WithoutANameIsNamedAfterItsFile) {
  EXPECT_EQ(LoadScenario(kFolder + "/hsr_walkway.yaml").name, "hsr_walkway");
}

TEST(HsrWalkway, HasThePublishedGeometryWhereItWasMeantToBe) {
  const Scenario scenario = LoadScenario(kFolder + "/hsr_walkway.yaml");
  EXPECT_EQ(scenario.X_WB.translation(), Eigen::Vector3d(0, 0, 0.4));
  ASSERT_EQ(scenario.static_obstacles.size(), 2u);
  EXPECT_EQ(scenario.static_obstacles[0].X_WO.translation(), Eigen::Vector3d(-0.31, 0, 0.2));
  EXPECT_EQ(scenario.static_obstacles[1].X_WO.translation(), Eigen::Vector3d(1.05, 0, 0.2));
  ASSERT_EQ(scenario.moving_obstacles.size(), 1u);
  const MovingObstacle& hsr = scenario.moving_obstacles[0];
  EXPECT_EQ(std::get<Box>(hsr.shape).size_m, Eigen::Vector3d(0.48, 0.55, 1.2));
  EXPECT_LT((PoseAt(hsr, EpisodeTime(1)).translation() - Eigen::Vector3d(0.4, 0.6, 0.6)).norm(),
            1e-12);
}

constexpr char kWithChoices[] = R"(
description: A scene
robot: {model: panda, base: {position_m: [0, 0, 0]}}
choices:
  pair:
    default: far
    options:
      near: {task: {start: a, goal: b}}
      far: {task: {start: a, goal: c}, seed: 5}
horizon: {duration_s: 3, step_s: 0.1}
workspace: {first_center_m: [-1, -1, -1], cell_m: 0.04, cells: [8, 8, 8]}
moving_obstacles:
  - name: a
    shape: {sphere: {radius_m: 0.1}}
    motion: {random_walk: {start_m: [0, 0, 0], heading_rad: 0, turn_rad: 0.1, turn_every_s: 0.2,
                           speed_m_s: 1}}
planner: {name: gpmp, epsilon_m: 0.1, sigma_obs: 0.2, n_int: 1}
knowledge: static
replanning: {rate_hz: 4, latency_s: 0.07}
sensor: {name: occupancy, rate_hz: 15}
seed: 42
)";

Scenario WithSettings(const Settings& settings) {
  return ParseScenario(kWithChoices, "scene.yaml", settings);
}

std::string Complaint(const Settings& settings) {
  try {
    WithSettings(settings);
  } catch (const InputError& error) {
    return error.what();
  }
  return "was accepted";
}

TEST(Choices, PutTheKeysOfTheirOptionInPlace) {
  EXPECT_EQ(WithSettings({}).goal_name, "c");
  EXPECT_EQ(WithSettings({}).seed, 5u);
  EXPECT_EQ(WithSettings({{"pair", "near"}}).goal_name, "b");
  EXPECT_EQ(WithSettings({{"pair", "near"}}).seed, 42u);
  EXPECT_EQ(WithSettings({{"pair", "near"}}).choices, (Settings{{"pair", "near"}}));
}

TEST(Choices, OfAnOptionThatIsNotThereNameThoseThatAre) {
  EXPECT_EQ(Complaint({{"pair", "9"}}), "--set pair: must be one of near, far, is '9'");
}

TEST(Settings, TakeThePlaceOfTheFilesValues) {
  EXPECT_EQ(WithSettings({{"planner.epsilon_m", "0.25"}}).epsilon_m, 0.25);
  EXPECT_EQ(WithSettings({{"task.goal", "[1, 2]"}}).q_goal, Eigen::Vector2d(1, 2));
  EXPECT_EQ(WithSettings({{"planner.qc", "3"}}).planner_parameters.at("qc"),
            "3");  // a key that the file leaves out
  const Scenario slow = WithSettings({{"moving_obstacles[0].motion.random_walk.speed_m_s", "0.5"}});
  EXPECT_EQ(std::get<RandomWalkMotion>(slow.moving_obstacles[0].motion).speed_m_s, 0.5);
}

TEST(Settings, OfTheSeedMoveWhatWalksAtRandom) {
  const auto end = [](const Settings& settings) {
    return PoseAt(WithSettings(settings).moving_obstacles[0], EpisodeTime(3)).translation();
  };
  EXPECT_EQ(end({}), end({{"seed", "5"}}));
  EXPECT_NE(end({}), end({{"seed", "6"}}));
}

TEST(Settings, ThatAreWrongAreBlamedOnThePersonWhoSetThem) {
  EXPECT_EQ(Complaint({{"planner.epsilon_m", "-1"}}),
            "--set planner.epsilon_m: must be >= 0, is -1");
  EXPECT_EQ(Complaint({{"planner.epsilon_m", "wide"}}),
            "--set planner.epsilon_m: must be a number, is 'wide'");
  EXPECT_EQ(Complaint({{"robot.base", "{position_m: [0, 0]}"}}),
            "--set robot.base.position_m: must have 3 numbers, has 2");
  EXPECT_THAT(Complaint({{"replanning.rate", "1"}}),
              ::testing::StartsWith("--set replanning.rate: is not a known key"));
  EXPECT_EQ(Complaint({{"planner.epsilonm", "[1]"}}),
            "--set planner.epsilonm: must be a number, true or false, or a word");
  EXPECT_EQ(Complaint({{"planer.epsilon_m", "1"}}),
            "--set planer.epsilon_m: leads nowhere: there is no 'planer'");
  EXPECT_EQ(Complaint({{"moving_obstacles[1].name", "b"}}),
            "--set moving_obstacles[1].name: leads nowhere: there is no '1'");
  EXPECT_EQ(Complaint({{"seed.of", "1"}}),
            "--set seed.of: leads nowhere: what is there holds no keys");
  EXPECT_THAT(Complaint({{"planner.qc", "[1"}}),
              ::testing::StartsWith("--set planner.qc: is not valid YAML"));
}

TEST(Settings, HaveOneSpelling) {
  const std::string no_path = ": is no path: it must be written as a.b or a[0].b";
  for (const std::string path :
       {"", "..", "planner..qc", ".seed", "seed.", "planner.", "[0]", "moving_obstacles[0]name",
        "moving_obstacles[0", "moving_obstacles0]", "moving_obstacles[00].name",
        "moving_obstacles[+0].name", "moving_obstacles[].name", "moving_obstacles[-1].name",
        "moving_obstacles.[0].name", "moving_obstacles[99999999999999999999]"}) {
    EXPECT_EQ(Complaint({{path, "1"}}), "--set " + path + no_path);
  }
  EXPECT_EQ(Complaint({{"moving_obstacles.0.name", "b"}}),
            "--set moving_obstacles.0.name: leads nowhere: items of a list are written [0], [1], "
            "...");
  EXPECT_EQ(Complaint({{"planner[0]", "b"}}),
            "--set planner[0]: leads nowhere: what is there is no list");
  EXPECT_EQ(WithSettings({{"moving_obstacles[0].name", "b"}}).moving_obstacles[0].name, "b");
}

TEST(Settings, ChooseByTheNameOfAChoiceAlone) {
  EXPECT_EQ(Complaint({{"choices.pair.default", "near"}}),
            "--set choices.pair.default: is chosen by --set NAME=OPTION");
}

// What is wrong may be what holds the value, what it lacks, or what it does not agree with.
TEST(Settings, AreBlamedForWhatTheyMakeWrongElsewhere) {
  EXPECT_THAT(Complaint({{"workspace.cells[0]", "1"}}),
              ::testing::StartsWith("--set workspace.cells[0]: must be whole numbers from 2"));
  EXPECT_EQ(Complaint({{"robot", "{model: panda}"}}), "--set robot.base: is missing");
  EXPECT_EQ(Complaint({{"robot", "{model: panda, model: wam}"}}),
            "--set robot: model: is given twice");
  EXPECT_THAT(Complaint({{"moving_obstacles[0].motion.circle", "{radius_m: 1}"}}),
              ::testing::StartsWith("--set moving_obstacles[0].motion.circle: must hold exactly"));
  EXPECT_EQ(Complaint({{"horizon.duration_s", "0.35"}}),
            "--set horizon.duration_s: horizon.step_s: must divide duration_s into at least 4 "
            "whole steps");
  EXPECT_EQ(Complaint({{"replanning.latency_s", "4"}}),
            "--set replanning.latency_s: must not exceed the horizon");
  EXPECT_EQ(Complaint({{"workspace.cell_m", "0.001"}, {"planner.epsilon_m", "0.3"}}),
            "--set planner.epsilon_m: must be at most 256 cells of the workspace");
}

TEST(RobotFolder, IsThatOfTheNameWhereverRobotsAreLookedFor) {
  const TemporaryFolder folder;
  const std::string first = (folder.path() / "first").string();
  const std::string second = (folder.path() / "second").string();
  std::filesystem::create_directories(first + "/wam");
  std::filesystem::create_directories(second + "/wam");
  std::filesystem::create_directories(second + "/panda");
  const ModelFolders models(std::vector<std::string>{first, second});
  Scenario scenario;
  scenario.file = "scene.yaml";
  scenario.robot = "wam";
  EXPECT_EQ(RobotFolder(scenario, models), first + "/wam");
  scenario.robot = "panda";
  EXPECT_EQ(RobotMjcf(scenario, models), second + "/panda/panda.xml");
  scenario.robot = "hsr";
  EXPECT_THAT([&] { RobotFolder(scenario, models); },
              ::testing::ThrowsMessage<InputError>(
                  "scene.yaml:1: robot.model: there is no 'hsr' in " + first + ", " + second));
}

TEST(RobotFolder, MayBeAPathFromTheScenariosOwnFolder) {
  const auto read = [](const std::string& model) { return WithSettings({{"robot.model", model}}); };
  const Scenario beside = read("./robots/arm/");
  EXPECT_EQ(beside.robot, "arm");
  EXPECT_EQ(RobotFolder(beside, "models"), "robots/arm");
  Scenario above = read("../arm");
  above.file = "a/b/scene.yaml";
  EXPECT_EQ(RobotFolder(above, "models"), "a/arm");
  const Scenario elsewhere = read("/robots/arm");
  EXPECT_EQ(RobotFolder(elsewhere, "models"), "/robots/arm");
  EXPECT_EQ(ParseScenario(ToYaml(above), "again.yaml").robot_path, "../arm");
}

TEST(WrongValue, IsToldAtTheNearestLineThatThereIs) {
  const Scenario scenario = WithSettings({{"task.goal", "c"}});
  EXPECT_STREQ(WrongValue(scenario, "robot.base.rpy_rad", "is odd").what(),
               "scene.yaml:3: robot.base.rpy_rad: is odd");
  EXPECT_STREQ(WrongValue(scenario, "moving_obstacles[0].shape.sphere", "is odd").what(),
               "scene.yaml:14: moving_obstacles[0].shape.sphere: is odd");
  EXPECT_STREQ(WrongValue(scenario, "task", "is odd").what(), "--set task.goal: is odd");
  EXPECT_STREQ(WrongValue(scenario, "task.start", "is odd").what(),
               "scene.yaml:9: task.start: is odd");
  EXPECT_STREQ(WrongValue(scenario, "task.start", "is odd", {"robot.model", "task.goal"}).what(),
               "--set task.goal: task.start: is odd");
}

}  // namespace
}  // namespace sidestep::scenarios::scenario_test
