// The statistics of open-loop tables, on tables small enough to count by hand.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/bench/reproduce/open_loop_outcomes.h"
#include "sidestep/bench/reproduce/open_loop_statistics.h"
#include "sidestep/bench/reproduce/open_loop_statistics_text.h"

namespace sidestep::bench::reproduce_statistics_test {
namespace {

const std::string kScenarios = SIDESTEP_SOURCE_DIR "/scenarios";

using Fields = std::vector<std::optional<double>>;

CsvTable MakeTable(const std::vector<Fields>& rows) {
  CsvTable table({"pair", "speed_m_per_s", "n_colliding_states_static",
                  "n_colliding_states_full_knowledge", "gp_cost_static", "gp_cost_full_knowledge"});
  for (const Fields& row : rows) table.AddRow(row);
  return table;
}

// Three pairs at two speeds; 0.5 m/s is excluded for the WAM.
CsvTable Sample() {
  return MakeTable({{1, 0.4, 2, 0, 10, 5},
                    {1, 0.5, 0, 0, 10, 7},
                    {2, 0.4, 3, 0, 10, 6},
                    {2, 0.5, 0, 1, 10, 8},
                    {3, 0.4, 1, 2, 10, 20},
                    {3, 0.5, 9, 9, 10, 9}});
}

OpenLoopStatistics Compute(const CsvTable& table, RowFilter filter = RowFilter::kAllRows) {
  return ComputeOpenLoopStatistics(ReadOutcomes(table), filter,
                                   MakeOpenLoopExperiment("wam_single_pillar", kScenarios));
}

TEST(OpenLoopStatistics, CountFreeRowsPooledAndBySpeed) {
  const OpenLoopStatistics statistics = Compute(Sample());
  EXPECT_EQ(statistics.num_rows, 6);
  ASSERT_EQ(statistics.pooled.size(), 2u);
  EXPECT_EQ(statistics.pooled[0].knowledge, sdf::Knowledge::kStatic);
  EXPECT_EQ(statistics.pooled[0].num_free, 2);
  EXPECT_EQ(statistics.pooled[1].num_free, 3);
  EXPECT_DOUBLE_EQ(statistics.pooled[1].mean_gp_cost, 55.0 / 6);
  EXPECT_LT(statistics.pooled[1].wilson.low, 0.5);
  EXPECT_GT(statistics.pooled[1].wilson.high, 0.5);
  ASSERT_EQ(statistics.by_speed.size(), 4u);
  EXPECT_EQ(statistics.by_speed[2].speed_m_s, 0.4);
  EXPECT_EQ(statistics.by_speed[2].num_free, 2);
  EXPECT_EQ(statistics.by_speed[2].num_rows, 3);
}

TEST(OpenLoopStatistics, CompareRowsOfTheSameStartGoalAndSpeed) {
  const OpenLoopStatistics statistics = Compute(Sample());
  ASSERT_EQ(statistics.comparisons.size(), 1u);
  const KnowledgeComparison& comparison = statistics.comparisons[0];
  EXPECT_EQ(comparison.first, sdf::Knowledge::kFullKnowledge) << "the one that knows more is first";
  EXPECT_EQ(comparison.only_first, 2);
  EXPECT_EQ(comparison.only_second, 1);
  EXPECT_DOUBLE_EQ(comparison.rate_difference, 1.0 / 6);
  EXPECT_LE(comparison.rate_interval.low, 1.0 / 6);
  EXPECT_GE(comparison.rate_interval.high, 1.0 / 6);
  // Costs differ by -5, -3, -4, -2, 10, -1.
  EXPECT_DOUBLE_EQ(comparison.median_cost_difference, -2.5);
  ASSERT_EQ(comparison.levels.size(), 2u);
  const LevelComparison& slow = comparison.levels[0];
  EXPECT_EQ(slow.only_first, 2);
  EXPECT_EQ(slow.only_second, 0);
  EXPECT_DOUBLE_EQ(slow.mcnemar_p, 0.5);
  EXPECT_DOUBLE_EQ(slow.mcnemar_p_holm, 1);
  EXPECT_DOUBLE_EQ(slow.all.shift, -0.75) << "-5, -4.5, -4, 2.5, 3, 10";
  EXPECT_DOUBLE_EQ(slow.all.p, 1) << "ranks 1 and 2 against 3";
  EXPECT_EQ(slow.both_succeed.num_rows, 0);
  EXPECT_TRUE(std::isnan(slow.both_succeed.shift));
  EXPECT_EQ(comparison.levels[1].both_succeed.num_rows, 1);
  EXPECT_DOUBLE_EQ(comparison.levels[1].all.p, 0.25) << "three of one sign: 2 / 8";
  EXPECT_DOUBLE_EQ(comparison.levels[1].all.p_holm, 0.5);
}

TEST(OpenLoopStatistics, SayWhatThePublishedExclusionsLeaveOut) {
  const OpenLoopStatistics statistics = Compute(Sample(), RowFilter::kPublishedExclusions);
  EXPECT_EQ(statistics.excluded_by_speed, 3);
  EXPECT_EQ(statistics.excluded_none_free, 1);
  EXPECT_EQ(statistics.num_rows, 2);
  EXPECT_EQ(statistics.pooled[1].num_free, 2);
}

TEST(OpenLoopStatistics, AreEmptyWithoutRows) {
  const OpenLoopStatistics statistics =
      Compute(MakeTable({{1, 0.5, 0, 0, 1, 1}}), RowFilter::kPublishedExclusions);
  EXPECT_EQ(statistics.num_rows, 0);
  EXPECT_TRUE(statistics.pooled.empty());
  EXPECT_TRUE(statistics.comparisons.empty());
}

TEST(OpenLoopStatistics, CountCostsThatCannotBeCompared) {
  const OpenLoopStatistics statistics =
      Compute(MakeTable({{1, 0.4, 0, 0, 10, {}}, {2, 0.4, 0, 0, 10, 4}, {3, 0.4, 0, {}, 10, 4}}));
  EXPECT_EQ(statistics.pooled[0].num_rows, 3);
  EXPECT_EQ(statistics.pooled[1].num_rows, 2) << "one row does not have this kind of knowledge";
  const CostComparison& costs = statistics.comparisons.at(0).levels.at(0).all;
  EXPECT_EQ(costs.num_rows, 2);
  EXPECT_EQ(costs.num_not_finite, 1);
  EXPECT_EQ(costs.shift, -6);
}

TEST(OpenLoopStatistics, AreWrittenWithTheirNames) {
  const auto json = nlohmann::json::parse(
      ToJson(std::vector{Compute(Sample()), Compute(Sample(), RowFilter::kPublishedExclusions)}));
  ASSERT_EQ(json.size(), 2u);
  EXPECT_EQ(json[1]["rows_excluded_by_speed"], 3);
  EXPECT_EQ(json[0]["comparisons"][0]["first"], "full_knowledge");
  const auto& slow = json[0]["comparisons"][0]["by_speed"][0];
  EXPECT_EQ(slow["mcnemar_p"], 0.5);
  EXPECT_TRUE(slow["gp_cost_where_both_free"]["hodges_lehmann_shift"].is_null());
  EXPECT_THAT(Describe(Compute(Sample(), RowFilter::kPublishedExclusions)),
              ::testing::HasSubstr("2 rows (excluded: 3 by speed, 1 in which none is free)"));
}

TEST(ReadOutcomes, RefusesATableWithoutPairOrSpeed) {
  EXPECT_THROW(ReadOutcomes(CsvTable({"pair"})), std::invalid_argument);
  CsvTable table({"pair", "speed_m_per_s"});
  table.AddRow({1, {}});
  EXPECT_THROW(ReadOutcomes(table), std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::bench::reproduce_statistics_test
