#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <string>

#include "sidestep/bench/metrics/registry.h"
#include "sidestep/bench/metrics/robot_limit_metrics.h"

namespace sidestep::bench::every_metric_test {
namespace {

// One joint goes from 0 to 1 rad in 1 s by the cubic q = 3t^2 - 2t^3 (rest to rest, constant jerk
// -12), is told so exactly, lags by 1 mrad, and rests until `end_s`.
record::Recording SmoothReach(double end_s = 1.5) {
  record::Recording recording;
  recording.q_start = Eigen::VectorXd::Zero(1);
  recording.q_goal = Eigen::VectorXd::Ones(1);
  recording.dwell_s = 0.2;
  recording.robot_limits = {Eigen::VectorXd::Constant(1, 2.0), Eigen::VectorXd::Constant(1, 10.0),
                            Eigen::VectorXd::Constant(1, 5e3), Eigen::VectorXd::Constant(1, 20.0)};
  recording.tool_a_max = 12;
  recording.tool_a_reflex = 2;
  recording.limits = {Eigen::VectorXd::Constant(1, 1.25), Eigen::VectorXd::Constant(1, 8.0),
                      Eigen::VectorXd::Constant(1, 1e4), Eigen::VectorXd::Constant(1, 20.0)};
  for (int i = 0; i <= std::lround(1000 * end_s); ++i) {
    const double t = 1e-3 * i, s = std::min(t, 1.0);
    ControlSample tick;
    tick.t = EpisodeTime(t);
    tick.q_command = Eigen::VectorXd::Constant(1, 3 * s * s - 2 * s * s * s);
    tick.v_command = Eigen::VectorXd::Constant(1, 6 * s - 6 * s * s);
    tick.a_command = Eigen::VectorXd::Constant(1, t < 1.0 ? 6 - 12 * t : 0);
    tick.q = tick.q_command - Eigen::VectorXd::Constant(1, 1e-3);
    tick.v = tick.v_command;
    tick.torque = Eigen::VectorXd::Constant(1, -5 * s);
    recording.control.push_back(tick);
    recording.p_WTool.push_back({1, 0.6 * tick.q_command(0), -0.8 * tick.q_command(0)});
  }
  for (int i = 1; i <= std::lround(100 * end_s); ++i) {
    TruthSample sample;
    sample.t = EpisodeTime(0.01 * i);
    sample.clearance_m = 0.2 - 0.001 * i;
    if (i == 120 || i == 121) {
      sample.in_contact = true;
      sample.contact_s = 0.01 * i - 0.003;
    }
    recording.truth.push_back(sample);
  }
  recording.cycles.resize(3);
  recording.cycles[1].accepted = true;
  // From rest to rest over 1 rad in 1 s, from the moment of effect on; faster before that, and in a
  // plan that was not given to the robot.
  CycleRecord& cycle = recording.cycles[1];
  cycle.plan_start = EpisodeTime(0.2);
  cycle.t_effect = EpisodeTime(0.3);
  cycle.plan = {Eigen::Vector3d(0, 0.1, 1.1), Eigen::RowVector3d(0, 1, 2),
                Eigen::RowVector3d::Zero()};
  recording.cycles[2].plan = recording.cycles[1].plan;
  recording.cycles[2].plan.q *= 9;
  recording.cycles[0].cut_short = recording.cycles[2].cut_short = true;
  recording.cycles[1].status = "short_of_goal";
  recording.cycles[0].samples_outside_grid = 7;
  recording.cycles[2].samples_outside_grid = 5;

  recording.events = {{EpisodeTime(0.1), "appeared", 1},
                      {EpisodeTime(0.2), "moved", 1},
                      {EpisodeTime(0.3), "rested", 1},
                      {EpisodeTime(0.4), "moved", 1}};

  // One obstacle runs along x at 1 m/s and stops at 1 s; another stands far away. From 0.1 s on it
  // is seen 1 cm too high and expected to go on.
  recording.obstacles = {"post", "ball"};
  for (TruthSample& sample : recording.truth) {
    sample.X_WO = {Pose::Translation({0, 5, 0}),
                   Pose::Translation({std::min(sample.t.seconds(), 1.0), 0, 0})};
  }
  recording.cycles[0].t = EpisodeTime(0.1);
  PredictedObject& object = recording.cycles[0].objects.emplace_back();
  for (int i = 0; i <= 25; ++i) {
    object.t.push_back(EpisodeTime(0.1 + 0.1 * i));
    object.X_WO.push_back(Pose::Translation({0.1 + 0.1 * i, 0, 0.01}));
  }
  return recording;
}

const Metric& Find(const std::string& name) {
  for (const Metric& metric : Metrics()) {
    if (name == metric.name) return metric;
  }
  throw std::invalid_argument("no metric " + name);
}

struct Expected {
  const char* metric;
  double value, tolerance;
  double end_s = 1.5;  // of the recording
};
std::ostream& operator<<(std::ostream& stream, const Expected& e) { return stream << e.metric; }

// What each metric is of SmoothReach: never 0 or NaN, which is what a metric that does nothing
// says.
constexpr Expected kKnown[] = {
    {"first_contact_s", 1.197, 1e-12},
    {"min_clearance_m", 0.05, 1e-12},
    // Within 0.02 rad and 0.05 rad/s: the speed decides, 6t - 6t^2 = 0.05 at t = 0.99159.
    {"time_to_goal_s", 0.992, 1e-9},
    {"time_to_dwell_s", 1.192, 1e-9},
    {"goal_error_rad", 1e-3, 1e-12},
    // The integral of a^2 / 2 over the second, 6, is what the cubic's GP cost is.
    {"gp_cost", 6, 1e-6},
    {"jerk_rms", 12, 1e-6},
    {"tracking_error_rad", 1e-3, 1e-12},
    // Differences of the cubic over h = 1 ms: 1.5 - 2 h^2 about its middle; 6 - 12 h at most; and
    // (3 - 2 h) / h at the first tick, where the acceleration begins at once.
    {"velocity_use", 0.749999, 1e-9},
    {"acceleration_use", 0.5988, 1e-8},
    {"jerk_use", 0.5996, 1e-6},
    // The tool moves with the joint, 1 m a rad.
    {"tool_acceleration_use", 0.499, 1e-8},
    {"tool_reflex_use", 2.994, 1e-8},
    // 1.5 rad/s half way, 6 rad/s^2 at the ends, 12 rad/s^3 throughout.
    {"planned_velocity_use", 1.2, 1e-12},
    {"planned_acceleration_use", 0.75, 1e-12},
    {"planned_jerk_use", 12e-4, 1e-12},
    {"commanded_velocity_use", 1.2, 1e-12},
    {"commanded_acceleration_use", 0.75, 1e-12},
    // At the end, the last 5.988 rad/s^2 are taken back within a tick.
    {"commanded_jerk_use", 0.5988, 1e-9},
    {"commanded_torque_rate_use", 0.25, 1e-9},
    {"replans", 3, 0},
    {"plans_accepted", 1, 0},
    {"replans_cut_short", 2, 0},
    {"replans_short_of_goal", 1, 0},
    {"samples_outside_grid", 12, 0},
    {"things_moved", 2, 0},
    // The height alone, until the ball stops: then also how far it was expected to go on.
    {"prediction_error_100ms_m", 0.01, 1e-12},
    {"prediction_error_300ms_m", 0.01, 1e-12},
    {"prediction_error_500ms_m", 0.01, 1e-12},
    {"prediction_error_1000ms_m", 0.100498756211209, 1e-12},       // 0.1 m and 0.01 m
    {"prediction_error_2000ms_m", 1.100045453606293, 1e-12, 2.2},  // 1.1 m and 0.01 m
};

class EveryMetric : public ::testing::TestWithParam<Expected> {};

TEST_P(EveryMetric, IsRightOnAMotionWithAKnownAnswer) {
  const Expected& expected = GetParam();
  const record::Recording recording = SmoothReach(expected.end_s);
  EXPECT_NEAR(Find(expected.metric).compute(recording), expected.value, expected.tolerance);
}

INSTANTIATE_TEST_SUITE_P(Known, EveryMetric, ::testing::ValuesIn(kKnown),
                         [](const auto& test) { return std::string(test.param.metric); });

TEST(Metrics, HaveEachAKnownAnswerThatIsNotTrivial) {
  for (const Metric& metric : Metrics()) {
    const auto* const row = std::find_if(std::begin(kKnown), std::end(kKnown), [&](const auto& e) {
      return std::string(e.metric) == metric.name;
    });
    if (row == std::end(kKnown)) {
      ADD_FAILURE() << "nothing says what " << metric.name << " is of a known motion: add a row to "
                    << "kKnown of tests/bench/every_metric_test.cc, and to SmoothReach what the "
                    << "metric needs of a recording so that it is neither 0 nor NaN";
    } else {
      EXPECT_TRUE(std::isfinite(row->value) && row->value != 0) << metric.name;
      EXPECT_LT(row->tolerance, 0.01 * std::abs(row->value)) << metric.name;
    }
  }
}

TEST(Metrics, ThatLookBeyondTheEndOfARecordingAreNotANumber) {
  EXPECT_TRUE(std::isnan(Find("prediction_error_2000ms_m").compute(SmoothReach())));
}

TEST(Metrics, DoNotCountAGoalThatTheArmDidNotStayAtAsLongAsAsked) {
  record::Recording recording = SmoothReach();
  recording.dwell_s = 0.6;
  EXPECT_TRUE(std::isnan(Find("time_to_goal_s").compute(recording)));
  EXPECT_TRUE(std::isnan(Find("time_to_dwell_s").compute(recording)));
}

TEST(Metrics, OfLimitsThatNobodyAskedForAreNotANumber) {
  record::Recording recording = SmoothReach();
  for (Eigen::VectorXd* limit : {&recording.limits.v_max, &recording.limits.a_max,
                                 &recording.limits.jerk_max, &recording.limits.torque_rate_max}) {
    limit->setConstant(std::numeric_limits<double>::infinity());
  }
  for (const char* name : {"planned_velocity_use", "planned_acceleration_use", "planned_jerk_use",
                           "commanded_velocity_use", "commanded_acceleration_use",
                           "commanded_jerk_use", "commanded_torque_rate_use"}) {
    EXPECT_TRUE(std::isnan(Find(name).compute(recording))) << name;
  }
}

TEST(Metrics, OfLimitsThatNobodyKnowsAreNotANumber) {
  record::Recording recording = SmoothReach();
  recording.tool_a_max = recording.tool_a_reflex = record::kNoLimit;
  for (Eigen::VectorXd* limit : {&recording.robot_limits.v_max, &recording.robot_limits.a_max,
                                 &recording.robot_limits.jerk_max}) {
    limit->setConstant(record::kNoLimit);
  }
  for (const char* name : {"velocity_use", "acceleration_use", "jerk_use", "tool_acceleration_use",
                           "tool_reflex_use"}) {
    EXPECT_TRUE(std::isnan(Find(name).compute(recording))) << name;
  }
}

TEST(Metrics, SayWhatWouldHaveTripped) {
  std::map<std::string, double> metrics;
  for (const TripMetric& metric : kTripMetrics) metrics[metric.name] = 0.999;
  EXPECT_TRUE(TrippedBy(metrics).empty());
  EXPECT_EQ(TellTrips(metrics), "no");
  metrics["jerk_use"] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(TellTrips(metrics), "not by what is known");
  metrics["commanded_torque_rate_use"] = 1;
  ASSERT_EQ(TrippedBy(metrics).size(), 1u);
  EXPECT_STREQ(TrippedBy(metrics).front().words, "torque rate");
}

TEST(Metrics, OfAnEmptyRecordingAreZeroOrNotANumberAndNeverThrow) {
  for (const Metric& metric : Metrics()) {
    const double value = metric.compute(record::Recording());
    EXPECT_TRUE(std::isnan(value) || value == 0) << metric.name << " is " << value;
  }
}

TEST(Metrics, HaveNamesThatEndInTheirUnit) {
  const std::map<std::string, std::string> suffixes = {{"s", "_s"}, {"m", "_m"}, {"rad", "_rad"}};
  for (const Metric& metric : Metrics()) {
    const auto suffix = suffixes.find(metric.unit);
    if (suffix != suffixes.end()) {
      EXPECT_THAT(metric.name, ::testing::EndsWith(suffix->second));
    }
  }
}

}  // namespace
}  // namespace sidestep::bench::every_metric_test
