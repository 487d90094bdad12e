// Runs that no sweep has planned, as the files that a sweep leaves.
#include "sidestep/bench/database/run_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "sidestep/bench/database/run_database.h"
#include "sidestep/bench/metrics/registry.h"
#include "sidestep/core/csv.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::bench::run_files_test {
namespace {

SingleRun OneRun(const std::string& knowledge, std::uint64_t seed, const std::string& outcome) {
  SingleRun run;
  run.scenario = "hall";
  run.seed = seed;
  run.machine = {{"cpu", knowledge == "static" ? "old" : "new"}};
  run.row.factors = {{"knowledge", knowledge}, {"planner.epsilon_m", "0.2"}};
  run.row.outcome = outcome;
  run.row.metrics = {{"min_clearance_m", 0.1 / static_cast<double>(seed + 2)}};
  run.row.drawn = {{"delay_s", 0.25}};
  run.row.identity = {"scene", "models", "build", ""};
  run.row.subject = {"panda", "gpmp", knowledge, "imm", 0.1};
  return run;
}

class RunFiles : public ::testing::Test {
 protected:
  const TemporaryFolder folder_;
  const std::string path_ = folder_.path().string();
};

TEST_F(RunFiles, AreADatabaseAndATableOfTheRows) {
  std::vector<SingleRun> runs = {OneRun("static", 7, "collision"), OneRun("prediction", 7, "goal")};
  runs[1].setup = "hall";
  runs[1].row.command = "sidestep run hall";
  runs[1].row.trace = "prediction.h5";
  WriteRunFiles(path_, {{{"title", "two runs"}}, "sidestep 1"}, runs);
  const RunDatabase database(path_ + "/results.db");
  EXPECT_EQ(database.Fact("title"), "two runs");
  EXPECT_EQ(database.Fact("num_done"), "2");
  ASSERT_EQ(database.factors().size(), 2u);
  EXPECT_EQ(database.factors()[0].values, (std::vector<std::string>{"static", "prediction"}));
  SqlStatement row = database.Select(
      "outcome, seed, min_clearance_m, drawn_delay_s, trace, command, run, \"key\"");
  ASSERT_TRUE(row.Step());
  EXPECT_EQ(row.Text(0), "collision");
  EXPECT_TRUE(row.IsNull(4));
  EXPECT_TRUE(row.IsNull(5)) << "nothing can run it again";
  ASSERT_TRUE(row.Step());
  EXPECT_EQ(row.Text(0), "goal");
  EXPECT_EQ(row.Integer(1), 7);
  EXPECT_EQ(row.Number(2), 0.1 / 9);
  EXPECT_EQ(row.Number(3), 0.25);
  EXPECT_EQ(row.Text(4), "prediction.h5");
  EXPECT_EQ(row.Text(6), RunId(runs[1].row.identity));
  EXPECT_EQ(row.Text(5), "sidestep run hall --seed 7 --out out/again/" + row.Text(6));
  EXPECT_TRUE(row.IsNull(7)) << "no sweep has planned it";
  SqlStatement machines =
      database.sql().Prepare("SELECT count(DISTINCT machine) FROM wall_clock_machines");
  ASSERT_TRUE(machines.Step());
  EXPECT_EQ(machines.Integer(0), 2);
  const CsvFile csv = ReadCsv(path_ + "/results.csv");
  EXPECT_EQ(csv.columns, database.columns());
  EXPECT_EQ(csv.rows.size(), 2u);
}

TEST_F(RunFiles, HoldOneRunOfWhichNothingIsVaried) {
  SingleRun run = OneRun("static", 1, "timeout");
  run.row.factors.clear();
  WriteRunFiles(path_, {}, {run});
  const RunDatabase database(path_ + "/results.db");
  EXPECT_EQ(database.num_runs(), 1);
  SqlStatement row = database.Select("planner, knowledge, robot");
  ASSERT_TRUE(row.Step());
  EXPECT_EQ(row.Text(0) + " " + row.Text(1) + " " + row.Text(2), "gpmp static panda");
}

}  // namespace
}  // namespace sidestep::bench::run_files_test
