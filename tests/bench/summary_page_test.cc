#include "sidestep/bench/summary_page.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "sidestep/bench/free_path_search.h"
#include "sidestep/bench/paired_table.h"
#include "sidestep/bench/resolve.h"
#include "sidestep/bench/run_row.h"
#include "sidestep/bench/statistics/paired_medians.h"
#include "sidestep/bench/statistics/paired_rates.h"

namespace sidestep::bench::summary_page_test {
namespace {

using ::testing::HasSubstr;

scenarios::Scenario Load(const std::string& name, const scenarios::Settings& settings = {}) {
  return scenarios::LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/" + name + ".yaml", settings);
}

robot::RobotModel RobotOf(const scenarios::Scenario& scenario) {
  return robot::RobotModel::Load(SIDESTEP_SOURCE_DIR "/models", scenario.robot, scenario.X_WB);
}

RunRow Row(const std::string& behaviour, const std::string& predictor, const std::string& outcome) {
  RunRow row;
  row.factors = {{"behaviour", behaviour}, {"predictor", predictor}};
  row.outcome = outcome;
  return row;
}

TEST(OutcomeTable, CountsGoalsAndSaysHowTheOthersEnded) {
  const std::vector<RunRow> rows = {
      Row("stop", "two_frame", "goal"),      Row("stop", "two_frame", "collision"),
      Row("stop", "kalman_cv", "goal"),      Row("circle", "two_frame", "failed"),
      Row("circle", "kalman_cv", "timeout"),
  };
  EXPECT_EQ(OutcomeTable(rows, {"behaviour", "predictor"}),
            "| behaviour, by predictor | two_frame | kalman_cv |\n"
            "|---|---|---|\n"
            "| stop | 1/2 | 1/1 |\n"
            "| circle | 0/1 | 0/1 |\n"
            "| all | 1/3 | 1/2 |\n"
            "| collision | 1 | 0 |\n"
            "| failed | 1 | 0 |\n"
            "| timeout | 0 | 1 |\n");
}

TEST(OutcomeTable, NeedsNoAxes) {
  const std::vector<RunRow> rows = {Row("stop", "imm", "goal"), Row("turn", "imm", "timeout")};
  EXPECT_EQ(OutcomeTable(rows, {"", ""}),
            "|  | episodes |\n|---|---|\n| all | 1/2 |\n| timeout | 1 |\n");
  EXPECT_EQ(OutcomeTable(rows, {"behaviour", ""}),
            "| behaviour | episodes |\n|---|---|\n| stop | 1/1 |\n| turn | 0/1 |\n"
            "| all | 1/2 |\n| timeout | 1 |\n");
  EXPECT_EQ(OutcomeTable(rows, {"", "behaviour"}),
            "| by behaviour | stop | turn |\n|---|---|---|\n| all | 1/1 | 0/1 |\n"
            "| timeout | 0 | 1 |\n");
}

TEST(OutcomeTable, HoldsNamesThatLookLikeMarkdown) {
  const std::vector<RunRow> rows = {Row("a|b\nc", "imm", "goal")};
  EXPECT_EQ(OutcomeTable(rows, {"behaviour", "predictor"}),
            "| behaviour, by predictor | imm |\n|---|---|\n| a\\|b c | 1/1 |\n| all | 1/1 |\n");
}

// An episode of one seed at one pace.
RunRow Episode(const std::string& pace, int seed, bool goal, double clearance_m, double time_s) {
  RunRow row;
  row.factors = {{"pace", pace}, {"behaviour", "stop"}, {"seed", std::to_string(seed)}};
  row.outcome = goal ? "goal" : "collision";
  row.metrics = {{"min_clearance_m", clearance_m}, {"time_to_goal_s", goal ? time_s : NAN}};
  return row;
}

TEST(PairedTable, SetsTheSameEpisodesBesideEachOther) {
  std::vector<RunRow> rows;
  for (int seed = 1; seed <= 30; ++seed) {
    // Each has a clearance of its own, and 20 mm more where it is fast; every third then arrives.
    rows.push_back(Episode("slow", seed, seed % 3 != 0, 0.01 * seed, 3));
    rows.push_back(Episode("fast", seed, true, 0.01 * seed + 0.02, 2.5));
  }
  rows.push_back(Episode("fast", 31, true, 5, 1));  // without a partner
  rows.push_back(Episode("slow", 32, true, 5, 1));
  rows.push_back(Episode("fast", 32, true, 5, 1));
  rows.back().outcome = kFailed;
  const std::string table = PairedTable(rows, {"behaviour", "pace"});
  EXPECT_THAT(table, HasSubstr("| behaviour | pace | pairs | goal [%] | difference | clearance"));
  EXPECT_THAT(table, HasSubstr("| stop | slow | 31 | 67.7 | – | 160.0 | – | 3.000 | – | – | – |"));
  EXPECT_THAT(table, HasSubstr("| stop | fast | 30 | 100.0 | +33.3 ("));
  EXPECT_THAT(table,
              HasSubstr(" | 175.0 | +20.0 (20.0 to 20.0) | 2.500 | -0.500 (-0.500 to -0.500)"));
  EXPECT_THAT(table, HasSubstr("| all | fast | 30 | 100.0 | +33.3 ("));
}

TEST(PairedTable, DrawsSeedsAndNotEpisodes) {
  std::vector<RunRow> rows;
  for (const char* const behaviour : {"stop", "turn", "park", "leave"}) {  // all alike
    for (int seed = 1; seed <= 12; ++seed) {
      for (const char* const pace : {"slow", "fast"}) {
        const bool is_fast = pace == std::string("fast");
        rows.push_back(Episode(pace, seed, true, is_fast ? 0.01 * seed : 0, 3));
        rows.back().factors["behaviour"] = behaviour;
      }
    }
  }
  const std::string table = PairedTable(rows, {"behaviour", "pace"});
  // Four times the same episodes tell no more than one time.
  const auto interval = [&](const std::string& line) {
    const std::size_t begin = table.find(line);
    const std::size_t at = table.find("+65.0 (", begin);
    return table.substr(at, table.find(')', at) - at);
  };
  EXPECT_EQ(interval("| all | fast |"), interval("| stop | fast |"));
}

TEST(PairedTable, HasTheIntervalsOfTheReport) {
  std::vector<RunRow> rows;
  std::vector<PairedOutcome> outcomes;
  std::vector<PairedNumber> clearances;
  for (int seed = 1; seed <= 12; ++seed) {
    const bool slow = seed % 4 != 0, fast = seed % 3 != 0;
    const double slow_m = 0.01 * (seed % 5), fast_m = 0.013 * (seed % 7);
    rows.push_back(Episode("slow", seed, slow, slow_m, 3));
    rows.push_back(Episode("fast", seed, fast, fast_m, 3));
    outcomes.push_back({seed, fast, slow});
    clearances.push_back({seed, 1e3 * fast_m, 1e3 * slow_m});
  }
  const PairedRates rates = ComparePairedRates(outcomes);
  const PairedMedians medians = ComparePairedMedians(clearances);
  EXPECT_THAT(PairedTable(rows, {"behaviour", "pace"}),
              HasSubstr(fmt::format("| stop | fast | 12 | 66.7 | {:+.1f} ({:.1f} to {:.1f}) | ",
                                    100 * rates.difference, 100 * rates.interval.low,
                                    100 * rates.interval.high)));
  EXPECT_THAT(PairedTable(rows, {"behaviour", "pace"}),
              HasSubstr(fmt::format(" | {:+.1f} ({:.1f} to {:.1f}) | ", medians.difference,
                                    medians.interval.low, medians.interval.high)));
}

TEST(PairedTable, IsEmptyWhereNothingVariesAcross) {
  EXPECT_EQ(PairedTable({Episode("slow", 1, true, 1, 1)}, {"behaviour", "pace"}), "");
  EXPECT_EQ(PairedTable({Episode("slow", 1, true, 1, 1)}, {"behaviour", ""}), "");
}

TEST(SummaryPage, SaysWhatIsVariedAndWhatIsNot) {
  std::vector<RunRow> rows;
  for (int seed = 1; seed <= 30; ++seed) {
    rows.push_back(Row("stop", "imm", "goal"));
    rows.back().factors["seed"] = std::to_string(seed);
  }
  const std::string page = SummaryPage({"hall", "A hall", "sidestep study hall"}, rows, {"", ""});
  EXPECT_THAT(page, ::testing::StartsWith("# hall\n\nA hall\n\n"
                                          "- varied: seed = 1, 2, ..., 30 (30)\n"
                                          "- fixed: behaviour = stop\n- fixed: predictor = imm\n"
                                          "- 30 episodes, made by\n\n      sidestep study hall\n"));
  EXPECT_THAT(page, HasSubstr("| all | 30/30 |\n"));
}

TEST(RecordedRun, ThatThrowsIsARowThatSaysWhy) {
  const scenarios::Scenario scenario = Load("hsr_walkway");
  const WorldFactory broken = [](const scenarios::Scenario&,
                                 const robot::RobotModel&) -> EpisodeWorld {
    throw std::runtime_error("no world");
  };
  const RecordedRun episode = RunEpisodeRow(scenario, RobotOf(scenario), broken, {{"seed", "1"}});
  const RunRow& row = episode.row;
  EXPECT_FALSE(episode.recording);
  EXPECT_EQ(row.outcome, "failed");
  EXPECT_EQ(row.error, "no world");
  EXPECT_EQ(row.factors.at("seed"), "1");
}

TEST(FreePathSearch, FindsTheMotionThatFullKnowledgeFinds) {
  scenarios::Scenario scenario = Load("hsr_walkway");
  const robot::RobotModel robot = RobotOf(scenario);
  ResolveTask(scenario, robot);
  const FreePath path = SearchFreePath(scenario, robot, 3, 1);
  EXPECT_TRUE(path.found);
  EXPECT_GT(path.clearance_m, 0);
  const int last = path.trajectory.num_states() - 1;
  EXPECT_LT((path.trajectory.q.col(0) - scenario.q_start).norm(), 1e-9);
  EXPECT_LT((path.trajectory.q.col(last) - scenario.q_goal).norm(), 1e-2);
}

TEST(FreePathSearch, KnowsTheFloor) {
  scenarios::Scenario scenario = Load("hsr_walkway");
  const robot::RobotModel robot = RobotOf(scenario);
  ResolveTask(scenario, robot);
  scenario.floor_m = 0.6;  // the hand ends 10 cm above the tables, at 0.4 m
  const FreePath path = SearchFreePath(scenario, robot, 1, 1);
  EXPECT_FALSE(path.found);
  EXPECT_LT(path.clearance_m, 0);
}

TEST(FreePathSearch, FindsNoneToAGoalOnWhichSomethingStands) {
  scenarios::Scenario scenario = Load("hsr_walkway");
  const robot::RobotModel robot = RobotOf(scenario);
  ResolveTask(scenario, robot);
  auto& hsr = std::get<scenarios::LinearMotion>(scenario.moving_obstacles[0].motion);
  hsr.start_m.x() = 0.7;  // where the hand shall be
  hsr.stop_at_s = 2 / hsr.speed_m_s;
  const FreePath path = SearchFreePath(scenario, robot, 2, 1);
  EXPECT_FALSE(path.found);
  EXPECT_EQ(path.guesses, 2);
  EXPECT_LT(path.clearance_m, 0);
}

}  // namespace
}  // namespace sidestep::bench::summary_page_test
