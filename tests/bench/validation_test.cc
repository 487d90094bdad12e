// What a validation varies, what its items conclude from what was found, and how it is told.
#include "sidestep/bench/validation/validation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/bench/resolve.h"
#include "sidestep/bench/validation/behaviours.h"
#include "sidestep/bench/validation/faults.h"
#include "sidestep/bench/validation/faulty_sensor.h"
#include "sidestep/bench/validation/matrix.h"
#include "sidestep/bench/validation/perception.h"
#include "sidestep/bench/validation/protective_distance.h"
#include "sidestep/bench/validation/report.h"
#include "sidestep/bench/validation/support.h"
#include "sidestep/bench/validation/timing.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "tests/support/bytes_of.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::bench::validation_test {
namespace {

using ::testing::HasSubstr;

ValidationSubject TheTable() {
  scenarios::Scenario scenario =
      scenarios::LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/hardware_single_table.yaml");
  robot::RobotModel robot =
      robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", scenario.robot, scenario.X_WB);
  ResolveTask(scenario, robot);
  return {std::move(scenario), std::move(robot)};
}

// The matrix.

TEST(ValidationMatrix, HasAtLeastTwoHundredEpisodesOfDifferentNames) {
  const std::vector<ValidationCase> cases = ValidationMatrix(TheTable().scenario, 2, true);
  std::set<std::string> names;
  for (const ValidationCase& one : cases) {
    EXPECT_TRUE(names.insert(NameOf(one)).second) << NameOf(one) << " is there twice";
  }
  EXPECT_GE(cases.size(), 200u);
}

TEST(ValidationMatrix, LeavesOutNoWordOfItsTables) {
  std::set<std::string> words;
  for (const ValidationCase& one : ValidationMatrix(TheTable().scenario, 1, true)) {
    words.insert({one.behaviour, one.perception, one.timing, one.fault});
  }
  for (const Behaviour& behaviour : Behaviours()) EXPECT_TRUE(words.count(behaviour.name));
  for (const Timing& timing : Timings()) EXPECT_TRUE(words.count(timing.name));
  for (const ValidationFault& fault : ValidationFaults()) EXPECT_TRUE(words.count(fault.name));
  // The table's sensor is occupancy, in whose place comes one whose noise is scaled.
  for (const Perception& perception : Perceptions()) {
    EXPECT_TRUE(words.count(perception.name)) << perception.name;
  }
}

TEST(ValidationMatrix, NeedsNoServerWhereThereIsNone) {
  for (const ValidationCase& one : ValidationMatrix(TheTable().scenario, 1, false)) {
    EXPECT_FALSE(one.on_the_wire) << NameOf(one);
  }
}

TEST(ValidationMatrix, GivesPairsThatDifferInWhatIsKnownTheSameObstacle) {
  const ValidationSubject table = TheTable();
  ValidationCase one;
  one.group = validation_group::kPrediction;
  one.behaviour = "circle";
  one.speed_m_s = 0.25;
  one.knowledge = "prediction";
  ValidationCase other = one;
  other.knowledge = "execute_and_update";
  const scenarios::Scenario a = ScenarioOf(one, table), b = ScenarioOf(other, table);
  for (const double t_s : {0.0, 1.0, 4.0}) {
    const EpisodeTime t(t_s);
    EXPECT_EQ(PoseAt(a.moving_obstacles[0], t).translation(),
              PoseAt(b.moving_obstacles[0], t).translation());
  }
  other.draw = 3;
  EXPECT_NE(PoseAt(a.moving_obstacles[0], EpisodeTime(0)).translation(),
            PoseAt(ScenarioOf(other, table).moving_obstacles[0], EpisodeTime(0)).translation());
}

// Obstacles.

class EveryBehaviour : public ::testing::TestWithParam<std::string> {};

// Differences of positions, 10 ms apart, of 12 s.
TEST_P(EveryBehaviour, KeepsToTheSpeedAndTheAccelerationThatItsRowTells) {
  constexpr double kSpeed = 0.4, kStep_s = 0.01, kRounding = 1e-6;
  for (int draw = 1; draw <= 5; ++draw) {
    ValidationSubject table = TheTable();
    SetBehaviour(GetParam(), kSpeed, static_cast<std::uint64_t>(draw), table.robot, table.scenario);
    const double most_m_s2 = BehaviourOf(GetParam()).acceleration_share *
                             table.scenario.safety.obstacle_acceleration_m_s2;
    for (const scenarios::MovingObstacle& obstacle : table.scenario.moving_obstacles) {
      Eigen::Vector3d last = PoseAt(obstacle, EpisodeTime(0)).translation();
      Eigen::Vector3d last_v = Eigen::Vector3d::Zero();
      for (int k = 1; k < 1200; ++k) {
        const Eigen::Vector3d p = PoseAt(obstacle, EpisodeTime(k * kStep_s)).translation();
        const Eigen::Vector3d v = (p - last) / kStep_s;
        EXPECT_LE(v.norm(), kSpeed + kRounding);
        if (k > 1) {
          EXPECT_LE((v - last_v).norm() / kStep_s, most_m_s2 + 1e-3) << GetParam() << " at " << k;
        }
        last = p;
        last_v = v;
      }
    }
  }
}

std::vector<std::string> BehaviourNames() {
  std::vector<std::string> names;
  for (const Behaviour& behaviour : Behaviours()) names.emplace_back(behaviour.name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(Listed, EveryBehaviour, ::testing::ValuesIn(BehaviourNames()),
                         [](const auto& test) { return test.param; });

// Sensors.

// Sees one box at rest, each 0.1 s.
class Steady final : public robot::Sensor {
 public:
  EpisodeTime NextDue() const override { return EpisodeTime(0); }
  std::optional<Scan> Read(EpisodeTime now) override {
    Scan scan;
    scan.t = now;
    scan.X_WC = Pose(Eigen::Quaterniond::Identity(), Eigen::Vector3d(2, 0, 0));
    ObjectObservation box;
    box.t = now;
    scan.objects.push_back(box);
    return scan;
  }
};

std::vector<std::optional<Scan>> Scans(const SensorFaults& faults, int count = 40) {
  Steady steady;
  FaultySensor sensor(&steady, faults, /*seed=*/1);
  std::vector<std::optional<Scan>> scans;
  for (int k = 0; k < count; ++k) scans.push_back(sensor.Read(EpisodeTime(0.1 * k)));
  return scans;
}

TEST(FaultySensor, ChangesNothingWithoutAFault) {
  for (const auto& scan : Scans({})) {
    ASSERT_TRUE(scan.has_value());
    EXPECT_EQ(scan->objects.at(0).X_WO.translation(), Eigen::Vector3d::Zero());
  }
}

TEST(FaultySensor, IsBlindForAsLongAsItIsSaidToBe) {
  const auto scans = Scans({.blind_from_s = 1, .blind_for_s = 0.5});
  EXPECT_EQ(std::count_if(scans.begin(), scans.end(), [](const auto& scan) { return !scan; }), 5);
  EXPECT_TRUE(scans[9].has_value());
  EXPECT_FALSE(scans[10].has_value());
  EXPECT_TRUE(scans[15].has_value());
}

TEST(FaultySensor, LosesWhatItSawFromThenOn) {
  const auto scans = Scans({.lost_from_s = 1});
  EXPECT_EQ(scans[9]->objects.size(), 1u);
  EXPECT_TRUE(scans[10]->objects.empty());
}

TEST(FaultySensor, SaysThatItSawLaterThanItDid) {
  const auto scans = Scans({.ahead_from_s = 1, .ahead_s = 0.3});
  EXPECT_NEAR(scans[9]->t.seconds(), 0.9, 1e-12);
  EXPECT_NEAR(scans[10]->t.seconds(), 1.3, 1e-12);
  EXPECT_EQ(scans[10]->objects.at(0).t, scans[10]->t);
}

TEST(FaultySensor, PutsSoManyThingsWhereTheyAreNot) {
  int outliers = 0;
  for (const auto& scan : Scans({.outlier_share = 0.2}, 2000)) {
    const double off_m = scan->objects.at(0).X_WO.translation().norm();
    EXPECT_TRUE(off_m < 1e-12 || std::abs(off_m - 0.5) < 1e-12);
    outliers += off_m > 0.1 ? 1 : 0;
  }
  EXPECT_NEAR(outliers, 400, 80);  // 4.5 standard deviations
}

// 2 m from the camera a turn of 0.01 rad is 20 mm at most.
TEST(FaultySensor, OfAWrongCalibrationIsOffByThatAlways) {
  const auto scans = Scans({.shift_m = 0.01, .turn_rad = 0.01});
  const Eigen::Vector3d off = scans[0]->objects.at(0).X_WO.translation();
  EXPECT_GT(off.norm(), 1e-4);
  EXPECT_LE(off.norm(), 0.01 + 0.02 + 1e-9);
  EXPECT_EQ(scans[30]->objects.at(0).X_WO.translation(), off);
}

// An arm that turns at its first joint, and a box beside its path, which stands.
struct TurningArm {
  ValidationSubject subject = TheTable();
  control::JerkLimitedTracker tracker = LabTracker(subject.robot);

  // Of 50 ms from one state on: by the quickest stop, or as before.
  Facts Measure(bool stops, const Pose& X_WO) const {
    const int n = subject.robot.num_joints();
    ControlSample tick;
    tick.q_command = subject.robot.configurations().at("home");
    tick.v_command = tick.a_command = Eigen::VectorXd::Zero(n);
    tick.v_command(0) = 0.5;
    EpisodeResult result;
    for (int i = 0; i <= 50; ++i) {
      tick.t = EpisodeTime(i * 1e-3);
      if (i > 0 && stops) {
        const control::JointPoint next =
            tracker.Brake({tick.q_command, tick.v_command, tick.a_command}, 1e-3);
        tick.q_command = next.q;
        tick.v_command = next.v;
        tick.a_command = next.a;
      } else if (i > 0) {
        tick.q_command += 1e-3 * tick.v_command;
      }
      tick.q = tick.q_command;
      result.recording.control.push_back(tick);
      TruthSample sample;
      sample.t = tick.t;
      sample.X_WO = {X_WO};
      if (i % 10 == 0) result.recording.truth.push_back(sample);
    }
    const std::span<const ValidationItem> items = ValidationItems();
    const auto item = std::find_if(items.begin(), items.end(),
                                   [](const ValidationItem& of) { return of.number == 10; });
    const ValidationCase supervised;
    return item->measure({supervised, subject.scenario, subject.robot, result});
  }
};

TEST(ProtectiveDistance, HasNoReactionTimeOfAnArmThatStopsAlready) {
  const TurningArm arm;
  const double radius_m = 0.5;
  // From behind on towards the arm, until even the one that stops is too near.
  double angle = 1.5;
  const auto beside = [&] {
    return Pose::Translation({radius_m * std::cos(angle), radius_m * std::sin(angle), 0.6});
  };
  const auto violated = [&](bool stops) {
    return arm.Measure(stops, beside()).at("separation_violated");
  };
  while (angle > 0 && violated(/*stops=*/true) == 0) angle -= 0.01;
  angle += 0.01;
  EXPECT_GT(angle, 0.2);
  EXPECT_EQ(violated(/*stops=*/true), 0);
  // What it would go on by in 0.12 s is missing to the one that does not stop.
  EXPECT_GT(arm.Measure(/*stops=*/false, beside()).at("separation_lack_m"), 0.02);
}

// Computed by hand, to two digits.
TEST(ProtectiveDistance, IsThatOfTheFormulaWithTypicalFigures) {
  const auto distance_m = [](double obstacle, double robot, double stop_s) {
    return ProtectiveDistance({.obstacle_m_s = obstacle,
                               .robot_m_s = robot,
                               .reaction_s = 0.12,
                               .stop_s = stop_s,
                               .stop_m = 0.06,
                               .uncertainty_m = 0.03});
  };
  EXPECT_NEAR(distance_m(1.6, 0.5, 0.25), 0.74, 0.005);
  EXPECT_NEAR(distance_m(0.5, 0.5, 0.25), 0.335, 0.005);
}

// Items.

struct Row {
  std::string group;
  Facts facts;
  Factors factors = {};
};

ItemFinding Judge(int number, const std::vector<Row>& told) {
  std::vector<RunRow> rows;
  int draw = 0;
  for (const Row& one : told) {
    ValidationCase as_case;
    as_case.group = one.group;
    as_case.behaviour = "cross";
    as_case.draw = ++draw;
    RunRow& row = rows.emplace_back();
    row.factors = FactorsOf(as_case);
    for (const auto& [factor, value] : one.factors) row.factors[factor] = value;
    row.metrics = one.facts;
    row.outcome = "goal";
  }
  const scenarios::Scenario scenario = TheTable().scenario;
  for (const ValidationItem& item : ValidationItems()) {
    if (item.number == number) return item.judge({scenario, rows});
  }
  ADD_FAILURE() << "no item " << number;
  return {};
}

struct Verdict {
  int item;
  std::string what;
  std::vector<Row> rows;
  ItemVerdict verdict;
};

// A test is told by its name, not by the bytes of its row.
void PrintTo(const Verdict& verdict, std::ostream* out) { *out << verdict.what; }

constexpr ItemVerdict kPass = ItemVerdict::kPass, kFail = ItemVerdict::kFail;

const std::string kEnvelope = validation_group::kEnvelope;

Row Pair(const std::string& knowledge, double is_free, double clearance_m, double jerk) {
  return {validation_group::kPrediction,
          {{"alone_free", is_free}, {"alone_clearance_m", clearance_m}, {"alone_jerk_rms", jerk}},
          {{"knowledge", knowledge}, {"draw", "1"}}};
}

std::vector<Verdict> Verdicts() {
  const auto limits = [](double v, double a, double j) {
    return Row{kEnvelope, {{"velocity_use", v}, {"acceleration_use", a}, {"jerk_use", j}}};
  };
  const auto clearance = [](double near, double sure) {
    return Row{kEnvelope,
               {{"samples_in_motion", 1000},
                {"samples_near", near},
                {"lack_of_clearance_m", -0.06},
                {"sure_lack_of_clearance_m", sure}}};
  };
  const auto stops = [](double without, double s, double m) {
    return Row{kEnvelope,
               {{"ticks", 5000}, {"ticks_without_stop", without}, {"stop_s", s}, {"stop_m", m}}};
  };
  const auto separation = [](double violated, double unanswered) {
    return Row{kEnvelope,
               {{"separation_samples", 1000},
                {"separation_violated", violated},
                {"separation_unanswered", unanswered},
                {"separation_lack_m", 0.01}}};
  };
  const auto reaction = [](double p50, double p99, double most) {
    return Row{kEnvelope,
               {{"reaction_p50_s", p50}, {"reaction_p99_s", p99}, {"reaction_max_s", most}}};
  };
  const auto fault = [](double answered, double rests) {
    return Row{validation_group::kFault, {{"fault_answered", answered}, {"fault_rests", rests}}};
  };
  const auto hash = [](const std::string& group, double value) {
    return Row{group, {{"commands_hash", value}}, {{"draw", "1"}}};
  };
  const auto task = [](double reached, double free) {
    return Row{kEnvelope, {{"reaches_goal", reached}, {"free_path", free}}};
  };
  const auto touch = [](const std::string& group, double moving) {
    return Row{group, {{"contact_in_motion", moving}, {"contact_at_rest_only", 1 - moving}}};
  };
  return {
      {1, "NoError", {{validation_group::kTiming, {{"robot_errors", 0}}}}, kPass},
      {1, "AReflex", {{kEnvelope, {{"robot_errors", 1}}}}, kFail},
      {2, "AtTheLimits", {limits(0.5, 0.5, 0.1 + 4e-7)}, kPass},
      {2, "TooFast", {limits(0.51, 0.4, 0.1)}, kFail},
      {2, "TooMuchJerk", {limits(0.4, 0.4, 0.1), limits(0.4, 0.4, 0.11)}, kFail},
      {3, "Far", {{kEnvelope, {{"joint_excess_rad", -0.1}}}}, kPass},
      {3, "Near", {{kEnvelope, {{"joint_excess_rad", -0.09}}}}, kFail},
      {4, "AtRest", {{kEnvelope, {{"start_share", 0}, {"end_share", 0.9}}}}, kPass},
      {4, "MovesInTheEnd", {{kEnvelope, {{"start_share", 0}, {"end_share", 1.1}}}}, kFail},
      {4, "MovesAtFirst", {{kEnvelope, {{"start_share", 2}}}}, kFail},
      {5, "Strong", {{kEnvelope, {{"torque_use", 0.9}, {"torque_rate_use", 0.9}}}}, kPass},
      {5, "Weak", {{kEnvelope, {{"torque_use", 0.97}, {"torque_rate_use", 0.9}}}}, kFail},
      {5, "Jerky", {{kEnvelope, {{"torque_use", 0.5}, {"torque_rate_use", 1.1}}}}, kFail},
      {6, "Slow", {{kEnvelope, {{"tool_speed_m_s", 0.24}}}}, kPass},
      {6, "LaterOnly", {{kEnvelope, {{"tool_speed_m_s", 0.5}}}}, kPass},
      {6, "Fast", {{kEnvelope, {{"tool_speed_m_s", 0.51}}}}, kFail},
      {7, "SeldomNear", {clearance(10, -0.01)}, kPass},
      {7, "OftenNear", {clearance(11, -0.01)}, kFail},
      {7, "NotSure", {clearance(0, 0.001)}, kFail},
      {8, "AtRest", {touch(kEnvelope, 0)}, kPass},
      {8, "InMotion", {touch(kEnvelope, 1)}, kFail},
      {8, "SeenBadly", {touch(kEnvelope, 0), touch(validation_group::kPerception, 1)}, kFail},
      {8, "BeyondTheEnvelope", {touch(kEnvelope, 0), touch(validation_group::kFast, 1)}, kPass},
      {9, "Covered", {stops(0, 0.35, 0.1)}, kPass},
      {9, "NotCovered", {stops(1, 0.1, 0.01)}, kFail},
      {9, "Long", {stops(0, 0.36, 0.1)}, kFail},
      {9, "Far", {stops(0, 0.3, 0.11)}, kFail},
      {10, "Kept", {separation(10, 0)}, kPass},
      {10, "NotKept", {separation(11, 0)}, kFail},
      {10, "NotAnswered", {separation(5, 1)}, kFail},
      {11, "Quick", {reaction(0.2, 0.3, 0.5)}, kPass},
      {11, "SlowOnce", {reaction(0.1, 0.2, 0.51)}, kFail},
      {11, "SlowMostly", {reaction(0.21, 0.25, 0.25)}, kFail},
      {12, "Regular", {{kEnvelope, {{"replan_periods_p99", 2}}}}, kPass},
      {12, "Rare", {{kEnvelope, {{"replan_periods_p99", 2.1}}}}, kFail},
      {12,
       "LateAndTouching",
       {{kEnvelope, {{"replan_periods_p99", 1}}},
        {validation_group::kTiming, {{"contact_in_motion", 1}}, {{"timing", "planner_x4"}}}},
       kFail},
      {14, "Answered", {fault(1, 1)}, kPass},
      {14, "NotAnswered", {fault(1, 1), fault(0, 1)}, kFail},
      {14, "GoesOn", {fault(1, 0)}, kFail},
      {15, "Same", {hash(kEnvelope, 7), hash(validation_group::kRepeat, 7)}, kPass},
      {15, "Other", {hash(kEnvelope, 7), hash(validation_group::kRepeat, 8)}, kFail},
      {18,
       "Worth",
       {Pair("prediction", 1, 0.12, 10), Pair("execute_and_update", 0, 0.02, 10)},
       kPass},
      {18,
       "Jerkier",
       {Pair("prediction", 1, 0.12, 11), Pair("execute_and_update", 1, 0.1, 10)},
       kFail},
      {18,
       "NoDifference",
       {Pair("prediction", 1, 0.1, 10), Pair("execute_and_update", 1, 0.1, 10)},
       kFail},
      {19, "Long", std::vector<Row>(2000, touch(validation_group::kSoak, 0)), kPass},
      {19, "TooShort", {touch(validation_group::kSoak, 0)}, ItemVerdict::kNotRun},
      {19, "Touched", {touch(validation_group::kSoak, 1)}, kFail},
      {20, "Reached", {task(1, 1), task(0, 0)}, kPass},
      {20, "HeldStill", {task(0, 1), task(1, 1)}, kFail},
  };
}

class ItemVerdicts : public ::testing::TestWithParam<Verdict> {};

TEST_P(ItemVerdicts, FollowFromWhatWasFound) {
  const ItemFinding finding = Judge(GetParam().item, GetParam().rows);
  EXPECT_EQ(finding.verdict, GetParam().verdict) << finding.evidence;
  EXPECT_FALSE(finding.evidence.empty());
}

INSTANTIATE_TEST_SUITE_P(Rows, ItemVerdicts, ::testing::ValuesIn(Verdicts()), [](const auto& test) {
  return "Item" + std::to_string(test.param.item) + test.param.what;
});

// The laboratory has them, or another scenario.
bool IsNeverRunHere(int number) { return number == 13 || number == 16 || number == 17; }

TEST(ValidationItems, CanEachPassAndFail) {
  std::set<std::pair<int, ItemVerdict>> seen;
  for (const Verdict& verdict : Verdicts()) seen.insert({verdict.item, verdict.verdict});
  for (const ValidationItem& item : ValidationItems()) {
    if (IsNeverRunHere(item.number)) continue;
    EXPECT_TRUE(seen.count({item.number, kPass})) << item.number << " needs a row that passes";
    EXPECT_TRUE(seen.count({item.number, kFail})) << item.number << " needs a row that fails";
  }
}

TEST(ValidationItems, AreNotRunWhereNothingWasAndSayWhy) {
  for (const ValidationItem& item : ValidationItems()) {
    const ItemFinding finding = Judge(item.number, {});
    EXPECT_EQ(finding.verdict, ItemVerdict::kNotRun) << item.number;
    EXPECT_GT(finding.evidence.size(), 10u) << item.number;
  }
}

TEST(ValidationItems, AreNumberedFromOneOn) {
  int number = 0;
  for (const ValidationItem& item : ValidationItems()) EXPECT_EQ(item.number, ++number);
  EXPECT_EQ(number, 20);
}

TEST(ValidationItems, ThatHoldSoFarDoNotPassBeforeTheEnd) {
  const scenarios::Scenario scenario = TheTable().scenario;
  RunRow row;
  ValidationCase one;
  one.group = kEnvelope;
  row.factors = FactorsOf(one);
  row.metrics = {{"tool_speed_m_s", 0.1}, {"joint_excess_rad", 0.0}};
  const std::vector<RunRow> rows = {row};
  for (const JudgedItem& judged : JudgeItems({scenario, rows}, /*is_whole=*/false)) {
    EXPECT_NE(judged.finding.verdict, kPass) << judged.item.number;
    const bool fails = judged.finding.verdict == kFail;
    EXPECT_EQ(fails, judged.item.number == 3) << "what fails will not mend";
  }
}

std::string Page(const std::string& name) { return BytesOf(SIDESTEP_SOURCE_DIR "/docs/" + name); }

// What is required stands on the page, so that nobody has to run it to know.
TEST(ValidationItems, AreInTheDocumentation) {
  const std::string page = Page("validation.md");
  for (const ValidationItem& item : ValidationItems()) {
    const std::string row = "| " + std::to_string(item.number) + " | " + item.name + " | " +
                            item.requirement + " | " + item.basis + " |";
    EXPECT_THAT(page, HasSubstr(row));
  }
  for (const char* const rung : BringUpLadder()) {
    EXPECT_THAT(Page("hardware.md"), HasSubstr(rung));
  }
  for (const Behaviour& behaviour : Behaviours()) {
    EXPECT_THAT(page, HasSubstr(std::string("| `") + behaviour.name + "` | " + behaviour.meaning));
  }
  for (const Perception& perception : Perceptions()) {
    EXPECT_THAT(page, HasSubstr("`" + std::string(perception.name) + "`"));
  }
  for (const ValidationFault& fault : ValidationFaults()) {
    EXPECT_THAT(page, HasSubstr("`" + std::string(fault.name) + "`"));
  }
}

// Reports.

TEST(ValidationReport, TellsOfEachFailureHowToRunItAgain) {
  const scenarios::Scenario scenario = TheTable().scenario;
  RunRow row;
  ValidationCase one;
  one.group = kEnvelope;
  one.behaviour = "cross";
  row.factors = FactorsOf(one);
  row.metrics = {{"tool_speed_m_s", 0.7}};
  row.outcome = "goal";
  row.command = "sidestep validate gpmp --only this";
  const std::vector<RunRow> rows = {row};
  const std::vector<JudgedItem> items = JudgeItems({scenario, rows}, true);
  const ValidationTitle title = {"gpmp", "table", "tags", "sidestep validate gpmp", 1, {}};
  EXPECT_TRUE(HasFailed(items));
  const std::string page = ValidationPage(title, items, rows);
  EXPECT_THAT(page, HasSubstr("sidestep validate gpmp --only this"));
  EXPECT_THAT(page, HasSubstr("| 6 | speed of the tool | **fail** |"));
  EXPECT_THAT(page, HasSubstr("Nothing here is certified"));
  const nlohmann::json json = nlohmann::json::parse(ValidationJson(title, items, rows));
  EXPECT_EQ(json["verdict"], "fail");
  EXPECT_EQ(json["items"].size(), ValidationItems().size());
  EXPECT_EQ(json["items"][5]["worst"][0]["case"], NameOf(one));
  EXPECT_EQ(json["items"][5]["worst"][0]["command"], row.command);
  EXPECT_EQ(json["items"][12]["verdict"], "not run");
  EXPECT_THAT(ValidationCsv(rows), HasSubstr("tool_speed_m_s"));
}

TEST(ValidationReport, IsReadBackToTheBitToBeGoneOnWith) {
  std::vector<RunRow> rows;
  for (const ValidationCase& one : SoakCases(TheTable().scenario, 501, 503)) {
    RunRow& row = rows.emplace_back();
    row.factors = FactorsOf(one);
    row.outcome = "collision";
    row.error = "a, \"b\"";
    row.metrics = {{"torque_use", 0.1 + 0.2 * one.draw}};
    if (one.draw == 502) row.metrics["only_here"] = 1e-300;
    row.command = "sidestep validate gpmp --soak " + std::to_string(one.draw);
  }
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "validation.csv").string();
  WriteFile(path, ValidationCsv(rows));
  const std::vector<RunRow> read = ReadValidationCsv(path);
  ASSERT_EQ(read.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(read[i].factors, rows[i].factors);
    EXPECT_EQ(read[i].outcome, rows[i].outcome);
    EXPECT_EQ(read[i].error, rows[i].error);
    EXPECT_EQ(read[i].metrics, rows[i].metrics);
    EXPECT_EQ(read[i].command, rows[i].command);
  }
  WriteFile(path, "case,outcome,error\n");
  EXPECT_THAT(
      [&] { ReadValidationCsv(path); },
      ::testing::ThrowsMessage<InputError>(HasSubstr("1: header: has no column 'command'")));
}

// What cannot be validated.

struct Unfit {
  const char* name;
  void (*spoil)(ValidationSubject&);
  const char* why;
};
constexpr Unfit kUnfit[] = {
    {"Unsupervised",
     [](ValidationSubject& table) {
       table.scenario.safety.profile = scenarios::SafetyProfile::kOff;
     },
     "safety.profile: must be lab to be validated"},
    {"NothingMoves", [](ValidationSubject& table) { table.scenario.moving_obstacles.clear(); },
     "moving_obstacles: must hold what moves"},
    {"NoCapsules",
     [](ValidationSubject& table) {
       table.robot =
           robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", "wam", table.scenario.X_WB);
     },
     "robot.model: wam has no capsules"},
};

void PrintTo(const Unfit& unfit, std::ostream* out) { *out << unfit.name; }

class UnfitSubject : public ::testing::TestWithParam<Unfit> {};

TEST_P(UnfitSubject, IsRefusedAsAPersonsMistake) {
  ValidationSubject table = TheTable();
  GetParam().spoil(table);
  try {
    CheckSubject(table);
    FAIL() << "was taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().why));
    EXPECT_THAT(error.what(), HasSubstr("hardware_single_table.yaml:"));
  }
}

INSTANTIATE_TEST_SUITE_P(Rows, UnfitSubject, ::testing::ValuesIn(kUnfit),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace sidestep::bench::validation_test
