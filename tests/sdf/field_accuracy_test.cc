// How far fields of 4 cm cells are from the truth: shapes at any position and turned any way, asked
// anywhere within the margin, against their closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <ostream>
#include <vector>

#include "sidestep/core/shape.h"
#include "sidestep/sdf/composite_field.h"
#include "sidestep/sdf/map/object_field.h"
#include "tests/support/random_points.h"

namespace sidestep::sdf::field_accuracy_test {
namespace {

constexpr double kCell_m = 0.04;
constexpr double kMargin_m = 0.4;

// How the field of a shape is made.
enum class MadeFrom { kClosedForm, kCells };

struct Case {
  const char* name;
  Shape shape;
  MadeFrom made_from = MadeFrom::kClosedForm;
};
std::ostream& operator<<(std::ostream& stream, const Case& c) { return stream << c.name; }

// Made from cells, only boxes of whole cells are what their cells are.
SdfGrid FieldOf(const Case& c) {
  if (c.made_from == MadeFrom::kClosedForm) return MakeShapeField(c.shape, kCell_m, kMargin_m);
  const Eigen::Vector3d size_m = std::get<Box>(c.shape).size_m;
  GridSpec spec{(Eigen::Vector3d::Constant(kCell_m) - size_m) / 2, kCell_m, {}};
  for (std::size_t a = 0; a < 3; ++a) {
    spec.size[a] = static_cast<int>(std::lround(size_m(static_cast<Eigen::Index>(a)) / kCell_m));
  }
  OccupancyGrid cells(spec);
  std::fill(cells.cells.begin(), cells.cells.end(), 1);
  return MakeObjectField(cells, kMargin_m);
}

double Quantile99(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() * 99 / 100];
}

class FieldAccuracy : public ::testing::TestWithParam<Case> {
 protected:
  RandomStream random_{6, "poses and points"};
};

TEST_P(FieldAccuracy, IsWithinMillimetresInFreeSpaceWhereverTheShapeStands) {
  const auto field_O = std::make_shared<const SdfGrid>(FieldOf(GetParam()));
  const auto nothing = std::make_shared<const SdfGrid>(
      GridSpec{Eigen::Vector3d::Constant(-1), 2, {2, 2, 2}}, AlignedVector<float>(8, 1.0F));
  const double reach_m = HalfExtents(GetParam().shape).norm() + kMargin_m;
  std::vector<double> inside_m, near_m, margin_m;  // errors, by the true distance
  for (int n = 0; n < 100; ++n) {
    const Eigen::Vector3d rpy_rad = UniformPoint(random_, M_PI);
    const Pose X_WO = Pose::FromRollPitchYaw(rpy_rad, UniformPoint(random_, 0.1));
    const CompositeField field(nothing, {{field_O, [&](EpisodeTime) { return X_WO; }}}, kMargin_m);
    for (int m = 0; m < 2000; ++m) {
      const Eigen::Vector3d p_WQ = X_WO * UniformPoint(random_, reach_m);
      const double exact_m = SignedDistance(GetParam().shape, X_WO.Inverse() * p_WQ);
      const double error_m = std::abs(field.Sample(p_WQ, EpisodeTime(0)).distance_m - exact_m);
      if (exact_m > kMargin_m - kCell_m) continue;
      (exact_m < 0 ? inside_m : exact_m <= 1.75 * kCell_m ? near_m : margin_m).push_back(error_m);
    }
  }
  ASSERT_GT(near_m.size(), 500u);
  ASSERT_GT(margin_m.size(), 10000u);
  EXPECT_LE(Quantile99(near_m), 0.010);
  EXPECT_LE(Quantile99(margin_m), 0.003);
  std::printf("p99 of the error [mm]: %.2f from 1.75 cells on, %.2f nearer, %.2f inside\n",
              1e3 * Quantile99(margin_m), 1e3 * Quantile99(near_m), 1e3 * Quantile99(inside_m));
}

INSTANTIATE_TEST_SUITE_P(
    Shape, FieldAccuracy,
    ::testing::Values(Case{"Box", Box{{0.48, 0.55, 0.7}}}, Case{"Plate", Box{{0.6, 0.4, 0.05}}},
                      Case{"Sphere", Sphere{0.2}}, Case{"SmallSphere", Sphere{0.06}},
                      Case{"Capsule", Capsule{0.1, 0.3}}, Case{"Cylinder", Cylinder{0.15, 0.4}},
                      Case{"Ellipsoid", Ellipsoid{{0.1, 0.2, 0.3}}},
                      Case{"Pillar", Box{{0.2, 0.2, 0.84}}, MadeFrom::kCells},
                      Case{"Cube", Box{{0.2, 0.24, 0.2}}, MadeFrom::kCells}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace sidestep::sdf::field_accuracy_test
