// Tables of results: reading, writing, comparing with published ones.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "sidestep/bench/reproduce/csv_table.h"
#include "sidestep/bench/reproduce/open_loop_rows.h"
#include "sidestep/bench/reproduce/published_table.h"
#include "sidestep/core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::bench::reproduce_table_test {
namespace {

std::string WriteTable(const TemporaryFolder& folder, const std::string& text) {
  const std::string path = folder.path() / "table.csv";
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

CsvTable Parse(const std::string& text) {
  const TemporaryFolder folder;
  return CsvTable::Read(WriteTable(folder, text));
}

TEST(CsvTable, ReadsBackToTheBitWhatItWrites) {
  CsvTable table({"a", "b"});
  table.AddRow({0.1, {}});
  table.AddRow({1.0 / 3, -2e-300});
  const std::string text = table.ToText();
  EXPECT_EQ(text.substr(0, 9), "a,b\n0.1,\n");
  const CsvTable read = Parse(text);
  EXPECT_EQ(read.At(0, 0), 0.1);
  EXPECT_EQ(read.At(0, 1), std::nullopt);
  EXPECT_EQ(read.At(1, 0), 1.0 / 3);
  EXPECT_EQ(read.At(1, 1), -2e-300);
}

TEST(CsvTable, TakesCarriageReturnsAndEmptyLines) {
  const CsvTable table = Parse("a,b\r\n1,2\r\n\r\n3,4\r\n");
  EXPECT_EQ(table.columns(), (std::vector<std::string>{"a", "b"}));
  ASSERT_EQ(table.num_rows(), 2u);
  EXPECT_EQ(table.At(1, 1), 4);
}

TEST(CsvTable, SaysWhereAFileIsBroken) {
  struct Broken {
    const char* text;
    const char* message;
  };
  for (const Broken& test : {
           Broken{"", ":1: needs a header of column names"},
           Broken{"a,a\n", ":1: a column comes twice"},
           Broken{"b,c\n1,2\n", ":1: has no column 'a'"},
           Broken{"a,b\n1,2\n3\n", ":3: has 1 fields, the header 2"},
           Broken{"a,b\n1,two\n", ":2: b: must be a finite number, is 'two'"},
           Broken{"a,b\n1,nan\n", ":2: b: must be a finite number, is 'nan'"},
           Broken{"a,b\n1,2x\n", ":2: b: must be a finite number, is '2x'"},
       }) {
    const TemporaryFolder folder;
    const std::string path = WriteTable(folder, test.text);
    try {
      CsvTable::Read(path, {"a"});
      ADD_FAILURE() << "was accepted: " << test.text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.what(), path + test.message);
    }
  }
  EXPECT_THROW(CsvTable::Read("/there/is/no/such.csv"), InputError);
  EXPECT_THROW(CsvTable::Read(std::filesystem::temp_directory_path()), InputError);
}

constexpr const char* kHeader =
    "pair,speed_m_per_s,n_colliding_states_static,gp_cost_static,iterations_static\n";

TEST(TableComparison, CountsWhatAgreesAndListsWhatDoesNot) {
  const CsvTable ours = Parse(std::string(kHeader) + "1,0.1,2,10,5\n1,0.2,3,20,5\n2,0.1,0,30,5\n");
  const CsvTable published =
      Parse(std::string(kHeader) + "2,0.1,0,30.000001,9\n1,0.2,4,25,9\n1,0.1,2,10,9\n");
  const TableComparison comparison = CompareTables(ours, published, "published.csv");
  EXPECT_EQ(comparison.rows_compared, 3);
  EXPECT_EQ(comparison.CountsAgreeing(), 2);
  EXPECT_EQ(comparison.CountsCompared(), 3);
  EXPECT_FALSE(comparison.AllCountsAgree());
  ASSERT_EQ(comparison.columns.size(), 2u) << "iterations are ours and are not compared";
  EXPECT_EQ(comparison.columns[1].column, "gp_cost_static");
  EXPECT_EQ(comparison.columns[1].agreeing, 2);
  EXPECT_DOUBLE_EQ(comparison.columns[1].largest_relative_difference, 0.2);
  EXPECT_DOUBLE_EQ(comparison.columns[1].mean_ours, 20);
  ASSERT_EQ(comparison.differences.size(), 2u);
  EXPECT_EQ(comparison.differences[0].column, "n_colliding_states_static");
  EXPECT_EQ(comparison.differences[0].published, 4);
  EXPECT_THAT(Describe(comparison), ::testing::HasSubstr("2 of 3 agree"));
}

TEST(TableComparison, LeavesOutWhatThePublishedTableDoesNotHave) {
  const CsvTable ours = Parse(std::string(kHeader) + "1,0.1,2,10,5\n1,0.3,9,9,9\n");
  const CsvTable published = Parse("speed_m_per_s,gp_cost_static,pair\n0.1,,1\n0.2,1,1\n");
  const TableComparison comparison = CompareTables(ours, published, "published.csv");
  EXPECT_EQ(comparison.rows_compared, 1);
  EXPECT_EQ(comparison.rows_only_ours, 1);
  EXPECT_EQ(comparison.rows_only_published, 1);
  EXPECT_TRUE(comparison.columns.empty());
  EXPECT_FALSE(comparison.AllCountsAgree()) << "there is nothing to agree";
}

TEST(TableComparison, RefusesATableWithoutItsKeysOrWithARowTwice) {
  const CsvTable ours = Parse(std::string(kHeader) + "1,0.1,2,10,5\n");
  for (const char* text : {"pair,gp_cost_static\n1,2\n", "speed_m_per_s,gp_cost_static\n1,2\n",
                           "pair,speed_m_per_s\n1,\n", "pair,speed_m_per_s\n1,0.1\n1,0.1\n"}) {
    EXPECT_THROW(CompareTables(ours, Parse(text), "published.csv"), InputError) << text;
  }
}

TEST(OpenLoopRuns, AreARunOfEachKnowledgeWithPairsAsSeeds) {
  OpenLoopStudy study;
  for (const int pair : {1, 4}) {
    OpenLoopRow& row = study.rows.emplace_back();
    row.pair = pair;
    row.speed_m_s = 1.4;
    row.cases[sdf::Knowledge::kStatic].result.colliding_states = 3;
    OpenLoopRow::Case& free = row.cases[sdf::Knowledge::kPrediction];
    free.result.gp_cost = 9.5;
    free.clearance = {0.02, 0.03, 0.025};
  }
  const OpenLoopExperiment experiment =
      MakeOpenLoopExperiment("panda_hsr", SIDESTEP_SOURCE_DIR "/scenarios");
  const std::vector<SingleRun> runs = OpenLoopRuns(experiment, study, "two_frame");
  ASSERT_EQ(runs.size(), 4u);
  EXPECT_EQ(runs[0].row.outcome, "collision");
  EXPECT_EQ(runs[3].seed, 4u);
  EXPECT_EQ(runs[3].row.outcome, "goal");
  EXPECT_EQ(runs[3].row.factors, (Factors{{"knowledge", "prediction"}, {"speed_m_s", "1.4"}}));
  EXPECT_EQ(runs[3].row.metrics.at("gp_cost"), 9.5);
  EXPECT_EQ(runs[3].row.metrics.at("min_clearance_m"), 0.02);
  EXPECT_EQ(runs[3].row.subject.robot, "panda");
}

}  // namespace
}  // namespace sidestep::bench::reproduce_table_test
