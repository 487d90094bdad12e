#include "sidestep/bench/sweep/sweep_rows.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "sidestep/bench/database/run_database.h"
#include "sidestep/bench/metrics/registry.h"
#include "sidestep/bench/sweep/merge.h"
#include "sidestep/bench/sweep/shard_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/random.h"
#include "tests/support/bytes_of.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::bench::sweep_rows_test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const ShardMaker kMaker{"build", "inputs"};

SweepPlan Plan() {
  return SweepPlan(
      ParseSweep("description: Which is faster?\n"
                 "scenarios: [hall, yard]\nset: {planner.qc: 2}\naxes:\n"
                 "  speed_m_s: [0.5, 1]\n"
                 "  knowledge: [static, prediction]\n"
                 "  moving_obstacles[0].name: [a, b]\n"
                 "  planner.epsilon_m/planner.n_int: [[0.1, 1], [0.2, 3]]\nseeds: 3\n"
                 "compare: {factor: knowledge, of: prediction, with: static}\n",
                 "pace.yaml"));
}

// What might come of a run: the same again, but for the clock.
RunRow RowOf(const SweepPlan& plan, std::uint64_t index, double clock_s = 1) {
  RandomStream random(index, "rows");
  const PlannedRun run = plan.At(index);
  RunRow row;
  if (index % 10 == 3) {
    row = FailedRow({}, "a \"word\",\n\tquoted, and caf\xe9");
    row.clock.episode_s = clock_s;
    return row;
  }
  row.outcome = index % 3 == 0 ? "goal" : "collision";
  row.touched = index % 3 == 0 ? "" : "hsr";
  for (const Metric& metric : Metrics()) {
    const bool is_none = random.Uniform() < 0.2;
    const bool is_count = std::string(metric.unit) == "count";
    const double number = is_count ? static_cast<double>(random.Bits() % 100) : random.Normal();
    row.metrics[metric.name] = is_none ? std::numeric_limits<double>::quiet_NaN() : number;
  }
  row.metrics["min_clearance_m"] = 0.1 + 1e-17 * static_cast<double>(index);
  row.drawn = {{"delay_s", random.Uniform()}};
  row.identity = {"scene" + std::to_string(index), "models", "build", ""};
  row.subject = {"panda", "gpmp", run.factors.at("knowledge"), "imm", 0.1};
  row.clock = {clock_s, 1, 2, 3, 4, 5, 6};
  return row;
}

class SweepRowsTest : public ::testing::Test {
 protected:
  std::string Folder() const { return folder_.path().string(); }
  std::string PathOf(const ShardName& shard) const { return Folder() + "/" + FileOf(shard); }

  void Write(const ShardName& shard, const std::vector<std::uint64_t>& indices, double clock_s = 1,
             const ShardMaker& maker = kMaker) const {
    ShardWriter writer(PathOf(shard), maker, {{"hostname", FileOf(shard)}});
    for (const std::uint64_t index : indices) {
      writer.Append(plan_.KeyOf(index), RowText(RowOf(plan_, index, clock_s)));
    }
  }
  // Every run, divided into shards, each of them written from its end to its beginning.
  void WriteAll(int of, double clock_s) const {
    for (int number = of; number >= 1; --number) {
      std::vector<std::uint64_t> indices;
      for (auto i = static_cast<std::uint64_t>(number - 1); i < plan_.num_runs();
           i += static_cast<std::uint64_t>(of)) {
        indices.insert(indices.begin(), i);
      }
      Write({number, of}, indices, clock_s);
    }
  }
  SweepRows Rows() const { return {plan_, Folder(), kMaker}; }
  std::string Merge(const std::string& name) const {
    const std::string path = Folder() + "/" + name;
    MergeRows(plan_, Rows(),
              {.path = path,
               .facts = {{"build_id", "build"}},
               .version = "sidestep 1",
               .command = [](const PlannedRun& run) { return "sidestep run " + run.scenario; },
               .trace = [](std::uint64_t) { return ""; },
               .scenario = [](const PlannedRun& run) { return run.scenario; }});
    return path;
  }

  const TemporaryFolder folder_;
  const SweepPlan plan_ = Plan();
};

TEST_F(SweepRowsTest, GivesBackEveryRowThatItWasGiven) {
  WriteAll(1, 2.5);
  const SweepRows rows = Rows();
  EXPECT_EQ(rows.num_done(), plan_.num_runs());
  EXPECT_THAT(rows.damage(), IsEmpty());
  for (std::uint64_t i = 0; i < plan_.num_runs(); ++i) {
    const RunRow row = rows.Read(i).row, expected = RowOf(plan_, i, 2.5);
    EXPECT_EQ(RowText(row), RowText(expected));
    EXPECT_EQ(row.outcome, expected.outcome);
    EXPECT_EQ(row.identity.build, expected.identity.build);
    EXPECT_EQ(row.clock.episode_s, 2.5);
    for (const auto& [metric, value] : expected.metrics) {
      const double read = row.metrics.at(metric);
      EXPECT_TRUE(std::isnan(value) ? std::isnan(read) : read == value) << metric;
    }
  }
}

TEST_F(SweepRowsTest, LosesAtMostTheRowThatWasBeingWritten) {
  const std::string path = PathOf({1, 1});
  Write({1, 1}, {0, 1, 2});
  const std::string whole = BytesOf(path);
  for (std::size_t cut = 1; cut < 200; cut += 7) {
    fs::resize_file(path, whole.size() - cut);
    EXPECT_EQ(Rows().num_done(), 2u);
    EXPECT_THAT(Rows().damage(), IsEmpty());  // that is no damage: it never was whole
    Write({1, 1}, {2});
    EXPECT_EQ(Rows().num_done(), 3u);
    EXPECT_THAT(Rows().damage(), IsEmpty());
  }
}

TEST_F(SweepRowsTest, BeginsAnewWhereNotEvenTheFirstLineIsWhole) {
  const std::string path = PathOf({1, 1});
  for (const std::size_t size : {0, 5, 40}) {
    Write({1, 1}, {});
    fs::resize_file(path, size);
    Write({1, 1}, {4});
    EXPECT_EQ(Rows().num_done(), 1u) << size;
    fs::remove(path);
  }
}

TEST_F(SweepRowsTest, FindsEveryByteThatWasChangedAndKeepsTheOtherRows) {
  const std::string path = PathOf({1, 1});
  Write({1, 1}, {0, 1, 2});
  const std::string whole = BytesOf(path);
  const std::size_t second = whole.find('\n') + 1;
  for (std::size_t at = second; at < whole.size(); at += 13) {
    if (whole[at] == '\n') continue;
    std::string damaged = whole;
    damaged[at] = damaged[at] == 'x' ? 'y' : 'x';
    std::ofstream(path, std::ios::binary) << damaged;
    const SweepRows rows = Rows();
    EXPECT_EQ(rows.num_done(), 2u) << at;
    ASSERT_EQ(rows.damage().size(), 1u);
    EXPECT_THAT(rows.damage().front(), HasSubstr(": is damaged: the run that it told of counts as "
                                                 "missing"));
  }
}

TEST_F(SweepRowsTest, RefusesWhatIsNoShard) {
  std::ofstream(PathOf({1, 1})) << "seed,outcome\n1,goal\n";
  EXPECT_THROW(Rows(), InputError);
  EXPECT_THROW(Write({1, 1}, {}), InputError);
  EXPECT_EQ(BytesOf(PathOf({1, 1})), "seed,outcome\n1,goal\n");
}

TEST_F(SweepRowsTest, GivesAShardToOneProcessAtATime) {
  const ShardWriter first(PathOf({1, 1}), kMaker, {});
  EXPECT_THAT(Rows().being_written().size(), 1);
  try {
    Write({1, 1}, {0});
    FAIL() << "was written";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("another process is writing here just now"));
  }
}

// As on a full disk.
TEST_F(SweepRowsTest, EndsWithAWholeRowWhereTheDiskIsFull) {
  const std::string path = PathOf({1, 1});
  Write({1, 1}, {0, 1});
  rlimit usual = {};
  getrlimit(RLIMIT_FSIZE, &usual);
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small = {fs::file_size(path) + 3000, usual.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  std::string why;
  try {
    ShardWriter writer(path, kMaker, {});
    for (std::uint64_t i = 2; i < 20; ++i) {
      writer.Append(plan_.KeyOf(i), RowText(RowOf(plan_, i)));
    }
  } catch (const InputError& error) {
    why = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &usual);
  EXPECT_EQ(why, path + ": cannot be written: File too large");
  EXPECT_EQ(BytesOf(path).back(), '\n');
  const std::uint64_t num_kept = Rows().num_done();
  EXPECT_GT(num_kept, 2u);
  EXPECT_LT(num_kept, 20u);
  EXPECT_THAT(Rows().damage(), IsEmpty());
  Write({1, 1}, {19});
  EXPECT_EQ(Rows().num_done(), num_kept + 1);
}

TEST_F(SweepRowsTest, CountsNoRunTwiceAndNoneOfAnotherBuild) {
  Write({1, 1}, {0, 1, 2}, 1);
  Write({2, 7}, {1, 2, 3}, 2);
  Write({3, 7}, {4, 5}, 1, {"another build", "inputs"});
  Write({4, 7}, {6}, 1, {"build", "another robot"});
  {
    ShardWriter writer(PathOf({5, 7}), kMaker, {});
    writer.Append(12345, RowText(RowOf(plan_, 0)));  // of another plan
  }
  const SweepRows rows = Rows();
  EXPECT_EQ(rows.num_done(), 4u);
  EXPECT_EQ(rows.num_of_other_makers(), 3u);
  EXPECT_EQ(rows.num_unasked(), 1u);
  EXPECT_THAT(rows.contradicted(), IsEmpty());  // clocks may differ
  EXPECT_EQ(rows.Read(1).row.clock.episode_s, 1);
}

TEST_F(SweepRowsTest, NoticesARunThatDidNotRepeat) {
  Write({1, 2}, {0, 1});
  ShardWriter writer(PathOf({2, 2}), kMaker, {});
  RunRow other = RowOf(plan_, 1);
  other.metrics["min_clearance_m"] = std::nextafter(other.metrics["min_clearance_m"], 1);
  writer.Append(plan_.KeyOf(1), RowText(other));
  EXPECT_THAT(Rows().contradicted(), ElementsAre(1));
}

TEST_F(SweepRowsTest, AreTheSameDatabaseHoweverTheyWereDivided) {
  WriteAll(1, 1);
  const std::string one = DigestOf(RunDatabase(Merge("one.db")));
  fs::remove(PathOf({1, 1}));
  WriteAll(7, 2);
  EXPECT_EQ(DigestOf(RunDatabase(Merge("seven.db"))), one);
  fs::remove(PathOf({4, 7}));
  WriteAll(2, 3);
  EXPECT_EQ(DigestOf(RunDatabase(Merge("both.db"))), one);
}

TEST_F(SweepRowsTest, HaveAnotherDigestWhereAnyNumberIsAnother) {
  WriteAll(1, 1);
  const std::string path = Merge("one.db");
  const std::string one = DigestOf(RunDatabase(path));
  for (const auto& [sql, differs] : std::map<std::string, bool>{
           {"UPDATE other.runs SET jerk_rms = jerk_rms + 1e-15 WHERE id = 2", true},
           {"UPDATE other.runs SET seed = 9 WHERE id = 96", true},
           {"UPDATE other.run_facts SET error = 'a word' WHERE runid = 4", true},
           {"DELETE FROM other.runs WHERE id = 1", true},
           {"UPDATE other.sidestep SET value = 'other' WHERE name = 'plan'", true},
           {"UPDATE other.experiments SET setup = 'other'", true},
           {"CREATE TABLE other.more(id)", true},
           {"UPDATE other.wall_clock SET episode_s = 99", false},
           {"UPDATE other.wall_clock_machines SET value = 'other'", false},
           {"VACUUM other", false}}) {
    const std::string copy = Folder() + "/copy.db";
    fs::copy_file(path, copy, fs::copy_options::overwrite_existing);
    SqlDatabase::Create(Folder() + "/scratch.db", "scratch")
        .Execute("ATTACH '" + copy + "' AS other; " + sql);
    EXPECT_EQ(DigestOf(RunDatabase(copy)) != one, differs) << sql;
  }
}

TEST_F(SweepRowsTest, AreReadFromTheDatabaseAsTheyWere) {
  WriteAll(3, 1);
  const RunDatabase database(Merge("results.db"));
  EXPECT_EQ(database.num_runs(), static_cast<std::int64_t>(plan_.num_runs()));
  EXPECT_EQ(database.Fact("title"), "pace");
  EXPECT_EQ(database.Fact("description"), "Which is faster?");
  EXPECT_EQ(database.Fact("num_planned"), std::to_string(plan_.num_runs()));
  EXPECT_EQ(database.Fact("compare.of"), "prediction");
  EXPECT_EQ(database.Fact("set.planner.qc"), "2");
  ASSERT_EQ(database.factors().size(), 4u);
  EXPECT_EQ(database.factors()[0].column, "speed_m_s");
  EXPECT_TRUE(database.factors()[0].is_number);
  EXPECT_FALSE(database.factors()[0].is_planner);
  EXPECT_TRUE(database.factors()[1].is_planner);
  EXPECT_EQ(database.factors()[2].column, "moving_obstacles_0__name");
  EXPECT_EQ(database.factors()[3].column, "planner_epsilon_m_planner_n_int");
  EXPECT_THAT(database.factors()[3].values, ElementsAre("0.1/1", "0.2/3"));
  SqlStatement rows = database.Select(
      "id, scenario, speed_m_s, knowledge, moving_obstacles_0__name, "
      "planner_epsilon_m_planner_n_int, seed, outcome, touched, error, min_clearance_m, replans, "
      "drawn_delay_s, command, run");
  for (std::uint64_t i = 0; i < plan_.num_runs(); ++i) {
    ASSERT_TRUE(rows.Step());
    const PlannedRun run = plan_.At(i);
    const RunRow row = RowOf(plan_, i);
    EXPECT_EQ(rows.Integer(0), static_cast<std::int64_t>(i + 1));
    EXPECT_EQ(rows.Text(1), run.scenario);
    EXPECT_EQ(rows.Number(2), std::stod(run.factors.at("speed_m_s")));
    EXPECT_EQ(rows.Text(3), run.factors.at("knowledge"));
    EXPECT_EQ(rows.Text(4), run.factors.at("moving_obstacles[0].name"));
    EXPECT_EQ(rows.Text(5), run.factors.at("planner.epsilon_m/planner.n_int"));
    EXPECT_EQ(rows.Integer(6), static_cast<std::int64_t>(run.seed));
    EXPECT_EQ(rows.Text(7), row.outcome);
    EXPECT_EQ(rows.Text(8), row.touched);
    EXPECT_EQ(rows.IsNull(9), row.error.empty());
    if (row.metrics.empty()) {
      EXPECT_TRUE(rows.IsNull(10));
      EXPECT_TRUE(rows.IsNull(13));  // there is nothing to run again
      continue;
    }
    EXPECT_EQ(rows.Number(10), row.metrics.at("min_clearance_m"));
    const double replans = row.metrics.at("replans");
    EXPECT_EQ(rows.Kind(11), std::isnan(replans) ? 'n' : 'i');
    EXPECT_EQ(rows.Number(12), row.drawn.at("delay_s"));
    EXPECT_EQ(rows.Text(13), "sidestep run " + run.scenario + " --seed " +
                                 std::to_string(run.seed) + " --out out/again/" + rows.Text(14));
  }
  EXPECT_FALSE(rows.Step());
}

// What Planner Arena (server.R of Debian's ompl-plannerarena 1.5.2) asks of a database.
TEST_F(SweepRowsTest, AreWhatPlannerArenaReads) {
  WriteAll(1, 1);
  const RunDatabase database(Merge("results.db"));
  const SqlDatabase& sql = database.sql();
  const SqlStatement experiments = sql.Prepare("SELECT * FROM experiments");
  std::vector<std::string> parameters;
  for (int c = 12; c < experiments.num_columns(); ++c) {
    parameters.push_back(experiments.ColumnName(c));
  }
  EXPECT_THAT(parameters, ElementsAre("robot", "speed_m_s", "moving_obstacles_0__name"));
  const SqlStatement runs = sql.Prepare("SELECT * FROM runs");
  EXPECT_EQ(runs.ColumnName(0), "id");
  EXPECT_EQ(runs.ColumnName(1), "experimentid");
  EXPECT_EQ(runs.ColumnName(2), "plannerid");
  SqlStatement all = sql.Prepare("SELECT * FROM runs");
  while (all.Step()) {
    for (int c = 0; c < all.num_columns(); ++c) EXPECT_NE(all.Kind(c), 't') << all.ColumnName(c);
  }
  SqlStatement performance = sql.Prepare(
      "SELECT count(*), count(DISTINCT plannerConfigs.name), count(DISTINCT version) FROM "
      "plannerConfigs JOIN runs ON plannerConfigs.id = runs.plannerid JOIN experiments ON "
      "runs.experimentid = experiments.id JOIN enums ON enums.name = 'outcome' AND enums.value = "
      "runs.outcome");
  ASSERT_TRUE(performance.Step());
  EXPECT_EQ(performance.Integer(0), static_cast<std::int64_t>(plan_.num_runs()));
  EXPECT_EQ(performance.Integer(2), 1);
  SqlStatement progress = sql.Prepare("SELECT runid, time, clearance_m FROM progress");
  EXPECT_FALSE(progress.Step());
  SqlStatement names = sql.Prepare("SELECT count(*) - count(DISTINCT name) FROM plannerConfigs");
  ASSERT_TRUE(names.Step());
  EXPECT_EQ(names.Integer(0), 0) << "two configurations have one name";
}

TEST(RunDatabase, IsRefusedWhereItIsNone) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "results.db").string();
  const auto message = [&] {
    try {
      RunDatabase database(path);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("was opened");
  };
  EXPECT_EQ(message(), path + ": no such file");
  std::ofstream(path) << "seed,outcome\n1,goal\nand so on, and so on, and so on, and so on, and on";
  EXPECT_EQ(message(), path + ": file is not a database");
  fs::remove(path);
  SqlDatabase::Create(path, path).Execute("CREATE TABLE runs(id)");
  EXPECT_EQ(message(), path + ": is no database of sidestep's results (sidestep-results-1)");
}

}  // namespace
}  // namespace sidestep::bench::sweep_rows_test
