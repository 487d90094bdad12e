#include "sidestep/sim/geom_shift.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/small_model.h"
#include "tests/support/random_points.h"

namespace sidestep::sim::geom_shift_test {
namespace {

// A bar of 0.6 m, whose ends come furthest when it turns, and a floor.
SmallModel BarOverFloor() {
  return SmallModel(
      "<geom type='plane' size='1 1 1'/>"
      "<body mocap='true'><geom type='box' size='0.3 0.02 0.01'/></body>");
}

TEST(GeomShift, IsNoLessThanAnyPointOfTheGeomHasCome) {
  SmallModel world = BarOverFloor();
  RandomStream random(1, "poses");
  for (int i = 0; i < 200; ++i) {
    const Pose before = RandomPose(random, 0.5);
    const bool across = i % 2 == 0;  // to the bar
    const double small = std::pow(10, random.Uniform(-6, 0));
    const Eigen::Vector3d axis =
        across ? Eigen::Vector3d::UnitZ() : UniformPoint(random, 1).normalized();
    const Pose after(before.rotation() * Eigen::Quaterniond(Eigen::AngleAxisd(small, axis)),
                     before.translation() + UniformPoint(random, small));
    world.Place(0, before);
    GeomShift shift(*world.model, {0, 1});
    EXPECT_TRUE(std::isinf(shift.Most_m(*world.data)));
    shift.Begin(*world.data);
    EXPECT_EQ(shift.Most_m(*world.data), 0);
    world.Place(0, after);
    double furthest_m = 0;
    for (const double x : {-0.3, 0.3}) {
      for (const double y : {-0.02, 0.02}) {
        for (const double z : {-0.01, 0.01}) {
          const Eigen::Vector3d corner(x, y, z);
          furthest_m = std::max(furthest_m, (after * corner - before * corner).norm());
        }
      }
    }
    EXPECT_GE(shift.Most_m(*world.data), furthest_m);
    if (across) {
      EXPECT_LE(shift.Most_m(*world.data), 4 * furthest_m + 1e-12) << "far more than it is";
    }
  }
}

TEST(GeomShift, KnowsNoBoundForAPlaneThatTurns) {
  SmallModel world("<body mocap='true'><geom type='plane' size='1 1 1'/></body>");
  GeomShift shift(*world.model, {0});
  shift.Begin(*world.data);
  world.Place(0, Pose::Translation({0, 0, 0.1}));
  EXPECT_DOUBLE_EQ(shift.Most_m(*world.data), 0.1);
  world.Place(0, Pose(Eigen::Quaterniond(Eigen::AngleAxisd(1e-3, Eigen::Vector3d::UnitX())),
                      Eigen::Vector3d::Zero()));
  EXPECT_TRUE(std::isinf(shift.Most_m(*world.data)));
}

}  // namespace
}  // namespace sidestep::sim::geom_shift_test
