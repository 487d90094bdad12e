#include "sidestep/cli/study_cases.h"

#include <gtest/gtest.h>

#include "sidestep/cli/run_case.h"
#include "sidestep/cli/shell_quote.h"
#include "sidestep/cli/sweep_summary.h"
#include "sidestep/cli/varied_keys.h"
#include "sidestep/core/input_error.h"

namespace sidestep::cli {
namespace {

bench::Sweep Of(const std::vector<std::pair<std::string, int>>& counts) {
  bench::Sweep sweep;
  sweep.scenarios = {"hall"};
  sweep.seeds = {1};
  for (const auto& [factor, count] : counts) {
    std::vector<std::string> values;
    for (int i = 0; i < count; ++i) values.push_back(std::to_string(i));
    if (factor == "seed") {
      sweep.seeds.assign(static_cast<std::size_t>(count), 1);
    } else {
      sweep.axes.push_back({factor, values});
    }
  }
  return sweep;
}

struct Choice {
  std::vector<std::pair<std::string, int>> factors;  // and how many values each has
  std::string asked_down, asked_across, down, across;
};

TEST(ChooseAxes, TakesWhatVaries) {
  const Choice choices[] = {
      {{}, "", "", "", ""},
      {{{"seed", 9}}, "", "", "", ""},
      {{{"speed_m_s", 3}}, "", "", "speed_m_s", ""},
      {{{"predictor", 3}, {"seed", 9}}, "", "", "predictor", ""},
      {{{"behaviour", 3}, {"knowledge", 2}}, "", "", "behaviour", "knowledge"},
      {{{"behaviour", 3}, {"predictor", 2}}, "", "", "behaviour", "predictor"},
      {{{"behaviour", 3}, {"speed_m_s", 2}}, "", "", "behaviour", "speed_m_s"},
      {{{"knowledge", 3}, {"predictor", 2}}, "", "", "predictor", "knowledge"},
      {{{"behaviour", 1}, {"speed_m_s", 2}}, "", "", "speed_m_s", ""},
      {{{"behaviour", 1}, {"speed_m_s", 2}}, "behaviour", "", "behaviour", "speed_m_s"},
      {{{"behaviour", 3}, {"knowledge", 2}}, "knowledge", "", "knowledge", "behaviour"},
      {{{"behaviour", 3}, {"seed", 9}}, "", "seed", "behaviour", "seed"},
  };
  for (const Choice& choice : choices) {
    const bench::TableAxes axes =
        ChooseAxes(Of(choice.factors), {choice.asked_down, choice.asked_across});
    EXPECT_EQ(axes.down, choice.down);
    EXPECT_EQ(axes.across, choice.across);
  }
}

TEST(ChooseAxes, PutsAcrossWhatASweepCompares) {
  bench::Sweep sweep = Of({{"knowledge", 2}, {"planner.qc", 2}, {"predictor", 3}});
  sweep.question.factor = "planner.qc";
  const bench::TableAxes axes = ChooseAxes(sweep, {});
  EXPECT_EQ(axes.down, "knowledge");
  EXPECT_EQ(axes.across, "planner.qc");
}

TEST(ChooseAxes, RefusesWhatIsNoFactor) {
  EXPECT_THROW(ChooseAxes(Of({{"speed_m_s", 2}}), {"pace", ""}), InputError);
  EXPECT_THROW(ChooseAxes(Of({{"speed_m_s", 2}}), {"speed_m_s", "speed_m_s"}), InputError);
}

TEST(RunCommandOf, NamesEveryFactor) {
  EXPECT_EQ(RunCommandOf("scenes/my room.yaml", {{"behaviour", "stop"},
                                                 {"knowledge", "static"},
                                                 {"planner.qc", "2"},
                                                 {"seed", "3"},
                                                 {"speed_m_s", "0.8"}}),
            "sidestep run 'scenes/my room.yaml' --set behaviour=stop --knowledge static "
            "--set planner.qc=2 --seed 3 --speed 0.8");
  EXPECT_EQ(RunCommandOf("a", {{"knowledge", "search"}}), "");
  EXPECT_EQ(RunCommandOf("a", {{"replanning.latency_s/replanning.rate_hz", "0.1/10"}}),
            "sidestep run a --set replanning.latency_s=0.1 --set replanning.rate_hz=10");
}

TEST(VariedKeys, AreReadWithTheirValues) {
  const VariedKeys one = ParseVariedKeys("planner.qc=1,2,0.5");
  EXPECT_EQ(one.factor, "planner.qc");
  EXPECT_EQ(one.values, (std::vector<std::string>{"1", "2", "0.5"}));
  const VariedKeys list = ParseVariedKeys("task.goal=[1, 2],{a: [3, 4], b: 5},\"x,y\",ready");
  EXPECT_EQ(list.values,
            (std::vector<std::string>{"[1, 2]", "{a: [3, 4], b: 5}", "\"x,y\"", "ready"}));
  EXPECT_EQ(ParseVariedKeys("sensor.name=a/b").values, (std::vector<std::string>{"a/b"}));
}

TEST(VariedKeys, ThatGoTogetherAreSetTogether) {
  const VariedKeys both = ParseVariedKeys("a.b/c[0]=0.1/[1/2],0.2/x");
  EXPECT_EQ(both.factor, "a.b/c[0]");
  using Settings = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(SettingsOf(both.factor, both.values.at(0)),
            (Settings{{"a.b", "0.1"}, {"c[0]", "[1/2]"}}));
  EXPECT_EQ(SettingsOf(both.factor, both.values.at(1)), (Settings{{"a.b", "0.2"}, {"c[0]", "x"}}));
  EXPECT_EQ(SettingsOf("file", "a/b"), (Settings{{"file", "a/b"}}));
}

std::string Complaint(const StudySpace& space) {
  try {
    SweepOf(space, {SIDESTEP_SOURCE_DIR "/models", SIDESTEP_SOURCE_DIR "/scenarios"});
  } catch (const InputError& error) {
    return error.what();
  }
  return "was accepted";
}

TEST(SweepOf, CrossesWhatIsVaried) {
  StudySpace space;
  space.scenario = "walkway_behaviours";
  space.varied = {"behaviour=stop,turn", "replanning.latency_s/replanning.rate_hz=0.1/10,0.02/50"};
  space.episodes = 3;
  const bench::SweepPlan plan(
      SweepOf(space, {SIDESTEP_SOURCE_DIR "/models", SIDESTEP_SOURCE_DIR "/scenarios"}));
  ASSERT_EQ(plan.num_runs(), 12u);
  EXPECT_EQ(plan.At(0).factors,
            (bench::Factors{{"behaviour", "stop"},
                            {"replanning.latency_s/replanning.rate_hz", "0.1/10"}}));
  EXPECT_EQ(plan.At(0).seed, 1u);
  EXPECT_EQ(plan.At(11).factors,
            (bench::Factors{{"behaviour", "turn"},
                            {"replanning.latency_s/replanning.rate_hz", "0.02/50"}}));
  EXPECT_EQ(plan.At(11).seed, 3u);
}

TEST(SweepOf, TakesEveryOptionOfAChoiceThatIsLeftOpenAndTheScenariosSeed) {
  StudySpace space;
  space.scenario = "walkway_behaviours";
  space.speeds = {0.5, 1};
  const DataPaths paths{SIDESTEP_SOURCE_DIR "/models", SIDESTEP_SOURCE_DIR "/scenarios"};
  EXPECT_EQ(bench::SweepPlan(SweepOf(space, paths)).num_runs(), 30u);
  space.settings = {"behaviour=stop", "seed=9"};
  const bench::SweepPlan fixed(SweepOf(space, paths));
  EXPECT_EQ(fixed.num_runs(), 2u);
  EXPECT_EQ(fixed.At(0).seed, 9u);
  space.settings = {"seed=nine"};
  EXPECT_EQ(Complaint(space), "--set seed: must be a whole number >= 0, is 'nine'");
  space.settings = {"seed=09"};
  EXPECT_EQ(Complaint(space), "--set seed: must be a whole number without leading zeros, is '09'");
}

TEST(SweepOf, RefusesWhatCannotBeVaried) {
  const auto complaint = [](const std::vector<std::string>& varied) {
    StudySpace space;
    space.scenario = "walkway_behaviours";
    space.settings = {"planner.qc=2"};
    space.varied = varied;
    return Complaint(space);
  };
  EXPECT_EQ(complaint({"planner.sigma_obs=1,2"}), "was accepted");
  EXPECT_EQ(complaint({"planner"}), "--vary: must be KEY=VALUE,VALUE,..., is 'planner'");
  EXPECT_EQ(complaint({"planner.qc=1,2"}), "--set planner.qc: is given twice");
  EXPECT_EQ(complaint({"a/b=1/2,3"}), "--vary a/b: needs 2 values with / between them, is '3'");
  EXPECT_EQ(complaint({"planner.n_int=1,1"}), "planner.n_int: '1' is given twice");
  EXPECT_EQ(complaint({"seed=1,2"}), "--vary seed: is what --episodes varies");
  EXPECT_EQ(complaint({"speed_m_s=1,2"}), "--vary speed_m_s: is what --speed varies");
}

TEST(ShellQuoted, LeavesPlainWordsAndQuotesTheOthers) {
  EXPECT_EQ(ShellQuoted("planner.qc=2"), "planner.qc=2");
  EXPECT_EQ(ShellQuoted(""), "''");
  EXPECT_EQ(ShellQuoted("a b"), "'a b'");
  EXPECT_EQ(ShellQuoted("sensor={rate_hz: 30}"), "'sensor={rate_hz: 30}'");
  EXPECT_EQ(ShellQuoted("it's"), "'it'\\''s'");
  EXPECT_EQ(ShellQuoted("caf\xe9\n'1"), "$'caf\\351\\012\\0471'");
}

}  // namespace
}  // namespace sidestep::cli
