// Runs that are cut off: killed, their disk full, their robot gone. What was recorded until then is
// there, and the robot rests.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "sidestep/core/input_error.h"
#include "sidestep/hardware/raw_fci_driver.h"
#include "sidestep/record/questions.h"
#include "sidestep/record/recording_file.h"
#include "sidestep/record/sealed_file.h"
#include "tests/hardware/own_loopback.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::cut_off_run_test {
namespace {

namespace fs = std::filesystem;
using hardware::OwnLoopback;
using record::Recording;
using ::testing::HasSubstr;

std::vector<std::string> Sidestep(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), SIDESTEP_PROGRAM);
  return arguments;
}

bool WaitUntil(const std::function<bool()>& is_so) {
  for (int i = 0; i < 12000 && !is_so(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return is_so();
}

// How many parts of the journal are on the disk as a whole: one that is being written does not
// count.
std::size_t NumWholeParts(const std::string& journal) {
  try {
    return record::ReadSealedRow(journal, {"sidestep journal", record::kTraceVersion})
        .payloads.size();
  } catch (const InputError&) {  // not begun, or within its first part
    return 0;
  }
}

bool WaitForParts(const std::string& folder, std::size_t parts) {
  return WaitUntil([&] { return NumWholeParts(folder + "/trace.journal") >= parts; });
}

std::vector<std::string> NamesIn(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

nlohmann::json ResultIn(const std::string& folder) {
  std::ifstream stream(folder + "/result.json");
  return nlohmann::json::parse(stream);
}

// The recording of a run of which there is a journal alone.
Recording Salvage(const std::string& folder) {
  EXPECT_EQ(NamesIn(folder), std::vector<std::string>{"trace.journal"});
  const Finished salvage = RunProgram(Sidestep({"salvage", folder}));
  EXPECT_EQ(salvage.exit_code, 0) << salvage.err;
  EXPECT_THAT(salvage.out, HasSubstr("reason           its process ended before the episode did"));
  EXPECT_EQ(NamesIn(folder), (std::vector<std::string>{"result.json", "trace.h5"}));
  EXPECT_EQ(ResultIn(folder).at("outcome"), "aborted");
  return record::ReadRecording(folder + "/trace.h5");
}

template <typename Rows, typename IsEqual>
void ExpectBeginningOf(const Rows& whole, const Rows& beginning, const IsEqual& is_equal) {
  ASSERT_LE(beginning.size(), whole.size());
  EXPECT_TRUE(std::equal(beginning.begin(), beginning.end(), whole.begin(), is_equal));
}

class KilledAfter : public ::testing::TestWithParam<std::size_t> {
};  // so many parts of its journal

TEST_P(KilledAfter, ARunInSimulationLeavesItsBeginning) {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& out) {
    // By the slower planner, so that it takes long enough.
    return Sidestep({"run", "hsr_walkway", "--set", "planner.name=gpmp", "--set",
                     "horizon.duration_s=20", "--out", out});
  };
  const std::string out = folder.path() / "killed", all = folder.path() / "whole";
  Running killed(run(out));
  ASSERT_TRUE(WaitForParts(out, GetParam()));
  killed.Signal(SIGKILL);
  EXPECT_EQ(killed.Finish().exit_code, -1) << "it was over before";
  const Recording beginning = Salvage(out);

  ASSERT_EQ(RunProgram(run(all)).exit_code, 0);
  EXPECT_EQ(NamesIn(all), (std::vector<std::string>{"result.json", "trace.h5"}));
  const Recording whole = record::ReadRecording(all + "/trace.h5");
  ExpectBeginningOf(whole.control, beginning.control, [](const auto& a, const auto& b) {
    return a.t == b.t && a.q == b.q && a.torque == b.torque;
  });
  ExpectBeginningOf(whole.truth, beginning.truth, [](const auto& a, const auto& b) {
    return a.t == b.t && a.clearance_m == b.clearance_m;
  });
  ExpectBeginningOf(whole.cycles, beginning.cycles,
                    [](const auto& a, const auto& b) { return a.t == b.t && a.cost == b.cost; });
  ExpectBeginningOf(whole.observations, beginning.observations, [](const auto& a, const auto& b) {
    return a.changed_cells == b.changed_cells;
  });
  // The first part may come before the first tick.
  EXPECT_TRUE(GetParam() == 1 || beginning.cycles.size() > 0);
  EXPECT_EQ(beginning.scenario_yaml, whole.scenario_yaml);
  EXPECT_EQ(beginning.model_xml, whole.model_xml);
  for (const char* const key : {"identity.run", "version.build_id", "scenario", "knowledge"}) {
    EXPECT_EQ(beginning.header.at(key), whole.header.at(key));
  }
  EXPECT_EQ(ResultIn(out).at("identity"), ResultIn(all).at("identity"));
  EXPECT_EQ(ResultIn(out).at("versions"), ResultIn(all).at("versions"));
  EXPECT_EQ(ResultIn(out).at("parameters"), ResultIn(all).at("parameters"));
}

INSTANTIATE_TEST_SUITE_P(Parts, KilledAfter, ::testing::Values(1, 3),
                         [](const auto& test) { return std::to_string(test.param); });

TEST(RunFolder, IsRefusedToASecondRunAsLongAsTheFirstWritesThere) {
  const TemporaryFolder folder;
  const std::string out = folder.path() / "out";
  // By the slower planner, so that it takes long enough.
  Running first(Sidestep({"run", "hsr_walkway", "--seed", "1", "--set", "planner.name=gpmp",
                          "--set", "horizon.duration_s=20", "--out", out}));
  ASSERT_TRUE(WaitForParts(out, 1));
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", "hsr_walkway", "--seed", "2"},
        {"hardware", "run", "hardware_single_table"}}) {
    std::vector<std::string> command = Sidestep(words);
    command.insert(command.end(), {"--out", out});
    const Finished second = RunProgram(command);
    EXPECT_EQ(second.exit_code, 2);
    EXPECT_EQ(second.err, "--out: '" + out + "': another command is writing here just now\n");
  }
  EXPECT_EQ(first.Finish().exit_code, 0);
  EXPECT_EQ(NamesIn(out), (std::vector<std::string>{"result.json", "trace.h5"}));
  EXPECT_EQ(ResultIn(out).at("seed"), 1);
}

// A scenario on a simulated Panda, both in lock-step.
class CutOffOnHardware : public ::testing::TestWithParam<std::size_t> {
 protected:
  void SetUp() override {
    server_ = std::make_unique<Running>(Sidestep(
        {"fci-server", "--address", OwnLoopback(), "--scenario", "hardware_single_table"}));
    ASSERT_TRUE(WaitUntil([&] { return server_->out().starts_with("simulated Panda"); }));
    client_ = std::make_unique<Running>(
        Sidestep({"hardware", "run", "hardware_single_table", "--clock", "lockstep", "--robot",
                  OwnLoopback(), "--set", "horizon.duration_s=20", "--out", out_}));
    ASSERT_TRUE(WaitForParts(out_, GetParam()));
  }

  const TemporaryFolder folder_;
  const std::string out_ = folder_.path() / "out";
  std::unique_ptr<Running> server_, client_;
};

TEST_P(CutOffOnHardware, ByBeingKilledLeavesWhatWasRecordedAndTheRobotAtRest) {
  client_->Signal(SIGKILL);
  EXPECT_EQ(client_->Finish().exit_code, -1) << "it was over before";
  const Recording recording = Salvage(out_);
  EXPECT_TRUE(GetParam() == 1 || recording.control.size() > 0);
  EXPECT_EQ(recording.joints.size(), 7u);

  ASSERT_TRUE(WaitUntil([&] { return server_->out().find("aborted") != std::string::npos; }));
  hardware::RawFciDriver robot(OwnLoopback());
  ASSERT_TRUE(WaitUntil([&] {
    const robot::fci::Joints dq = robot.ReadOnce().dq;
    return std::all_of(dq.begin(), dq.end(), [](double v) { return std::abs(v) < 1e-3; });
  }));
  EXPECT_EQ(robot.ReadOnce().mode, robot::fci::RobotMode::kReflex);
}

TEST_P(CutOffOnHardware, ByTheRobotGoingAwayKeepsItsResults) {
  server_->Signal(SIGKILL);
  const Finished client = client_->Finish();
  EXPECT_EQ(client.exit_code, 1);
  EXPECT_EQ(NamesIn(out_), (std::vector<std::string>{"result.json", "trace.h5"}));
  EXPECT_EQ(record::ReadRecording(out_ + "/trace.h5").joints.size(), 7u);
  EXPECT_EQ(ResultIn(out_).at("outcome"), "aborted");
}

TEST_P(CutOffOnHardware, ByANetworkThatIsSilentKeepsItsResults) {
  server_->Signal(SIGSTOP);
  const Finished client = client_->Finish();
  server_->Signal(SIGCONT);
  EXPECT_EQ(client.exit_code, 1);
  EXPECT_THAT(client.err, HasSubstr("the robot sends no state"));
  EXPECT_EQ(NamesIn(out_), (std::vector<std::string>{"result.json", "trace.h5"}));
  EXPECT_EQ(record::ReadRecording(out_ + "/trace.h5").joints.size(), 7u);

  const Finished hindsight = RunProgram(Sidestep({"hindsight", out_ + "/trace.h5"}));
  EXPECT_EQ(hindsight.exit_code, 0) << hindsight.err;
  EXPECT_THAT(hindsight.out,
              ::testing::MatchesRegex(".*/trace.h5: was aborted at [0-9.]+ s: .*sends no state.*"));
  EXPECT_EQ(std::count(hindsight.out.begin(), hindsight.out.end(), '\n'), 1) << hindsight.out;
}

INSTANTIATE_TEST_SUITE_P(Parts, CutOffOnHardware, ::testing::Values(1, 3),
                         [](const auto& test) { return std::to_string(test.param); });

class FullDisk : public ::testing::Test {
 protected:
  void SetUp() override { fs::create_directories(out_); }
  static std::vector<std::string> Run(const std::string& out) {
    return Sidestep({"run", "hsr_walkway", "--set", "planner.name=straight_line", "--set",
                     "horizon.duration_s=4", "--out", out});
  }
  const TemporaryFolder folder_;
  const std::string out_ = folder_.path() / "out";
};

TEST_F(FullDisk, ThatStaysFullIsToldOnceAndTheRunGoesOn) {
  fs::create_symlink("/dev/full", out_ + "/trace.journal");
  std::vector<std::string> in_real_time = Run(out_);
  in_real_time.insert(in_real_time.end(), {"--clock", "wall"});
  const Finished run = RunProgram(in_real_time);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.err, out_ +
                         "/trace.journal: cannot be written: No space left on device; the run "
                         "goes on\n");
  EXPECT_GT(record::EndOf(record::ReadRecording(out_ + "/trace.h5")).seconds(), 3);
}

TEST_F(FullDisk, ForTheJournalChangesNothing) {
  fs::create_symlink("/dev/full", out_ + "/trace.journal");
  const std::string other = folder_.path() / "other";
  for (const std::string& out : {out_, other}) {
    const Finished run = RunProgram(Run(out));
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }
  EXPECT_EQ(record::ToHdf5(record::ReadRecording(out_ + "/trace.h5")),
            record::ToHdf5(record::ReadRecording(other + "/trace.h5")));
}

TEST_F(FullDisk, ForTheTraceLeavesTheJournal) {
  fs::create_symlink("/dev/full", out_ + "/trace.h5");
  const Finished run = RunProgram(Run(out_));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.out, HasSubstr("outcome "));
  EXPECT_EQ(run.err, out_ +
                         "/trace.h5: cannot be written: No space left on device; trace.journal " +
                         "holds the run: `sidestep salvage " + out_ + " --out DIR`\n");
  const std::string other = folder_.path() / "other";
  ASSERT_EQ(RunProgram(Sidestep({"salvage", out_, "--out", other})).exit_code, 0);
  const Recording salvaged = record::ReadRecording(other + "/trace.h5");
  ASSERT_EQ(RunProgram(Run(out_ + "2")).exit_code, 0);
  const Recording whole = record::ReadRecording(out_ + "2/trace.h5");
  EXPECT_EQ(salvaged.control.size(), whole.control.size());
  EXPECT_EQ(salvaged.truth.size(), whole.truth.size());
  EXPECT_EQ(salvaged.cycles.size(), whole.cycles.size());
}

TEST(SalvageCommand, SaysThatThereIsNothing) {
  const TemporaryFolder folder;
  const std::string path = folder.path();
  const Finished salvage = RunProgram(Sidestep({"salvage", path}));
  EXPECT_EQ(salvage.exit_code, 2);
  EXPECT_EQ(salvage.err, path + "/trace.journal: no such file\n");
}

TEST(RenderCommand, PointsToTheJournalOfARunThatWasCutOff) {
  const TemporaryFolder folder;
  const std::string path = folder.path();
  std::ofstream(path + "/trace.journal") << "anything";
  const Finished render =
      RunProgram(Sidestep({"render", path + "/trace.h5", "--still", path + "/a.png"}));
  EXPECT_EQ(render.exit_code, 2);
  EXPECT_EQ(render.err, path + "/trace.h5: no such file, but the journal of a run that was cut " +
                            "off: first `sidestep salvage " + path + "`\n");
}

}  // namespace
}  // namespace sidestep::cut_off_run_test
