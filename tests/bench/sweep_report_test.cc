#include "sidestep/bench/report/sweep_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "sidestep/bench/database/run_choice.h"
#include "sidestep/bench/database/run_database_writer.h"
#include "sidestep/bench/report/comparison.h"
#include "sidestep/bench/report/svg.h"
#include "sidestep/bench/run_row.h"
#include "sidestep/core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::bench::sweep_report_test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

// A sweep as a database: knowledge `now` fails where the speed is above 1, or the seed is 3.
class ReportTest : public ::testing::Test {
 protected:
  struct Options {
    int seeds = 3;
    std::string title = "walk", touched = "hsr", error;
    bool asks = true;
  };

  RunDatabase Write(const Options& options) {
    const std::string path = (folder_.path() / "results.db").string();
    RunTableHead head;
    head.facts = {
        {"title", options.title}, {"description", "does it help?"}, {"num_planned", "99"}};
    if (options.asks) {
      head.facts["compare.factor"] = "knowledge";
      head.facts["compare.of"] = "ahead";
      head.facts["compare.with"] = "now";
    }
    head.factors =
        FactorColumnsOf({{"speed_m_s", {"0.50", "1", "2.0"}}, {"knowledge", {"now", "ahead"}}});
    head.machines = {{{"cpu", "a & b"}}};
    RunDatabaseWriter writer(path, head);
    NumberedRun run;
    run.scenario = "hall";
    for (const char* const speed : {"0.50", "1", "2.0"}) {
      for (const char* const knowledge : {"now", "ahead"}) {
        for (int seed = 1; seed <= options.seeds; ++seed) {
          ++run.id;
          run.key = std::to_string(run.id);
          run.seed = static_cast<std::uint64_t>(seed);
          run.combination_command = "sidestep run hall";
          writer.Add(run, RowOf(speed, knowledge, seed, options));
        }
      }
    }
    writer.Commit();
    return RunDatabase(path);
  }

  static RunRow RowOf(const std::string& speed, const std::string& knowledge, int seed,
                      const Options& options) {
    RunRow row;
    row.factors = {{"speed_m_s", speed}, {"knowledge", knowledge}};
    row.identity.build = "1";
    const bool fails = knowledge == "now" && (speed == "2.0" || seed == 3);
    row.outcome = fails ? "collision" : "goal";
    if (!options.error.empty() && speed == "1" && seed == 2 && knowledge == "now") {
      row.outcome = kFailed;
      row.error = options.error;
      return row;
    }
    if (fails) row.touched = options.touched;
    if (fails) row.trace = "traces/" + knowledge + std::to_string(seed) + ".h5";
    row.metrics["min_clearance_m"] = (fails ? -0.01 : 0.1) + 0.001 * seed;
    if (!fails) row.metrics["time_to_goal_s"] = 2 + 0.1 * seed + (knowledge == "ahead" ? 0.5 : 0);
    row.subject.charged_latency_s = 0.1;
    row.clock.cycle_p50_ms = row.clock.cycle_p95_ms = row.clock.cycle_max_ms = seed;
    return row;
  }

  const TemporaryFolder folder_;
};

std::size_t Count(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++count;
  return count;
}

TEST_F(ReportTest, AnswersWhatTheSweepAsksInOneSentence) {
  const RunDatabase database = Write({});
  const ReportSource source(database, {});
  // By hand: `now` arrives at two speeds with two seeds, `ahead` always.
  const Comparison comparison = Compare(source.runs(), source.question(), {});
  EXPECT_EQ(comparison.rates.num_pairs, 9);
  EXPECT_EQ(comparison.rates.first_successes, 9);
  EXPECT_EQ(comparison.rates.second_successes, 4);
  // Seeds differ by 1, 1 and 3 pairs: all signs alike in 2 of 8 ways.
  EXPECT_NEAR(comparison.rates.p, 0.25, 1e-12);
  const SweepReport report = source.Make({});
  EXPECT_THAT(
      report.answer,
      HasSubstr("With knowledge ahead the robot reached its goal and touched nothing in 9 of 9 "
                "runs (100.0 %), with now in 4 of 9 runs (44.4 %): a difference of +55.6 "
                "percentage points (95 % interval +33.3 to +100.0), n = 9 pairs of 3 seeds, "
                "p = 0.25."));
  EXPECT_THAT(report.html, HasSubstr("18 runs of 99 planned, so far: 5 collision, 13 goal."));
  EXPECT_EQ(Count(report.html, "sidestep run hall --seed"), 5u) << "one a collision";
  EXPECT_THAT(report.html, HasSubstr("sidestep view traces/now3.h5"));
}

TEST_F(ReportTest, ComparesWhatIsAskedOfItAndNothingThatIsNotThere) {
  const RunDatabase database = Write({});
  ReportRequest request;
  request.factor = "speed_m_s";
  request.of = "2.0";
  request.with = "0.50";
  EXPECT_THAT(ReportSource(database, request).Make({}).answer, HasSubstr("With speed_m_s 2.0 the"));
  request.of = "2";
  EXPECT_THROW(ReportSource(database, request), InputError);
  request.factor = "colour";
  EXPECT_THROW(ReportSource(database, request), InputError);
}

TEST_F(ReportTest, PairsCostsOfRunsThatBothArrivedAlone) {
  const RunDatabase database = Write({});
  const ReportSource source(database, {});
  const Comparison comparison = Compare(source.runs(), source.question(),
                                        {{"time_to_goal_s", true}, {"min_clearance_m", false}});
  ASSERT_EQ(comparison.metrics.size(), 2u);
  EXPECT_EQ(comparison.metrics[0].num_pairs, 4);
  EXPECT_NEAR(comparison.metrics[0].difference, 0.5, 1e-12);
  EXPECT_EQ(comparison.metrics[1].num_pairs, 9);
  EXPECT_NEAR(comparison.metrics[1].difference, 0.11, 1e-12);
}

TEST_F(ReportTest, LeavesOutPairsOfWhichARunFailedAndSaysSo) {
  Options options;
  options.error = "no such <thing>";
  const RunDatabase database = Write(options);
  const ReportSource source(database, {});
  const Comparison comparison = Compare(source.runs(), source.question(), {});
  EXPECT_EQ(comparison.rates.num_pairs, 8);
  EXPECT_EQ(comparison.num_left_out, 1);
  const std::string html = source.Make({}).html;
  EXPECT_THAT(html, HasSubstr("1 pairs are left out, because one of their runs failed."));
  EXPECT_THAT(html, HasSubstr("no such &lt;thing&gt;"));
}

TEST_F(ReportTest, IsAPageEvenOfRunsThatAllFailed) {
  const std::string path = (folder_.path() / "failed.db").string();
  RunTableHead head;
  head.factors = FactorColumnsOf({{"knowledge", {"now", "ahead"}}});
  RunDatabaseWriter writer(path, head);
  for (const char* const knowledge : {"now", "ahead"}) {
    NumberedRun run;
    run.id = knowledge == std::string("now") ? 1 : 2;
    run.scenario = "hall";
    writer.Add(run, FailedRow({{"knowledge", knowledge}}, "it is a trap"));
  }
  writer.Commit();
  const RunDatabase database(path);
  const SweepReport report = ReportSource(database, {}).Make({});
  EXPECT_THAT(report.html, HasSubstr("it is a trap"));
  EXPECT_THAT(report.answer, HasSubstr("in 0 of 0 runs"));
  EXPECT_THAT(report.html, Not(HasSubstr("nan")));
}

TEST_F(ReportTest, LetsNoTextOfTheDatabaseBecomeMarkup) {
  Options options;
  options.title = options.touched = "</title><script>alert(1)</script>\xE9";
  const RunDatabase database = Write(options);
  const std::string html = ReportSource(database, {}).Make({}).html;
  EXPECT_THAT(html, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;alert(1)&lt;/script&gt;\\xE9"));
  EXPECT_THAT(html, Not(HasSubstr("src=")));
}

TEST_F(ReportTest, SaysSomethingOfASingleRunAndOfNoQuestion) {
  Options options;
  options.seeds = 1;
  options.asks = false;
  const RunDatabase database = Write(options);
  const SweepReport report = ReportSource(database, {}).Make({});
  EXPECT_THAT(report.answer, HasSubstr("With knowledge ahead"));
  EXPECT_THAT(report.html, HasSubstr("McNemar"));  // one seed: each pair counts by itself
}

// --- Which runs are filmed
// ------------------------------------------------------------------------

std::vector<std::int64_t> Ids(const RunDatabase& database, const RunChoice& choice) {
  std::vector<std::int64_t> ids;
  for (const ChosenRun& run : ChooseRuns(database, choice)) ids.push_back(run.id);
  return ids;
}

TEST_F(ReportTest, ChoosesRunsByWhatAPersonAsks) {
  const RunDatabase database = Write({});
  EXPECT_THAT(Ids(database, {"", "", 2}), ElementsAre(13, 14));
  EXPECT_THAT(Ids(database, {"outcome = 'collision' AND speed_m_s < 2", "", 9}), ElementsAre(3, 9));
  EXPECT_THAT(Ids(database, {"outcome <> beside_outcome AND knowledge = 'ahead'",
                             "abs(min_clearance_m - beside_min_clearance_m) DESC, id DESC", 2}),
              ElementsAre(18, 17));
  const ChosenRun run = ChooseRuns(database, {"id = 3", "", 1}).front();
  EXPECT_EQ(run.beside_id, 6);
  EXPECT_EQ(run.name, "now");
  EXPECT_EQ(run.beside_name, "ahead");
  EXPECT_EQ(run.what, "collision, hall, seed 3, speed_m_s 0.5");
}

TEST_F(ReportTest, RefusesWhatIsNoSqlOrMoreThanOneExpression) {
  const RunDatabase database = Write({});
  for (const char* const where :
       {"colour = 1", "1) OR (1", "1; DROP TABLE runs", "1 --", "1 /* */", "'1", "(1", "1 LIMIT 3",
        "id IN (SELECT", "1) UNION SELECT * FROM (runs"}) {
    try {
      ChooseRuns(database, {where, "", 1});
      ADD_FAILURE() << where;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), ::testing::StartsWith("--where: ")) << where;
    }
  }
  for (const char* const order : {"colour", "id LIMIT 5", "id; DELETE FROM runs"}) {
    EXPECT_THROW(ChooseRuns(database, {"", order, 1}), InputError) << order;
  }
  EXPECT_EQ(database.num_runs(), 18);
}

TEST_F(ReportTest, EndsWhatIsEndlessOrGoesWrongOnTheWay) {
  const RunDatabase database = Write({});
  const std::string endless =
      "(WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT max(i) FROM n) > 0";
  const auto complaint = [&](const std::string& where, const std::string& order) {
    try {
      ChooseRuns(database, {where, order, 1});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("was accepted");
  };
  EXPECT_EQ(complaint(endless, ""), "--where: takes too many steps, as if it were endless");
  EXPECT_EQ(complaint("", endless), "--order: takes too many steps, as if it were endless");
  EXPECT_EQ(complaint("abs(-9223372036854775807 - 1) > 0", ""), "--where: integer overflow");
  EXPECT_EQ(complaint("length(zeroblob(900000000)) > 0", ""), "--where: string or blob too big");
  EXPECT_THAT(Ids(database, {"", "", 2}), ElementsAre(13, 14)) << "it is as it was";
}

// --- Pictures
// -------------------------------------------------------------------------------------

TEST(ToSvg, PutsPointsWhereTheirNumbersAre) {
  Panel panel;
  panel.x_label = "speed <m/s>";
  panel.y_range = {0, 100};
  panel.series = {{"a", Series::Style::kLine, 1, {0, 10, NAN}, {0, 100, 5}, {}, {}}};
  const std::string svg = ToSvg(panel, SvgPlace::kFile, 400, 300);
  EXPECT_EQ(Count(svg, "<circle"), 2u) << "what is no number is left out";
  EXPECT_THAT(svg, HasSubstr("speed &lt;m/s&gt;"));
  EXPECT_THAT(svg, HasSubstr("<title>a: 10, 100</title>"));
  EXPECT_THAT(svg, HasSubstr("cy=\"246.0\""));  // 0 stands on the axis, 54 px above the edge
  EXPECT_EQ(svg, ToSvg(panel, SvgPlace::kFile, 400, 300));
}

TEST(ToSvg, DrawsWhateverThereIs) {
  for (const bool log_x : {false, true}) {
    for (const std::vector<double>& y : std::vector<std::vector<double>>{
             {}, {1}, {0, 0}, {-1e300, 1e300}, {INFINITY, 1}, {1e-12, 1e-12}}) {
      Panel panel;
      panel.log_x = log_x;
      panel.series = {{"", Series::Style::kBars, 0, y, y, y, y}};
      const std::string svg = ToSvg(panel, SvgPlace::kPage);
      EXPECT_THAT(svg, Not(HasSubstr("nan")));
      EXPECT_THAT(svg, Not(HasSubstr("inf")));
    }
  }
}

}  // namespace
}  // namespace sidestep::bench::sweep_report_test
