// What keeps a robot from being moved, and from being recovered.
#include "sidestep/hardware/readiness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <memory>
#include <ostream>
#include <string>

#include "sidestep/core/text_file.h"
#include "sidestep/hardware/panda_robot.h"
#include "sidestep/hardware/recovery.h"
#include "tests/hardware/perfect_panda.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::hardware::readiness_test {
namespace {

using control::SafetyCheck;
using robot::fci::RobotMode;
using ::testing::HasSubstr;

constexpr const char* kModels = SIDESTEP_SOURCE_DIR "/models";

robot::RobotModel Panda() { return robot::RobotModel::Load(kModels, "panda", Pose()); }

// The same with something else in its robot.yaml.
robot::RobotModel PandaWith(const std::string& text, const std::string& instead) {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  fs::copy(fs::path(kModels) / "panda", folder.path() / "panda", fs::copy_options::recursive);
  const std::string file = folder.path() / "panda/robot.yaml";
  std::string yaml = ReadTextFile(file, 1 << 20);
  const std::size_t at = yaml.find(text);
  EXPECT_NE(at, std::string::npos);
  yaml.replace(at, text.size(), instead);
  std::ofstream(file) << yaml;
  return robot::RobotModel::Load(folder.path().string(), "panda", Pose());
}

TEST(WhyNotReady, SaysNothingOfARobotThatIs) {
  EXPECT_FALSE(WhyNotReady(RestingPanda(), Panda()));
  EXPECT_FALSE(WhyNotReady(RestingPanda(), PandaWith("v_max_rad_s: 2.175", "v_max_rad_s: 1")));
}

struct Trouble {
  const char* name;
  std::function<void(RobotSnapshot&)> spoil;
  SafetyCheck check;
  const char* says;
};
std::ostream& operator<<(std::ostream& stream, const Trouble& t) { return stream << t.name; }

class NotReadyRobot : public testing::TestWithParam<Trouble> {};

TEST_P(NotReadyRobot, IsToldAndNotMoved) {
  RobotSnapshot state = RestingPanda();
  GetParam().spoil(state);
  const auto objection = WhyNotReady(state, Panda());
  ASSERT_TRUE(objection);
  EXPECT_EQ(objection->check, GetParam().check);
  EXPECT_THAT(objection->why, HasSubstr(GetParam().says));
  auto driver = std::make_unique<PerfectPanda>(state);
  driver->before = [] { FAIL() << "it was moved"; };
  try {
    PandaRobot(std::move(driver), Panda(), {});
    FAIL() << "it was accepted";
  } catch (const NotReady& error) {
    EXPECT_EQ(error.objection().why, objection->why);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Because, NotReadyRobot,
    testing::Values(
        Trouble{"OfAReflex", [](RobotSnapshot& s) { s.mode = RobotMode::kReflex; },
                SafetyCheck::kRobotMode, "in the mode 'reflex'"},
        Trouble{"OfTheUserStop", [](RobotSnapshot& s) { s.mode = RobotMode::kUserStopped; },
                SafetyCheck::kRobotMode, "in the mode 'user stopped'"},
        Trouble{"OfAnotherHand", [](RobotSnapshot& s) { s.F_T_EE[14] = 0.2; },
                SafetyCheck::kConfiguration, "end effector"},
        Trouble{"OfAHandThatIsTurned", [](RobotSnapshot& s) { s.F_T_EE[0] += 0.01; },
                SafetyCheck::kConfiguration, "end effector"},
        Trouble{"OfALoad", [](RobotSnapshot& s) { s.load_kg = 0.5; }, SafetyCheck::kConfiguration,
                "a load of 0.5 kg"},
        Trouble{"OfAJointBeyondItsLimit", [](RobotSnapshot& s) { s.q[3] = s.q_d[3] = -0.05; },
                SafetyCheck::kConfiguration, "joint 4 is at -0.05 rad, outside its limits"},
        Trouble{"OfAJointThatIsNoNumber", [](RobotSnapshot& s) { s.q[3] = std::nan(""); },
                SafetyCheck::kConfiguration, "joint 4 is at no number"},
        Trouble{"OfAJointThatMoves", [](RobotSnapshot& s) { s.dq[5] = -0.002; },
                SafetyCheck::kRecovery, "joint 6 does not rest"},
        Trouble{"OfAJointThatIsElsewhere", [](RobotSnapshot& s) { s.q_d[0] += 0.01; },
                SafetyCheck::kRecovery, "joint 1 is 0.01 rad from where"}),
    [](const auto& test) { return std::string(test.param.name); });

// Trembles for so many milliseconds.
class TremblingPanda final : public PerfectPanda {
 public:
  explicit TremblingPanda(int length_ms) : PerfectPanda(RestingPanda()), length_ms_(length_ms) {}
  RobotSnapshot ReadOnce() override {
    RobotSnapshot state = PerfectPanda::ReadOnce();
    if (reads_++ < length_ms_) state.dq[2] = 0.01;
    return state;
  }

 private:
  int length_ms_, reads_ = 0;
};

TEST(AwaitReady, GivesARobotThatHasJustStoppedHalfASecondToRest) {
  TremblingPanda soon(400), late(600);
  EXPECT_EQ(AwaitReady(soon, Panda()).dq[2], 0);
  EXPECT_THROW(AwaitReady(late, Panda()), NotReady);
}

// A robot.yaml of another robot, such as the FR3, or of wishful thinking.
struct WideLimit {
  const char* text;
  const char* instead;
  const char* says;
};
class WideLimits : public testing::TestWithParam<WideLimit> {};

TEST_P(WideLimits, AreRefused) {
  const auto objection =
      WhyNotReady(RestingPanda(), PandaWith(GetParam().text, GetParam().instead));
  ASSERT_TRUE(objection);
  EXPECT_EQ(objection->check, SafetyCheck::kConfiguration);
  EXPECT_THAT(objection->why, HasSubstr(GetParam().says));
  EXPECT_GT(objection->value, objection->limit);
}

INSTANTIATE_TEST_SUITE_P(
    OfRobotYaml, WideLimits,
    testing::Values(
        WideLimit{"q_max_rad: 3.7525", "q_max_rad: 4.5169", "q_max_rad of joint 6"},
        WideLimit{"q_min_rad: -1.7628", "q_min_rad: -1.7837", "q_min_rad of joint 2"},
        WideLimit{"v_max_rad_s: 2.61", "v_max_rad_s: 5.26", "v_max_rad_s of joint 5"},
        WideLimit{"a_max_rad_s2: 7.5", "a_max_rad_s2: 10", "a_max_rad_s2 of joint 2"},
        WideLimit{"jerk_max_rad_s3: 6250", "jerk_max_rad_s3: 6251", "jerk_max_rad_s3 of joint 4"},
        WideLimit{"torque_max_n_m: 12", "torque_max_n_m: 13", "torque_max_n_m of joint 5"}),
    [](const auto& test) { return "Case" + std::to_string(test.index); });

RecoveryRequest InAReflex() {
  RecoveryRequest request;
  request.state = RestingPanda();
  request.state.mode = RobotMode::kReflex;
  return request;
}

// Straight above the arm, which at home is no higher than 0.77 m.
ObstacleState BallAt(double z_m) {
  ObstacleState ball;
  ball.X_WO = Pose::Translation({0.1, 0, z_m});
  ball.radius_m = 0.1;
  return ball;
}

TEST(WhyNotRecover, SaysNothingAgainstARobotThatIsInAReflex) {
  RecoveryRequest request = InAReflex();
  EXPECT_FALSE(WhyNotRecover(request, Panda(), 0.5));
  request.since_last_s = 61;
  request.obstacles = {BallAt(2)};
  EXPECT_FALSE(WhyNotRecover(request, Panda(), 0.5));
}

TEST(WhyNotRecover, RefusesWhileItIsStoppedGuidedOrTooSoon) {
  RecoveryRequest request = InAReflex();
  request.state.mode = RobotMode::kUserStopped;
  EXPECT_THAT(WhyNotRecover(request, Panda(), 0.5)->why, HasSubstr("user stop is pressed"));
  request.state.mode = RobotMode::kGuiding;
  EXPECT_THAT(WhyNotRecover(request, Panda(), 0.5)->why, HasSubstr("guides the arm"));
  request = InAReflex();
  request.since_last_s = 59;
  EXPECT_THAT(WhyNotRecover(request, Panda(), 0.5)->why, HasSubstr("once a minute"));
}

// Along a line: refused up to a distance, which is the protective one from the nearest capsule.
TEST(WhyNotRecover, RefusesWhileSomethingIsInsideTheProtectiveDistance) {
  RecoveryRequest request = InAReflex();
  double last_refused_m = 0, last_distance_m = 0;
  for (double z_m = 0.9; z_m < 1.6; z_m += 0.001) {
    request.obstacles = {BallAt(z_m)};
    const auto objection = WhyNotRecover(request, Panda(), 0.5);
    if (!objection) break;
    EXPECT_EQ(objection->check, SafetyCheck::kRecovery);
    EXPECT_DOUBLE_EQ(objection->limit, ProtectiveDistance(0.5));
    last_refused_m = z_m;
    last_distance_m = objection->value;
  }
  EXPECT_NEAR(last_distance_m, ProtectiveDistance(0.5), 0.002);
  // The highest is the capsule of the elbow.
  EXPECT_GT(last_refused_m, 1.0);
  EXPECT_LT(last_refused_m, 1.5);
  request.obstacles = {BallAt(last_refused_m)};
  EXPECT_FALSE(WhyNotRecover(request, Panda(), 0.25)) << "a slower one may be nearer";
}

}  // namespace
}  // namespace sidestep::hardware::readiness_test
