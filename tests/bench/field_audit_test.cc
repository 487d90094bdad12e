// The audit finds the errors that a field was given, where it was given them.
#include "sidestep/bench/field_audit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <stdexcept>
#include <vector>

#include "sidestep/sdf/shape_field.h"

namespace sidestep::bench::field_audit_test {
namespace {

constexpr double kClamp_m = 0.3, kCell_m = 0.04;

// A cube of 0.4 m at rest, and a ball that flies along x at 1 m/s.
scenarios::Scenario MakeScenario() {
  scenarios::Scenario scenario;
  scenario.grid = {Eigen::Vector3d::Constant(-0.8), kCell_m, {41, 41, 41}};
  scenario.static_obstacles = {{"cube", Pose(), Box{Eigen::Vector3d::Constant(0.4)}}};
  scenario.floor_m = -9;
  scenario.seed = 5;
  return scenario;
}

Eigen::Vector3d BallCenter(EpisodeTime t) { return {t.seconds() - 0.6, 0.5, 0}; }
constexpr double kBallRadius_m = 0.1;

class FlyingBall final : public robot::WorldTruth {
 public:
  std::vector<ObjectObservation> ObstaclesAt(EpisodeTime t) const override {
    ObjectObservation ball;
    ball.t = t;
    ball.X_WO = Pose::Translation(BallCenter(t));
    ball.shape = Sphere{kBallRadius_m};
    return {ball};
  }
  std::vector<TruthSample> TakeSamples() override { return {}; }
};

double CubeDistance(const Eigen::Vector3d& p) {
  const Eigen::Vector3d q = p.cwiseAbs().array() - 0.2;
  return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
}
double Truth(const Eigen::Vector3d& p, EpisodeTime t) {
  return std::min(CubeDistance(p), (p - BallCenter(t)).norm() - kBallRadius_m);
}

// The truth, falsified as a test wants it.
class FalseField final : public sdf::DistanceField {
 public:
  using Error = std::function<double(double truth_m, const Eigen::Vector3d& p_W, EpisodeTime t)>;
  explicit FalseField(Error error, Eigen::AngleAxisd turn = Eigen::AngleAxisd::Identity())
      : error_(std::move(error)), turn_(turn) {}

  sdf::DistanceSample Sample(const Eigen::Vector3d& p_WQ, EpisodeTime t) const override {
    const double truth_m = Truth(p_WQ, t);
    sdf::DistanceSample sample;
    sample.distance_m = std::min(truth_m, kClamp_m) + error_(truth_m, p_WQ, t);
    constexpr double kStep_m = 1e-6;
    for (int a = 0; a < 3; ++a) {
      const Eigen::Vector3d step = kStep_m * Eigen::Vector3d::Unit(a);
      sample.gradient_W(a) = (Truth(p_WQ + step, t) - Truth(p_WQ - step, t)) / (2 * kStep_m);
    }
    sample.gradient_W = turn_ * sample.gradient_W;
    return sample;
  }
  double max_distance_m() const override { return kClamp_m; }

 private:
  Error error_;
  Eigen::AngleAxisd turn_;
};

struct Zone {
  AuditZone zone;
  double from_m, to_m;
};
const Zone kZones[] = {{AuditZone::kInside, -1, 0},
                       {AuditZone::kNear, 0, 1.75 * kCell_m},
                       {AuditZone::kMargin, 1.75 * kCell_m, kClamp_m - kCell_m},
                       {AuditZone::kEdge, kClamp_m - kCell_m, kClamp_m},
                       {AuditZone::kBeyond, kClamp_m, 100}};

// In millimetres: another in each zone.
double ErrorOf(double truth_m) {
  for (int n = 0; n < 5; ++n) {
    if (truth_m < kZones[n].to_m) return n + 1;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

TEST(FieldAudit, FindsTheErrorOfEachZone) {
  FieldAudit audit(MakeScenario(), {0, 0.4}, 4000);
  const FalseField field(
      [](double truth_m, const Eigen::Vector3d&, EpisodeTime) { return -1e-3 * ErrorOf(truth_m); });
  for (const double t_s : {0.0, 0.2}) audit.Look(EpisodeTime(t_s), field, FlyingBall());
  const std::vector<AuditRow> rows = audit.Rows();
  ASSERT_EQ(rows.size(), 10u);
  std::map<double, std::size_t> num_points;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    SCOPED_TRACE(ToString(rows[n].zone));
    EXPECT_EQ(rows[n].ahead_s, n < 5 ? 0 : 0.4);
    EXPECT_EQ(rows[n].zone, kAllAuditZones[n % 5]);
    const double error_m = 1e-3 * static_cast<double>(n % 5 + 1);
    EXPECT_NEAR(rows[n].median_m, error_m, 1e-12);
    EXPECT_NEAR(rows[n].p99_m, error_m, 1e-12);
    EXPECT_NEAR(rows[n].max_m, error_m, 1e-12);
    EXPECT_GT(rows[n].num_points, 100u);
    num_points[rows[n].ahead_s] += rows[n].num_points;
  }
  EXPECT_EQ(num_points[0], 8000u);  // each point at each of two cycles
  EXPECT_EQ(num_points[0.4], 8000u);
}

TEST(FieldAudit, MeasuresTheAngleBetweenGradientsWhereBothMeanSomething) {
  FieldAudit audit(MakeScenario(), {0}, 4000);
  const double angle_deg = 12;
  audit.Look(
      EpisodeTime(0),
      FalseField([](double, const Eigen::Vector3d&, EpisodeTime) { return 0; },
                 Eigen::AngleAxisd(angle_deg * M_PI / 180, Eigen::Vector3d(1, 1, 1).normalized())),
      FlyingBall());
  for (const AuditRow& row : audit.Rows()) {
    const bool counts = row.zone == AuditZone::kNear || row.zone == AuditZone::kMargin;
    EXPECT_EQ(std::isnan(row.gradient_max_deg), !counts) << ToString(row.zone);
    if (!counts) continue;
    EXPECT_LE(row.gradient_max_deg, angle_deg + 0.1);  // less where the gradient is near the axis
    EXPECT_GT(row.gradient_median_deg, angle_deg / 2);
  }
}

TEST(FieldAudit, NamesTheMostWrongPlaceOutsideSolidsAndItsTime) {
  // Off by most inside the cube, and next to that in a corner of free space after 0.3 s.
  const auto is_corner = [](const Eigen::Vector3d& p, EpisodeTime t) {
    return t.seconds() > 0.3 && p.minCoeff() > 0.5;
  };
  FieldAudit audit(MakeScenario(), {0, 0.5}, 3000);
  const FalseField field([&](double truth_m, const Eigen::Vector3d& p, EpisodeTime t) {
    return truth_m < 0 ? 0.5 : is_corner(p, t) ? -0.2 : 0.001;
  });
  audit.Look(EpisodeTime(0.1), field, FlyingBall());
  const AuditPlace& worst = audit.worst();
  EXPECT_EQ(worst.t_cycle, EpisodeTime(0.1));
  EXPECT_EQ(worst.t, EpisodeTime(0.6));
  EXPECT_TRUE(is_corner(worst.p_W, worst.t));
  EXPECT_NEAR(worst.truth_m, std::min(Truth(worst.p_W, worst.t), kClamp_m), 1e-12);
  EXPECT_NEAR(worst.field_m, std::min(worst.truth_m, kClamp_m) - 0.2, 1e-12);

  const AuditGrids& grids = audit.worst_grids();
  EXPECT_EQ(grids.field_W.spec(), MakeScenario().grid);
  for (const auto& [i, j, k] : {std::array{0, 0, 0}, {20, 20, 20}, {40, 40, 40}, {20, 32, 21}}) {
    const Eigen::Vector3d p_W = grids.field_W.spec().Center(i, j, k);
    EXPECT_NEAR(grids.truth_W.At(i, j, k), std::min(Truth(p_W, worst.t), kClamp_m), 1e-6);
    EXPECT_NEAR(grids.field_W.At(i, j, k), field.Sample(p_W, worst.t).distance_m, 1e-6);
  }
}

TEST(FieldAudit, TellsHowMuchTooFarTheFieldSaidApartFromTooNear) {
  for (const double off_m : {-0.02, 0.01}) {
    FieldAudit audit(MakeScenario(), {0}, 2000);
    const FalseField field([&](double, const Eigen::Vector3d&, EpisodeTime) { return off_m; });
    audit.Look(EpisodeTime(0), field, FlyingBall());
    for (const AuditRow& row : audit.Rows()) {
      EXPECT_NEAR(row.max_m, std::abs(off_m), 1e-12);
      EXPECT_NEAR(row.too_far_max_m, std::max(off_m, 0.0), 1e-12);
    }
  }
}

TEST(FieldAudit, HoldsTheFloorForTrue) {
  scenarios::Scenario scenario = MakeScenario();
  scenario.floor_m = -0.55;
  const auto with_floor = [&](const Eigen::Vector3d& p, double truth_m) {
    return std::min({truth_m, p.z() + 0.55, kClamp_m}) - std::min(truth_m, kClamp_m);
  };
  FieldAudit audit(scenario, {0}, 3000);
  audit.Look(EpisodeTime(0), FalseField([&](double truth_m, const Eigen::Vector3d& p, EpisodeTime) {
               return with_floor(p, truth_m);
             }),
             FlyingBall());
  for (const AuditRow& row : audit.Rows()) EXPECT_NEAR(row.max_m, 0, 1e-12) << ToString(row.zone);
}

TEST(FieldAudit, OfAWorldWithoutAnythingHasNoErrorAndNoInfinity) {
  scenarios::Scenario scenario = MakeScenario();
  scenario.static_obstacles.clear();
  class Nothing final : public robot::WorldTruth {
   public:
    std::vector<ObjectObservation> ObstaclesAt(EpisodeTime) const override { return {}; }
    std::vector<TruthSample> TakeSamples() override { return {}; }
  };
  FieldAudit audit(scenario, {0}, 100);
  audit.Look(EpisodeTime(0), sdf::ShapeField({}, {}, kClamp_m), Nothing());
  ASSERT_EQ(audit.Rows().size(), 1u);
  EXPECT_EQ(audit.Rows()[0].zone, AuditZone::kBeyond);
  EXPECT_EQ(audit.Rows()[0].max_m, 0);
  EXPECT_EQ(audit.worst().field_m, kClamp_m);
  EXPECT_EQ(audit.worst().truth_m, kClamp_m);
}

TEST(FieldAudit, RefusesTimesInThePastAndNoPoints) {
  EXPECT_THROW(FieldAudit(MakeScenario(), {}, 10), std::invalid_argument);
  EXPECT_THROW(FieldAudit(MakeScenario(), {0, -1}, 10), std::invalid_argument);
  EXPECT_THROW(FieldAudit(MakeScenario(), {std::nan("")}, 10), std::invalid_argument);
  EXPECT_THROW(FieldAudit(MakeScenario(), {0}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::bench::field_audit_test
