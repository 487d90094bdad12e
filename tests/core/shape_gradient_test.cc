#include "sidestep/core/shape_gradient.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "sidestep/core/convex_polytope.h"
#include "sidestep/core/random.h"
#include "tests/support/random_points.h"

namespace sidestep::shape_gradient_test {
namespace {

struct Case {
  std::string name;
  Shape shape;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

Shape RandomMesh() {
  RandomStream random(1, "corners");
  std::vector<Eigen::Vector3d> points;
  for (int n = 0; n < 30; ++n) points.push_back(UniformPoint(random, 0.4));
  return ConvexMesh{std::make_shared<const ConvexPolytope>(points)};
}

class GradientOfEveryShape : public ::testing::TestWithParam<Case> {};

TEST_P(GradientOfEveryShape, HasTheGradientOfItsDistance) {
  RandomStream random(1, GetParam().name);
  constexpr double kStep_m = 1e-6;
  int num_smooth = 0;
  for (int n = 0; n < 3000; ++n) {
    const Eigen::Vector3d p =
        0.6 * Eigen::Vector3d(2 * random.Uniform() - 1, 2 * random.Uniform() - 1,
                              2 * random.Uniform() - 1);
    const Eigen::Vector3d gradient = DistanceGradient(GetParam().shape, p);
    EXPECT_NEAR(gradient.norm(), 1, 1e-9);
    const double here_m = SignedDistance(GetParam().shape, p);
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3d step = kStep_m * Eigen::Vector3d::Unit(a);
      const double above = SignedDistance(GetParam().shape, p + step) - here_m;
      const double below = here_m - SignedDistance(GetParam().shape, p - step);
      if (std::abs(above - below) > 1e-3 * kStep_m) continue;  // a crease
      ++num_smooth;
      ASSERT_NEAR(gradient(a), (above + below) / (2 * kStep_m), 2e-5) << "at " << p.transpose();
    }
  }
  EXPECT_GT(num_smooth, 8000);
}

TEST_P(GradientOfEveryShape, HasAGradientAlsoWhereSeveralSurfacePointsAreNearest) {
  for (const Eigen::Vector3d& p :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 0.1), Eigen::Vector3d(0, 0, 0.3)}) {
    EXPECT_NEAR(DistanceGradient(GetParam().shape, p).norm(), 1, 1e-9) << p.transpose();
  }
}

INSTANTIATE_TEST_SUITE_P(ShapeGradient, GradientOfEveryShape,
                         ::testing::Values(Case{"Box", Box{{0.3, 0.5, 0.2}}},
                                           Case{"Sheet", Box{{0.5, 0.02, 0.5}}},
                                           Case{"Sphere", Sphere{0.3}},
                                           Case{"Capsule", Capsule{0.1, 0.6}},
                                           Case{"Cylinder", Cylinder{0.2, 0.5}},
                                           Case{"Ellipsoid", Ellipsoid{{0.1, 0.2, 0.4}}},
                                           Case{"ConvexMesh", RandomMesh()}),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace sidestep::shape_gradient_test
