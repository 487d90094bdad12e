// The scenario files against the figures of the authors' code, ori-drs/gpmp2, to the bit: the
// scenes of the published experiments are read from them.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/bench/reproduce/field_scene.h"
#include "sidestep/bench/reproduce/open_loop_experiment.h"
#include "sidestep/core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::bench::reproduce_scenes_test {
namespace {

using Eigen::Vector3d;

const std::string kScenarios = SIDESTEP_SOURCE_DIR "/scenarios";
constexpr double kNever = std::numeric_limits<double>::infinity();

struct PublishedBox {
  Vector3d center_m, size_m;
};
struct PublishedMovingBox {
  PublishedBox at_start;
  Vector3d velocity_m_s;
  double stop_s;
};

const std::vector<PublishedBox> kTableAndCabinet = {
    {{0.20, 0.70, -0.20}, {1.40, 0.60, 0.05}},   // table top
    {{-0.45, 0.45, -0.60}, {0.1, 0.1, 0.8}},     // its legs
    {{0.85, 0.45, -0.60}, {0.1, 0.1, 0.8}},      //
    {{-0.45, 0.95, -0.60}, {0.1, 0.1, 0.8}},     //
    {{0.85, 0.95, -0.60}, {0.1, 0.1, 0.8}},      //
    {{1.00, 0.40, -0.05}, {0.60, 0.05, 1.90}},   // sides of the cabinet
    {{1.00, -0.60, -0.05}, {0.60, 0.05, 1.90}},  //
    {{0.50, 0.40, -0.05}, {0.40, 0.05, 1.90}},   // partition
    {{1.00, -0.10, 0.90}, {0.60, 1.00, 0.05}},   // shelves
    {{1.00, -0.10, 0.40}, {0.60, 1.00, 0.05}},   //
    {{1.00, -0.10, -0.10}, {0.60, 1.00, 0.05}},  //
    {{1.00, -0.10, -0.60}, {0.60, 1.00, 0.05}},  //
};
const std::vector<PublishedBox> kTwoTables = {{{-0.31, 0, 0.2}, {0.80, 1.2, 0.4}},
                                              {{1.05, 0, 0.2}, {0.80, 1.2, 0.4}}};

void ExpectStands(const scenarios::Scenario& scene, const std::vector<PublishedBox>& boxes) {
  ASSERT_EQ(scene.static_obstacles.size(), boxes.size());
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    EXPECT_EQ(scene.static_obstacles[b].X_WO.translation(), boxes[b].center_m) << "box " << b + 1;
    EXPECT_EQ(std::get<Box>(scene.static_obstacles[b].shape).size_m, boxes[b].size_m)
        << "box " << b + 1;
  }
}

void ExpectIsTheMovingBox(const OpenLoopExperiment& experiment, const PublishedBox& at_start,
                          double stop_s) {
  ASSERT_EQ(experiment.scene.moving_obstacles.size(), 1u);
  const auto& motion =
      std::get<scenarios::LinearMotion>(experiment.scene.moving_obstacles[0].motion);
  EXPECT_EQ(motion.start_m, at_start.center_m);
  EXPECT_EQ(experiment.moving_box().size_m, at_start.size_m);
  EXPECT_EQ(motion.begin_at_s, 0);
  EXPECT_EQ(std::min(motion.stop_at_s, 3.0), stop_s) << "the horizon ends after 3 s";
  EXPECT_LT((motion.direction - experiment.direction.normalized()).norm(), 1e-15);
}

GridSpec Cube(int cells) { return {Vector3d(-1, -1, -1), 0.04, {cells, cells, cells}}; }

TEST(WamSinglePillarYaml, IsThePublishedScene) {
  const OpenLoopExperiment wam = MakeOpenLoopExperiment("wam_single_pillar", kScenarios);
  ExpectStands(wam.scene, kTableAndCabinet);
  ExpectIsTheMovingBox(wam, {{0.55, -0.95, -0.05}, {0.15, 0.15, 1.9}}, 2);
  EXPECT_EQ(wam.direction, Vector3d(-0.2726, 0.9621, 0)) << "not of unit length";
  EXPECT_EQ(wam.scene.robot, "wam");
  EXPECT_EQ(wam.scene.X_WB.translation(), Vector3d(0, 0, 0));
  EXPECT_EQ(wam.scene.grid, Cube(64));
  EXPECT_EQ(wam.scene.step_s, 0.1);
  EXPECT_EQ(wam.num_states(), 31);
  const std::vector<std::pair<std::string, std::string>> pairs = {
      {"pose1", "pose3"}, {"pose1", "pose4"}, {"pose1", "pose5"}, {"pose2", "pose3"},
      {"pose2", "pose4"}, {"pose2", "pose5"}, {"pose3", "pose4"}};
  EXPECT_EQ(wam.pairs, pairs);
}

TEST(HsrWalkwayYaml, IsThePublishedScene) {
  const OpenLoopExperiment panda = MakeOpenLoopExperiment("panda_hsr", kScenarios);
  ExpectStands(panda.scene, kTwoTables);
  ExpectIsTheMovingBox(panda, {{0.4, 2.0, 0.6}, {0.48, 0.55, 1.2}}, 3);
  EXPECT_EQ(panda.direction, Vector3d(0, -1, 0));
  EXPECT_EQ(panda.scene.robot, "panda");
  EXPECT_EQ(panda.scene.X_WB.translation(), Vector3d(0, 0, 0.4));
  EXPECT_EQ(panda.scene.X_WB.rotation().coeffs(), Eigen::Quaterniond::Identity().coeffs());
  EXPECT_EQ(panda.scene.grid, Cube(96));
  EXPECT_EQ(panda.scene.step_s, 0.1);
  EXPECT_EQ(panda.num_states(), 31);
  EXPECT_EQ(panda.pairs.size(), 48u);
}

struct FieldCase {
  const char* name;
  bool has_furniture;
  std::vector<PublishedMovingBox> moving;
};
const PublishedMovingBox kHighBox = {{{0.3, 0.25, 1.45}, {0.15, 0.15, 0.15}}, {-0.6, 0, 0}, kNever};
const PublishedMovingBox kOtherHighBox = {
    {{0.55, -0.95, 1.45}, {0.15, 0.15, 0.15}}, {-0.17, 0.6, 0}, 2};
const PublishedMovingBox kPillar = {{{0.55, -0.95, -0.05}, {0.15, 0.15, 1.9}}, {-0.17, 0.6, 0}, 2};
const PublishedMovingBox kOtherPillar = {
    {{0.3, 0.25, -0.05}, {0.15, 0.15, 1.9}}, {-0.6, 0, 0}, kNever};
const PublishedMovingBox kBlock = {{{0.4, 0.4, 0.4}, {0.2, 0.2, 0.2}}, {-0.17, 0.6, 0}, kNever};

OccupancyGrid CellsOf(const std::vector<PublishedMovingBox>& moving, const GridSpec& grid,
                      double t_s) {
  OccupancyGrid occupancy(grid);
  for (const PublishedMovingBox& box : moving) {
    const Vector3d center_m = box.at_start.center_m + std::min(t_s, box.stop_s) * box.velocity_m_s;
    Fill(occupancy,
         PublishedBoxCells(grid, center_m, box.at_start.size_m, BoxAlignment::kIntended));
  }
  return occupancy;
}

// A scenario says the velocity as speed and direction and multiplies in another order. That must
// not show in any cell, at any moment that is timed, on any of the published grids.
TEST(FieldScenesYaml, FillThePublishedCells) {
  const std::vector<FieldCase> cases = {
      {"field_one_box", true, {kHighBox}},    {"field_two_boxes", true, {kHighBox, kOtherHighBox}},
      {"field_one_pillar", true, {kPillar}},  {"field_two_pillars", true, {kOtherPillar, kPillar}},
      {"field_large_block", false, {kBlock}},
  };
  std::vector<std::string> names;
  for (const FieldCase& test : cases) {
    names.emplace_back(test.name);
    const scenarios::Scenario scene = LoadBoxScene(kScenarios + "/" + test.name + ".yaml");
    EXPECT_EQ(scene.robot, "");
    EXPECT_EQ(scene.grid, PublishedTimingGrid(96));
    ExpectStands(scene, test.has_furniture ? kTableAndCabinet : std::vector<PublishedBox>());
    ASSERT_EQ(scene.moving_obstacles.size(), test.moving.size());
    for (const int voxels : {64, 96, 128, 160}) {
      const GridSpec grid = PublishedTimingGrid(voxels);
      for (int step = 0; step <= 30; ++step) {
        const double t_s = step * 0.1;
        EXPECT_EQ(MovingOccupancy(scene, grid, EpisodeTime(t_s)).cells,
                  CellsOf(test.moving, grid, t_s).cells)
            << test.name << ", " << voxels << " voxels, " << t_s << " s";
      }
    }
  }
  EXPECT_EQ(names, FieldSceneNames());
}

TEST(LoadBoxScene, RefusesWhatThePublishedRasteriserDoesNotKnow) {
  const std::string frame =
      "description: x\nworkspace: {first_center_m: [-1, -1, -1], cell_m: 0.1, cells: [20, 20, "
      "20]}\n"
      "floor_m: -1\nknowledge: prediction\nsensor: {name: occupancy, rate_hz: 30}\nseed: 1\n";
  const std::string motion =
      "motion: {linear: {start_m: [0, 0, 0], direction: [1, 0, 0], speed_m_s: 1}}}]\n";
  const TemporaryFolder folder;
  const std::string path = folder.path() / "scene.yaml";
  const auto load = [&](const std::string& text) {
    std::ofstream(path) << frame << text;
    return LoadBoxScene(path);
  };
  EXPECT_NO_THROW(
      load("moving_obstacles: [{name: b, shape: {box: {size_m: [1, 1, 1]}}, " + motion));
  for (const std::string& text : {
           "static_boxes: [{name: b, center_m: [0, 0, 0], size_m: [1, 1, 1], rpy_rad: [0, 0, "
           "1]}]\n" +
               std::string("moving_obstacles: []\n"),
           "moving_obstacles: [{name: b, shape: {sphere: {radius_m: 1}}, " + motion,
           "moving_obstacles: [{name: b, shape: {box: {size_m: [1, 1, 1]}}, rpy_rad: [0, 0, 1], " +
               motion,
       }) {
    try {
      load(text);
      ADD_FAILURE() << "was accepted: " << text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), path + ": 'b' is not a box along the axes, as published ones are");
    }
  }
}

}  // namespace
}  // namespace sidestep::bench::reproduce_scenes_test
