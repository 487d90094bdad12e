#include "sidestep/render/timeline.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "sidestep/scenarios/scenario.h"
#include "tests/render/sample_recording.h"

namespace sidestep::render::timeline_test {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Timeline, GivesTheJointsBetweenSamplesOnAStraightLine) {
  record::Recording recording;
  for (const double t_s : {1.0, 2.0, 4.0}) {
    ControlSample sample;
    sample.t = EpisodeTime(t_s);
    sample.q = Eigen::Vector2d(10 * t_s, -t_s);
    recording.control.push_back(sample);
  }
  const struct {
    double t_s, q;
  } cases[] = {{0, 10}, {1, 10}, {1.5, 15}, {2, 20}, {3.5, 35}, {4, 40}, {9, 40}};
  for (const auto& c : cases) {
    EXPECT_NEAR(JointsAt(recording, EpisodeTime(c.t_s))(0), c.q, 1e-12) << c.t_s;
    EXPECT_NEAR(JointsAt(recording, EpisodeTime(c.t_s))(1), -c.q / 10, 1e-12) << c.t_s;
  }
}

TEST(Timeline, TurnsPosesEvenlyAndClampsThemOutside) {
  const std::vector<EpisodeTime> times = {EpisodeTime(1), EpisodeTime(2)};
  const std::vector<Pose> poses = {Pose::FromRollPitchYaw({0, 0, 0}, {0, 0, 0}),
                                   Pose::FromRollPitchYaw({0, 0, kPi / 2}, {4, 0, 2})};
  const Pose X = PoseAt(times, poses, EpisodeTime(1.25));
  EXPECT_LT((X.translation() - Eigen::Vector3d(1, 0, 0.5)).norm(), 1e-12);
  const Eigen::Vector3d x_axis = X.Rotate(Eigen::Vector3d::UnitX());
  EXPECT_NEAR(std::atan2(x_axis.y(), x_axis.x()), kPi / 8, 1e-12);
  EXPECT_EQ(PoseAt(times, poses, EpisodeTime(0)).translation(), poses[0].translation());
  EXPECT_EQ(PoseAt(times, poses, EpisodeTime(7)).translation(), poses[1].translation());
}

TEST(Timeline, FollowsTheObstacleAndItsSpeed) {
  const record::Recording recording = MakeSampleRecording({});
  for (const double t_s : {0.0, 0.333, 1.0, 1.999, 2.0}) {
    const std::vector<Pose> poses = ObstaclesAt(recording, EpisodeTime(t_s));
    ASSERT_EQ(poses.size(), 1u);
    EXPECT_LT((poses[0].translation() - TrolleyPoseAt(t_s).translation()).norm(), 1e-12);
    EXPECT_NEAR(ObstacleSpeedAt(recording, EpisodeTime(t_s)), kTrolleySpeed_m_s, 1e-9) << t_s;
  }
  EXPECT_EQ(ObstacleSpeedAt(record::Recording(), EpisodeTime(0)), 0);
}

TEST(Timeline, FollowsWhatTheScenarioPrescribesWhereNobodyKnowsTheTruth) {
  record::Recording recording = MakeSampleRecording({});
  recording.truth.clear();
  const scenarios::Scenario walkway =
      scenarios::LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/hsr_walkway.yaml");
  recording.scenario_yaml = scenarios::ToYaml(walkway);
  const std::vector<Pose> poses = ObstaclesAt(recording, EpisodeTime(1.5));
  ASSERT_EQ(poses.size(), 1u);
  // From y = 2 m at 1.4 m/s.
  EXPECT_NEAR(poses[0].translation().y(), 2 - 1.4 * 1.5, 1e-12);
  EXPECT_NEAR(ObstacleSpeedAt(recording, EpisodeTime(1)), 1.4, 1e-9);
}

TEST(Timeline, FollowsWhatACameraSawWhereNothingWasPrescribed) {
  record::Recording recording = MakeSampleRecording({});
  recording.truth.clear();
  const scenarios::Scenario walkway =
      scenarios::LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/hsr_walkway.yaml");
  recording.scenario_yaml = scenarios::ToYaml(walkway);
  recording.obstacles = {walkway.moving_obstacles.front().name};
  recording.header["camera"] = "recorded, 1234";
  recording.observations.clear();
  for (const double t_s : {0.5, 0.6, 0.7}) {
    record::ObservationRecord& scan = recording.observations.emplace_back();
    scan.t = EpisodeTime(t_s);
    if (t_s == 0.6) continue;  // not seen
    scan.objects = {{"another", Pose(), {}},
                    {recording.obstacles[0], Pose::Translation({t_s, 2, 3}), {}}};
  }
  const struct {
    double t_s, x_m;
  } cases[] = {{0, 0.5}, {0.5, 0.5}, {0.69, 0.5}, {0.7, 0.7}, {9, 0.7}};
  for (const auto& [t_s, x_m] : cases) {
    EXPECT_EQ(ObstaclesAt(recording, EpisodeTime(t_s)).at(0).translation().x(), x_m) << t_s;
  }
}

TEST(Timeline, TellsTheSpeedOfWhatACameraSees) {
  record::Recording recording = MakeSampleRecording({});
  recording.truth.clear();
  // As prescribed it would go at 1.4 m/s.
  recording.scenario_yaml =
      scenarios::ToYaml(scenarios::LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/hsr_walkway.yaml"));
  recording.obstacles = {"hsr", "cart"};
  recording.header["camera"] = "recorded, 1234";
  recording.observations.clear();
  constexpr double kSpeed_m_s = 0.3, kLastSeen_s = 1.5;
  for (int i = 0; i <= 60; ++i) {
    record::ObservationRecord& scan = recording.observations.emplace_back();
    scan.t = EpisodeTime(i / 30.0);
    if (scan.t.seconds() > kLastSeen_s + 1e-9) continue;
    scan.objects = {{"cart", Pose::Translation({1, 0, 0}), {}},
                    {"hsr", Pose::Translation({0, kSpeed_m_s * scan.t.seconds(), 0}), {}}};
  }
  // Between pictures as well as at one.
  for (const double t_s : {0.04, 0.1, 0.517, 0.55, 1.0, 1.55, 1.7}) {
    EXPECT_NEAR(ObstacleSpeedAt(recording, EpisodeTime(t_s)), kSpeed_m_s, 1e-9) << t_s;
  }
  for (const double t_s : {0.0, 0.03, 1.8, 2.0}) {
    EXPECT_TRUE(std::isnan(ObstacleSpeedAt(recording, EpisodeTime(t_s)))) << t_s;
  }
}

TEST(Timeline, KnowsWhichPlanIsInForce) {
  record::Recording recording = MakeSampleRecording({});
  recording.cycles[3].accepted = false;     // observed at 0.3 s, of effect at 0.35 s
  recording.cycles[4].plan = Trajectory();  // 0.4 s, 0.45 s
  const struct {
    double t_s;
    int cycle;
  } cases[] = {{0, -1},   {0.049, -1}, {0.05, 0}, {0.1, 0}, {0.26, 2},
               {0.36, 2}, {0.46, 2},   {0.56, 5}, {99, 18}};
  for (const auto& c : cases) {
    const CycleRecord* const cycle = CycleInForce(recording, EpisodeTime(c.t_s + 1e-9));
    EXPECT_EQ(cycle == nullptr ? -1 : cycle - recording.cycles.data(), c.cycle) << c.t_s;
  }
}

}  // namespace
}  // namespace sidestep::render::timeline_test
