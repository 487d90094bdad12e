// Recorded motions as scenarios give them, and motions of all kinds that face along their path.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "sidestep/core/input_error.h"
#include "sidestep/scenarios/scenario.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::scenarios::recorded_motion_test {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kPi = std::numbers::pi;

RecordedMotion Recorded(const std::vector<std::vector<double>>& rows) {
  std::vector<TrackSample> samples;
  for (const auto& row : rows) EXPECT_FALSE(AppendSample(row, &samples));
  RecordedMotion motion;
  motion.track = std::make_shared<const RecordedTrack>(samples);
  motion.speed_m_s = motion.track->mean_speed_m_s();
  motion.stop_at_s = kNever;
  return motion;
}

// East at 2 m/s, a pause of 1 s, then north.
RecordedMotion Walk() {
  return Recorded({{1, 0, 0, 1}, {2, 2, 0, 1}, {3, 2, 0, 1}, {4, 2, 2, 1}, {5, 2, 4, 1}});
}

MovingObstacle Facing(const Motion& motion) {
  MovingObstacle obstacle{"thing", Box{{0.2, 0.4, 1}}, Eigen::Vector3d::Zero(), motion, ""};
  obstacle.faces_path = true;
  return obstacle;
}

Eigen::Vector3d PositionAt(const Motion& motion, double t_s) {
  return PoseAt(Facing(motion), EpisodeTime(t_s)).translation();
}

double YawAt(const MovingObstacle& obstacle, double t_s) {
  const Eigen::Vector3d ahead = PoseAt(obstacle, EpisodeTime(t_s)).Rotate({1, 0, 0});
  EXPECT_NEAR(ahead.z(), 0, 1e-12);
  return std::atan2(ahead.y(), ahead.x());
}

TEST(RecordedMotion, GoesAsRecordedAtTheSpeedOfItsTrack) {
  const RecordedMotion motion = Walk();
  for (double t_s = -1; t_s < 7; t_s += 0.05) {
    EXPECT_EQ(PositionAt(motion, t_s), motion.track->Position(t_s));
  }
}

TEST(RecordedMotion, GoesTheSameWayInHalfTheTimeAtTwiceTheSpeed) {
  RecordedMotion fast = Walk();
  fast.speed_m_s *= 2;
  for (double t_s = 0; t_s < 4; t_s += 0.05) {
    EXPECT_LT((PositionAt(fast, t_s) - PositionAt(Walk(), 2 * t_s)).norm(), 1e-12);
  }
}

TEST(RecordedMotion, IsPutOffAsAWholeByItsBeginAndHeldByItsStop) {
  RecordedMotion late = Walk();
  late.begin_at_s = 0.5;
  late.stop_at_s = 2.2;
  EXPECT_EQ(PositionAt(late, 1.4), Eigen::Vector3d(0, 0, 1));
  EXPECT_LT((PositionAt(late, 1.9) - PositionAt(Walk(), 1.4)).norm(), 1e-12);
  EXPECT_LT((PositionAt(late, 9) - PositionAt(Walk(), 1.7)).norm(), 1e-12);
}

TEST(RecordedMotion, StaysAtItsStartAtNoSpeed) {
  RecordedMotion motion = Walk();
  motion.speed_m_s = 0;
  EXPECT_EQ(PositionAt(motion, 9), Eigen::Vector3d(0, 0, 1));
}

TEST(RecordedMotion, ThatOnlyTurnsTurnsAsRecordedWhateverTheSpeed) {
  RecordedMotion door = Recorded({{0, 1, 2, 1, 1, 0, 0, 0}, {1, 1, 2, 1, 0, 0, 0, 1}});
  door.speed_m_s = 3;
  MovingObstacle obstacle = Facing(door);
  obstacle.faces_path = false;
  EXPECT_NEAR(YawAt(obstacle, 0.25), kPi / 4, 1e-12);
  EXPECT_NEAR(std::abs(YawAt(obstacle, 7)), kPi, 1e-12);
}

TEST(RecordedMotion, TurnsTheObstaclesOwnOrientation) {
  MovingObstacle obstacle = Facing(
      Recorded({{0, 0, 0, 0, 1, 0, 0, 0}, {1, 1, 0, 0, std::sqrt(0.5), 0, 0, std::sqrt(0.5)}}));
  obstacle.faces_path = false;
  obstacle.rpy_rad = {0, 0.3, 0};
  const Pose start = Pose::FromRollPitchYaw({0, 0.3, 0}, {0, 0, 0});
  EXPECT_LT(
      (PoseAt(obstacle, EpisodeTime(0)).rotation().coeffs() - start.rotation().coeffs()).norm(),
      1e-12);
  const Pose end = Pose::FromRollPitchYaw({0, 0.3, kPi / 2}, {1, 0, 0});
  EXPECT_LT(PoseAt(obstacle, EpisodeTime(2)).rotation().angularDistance(end.rotation()), 1e-7);
}

std::vector<Motion> AllKinds() {
  return {
      LinearMotion{{1, 2, 3}, {-0.6, 0.8, 0}, 1, 4, 0.5},
      WaypointMotion{{{1, 2, 3}, {2, 2, 3}, {2, 2, 4}, {2, 0, 4}}, 1, 3.2, 0.5},
      AcceleratedMotion{{1, 2, 3}, {0, -1, 0}, 1, -0.5, 0, kNever, kNever, 0.5},
      CircleMotion{{0, 2, 3}, 1, 0.3, false, 1, 4, 0.5},
      CircleMotion{{0, 2, 3}, 1, 0.3, true, 1, 4, 0.5},
      RandomWalkMotion{{1, 2, 3}, 0.7, 0.4, 0.5, 1, 1, 4, 0.5},
      WalkMotion{
          {1, 2, 3}, {0.6, 0.8, 0}, {0.8, 1.8}, {0.5, 1.5}, {0.7, 1.3}, 0, 1, 1, 1.3, 4, 0.5},
  };
}

TEST(FacingAlongThePath, IsAlongTheVelocityWhereverAnyMotionMovesOnTheLevel) {
  constexpr double kStep_s = 1e-6;
  for (const Motion& motion : AllKinds()) {
    for (double t_s = 0; t_s < 5; t_s += 0.0101) {
      const Eigen::Vector3d way =
          PositionAt(motion, t_s + kStep_s) - PositionAt(motion, t_s - kStep_s);
      if (way.head<2>().norm() < 1e-9) continue;
      const double yaw = YawAt(Facing(motion), t_s);
      EXPECT_LT(std::abs(std::remainder(yaw - std::atan2(way.y(), way.x()), 2 * kPi)), 1e-4)
          << motion.index() << " at " << t_s;
    }
  }
}

TEST(FacingAlongThePath, IsAtRestAsItWentLastOrWillGoFirst) {
  for (const Motion& motion : AllKinds()) {
    const MovingObstacle obstacle = Facing(motion);
    const double first = YawAt(obstacle, 0.5001), last = YawAt(obstacle, 60);
    for (const double t_s : {-3.0, 0.0, 0.3, 0.5}) {
      EXPECT_NEAR(YawAt(obstacle, t_s), first, 1e-3) << motion.index() << " at " << t_s;
    }
    EXPECT_NEAR(std::remainder(YawAt(obstacle, 4.0) - last, 2 * kPi), 0, 1e-3) << motion.index();
  }
}

TEST(FacingAlongThePath, OfWaypointsTurnsAtACornerAndKeepsItsHeadingOnAVerticalLeg) {
  const MovingObstacle obstacle =
      Facing(WaypointMotion{{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 2}, {1, -1, 2}}, 1, kNever});
  EXPECT_EQ(YawAt(obstacle, 0.5), 0);  // rises: as it will go first
  EXPECT_EQ(YawAt(obstacle, 1.999), 0);
  EXPECT_EQ(YawAt(obstacle, 2.5), 0);  // rises again
  EXPECT_DOUBLE_EQ(YawAt(obstacle, 3.001), -kPi / 2);
  EXPECT_DOUBLE_EQ(YawAt(obstacle, 60), -kPi / 2);
}

TEST(FacingAlongThePath, OfAPersonIsAlongTheLineHoweverTheySway) {
  const WalkMotion motion{{0, 0, 0}, {0, 1, 0}, {0.8, 1.8}, {0.5, 1.5}, {0.7, 1.3}, 0.03,
                          1,         1,         1.3,        kNever,     0};
  for (const double t_s : {0.0, 0.3, 1.7}) EXPECT_DOUBLE_EQ(YawAt(Facing(motion), t_s), kPi / 2);
}

TEST(FacingAlongThePath, IsAlongXForWhatNeverMovesOnTheLevel) {
  EXPECT_EQ(YawAt(Facing(LinearMotion{{0, 0, 0}, {0, 0, 1}, 1, kNever}), 1), 0);
}

TEST(FacingAlongThePath, AddsToTheObstaclesOwnOrientation) {
  MovingObstacle obstacle = Facing(LinearMotion{{0, 0, 0}, {0, 1, 0}, 1, kNever});
  obstacle.rpy_rad = {0.2, 0, 0.5};
  const Pose expected = Pose::FromRollPitchYaw({0.2, 0, 0.5 + kPi / 2}, {0, 1, 0});
  EXPECT_LT(PoseAt(obstacle, EpisodeTime(1)).rotation().angularDistance(expected.rotation()), 1e-7);
}

constexpr char kScene[] = R"(
description: a walk
workspace: {first_center_m: [-1, -1, -1], cell_m: 0.04, cells: [8, 8, 8]}
moving_obstacles:
  - name: walker
    shape: {box: {size_m: [0.3, 0.5, 1.7]}}
    motion: {recorded: {@}}
knowledge: prediction
sensor: {name: occupancy, rate_hz: 30}
seed: 1
)";

std::string SceneWith(const std::string& keys) {
  std::string text = kScene;
  return text.replace(text.find('@'), 1, keys);
}

class TrackFile : public ::testing::Test {
 protected:
  Scenario Load(const std::string& csv, const std::string& keys = "file: walk.csv") {
    Write("walk.csv", csv);
    Write("scene.yaml", SceneWith(keys));
    return LoadScenario(PathOf("scene.yaml"));
  }
  void Write(const std::string& name, const std::string& text) {
    std::ofstream(PathOf(name), std::ios::binary) << text;
  }
  std::string PathOf(const std::string& name) { return (folder_.path() / name).string(); }
  static const RecordedMotion& MotionOf(const Scenario& scenario) {
    return std::get<RecordedMotion>(scenario.moving_obstacles.at(0).motion);
  }

 private:
  const TemporaryFolder folder_;
};

TEST_F(TrackFile, IsReadHoweverAnEditorWroteIt) {
  const Scenario plain = Load("t,x,y,z\n0,0.1,0.2,0.3\n0.1,0.15,0.2,0.3\n");
  const Scenario odd =
      Load("\xEF\xBB\xBF t, x ,y,z\r\n\r\n0 ,0.1,\t0.2,0.3\r\n1e-1,0.15,0.2,3e-1\r\n\r\n");
  EXPECT_EQ(ToYaml(odd), ToYaml(plain));
}

TEST_F(TrackFile, StandsInTheWrittenScenarioWithAllItsDigits) {
  const Scenario scenario = Load(
      "t,x,y,z,qw,qx,qy,qz\n0,0.1,0.2,0.3,1,0,0,0\n"
      "0.3333333333333333,0.123456789012345,0.2,0.3,0.9998,0.02,0,0\n"
      "0.5,0.13,0.2,0.3,0.7071,0,0,-0.7071\n",
      "file: walk.csv, begin_at_s: 0.25");
  const std::string yaml = ToYaml(scenario);
  EXPECT_EQ(yaml.find("walk.csv"), std::string::npos);
  const Scenario again = ParseScenario(yaml, "written.yaml");
  EXPECT_EQ(ToYaml(again), yaml);
  for (double t_s = 0; t_s < 1; t_s += 0.01) {
    const Pose before = PoseAt(scenario.moving_obstacles[0], EpisodeTime(t_s));
    const Pose after = PoseAt(again.moving_obstacles[0], EpisodeTime(t_s));
    EXPECT_EQ(after.translation(), before.translation());
    EXPECT_EQ(after.rotation().coeffs(), before.rotation().coeffs());
  }
}

TEST_F(TrackFile, KeepsItsSpeedAndItsFacingWhenWritten) {
  const Scenario scenario = Load("t,x,y,z\n0,0,0,0\n1,1,0,0\n2,1,3,0\n",
                                 "file: walk.csv, speed_m_s: 0.5, face: along_path, stop_at_s: 9");
  const Scenario again = ParseScenario(ToYaml(scenario), "written.yaml");
  EXPECT_EQ(ToYaml(again), ToYaml(scenario));
  EXPECT_EQ(MotionOf(again).speed_m_s, 0.5);
  EXPECT_EQ(MotionOf(again).stop_at_s, 9);
  EXPECT_TRUE(again.moving_obstacles[0].faces_path);
}

TEST_F(TrackFile, HasTheSpeedOfItsTrackUnlessToldAnother) {
  EXPECT_EQ(MotionOf(Load("t,x,y,z\n0,0,0,0\n1,1,0,0\n2,1,3,0\n")).speed_m_s, 2);
}

TEST_F(TrackFile, MayHoldTenThousandSamplesAndBeReadBack) {
  std::string csv = "t,x,y,z\n";
  for (int n = 0; n < 10000; ++n) {
    csv += std::to_string(n / 30.0) + "," + std::to_string(std::sin(0.01 * n)) + ",0.3,0.85\n";
  }
  const Scenario scenario = Load(csv);
  EXPECT_EQ(MotionOf(scenario).track->samples().size(), 10000u);
  EXPECT_EQ(ToYaml(ParseScenario(ToYaml(scenario), "written.yaml")), ToYaml(scenario));
  EXPECT_THROW(Load(csv + "400,0,0,0\n"), InputError);
}

TEST(TrackFileOfAText, IsRefusedBecauseATextStandsNowhere) {
  try {
    ParseScenario(SceneWith("file: walk.csv"), "trace.h5");
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "trace.h5:7: moving_obstacles[0].motion.recorded.file: stands beside a scenario "
                 "file, and this is none: give samples");
  }
}

}  // namespace
}  // namespace sidestep::scenarios::recorded_motion_test
