#include "sidestep/sim/occupancy_sensor.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sidestep/sim/simulation.h"
#include "tests/sim/two_link.h"

namespace sidestep::sim::occupancy_sensor_test {
namespace {

scenarios::Scenario BusyScenario() {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.static_obstacles = {{"shelf", Pose::Translation({0, 0.7, 0.4}), Box{{0.4, 0.2, 0.3}}},
                               {"pole", Pose::Translation({-0.5, -0.5, 0.5}), Box{{0.1, 0.1, 1}}}};
  scenario.moving_obstacles = {
      Passing("cart", Box{{0.48, 0.55, 0.4}}, {0.3, 0.9, 0.6}, {0, -1, 0}, 1.4),
      Passing("bead", Sphere{0.15}, {-0.9, 0.7, 0.3}, {1, 0, 0}, 0.5)};  // into the shelf
  return scenario;
}

OccupancyGrid GridOf(const Scan& scan, const GridSpec& spec) {
  OccupancyGrid grid(spec);
  for (Eigen::Index i = 0; i < scan.p_CP.cols(); ++i) {
    const auto cell = spec.CellOf(scan.X_WC * scan.p_CP.col(i));
    grid.cells[spec.Index(cell[0], cell[1], cell[2])] = 1;
  }
  return grid;
}

class OccupancySensorBy : public testing::TestWithParam<CellRule> {};

TEST_P(OccupancySensorBy, SeesTheCentresOfTheCellsThatAreFilledAtItsTime) {
  scenarios::Scenario scenario = BusyScenario();
  scenario.sensor.cells = GetParam();
  Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  for (int k = 0; k < 20; ++k) {
    simulation.robot().AdvanceTo(simulation.sensor().NextDue());
    const std::optional<Scan> scan = simulation.sensor().Read(simulation.world().time());
    ASSERT_TRUE(scan.has_value());
    // The world as the scenario has it at the scan's time, rasterised from nothing.
    scenarios::Scenario then = scenario;
    for (scenarios::MovingObstacle& obstacle : then.moving_obstacles) {
      std::get<scenarios::LinearMotion>(obstacle.motion).start_m =
          PoseAt(obstacle, scan->t).translation();
    }
    const Simulation still(then, TwoLink(then), kTestModels);
    const OccupancyGrid wanted = RasteriseWorld(still.world().model(), still.world().data(),
                                                scenario.grid, scenario.sensor.cells);
    EXPECT_EQ(GridOf(*scan, scenario.grid).cells, wanted.cells) << "capture " << k;
    EXPECT_EQ(static_cast<std::size_t>(scan->p_CP.cols()), wanted.CountFilled());  // none twice
  }
}

INSTANTIATE_TEST_SUITE_P(Rules, OccupancySensorBy,
                         testing::Values(CellRule::kTouched, CellRule::kCentre));

TEST(OccupancySensor, CapturesAtItsRateOnTicksOfTheWorld) {
  const scenarios::Scenario scenario = BusyScenario();
  Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  for (int k = 0; k < 40; ++k) {
    const EpisodeTime due = simulation.sensor().NextDue();
    EXPECT_GE(due.seconds(), k / 30.0 - 1e-9);
    EXPECT_LT(due.seconds(), k / 30.0 + 1e-3);
    if (k > 0) {
      simulation.robot().AdvanceTo(EpisodeTime(due.seconds() - 0.001));
      EXPECT_FALSE(simulation.sensor().Read(simulation.world().time()).has_value());
    }
    simulation.robot().AdvanceTo(due);
    EXPECT_EQ(simulation.sensor().Read(simulation.world().time())->t, due);
    EXPECT_EQ(simulation.robot().Read().t, due);
    EXPECT_FALSE(simulation.sensor().Read(simulation.world().time()).has_value());
  }
}

TEST(OccupancySensor, SkipsCapturesThatWereMissed) {
  const scenarios::Scenario scenario = BusyScenario();
  Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  simulation.robot().AdvanceTo(EpisodeTime(0.25));
  EXPECT_EQ(simulation.sensor().Read(simulation.world().time())->t, EpisodeTime(0.25));
  EXPECT_FALSE(simulation.sensor().Read(simulation.world().time()).has_value());
  EXPECT_EQ(simulation.sensor().NextDue(), EpisodeTime(0.267));  // 8 / 30 s
}

}  // namespace
}  // namespace sidestep::sim::occupancy_sensor_test
