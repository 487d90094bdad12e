// Sweeps as a person runs them: divided, interrupted, killed, gone on with.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>  // kill is POSIX's, not <csignal>'s
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "sidestep/bench/database/run_database.h"
#include "sidestep/bench/sweep/shard_file.h"
#include "sidestep/core/csv.h"
#include "tests/support/bytes_of.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::sweep_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

// Runs that take a moment: no optimiser, and short. Some cannot be made.
constexpr const char* kSweep =
    "description: Quick runs\n"
    "scenarios: [walkway_behaviours]\n"
    "set: {planner.name: straight_line, horizon.duration_s: 1}\n"
    "axes:\n"
    "  behaviour: [stop, turn]\n"
    "  knowledge: [static, prediction]\n"
    "  replanning.latency_s: [0.1, 5]\n"  // no latency is above the horizon
    "seeds: 4\n";
constexpr int kNumRuns = 32;

class SweepTest : public ::testing::Test {
 protected:
  SweepTest() { Write(kSweep); }

  void Write(const std::string& text) const { std::ofstream(file_) << text; }
  Finished Sweep(const std::string& what, const std::string& out,
                 std::vector<std::string> further = {},
                 const std::vector<std::string>& environment = {}) const {
    std::vector<std::string> words = {SIDESTEP_PROGRAM, "sweep", what, file_, "--out", OutOf(out)};
    words.insert(words.end(), further.begin(), further.end());
    return RunProgram(words, environment);
  }
  std::string OutOf(const std::string& out) const { return (folder_.path() / out).string(); }
  std::string DatabaseOf(const std::string& out) const { return OutOf(out) + "/results.db"; }
  std::string Digest(const std::string& out) const {
    const Finished finished = RunProgram({SIDESTEP_PROGRAM, "verify", DatabaseOf(out), "--digest"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return finished.out;
  }
  // How many are finished of a sweep that is not divided.
  int NumRowsOf(const std::string& out) const {
    std::ifstream stream(fs::path(OutOf(out)) / "shards/1-of-1.rows");
    int count = 0;
    for (std::string line; std::getline(stream, line) && !stream.eof();) {
      count += line.find("\tsession\t") == std::string::npos ? 1 : 0;
    }
    return count;
  }
  // The processes whose command line holds `text`.
  static std::vector<int> ProcessesOf(const std::string& text) {
    std::vector<int> found;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator("/proc", error)) {
      const std::string name = entry.path().filename().string();
      if (name.find_first_not_of("0123456789") != std::string::npos) continue;
      std::ifstream stream(entry.path() / "cmdline", std::ios::binary);
      const std::string line{std::istreambuf_iterator<char>(stream), {}};
      if (line.find(text) != std::string::npos) found.push_back(std::stoi(name));
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  const TemporaryFolder folder_;
  const std::string file_ = (folder_.path() / "quick.yaml").string();
};

TEST_F(SweepTest, SaysBeforeTheWorkWhatCannotBeRun) {
  const Finished plan = Sweep("plan", "none");
  EXPECT_EQ(plan.exit_code, 0) << plan.err;
  EXPECT_THAT(plan.out, HasSubstr("32 runs: 8 combinations, each with 4 seeds"));
  EXPECT_THAT(plan.out, HasSubstr("4 combinations tried: 1 cannot be run"));
  EXPECT_FALSE(fs::exists(OutOf("none")));
}

TEST_F(SweepTest, OfAHundredThousandShortRunsIsPlanned) {
  const Finished plan = RunProgram({SIDESTEP_PROGRAM, "sweep", "plan",
                                    SIDESTEP_SOURCE_DIR "/tests/data/many_runs/many_runs.yaml"});
  EXPECT_EQ(plan.exit_code, 0) << plan.err;
  EXPECT_THAT(plan.out, HasSubstr("100000 runs: 4 combinations, each with 25000 seeds"));
  EXPECT_THAT(plan.out, HasSubstr("all can be run"));
}

TEST_F(SweepTest, ComesToTheSameResultsHoweverItIsDividedAndWhoeverIsKilled) {
  const Finished one = Sweep("run", "one", {"-j", "1"});
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_THAT(one.out, HasSubstr("32 of 32 runs"));
  const std::string digest = Digest("one");
  const bench::RunDatabase database(DatabaseOf("one"));
  EXPECT_EQ(database.num_runs(), kNumRuns);
  bench::SqlStatement refused =
      database.Select("error, run, command", "outcome = 'failed' AND replanning_latency_s = 5");
  ASSERT_TRUE(refused.Step());
  EXPECT_THAT(refused.Text(0), HasSubstr("replanning.latency_s"));
  EXPECT_TRUE(refused.IsNull(1));

  EXPECT_EQ(Sweep("run", "two", {"-j", "2"}).exit_code, 0);
  EXPECT_EQ(Digest("two"), digest);

  for (const int shard : {5, 1, 7, 3, 2, 6, 4}) {
    const Finished part = Sweep("run", "seven", {"--shard", std::to_string(shard) + "/7"});
    EXPECT_EQ(part.exit_code, 0) << part.err;
  }
  EXPECT_EQ(Sweep("merge", "seven").exit_code, 0);
  EXPECT_EQ(Digest("seven"), digest);

  // Killed again and again, workers and all, whenever something has been done.
  int kills = 0;
  for (bool is_done = false; !is_done;) {
    Running running({SIDESTEP_PROGRAM, "sweep", "run", file_, "--out", OutOf("killed"), "-j", "2"});
    for (int wait = 0; wait < 500 && ProcessesOf(OutOf("killed")).empty(); ++wait) usleep(10'000);
    for (int i = 0; i < 4; ++i) {
      const int rows = NumRowsOf("killed");
      std::vector<int> processes = ProcessesOf(OutOf("killed"));
      for (int wait = 0; !processes.empty() && NumRowsOf("killed") == rows; ++wait) {
        ASSERT_LT(wait, 6000) << "nothing is done for minutes";
        usleep(10'000);
        processes = ProcessesOf(OutOf("killed"));
      }
      if (processes.empty()) break;
      // The last that began is a worker, the first one their parent.
      kill(i == 3 ? processes.front() : processes.back(), SIGKILL);
      ++kills;
    }
    is_done = running.Finish().exit_code == 0;
    ASSERT_LT(kills, 200);
  }
  EXPECT_GT(kills, 2);
  EXPECT_EQ(Digest("killed"), digest);
  EXPECT_EQ(ProcessesOf(OutOf("killed")).size(), 0u);
}

TEST_F(SweepTest, FinishesWhatIsInFlightWhenItIsStoppedAndGoesOnFromThere) {
  {
    Running running({SIDESTEP_PROGRAM, "sweep", "run", file_, "--out", OutOf("out"), "-j", "1"});
    for (int i = 0; i < 3000 && NumRowsOf("out") < 3; ++i) usleep(10'000);
    running.Signal(SIGINT);
    const Finished finished = running.Finish();
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_THAT(finished.err, HasSubstr("stopped by Ctrl-C: "));
    EXPECT_THAT(finished.err, HasSubstr("of 32 runs are finished, and the same command goes on"));
  }
  EXPECT_FALSE(fs::exists(DatabaseOf("out")));
  const Finished status = Sweep("status", "out");
  EXPECT_EQ(status.exit_code, 1);
  EXPECT_THAT(status.out, HasSubstr("of 32 runs are finished"));
  const Finished merged = Sweep("merge", "out");  // what there is
  EXPECT_EQ(merged.exit_code, 1);
  const auto before = bench::RunDatabase(DatabaseOf("out")).num_runs();
  EXPECT_GT(before, 2);
  EXPECT_LT(before, kNumRuns);
  const Finished rest = Sweep("run", "out");
  EXPECT_EQ(rest.exit_code, 0);
  EXPECT_THAT(rest.err, HasSubstr(std::to_string(before) + " of 32 runs, from before"));
  EXPECT_THAT(Sweep("status", "out").out, HasSubstr("32 of 32 runs are finished, 0 are missing"));
}

TEST_F(SweepTest, GoesOnAfterAChangedCommentButNotAfterAChangedRobotOrScenario) {
  const fs::path data = folder_.path() / "data";
  fs::create_directories(data);
  for (const char* const part : {"models", "scenarios"}) {
    fs::copy(fs::path(SIDESTEP_SOURCE_DIR) / part, data / part, fs::copy_options::recursive);
  }
  const auto append = [&](const char* file, const char* text) {
    std::ofstream(data / file, std::ios::app) << text;
  };
  const std::vector<std::string> environment = {"SIDESTEP_DATA_DIR=" + data.string()};
  const auto run = [&](std::vector<std::string> further = {}) {
    return Sweep("run", "out", std::move(further), environment);
  };
  EXPECT_EQ(run().exit_code, 0);
  append("scenarios/walkway_behaviours.yaml", "# another comment\n");
  const Finished same = run();
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_THAT(same.err, HasSubstr("32 of 32 runs, from before"));

  append("models/panda/robot.yaml", "# another robot, for all we know\n");
  const Finished robot = run();
  EXPECT_EQ(robot.exit_code, 2);
  EXPECT_THAT(robot.err, HasSubstr("holds runs of other scenarios, settings or robots"));

  const Finished again = run({"--again"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.err, Not(HasSubstr("from before")));
  EXPECT_THAT(again.err, HasSubstr("32 rows by another build or of other inputs do not count"));
  EXPECT_EQ(bench::RunDatabase(DatabaseOf("out")).num_runs(), kNumRuns);

  append("scenarios/walkway_behaviours.yaml", "predictor: imm\n");
  EXPECT_EQ(run().exit_code, 2);
  for (const char* const what : {"status", "merge"}) {
    const Finished told = Sweep(what, "out", {}, environment);
    EXPECT_EQ(told.exit_code, 1) << what;
    EXPECT_THAT(told.err, HasSubstr("holds runs of other scenarios, settings or robots")) << what;
    EXPECT_THAT(told.out, HasSubstr("32 of 32 runs")) << what;
  }
}

TEST_F(SweepTest, RunsOnlyWhatIsNewWhenItsPlanGrowsAndLeavesOutWhatItLost) {
  EXPECT_EQ(Sweep("run", "out").exit_code, 0);
  std::string more = kSweep;
  more.replace(more.find("seeds: 4"), 8, "seeds: 5");
  Write(more);
  const Finished grown = Sweep("run", "out");
  EXPECT_EQ(grown.exit_code, 0) << grown.err;
  EXPECT_THAT(grown.err, HasSubstr("32 of 40 runs, from before"));
  more.replace(more.find("[stop, turn]"), 12, "[straight, stop, turn]");
  Write(more);
  const Finished wider = Sweep("run", "out");
  EXPECT_EQ(wider.exit_code, 0) << wider.err;
  EXPECT_THAT(wider.err, HasSubstr("40 of 60 runs, from before"));
  std::string less = kSweep;
  less.replace(less.find("[stop, turn]"), 12, "[stop]");
  Write(less);
  const Finished merged = Sweep("merge", "out");
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_THAT(merged.err, HasSubstr("44 rows of runs that this plan does not hold do not count"));
  EXPECT_EQ(bench::RunDatabase(DatabaseOf("out")).num_runs(), 16);
}

TEST_F(SweepTest, SaysWhatIsWrongWithItsFolder) {
  EXPECT_THAT(Sweep("status", "none").err, HasSubstr("none/plan.json: no such file"));
  std::ofstream(OutOf("file")) << "text";
  const Finished file = Sweep("run", "file");
  EXPECT_EQ(file.exit_code, 2);
  EXPECT_THAT(file.err, HasSubstr("cannot be made a folder"));
  fs::create_directories(OutOf("busy") + "/shards");
  const bench::ShardWriter busy(OutOf("busy") + "/shards/1-of-1.rows", {"build", "inputs"}, {});
  const Finished second = Sweep("run", "busy");
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_THAT(second.err, HasSubstr("another process is writing here just now"));
  EXPECT_EQ(Sweep("run", "bad", {"--shard", "8/7"}).exit_code, 2);
  EXPECT_EQ(Sweep("run", "bad", {"--shard", "7"}).exit_code, 2);
}

TEST_F(SweepTest, LosesNothingWhereTheDiskIsFull) {
  const Finished full = RunProgram({"/bin/sh", "-c",
                                    std::string("ulimit -f 12; exec ") + SIDESTEP_PROGRAM +
                                        " sweep run " + file_ + " -j 2 --out " + OutOf("out")});
  EXPECT_EQ(full.exit_code, 2);
  EXPECT_THAT(full.err, HasSubstr("1-of-1.rows: cannot be written: File too large"));
  const Finished rest = Sweep("run", "out");
  EXPECT_EQ(rest.exit_code, 0) << rest.err;
  EXPECT_THAT(rest.err, HasSubstr("of 32 runs, from before"));
  EXPECT_THAT(rest.err, Not(HasSubstr("is damaged")));
}

TEST_F(SweepTest, KeepsTheTracesThatAreAskedForAlsoAfterwards) {
  EXPECT_EQ(Sweep("run", "out").exit_code, 0);
  Write(std::string(kSweep) + "traces: all\n");
  const Finished run = Sweep("run", "out");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const bench::RunDatabase database(DatabaseOf("out"));
  bench::SqlStatement rows = database.Select("outcome, trace, error");
  int kept = 0;
  while (rows.Step()) {
    const bool is_wanted = rows.Text(0) != "failed";
    EXPECT_EQ(!rows.IsNull(1), is_wanted);
    if (!is_wanted) continue;
    EXPECT_TRUE(fs::exists(OutOf("out") + "/" + rows.Text(1)));
    ++kept;
  }
  EXPECT_GT(kept, 0);
}

TEST_F(SweepTest, IsReadByPythonAsTheExampleSays) {
  if (RunProgram({"/usr/bin/python3", "-c", "import pandas, h5py"}).exit_code != 0) {
    GTEST_SKIP() << "needs Debian's python3-pandas and python3-h5py";
  }
  Write(std::string(kSweep) + "traces: all\n");
  ASSERT_EQ(Sweep("run", "out", {"--csv"}).exit_code, 0);
  const Finished example =
      RunProgram({"/usr/bin/python3", SIDESTEP_SOURCE_DIR "/examples/sweeps/read_results.py",
                  DatabaseOf("out")});
  EXPECT_EQ(example.exit_code, 0) << example.err;
  EXPECT_THAT(example.out, HasSubstr("walkway_behaviours prediction"));
  EXPECT_THAT(example.out, HasSubstr(" ticks of 7 joints"));
}

TEST_F(SweepTest, WritesACsvOfEveryRow) {
  ASSERT_EQ(Sweep("run", "out", {"--csv"}).exit_code, 0);
  const CsvFile csv = ReadCsv(OutOf("out") + "/results.csv");
  const bench::RunDatabase database(DatabaseOf("out"));
  EXPECT_EQ(csv.columns, database.columns());
  ASSERT_EQ(csv.rows.size(), static_cast<std::size_t>(kNumRuns));
  const auto column = std::find(csv.columns.begin(), csv.columns.end(), "goal_error_rad");
  const auto c = static_cast<std::size_t>(column - csv.columns.begin());
  bench::SqlStatement rows = database.Select("goal_error_rad");
  for (const CsvRow& line : csv.rows) {
    ASSERT_TRUE(rows.Step());
    if (rows.IsNull(0)) {
      EXPECT_EQ(line.fields[c], "");
    } else {
      EXPECT_EQ(std::stod(line.fields[c]), rows.Number(0));
    }
  }
}

TEST_F(SweepTest, IsVerifiedFromAnywhereWhereItsScenarioIsGivenByAPath) {
  fs::create_directories(folder_.path() / "elsewhere");
  fs::copy(fs::path(SIDESTEP_SOURCE_DIR) / "scenarios/hsr_walkway.yaml",
           folder_.path() / "own.yaml");
  Write(
      "scenarios: [./own.yaml]\n"
      "set: {planner.name: straight_line, horizon.duration_s: 1}\n"
      "axes: {knowledge: [static, prediction]}\n");
  const std::string elsewhere = (folder_.path() / "elsewhere").string();
  const Finished run =
      RunProgram({SIDESTEP_PROGRAM, "sweep", "run", "quick.yaml", "--out", "relative"}, {},
                 folder_.path().string());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Finished verify =
      RunProgram({SIDESTEP_PROGRAM, "verify", "../relative/results.db"}, {}, elsewhere);
  EXPECT_EQ(verify.exit_code, 0) << verify.out << verify.err;
  EXPECT_THAT(verify.out, HasSubstr("2 of 2 runs came out the same"));
  const bench::RunDatabase database(DatabaseOf("relative"));
  bench::SqlStatement command = database.Select("command");
  ASSERT_TRUE(command.Step());
  EXPECT_THAT(command.Text(0), HasSubstr("sidestep run " + (folder_.path() / "own.yaml").string()));
}

struct SweepFault {
  const char *sweep, *says;
};

TEST_F(SweepTest, SaysWhereInItsFileTheFaultIs) {
  for (const SweepFault& fault : {
           SweepFault{"scenarios: [hsr_walkway]\nset:\n  planner.nme: gpmp\n",
                      ":3: set.planner.nme: is not a known key"},
           {"scenarios: [hsr_walkway]\nset: {knowledge: magic}\n",
            ":2: set.knowledge: must be one of static"},
           {"scenarios: [hsr_walkway]\naxes:\n  predictor: [magic]\n",
            ":3: axes.predictor: must be one of"},
           {"scenarios: [hsr_walkway]\naxes:\n  replanning.latency_s/replanning.rate_hz: [[5, "
            "10]]\n",
            ":3: axes.replanning.latency_s: must not exceed the horizon"},
           {"scenarios: [hsr_walkway]\n\nvariations: {delay_s: [1, 0]}\n",
            ":3: variations.delay_s: must be [LEAST, MOST]"},
           {"scenarios: [hsr_walkway]\naxes:\n  knowledge: [static]\n  speed_m_s: [1000]\n",
            ":4: axes.speed_m_s: must be a number from 0 to 100"},
           {"scenarios: [walkway_behaviours]\nset: {behaviour: speed_up_2}\naxes: {speed_m_s: "
            "[90]}\n",
            ":3: axes.speed_m_s: "},
           {"scenarios: [walkway_behaviours]\nset: {behaviour: magic}\n",
            ":2: set.behaviour: must be one of straight"},
           {"set: {seed_: 1}\nscenarios: [nowhere]\n", ":2: scenarios: 'nowhere' is no scenario"},
           {"scenarios: [./nofile.yaml]\n", ":1: scenarios: "},
           {"scenarios: [hsr_walkway]\nset: {robot: {model: panda}}\n",
            ":2: set.robot.base: is missing"},
           {"scenarios: [hsr_walkway]\nseeds: 3\n", ":2: seeds: a seed changes nothing"},
       }) {
    Write(fault.sweep);
    const Finished plan = Sweep("plan", "none");
    EXPECT_EQ(plan.exit_code, 2) << fault.sweep;
    EXPECT_THAT(plan.err, ::testing::StartsWith(file_ + fault.says)) << fault.sweep;
    EXPECT_THAT(plan.err, Not(HasSubstr("--")));
    EXPECT_EQ(std::count(plan.err.begin(), plan.err.end(), '\n'), 1) << plan.err;
  }
}

TEST_F(SweepTest, IsNotVerifiedWhereItsDatabaseNamesNoNumberOfGuesses) {
  EXPECT_EQ(Sweep("run", "out").exit_code, 0);
  bench::SqlDatabase::Create(OutOf("scratch.db"), "scratch")
      .Execute("ATTACH '" + DatabaseOf("out") +
               "' AS other; INSERT INTO other.sidestep VALUES ('search', '1e99 and more')");
  const Finished verify = RunProgram({SIDESTEP_PROGRAM, "verify", DatabaseOf("out")});
  EXPECT_EQ(verify.exit_code, 2);
  EXPECT_EQ(verify.err,
            DatabaseOf("out") + ": `search` must be a number of guesses, is '1e99 and more'\n");
}

TEST_F(SweepTest, IsVerifiedBitForBit) {
  EXPECT_EQ(Sweep("run", "out").exit_code, 0);
  const auto verify = [&] {
    return RunProgram({SIDESTEP_PROGRAM, "verify", DatabaseOf("out"), "--sample", "32"});
  };
  const Finished same = verify();
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_THAT(same.out, HasSubstr("32 of 32 runs came out the same, bit for bit"));
  bench::SqlDatabase::Create(OutOf("scratch.db"), "scratch")
      .Execute("ATTACH '" + DatabaseOf("out") + "' AS other; " +
               "UPDATE other.runs SET goal_error_rad = goal_error_rad * (1 + 3e-16) WHERE id = 1; "
               "UPDATE other.run_facts SET touched = 'a ghost' WHERE runid = 2;"
               "UPDATE other.wall_clock_machines SET value = 'x86-64' WHERE name = 'cpu_features'");
  const Finished other = verify();
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.out, HasSubstr("30 of 32 runs came out the same"));
  EXPECT_THAT(other.out, HasSubstr("run 1: goal_error_rad was "));
  EXPECT_THAT(other.out, HasSubstr("run 2: touched was a ghost, is "));
  EXPECT_THAT(other.out, HasSubstr("some were made with cpu_features x86-64, here it is "));
}

}  // namespace
}  // namespace sidestep::sweep_test
