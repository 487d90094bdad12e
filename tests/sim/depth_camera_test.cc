#include <gtest/gtest.h>

#include <map>

#include "sidestep/sim/simulation.h"
#include "tests/sim/two_link.h"

namespace sidestep::sim::depth_camera_test {
namespace {

TEST(DepthCamera, NamesTheRayOfEachPointWhateverElseItSees) {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.robot.clear();
  scenario.static_obstacles = {{"wall", Pose::Translation({1.5, 0, 0.5}), Box{{0.1, 2, 1}}}};
  scenario.moving_obstacles = {
      Passing("ball", Sphere{0.2}, {0.5, -0.5, 0.5}, Eigen::Vector3d::UnitY(), 2)};
  scenarios::CameraSettings camera;
  camera.position_m = {-1, 0, 0.6};
  camera.look_at_m = {1, 0, 0.5};
  camera.width = 40;
  camera.height = 30;
  camera.noise_per_m = 0.01;
  camera.pixel_dropout = 0.2;
  scenario.sensor.name = "depth_camera";
  scenario.sensor.camera = camera;
  Simulation simulation(scenario, kTestModels);

  std::map<int, Eigen::Vector2d> ways;
  int again = 0;
  for (int n = 0; n < 10; ++n) {
    simulation.robot().AdvanceTo(simulation.sensor().NextDue());
    const auto scan = simulation.sensor().Read(simulation.world().time());
    ASSERT_TRUE(scan);
    ASSERT_EQ(scan->rays.size(), static_cast<std::size_t>(scan->p_CP.cols()));
    int last = -1;
    for (Eigen::Index c = 0; c < scan->p_CP.cols(); ++c) {
      const int ray = scan->rays[static_cast<std::size_t>(c)];
      EXPECT_GT(ray, last);
      EXPECT_LT(ray, 40 * 30);
      last = ray;
      const Eigen::Vector2d way = scan->p_CP.col(c).hnormalized();
      const auto [known, is_new] = ways.try_emplace(ray, way);
      again += is_new ? 0 : 1;
      EXPECT_LT((known->second - way).norm(), 1e-12);
    }
  }
  EXPECT_GT(again, 1000);
}

}  // namespace
}  // namespace sidestep::sim::depth_camera_test
