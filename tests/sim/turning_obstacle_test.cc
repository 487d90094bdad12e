// What turns on its way is simulated, seen, known and followed as such.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "sidestep/scenarios/scenario.h"
#include "sidestep/sdf/world_model.h"
#include "sidestep/sim/simulation.h"
#include "tests/sim/two_link.h"

namespace sidestep::sim::turning_obstacle_test {
namespace {

constexpr double kClamp_m = 0.3;

// A long box that drives round a circle, broadside on, with 1.2 rad/s.
scenarios::Scenario Turning() {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.robot.clear();
  scenario.grid = {{-1, -1, 0.02}, 0.04, {60, 60, 20}};
  scenarios::MovingObstacle obstacle;
  obstacle.name = "cart";
  obstacle.shape = Box{{0.23, 0.57, 0.4}};
  obstacle.rpy_rad = Eigen::Vector3d::Zero();
  obstacle.motion = scenarios::CircleMotion{
      {0.2, 0.2, 0.4}, 0.5, 0, false, 0.6, std::numeric_limits<double>::infinity(), 0};
  obstacle.faces_path = true;
  scenario.moving_obstacles = {obstacle};
  scenario.sensor.cells = CellRule::kCentre;  // cells are counted against the centres
  return scenario;
}

// The same by a recorded track whose samples say how it is turned, and tilted a little.
scenarios::Scenario Tilting() {
  scenarios::Scenario scenario = Turning();
  std::vector<scenarios::TrackSample> samples;
  for (int n = 0; n <= 40; ++n) {
    const EpisodeTime t(0.1 * n);
    const Pose X_WO = PoseAt(scenario.moving_obstacles[0], t);
    const Pose tilt = Pose::FromRollPitchYaw({0.3, -0.2, 0}, {0, 0, 0});
    samples.push_back({t.seconds(), X_WO.translation(), (X_WO * tilt).rotation()});
  }
  scenarios::RecordedMotion motion;
  motion.track = std::make_shared<const scenarios::RecordedTrack>(samples);
  motion.speed_m_s = motion.track->mean_speed_m_s();
  motion.stop_at_s = std::numeric_limits<double>::infinity();
  scenario.moving_obstacles[0].motion = motion;
  scenario.moving_obstacles[0].faces_path = false;
  return scenario;
}

double TrueDistance(const scenarios::MovingObstacle& obstacle, const Eigen::Vector3d& p_W,
                    EpisodeTime t) {
  return SignedDistance(obstacle.shape, PoseAt(obstacle, t).Inverse() * p_W);
}

using Visit = std::function<void(const Scan&)>;

void WatchScans(Simulation& simulation, double until_s, const Visit& visit) {
  while (simulation.sensor().NextDue().seconds() <= until_s) {
    simulation.robot().AdvanceTo(simulation.sensor().NextDue());
    if (const auto scan = simulation.sensor().Read(simulation.world().time())) visit(*scan);
  }
}

TEST(TurningObstacle, FillsTheCellsWhoseCentresAreInItAsItIsTurned) {
  for (const scenarios::Scenario& scenario : {Turning(), Tilting()}) {
    const scenarios::MovingObstacle& obstacle = scenario.moving_obstacles[0];
    Simulation simulation(scenario, kTestModels);
    WatchScans(simulation, 1.5, [&](const Scan& scan) {
      std::set<std::size_t> seen;
      for (const auto& p_CP : scan.p_CP.colwise()) {
        const Eigen::Vector3d cell =
            (scan.X_WC * p_CP - scenario.grid.first_center_m) / scenario.grid.cell_m;
        seen.insert(scenario.grid.Index(static_cast<int>(std::lround(cell.x())),
                                        static_cast<int>(std::lround(cell.y())),
                                        static_cast<int>(std::lround(cell.z()))));
      }
      ASSERT_GT(seen.size(), 400u);
      for (std::size_t cell = 0; cell < scenario.grid.num_cells(); ++cell) {
        const double distance_m = TrueDistance(obstacle, scenario.grid.CenterOf(cell), scan.t);
        if (std::abs(distance_m) < 1e-6) continue;
        ASSERT_EQ(seen.count(cell) > 0, distance_m < 0) << "at " << scan.t.seconds() << " s";
      }
    });
  }
}

TEST(TurningObstacle, IsWhereItWillBeTurnedToUnderFullKnowledge) {
  for (const scenarios::Scenario& scenario : {Turning(), Tilting()}) {
    const scenarios::MovingObstacle& obstacle = scenario.moving_obstacles[0];
    Simulation simulation(scenario, kTestModels);
    sdf::WorldModelOptions options;
    options.knowledge = sdf::Knowledge::kFullKnowledge;
    options.grid = scenario.grid;
    options.max_distance_m = kClamp_m;
    options.true_obstacles = {
        {obstacle.shape, [obstacle](EpisodeTime t) { return PoseAt(obstacle, t); }}};
    const auto model = sdf::MakeWorldModel(options);
    WatchScans(simulation, 0.5, [&](const Scan& scan) { model->Observe(scan); });
    const auto field = model->MakeField();
    int num_near = 0;
    for (const double t_s : {0.5, 1.1, 2.6}) {
      for (std::size_t cell = 0; cell < scenario.grid.num_cells(); cell += 17) {
        const Eigen::Vector3d p_W = scenario.grid.CenterOf(cell);
        const double want = TrueDistance(obstacle, p_W, EpisodeTime(t_s));
        if (want > 0.2) continue;
        ++num_near;
        // Between cell centres the box's edges are a little rounded.
        EXPECT_NEAR(field->Sample(p_W, EpisodeTime(t_s)).distance_m, want, 0.5 * 0.04);
      }
    }
    EXPECT_GT(num_near, 500);
  }
}

TEST(TurningObstacle, IsFollowedFromItsCellsAsOneThing) {
  const scenarios::Scenario scenario = Turning();
  Simulation simulation(scenario, kTestModels);
  sdf::WorldModelOptions options;
  options.grid = scenario.grid;
  options.max_distance_m = kClamp_m;
  const auto model = sdf::MakeWorldModel(options);
  std::vector<std::string> story;
  double worst_m = 0;
  WatchScans(simulation, 3, [&](const Scan& scan) {
    model->Observe(scan);
    for (const TrackEvent& event : model->TakeEvents()) story.push_back(event.what);
    model->MakeField();
    for (const PredictedObject& object : model->DescribeObjects({scan.t})) {
      EXPECT_LT(object.X_WO[0].rotation().vec().norm(), 1e-12);  // cells tell no orientation
      const Eigen::Vector3d p_WO = PoseAt(scenario.moving_obstacles[0], scan.t).translation();
      worst_m = std::max(worst_m, (object.X_WO[0].translation() - p_WO).norm());
    }
  });
  EXPECT_EQ(story, (std::vector<std::string>{"appeared", "moved"}));
  EXPECT_LT(worst_m, 0.04);
}

}  // namespace
}  // namespace sidestep::sim::turning_obstacle_test
