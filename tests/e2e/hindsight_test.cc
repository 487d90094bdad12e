#include "sidestep/bench/hindsight.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/episode_world.h"
#include "sidestep/bench/resolve.h"
#include "sidestep/sim/simulation.h"

namespace sidestep::bench {
namespace {

const std::string kModels = SIDESTEP_SOURCE_DIR "/models";

struct LookedBack {
  scenarios::Scenario scenario;
  robot::RobotModel robot;
  record::Recording recording;
  Hindsight hindsight;
};

LookedBack RunAndLookBack(const std::string& knowledge, const scenarios::Settings& settings = {}) {
  scenarios::Scenario scenario =
      scenarios::LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/hsr_walkway.yaml", settings);
  scenario.planner = "gpmp_fast";
  scenario.knowledge = knowledge;
  const robot::RobotModel robot = robot::RobotModel::Load(kModels, scenario.robot, scenario.X_WB);
  ResolveTask(scenario, robot);
  const auto make_world = [](const scenarios::Scenario& of, const robot::RobotModel& model) {
    return MakeEpisodeWorld(std::make_shared<sim::Simulation>(of, model, kModels));
  };
  const EpisodeResult result = RunEpisode(scenario, robot, make_world, {});
  RequireWhole(result);
  return {scenario, robot, result.recording,
          LookBack(result.recording, scenario, robot, /*max_guesses=*/5, /*seed=*/1)};
}

TEST(Hindsight, HasNothingToSayOfAGoalThatWasReached) {
  const Hindsight hindsight = RunAndLookBack("prediction").hindsight;
  EXPECT_EQ(hindsight.verdict, HindsightVerdict::kReached);
  EXPECT_FALSE(hindsight.contact);
  EXPECT_TRUE(hindsight.cycles.empty());
}

// Who does not know that the robot moves takes it for free until it is there.
TEST(Hindsight, TellsThatWhoKnewNoMotionCouldNotKnowInTime) {
  const LookedBack run = RunAndLookBack("static");
  EXPECT_EQ(run.hindsight.verdict, HindsightVerdict::kNotKnown);
  ASSERT_TRUE(run.hindsight.contact);
  const auto touched = std::find_if(run.recording.truth.begin(), run.recording.truth.end(),
                                    [](const TruthSample& sample) { return sample.in_contact; });
  ASSERT_NE(touched, run.recording.truth.end());
  EXPECT_EQ(run.hindsight.contact->seconds(), touched->contact_s);
  ASSERT_FALSE(run.hindsight.cycles.empty());
  EXPECT_LT(run.hindsight.cycles.back().t_effect, *run.hindsight.contact);
  const HindsightCycle& first = run.hindsight.cycles.front();
  EXPECT_TRUE(first.was_thought_free);
  EXPECT_TRUE(first.knew_a_way);
  EXPECT_TRUE(first.had_a_way);
  EXPECT_GT(first.true_clearance_m, 0);
}

// The robot comes to stand where the hand shall be.
TEST(Hindsight, FindsNoWayWhereThereIsNone) {
  const scenarios::Settings settings = {
      {"moving_obstacles[0].motion",
       "{linear: {start_m: [0.7, 0.5, 0.6], direction: [0, -1, 0], "
       "speed_m_s: 1, stop_at_s: 0.5}}"}};
  const Hindsight hindsight = RunAndLookBack("full_knowledge", settings).hindsight;
  EXPECT_EQ(hindsight.verdict, HindsightVerdict::kNoWay);
  EXPECT_THAT(hindsight.cycles, testing::Each(testing::Field(&HindsightCycle::had_a_way, false)));
  EXPECT_FALSE(hindsight.cycles.empty());
}

TEST(Hindsight, DoesNotAskThePlannerWhyARunWasAborted) {
  LookedBack run = RunAndLookBack("static");
  EXPECT_EQ(WhyCutShort(run.recording), std::nullopt);
  run.recording.header["outcome"] = "aborted";
  run.recording.header["reason"] = "the robot sends no state";
  // What was touched before is looked back at.
  EXPECT_EQ(WhyCutShort(run.recording), std::nullopt);
  EXPECT_TRUE(LookBack(run.recording, run.scenario, run.robot, 1, 1).contact);
  run.recording.truth.clear();
  EXPECT_EQ(WhyCutShort(run.recording), "the robot sends no state");
  EXPECT_THROW(LookBack(run.recording, run.scenario, run.robot, 1, 1), std::invalid_argument);
}

TEST(Hindsight, RefusesARecordingOfAnotherRobotOrWithoutMotion) {
  const LookedBack run = RunAndLookBack("prediction");
  record::Recording other = run.recording;
  other.joints.pop_back();
  EXPECT_THROW(LookBack(other, run.scenario, run.robot, 1, 1), std::invalid_argument);
  other = run.recording;
  other.control.clear();
  EXPECT_THROW(LookBack(other, run.scenario, run.robot, 1, 1), std::invalid_argument);
  other = run.recording;
  other.observations.clear();
  EXPECT_THROW(LookBack(other, run.scenario, run.robot, 1, 1), std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::bench
