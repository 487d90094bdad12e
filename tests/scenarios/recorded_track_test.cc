#include "sidestep/scenarios/recorded_track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sidestep/core/random.h"

namespace sidestep::scenarios::recorded_track_test {
namespace {

using Rows = std::vector<std::vector<double>>;

constexpr double kPi = std::numbers::pi;

RecordedTrack TrackOf(const Rows& rows) {
  std::vector<TrackSample> samples;
  for (const std::vector<double>& row : rows) {
    const auto fault = AppendSample(row, &samples);
    EXPECT_FALSE(fault) << fault->column << " " << fault->why;
  }
  return RecordedTrack(samples);
}

Rows Sampled(double rate_hz, double until_s, const std::function<Eigen::Vector3d(double)>& p_WO) {
  Rows rows;
  for (int n = 0; n <= std::lround(rate_hz * until_s); ++n) {
    const double t_s = n / rate_hz;
    const Eigen::Vector3d p = p_WO(t_s);
    rows.push_back({t_s, p.x(), p.y(), p.z()});
  }
  return rows;
}

Eigen::Vector3d OnCircle(double t_s) {  // 1.2 m/s, radius 1 m, counter-clockwise
  return {std::cos(1.2 * t_s), std::sin(1.2 * t_s), 0.85};
}

// A walk on random legs of random duration, with pauses, a corner and a way back.
Rows RoughWalk() {
  RandomStream random(3, "rough walk");
  Rows rows = {{0.2, 0, 0, 1}};
  for (int n = 0; n < 40; ++n) {
    std::vector<double> row = rows.back();
    row[0] += 0.02 + 0.2 * random.Uniform();
    if (n % 7 < 5) {
      for (std::size_t axis = 1; axis < 4; ++axis) row[axis] += 0.3 * (random.Uniform() - 0.5);
    }
    rows.push_back(row);
  }
  for (const auto& [x, y] : {std::pair(1.0, 0.0), {1.0, 1.0}, {0.2, 1.0}, {1.0, 1.0}}) {
    rows.push_back({rows.back()[0] + 0.5, x, y, 1});
  }
  return rows;
}

Eigen::Vector3d PointOf(const std::vector<double>& row) { return {row[1], row[2], row[3]}; }

double AngleBetween(double a_rad, double b_rad) {
  return std::abs(std::remainder(a_rad - b_rad, 2 * kPi));
}

TEST(RecordedTrack, PassesExactlyThroughItsSamples) {
  const Rows rows = RoughWalk();
  const RecordedTrack track = TrackOf(rows);
  for (const auto& row : rows) EXPECT_EQ(track.Position(row[0]), PointOf(row));
}

TEST(RecordedTrack, RestsBeforeItsFirstSampleAndAfterItsLast) {
  const Rows rows = RoughWalk();
  const RecordedTrack track = TrackOf(rows);
  for (const double t_s : {-5.0, 0.0, 0.2}) {
    EXPECT_EQ(track.Position(t_s), PointOf(rows.front()));
    EXPECT_EQ(track.Velocity(t_s), Eigen::Vector3d(0, 0, 0));
  }
  for (const double t_s : {rows.back()[0], 1e3}) {
    EXPECT_EQ(track.Position(t_s), PointOf(rows.back()));
    EXPECT_EQ(track.Velocity(t_s), Eigen::Vector3d(0, 0, 0));
  }
}

TEST(RecordedTrack, HasTheVelocityOfItsFiniteDifferencesOnBothSidesOfEachMoment) {
  const Rows rows = RoughWalk();
  const RecordedTrack track = TrackOf(rows);
  constexpr double kStep_s = 1e-6;
  std::vector<double> times_s;
  for (const auto& row : rows) times_s.push_back(row[0]);
  for (double t_s = 0; t_s < rows.back()[0] + 0.3; t_s += 0.0037) times_s.push_back(t_s);
  for (const double t_s : times_s) {
    const Eigen::Vector3d v = track.Velocity(t_s);
    const Eigen::Vector3d before = (track.Position(t_s) - track.Position(t_s - kStep_s)) / kStep_s;
    const Eigen::Vector3d after = (track.Position(t_s + kStep_s) - track.Position(t_s)) / kStep_s;
    EXPECT_LT((before - v).norm(), 1e-3) << t_s;  // accelerations are below 2 km/s^2
    EXPECT_LT((after - v).norm(), 1e-3) << t_s;
  }
}

TEST(RecordedTrack, HasTheVelocityOfItsCentralDifferencesBetweenSamples) {
  const RecordedTrack track = TrackOf(Sampled(10, 3, OnCircle));
  constexpr double kStep_s = 1e-5;
  for (double t_s = 0.005; t_s < 3; t_s += 0.01) {
    const Eigen::Vector3d difference =
        (track.Position(t_s + kStep_s) - track.Position(t_s - kStep_s)) / (2 * kStep_s);
    EXPECT_LT((difference - track.Velocity(t_s)).norm(), 1e-7) << t_s;
  }
}

TEST(RecordedTrack, NeitherTurnsBackNorOvershootsOnItsWayFromSampleToSample) {
  const Rows rows = RoughWalk();
  const RecordedTrack track = TrackOf(rows);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const Eigen::Vector3d a = PointOf(rows[i - 1]), chord = PointOf(rows[i]) - a;
    const double begin_s = rows[i - 1][0], interval_s = rows[i][0] - begin_s;
    double furthest = 0;
    for (int n = 0; n <= 100; ++n) {
      const Eigen::Vector3d p = track.Position(begin_s + 0.01 * n * interval_s) - a;
      if (chord.isZero(0)) {
        EXPECT_EQ(p, Eigen::Vector3d(0, 0, 0));  // a pause is exact rest
        continue;
      }
      const double along = p.dot(chord) / chord.squaredNorm();
      EXPECT_GE(along, furthest - 1e-12);
      EXPECT_LE(along, 1 + 1e-12);
      furthest = along;
      // The most that two velocities of 3 times the chord's can bend it aside.
      EXPECT_LE((p - along * chord).norm(), (0.75 + 1e-12) * chord.norm());
    }
  }
}

TEST(RecordedTrack, StopsWhereItTurnsRound) {
  const RecordedTrack track =
      TrackOf({{0, 0, 0, 0}, {1, 1, 0, 0}, {2, 2, 0, 0}, {3, 1.5, 0, 0}, {4, 0, 0, 0}});
  EXPECT_LT(track.Velocity(2).norm(), 1e-12);
  for (double t_s = 1; t_s < 3; t_s += 0.01) EXPECT_LE(track.Position(t_s).x(), 2);
}

TEST(RecordedTrack, DoesNotDependOnTheAxes) {
  Rows rows = RoughWalk();
  const RecordedTrack track = TrackOf(rows);
  const Eigen::Quaterniond R = Eigen::Quaterniond(0.8, 0.1, -0.3, 0.5).normalized();
  for (auto& row : rows) {
    const Eigen::Vector3d p = R * PointOf(row);
    row = {row[0], p.x(), p.y(), p.z()};
  }
  const RecordedTrack turned = TrackOf(rows);
  for (double t_s = 0; t_s < rows.back()[0]; t_s += 0.013) {
    EXPECT_LT((turned.Position(t_s) - R * track.Position(t_s)).norm(), 1e-12);
  }
}

TEST(RecordedTrack, FollowsASteadyLineExactlyOnceUnderWay) {
  const RecordedTrack track =
      TrackOf(Sampled(10, 2, [](double t_s) { return Eigen::Vector3d(1.3 * t_s, 0, 1); }));
  for (double t_s = 0.1; t_s < 1.9; t_s += 0.007) {
    EXPECT_NEAR(track.Position(t_s).x(), 1.3 * t_s, 1e-12);
    EXPECT_NEAR(track.Velocity(t_s).x(), 1.3, 1e-12);
  }
  EXPECT_NEAR(track.mean_speed_m_s(), 1.3, 1e-12);
}

TEST(RecordedTrack, HasTheVelocityOfAParabolaAtSamplesAnyTimeApart) {
  const auto parabola = [](double t_s) { return Eigen::Vector3d(t_s, 0.5 * t_s * t_s, 0); };
  Rows rows;
  for (const double t_s : {0.0, 0.1, 0.4, 0.45, 0.8, 1.0}) {
    const Eigen::Vector3d p = parabola(t_s);
    rows.push_back({t_s, p.x(), p.y(), p.z()});
  }
  const RecordedTrack track = TrackOf(rows);
  for (const double t_s : {0.1, 0.4, 0.45, 0.8}) {
    EXPECT_LT((track.Velocity(t_s) - Eigen::Vector3d(1, t_s, 0)).norm(), 1e-12) << t_s;
  }
  for (double t_s = 0.1; t_s < 0.8; t_s += 0.01) {
    EXPECT_LT((track.Position(t_s) - parabola(t_s)).norm(), 1e-12) << t_s;
  }
}

TEST(RecordedTrack, FollowsACurveSeenAtTenHertzToAMillimetreAndItsHeadingToADegree) {
  const RecordedTrack track = TrackOf(Sampled(10, 3, OnCircle));
  for (double t_s = 0.1; t_s < 2.9; t_s += 0.007) {
    EXPECT_LT((track.Position(t_s) - OnCircle(t_s)).norm(), 1e-3) << t_s;
    EXPECT_LT(AngleBetween(track.Heading(t_s), kPi / 2 + 1.2 * t_s), kPi / 180) << t_s;
  }
}

TEST(RecordedTrack, CountsNoPauseIntoItsMeanSpeed) {
  const RecordedTrack track =
      TrackOf({{0, 0, 0, 0}, {1, 2, 0, 0}, {9, 2, 0, 0}, {10, 2, 0, 0}, {11, 2, 4, 0}});
  EXPECT_DOUBLE_EQ(track.mean_speed_m_s(), 3);
  EXPECT_EQ(TrackOf({{0, 1, 0, 0}, {1, 1, 0, 0}}).mean_speed_m_s(), 0);
}

TEST(RecordedTrack, TurnsAsSampledByTheShorterWay) {
  const double half = std::sqrt(0.5);
  // The last is the second's double: the same orientation by another sign.
  const RecordedTrack track = TrackOf(
      {{0, 0, 0, 0, 1, 0, 0, 0}, {1, 0, 0, 0, half, 0, 0, half}, {2, 0, 0, 0, -half, 0, 0, -half}});
  EXPECT_EQ(track.Rotation(-1).coeffs(), Eigen::Quaterniond(1, 0, 0, 0).coeffs());
  EXPECT_EQ(track.Rotation(0).coeffs(), Eigen::Quaterniond(1, 0, 0, 0).coeffs());
  EXPECT_LT(track.Rotation(1).angularDistance(Eigen::Quaterniond(half, 0, 0, half)), 1e-12);
  for (const double t_s : {0.1, 0.5, 0.9}) {
    const Eigen::Quaterniond expected(Eigen::AngleAxisd(t_s * kPi / 2, Eigen::Vector3d::UnitZ()));
    EXPECT_LT(track.Rotation(t_s).angularDistance(expected), 1e-7);
  }
  for (const double t_s : {1.3, 2.0, 5.0}) {
    EXPECT_LT(track.Rotation(t_s).angularDistance(track.Rotation(1)), 1e-7);
  }
}

TEST(TrackHeading, IsKeptInAPauseAndTurnsToWhereItGoesOn) {
  // East, a pause, then north.
  const RecordedTrack track = TrackOf({{0, 0, 0, 0},
                                       {1, 1, 0, 0},
                                       {2, 2, 0, 0},
                                       {3, 2, 0, 0},
                                       {4, 2, 0, 0},
                                       {5, 2, 1, 0},
                                       {6, 2, 2, 0}});
  for (const double t_s : {-1.0, 0.0, 1.5, 2.0, 3.5, 4.0}) EXPECT_EQ(track.Heading(t_s), 0) << t_s;
  EXPECT_NEAR(track.Heading(4.5), kPi / 4, 1e-12);
  for (const double t_s : {5.0, 5.5, 6.0, 9.0}) {
    EXPECT_NEAR(track.Heading(t_s), kPi / 2, 1e-12) << t_s;
  }
}

TEST(TrackHeading, OfAReversalIsATurnFromOneSampleToTheNext) {
  const RecordedTrack track = TrackOf(
      Sampled(10, 2, [](double t_s) { return Eigen::Vector3d(1 - std::abs(t_s - 1), 0, 0); }));
  EXPECT_EQ(track.Heading(1), 0);
  EXPECT_NEAR(std::abs(track.Heading(1.05)), kPi / 2, 1e-12);
  EXPECT_NEAR(std::abs(track.Heading(1.1)), kPi, 1e-12);
}

TEST(TrackHeading, IsContinuousAlsoPastASouthWestDirection) {
  const RecordedTrack track = TrackOf(Sampled(10, 12, OnCircle));
  for (double t_s = 0; t_s < 12; t_s += 0.001) {
    EXPECT_LT(std::abs(track.Heading(t_s + 0.001) - track.Heading(t_s)), 0.003) << t_s;
  }
}

TEST(TrackHeading, OfOneWhoStandsAndIsSeenWithNoiseStays) {
  RandomStream random(1, "noise");
  const RecordedTrack track = TrackOf(Sampled(30, 4, [&](double t_s) -> Eigen::Vector3d {
    const Eigen::Vector3d noise(random.Normal(), random.Normal(), 0);
    return Eigen::Vector3d(1.3 * std::min(t_s, 2.0), 0, 1) + 0.0015 * noise;
  }));
  for (double t_s = 0.2; t_s < 4; t_s += 0.01) {
    EXPECT_LT(std::abs(track.Heading(t_s)), 0.15) << t_s;
  }
}

TEST(TrackHeading, BeginsAndEndsAlongTheFirstAndLastStep) {
  const RecordedTrack track = TrackOf({{0, 0, 0, 0}, {1, 1, 0, 0}, {2, 1, 1, 0}});
  EXPECT_EQ(track.Heading(0), 0);
  EXPECT_NEAR(track.Heading(1), kPi / 4, 1e-12);
  EXPECT_NEAR(track.Heading(2), kPi / 2, 1e-12);
}

TEST(TrackHeading, OfOneThatOnlyRisesIsAlongX) {
  EXPECT_EQ(TrackOf({{0, 0, 0, 0}, {1, 0, 0, 1}, {2, 0, 0, 2}}).Heading(1), 0);
}

TEST(TrackHeading, OfTwoSamplesIsThatOfTheLineBetweenThem) {
  const RecordedTrack track = TrackOf({{1, 0, 0, 0}, {2, 0, -1, 0}});
  for (const double t_s : {0.0, 1.0, 1.5, 2.0, 3.0}) {
    EXPECT_DOUBLE_EQ(track.Heading(t_s), -kPi / 2);
  }
}

TEST(RecordedTrack, NeedsTwoSamples) {
  std::vector<TrackSample> samples;
  EXPECT_FALSE(AppendSample({0, 1, 2, 3}, &samples));
  EXPECT_THROW(RecordedTrack{samples}, std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::scenarios::recorded_track_test
