// `sidestep fci-server` as a person and a client meet it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <ostream>
#include <string>
#include <thread>
#include <vector>

#include "sidestep/hardware/raw_fci_driver.h"
#include "sidestep/record/recording_file.h"
#include "tests/hardware/own_loopback.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::fci_server_command_test {
namespace {

using hardware::OwnLoopback;
using ::testing::HasSubstr;

std::vector<std::string> Serve(const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {SIDESTEP_PROGRAM, "fci-server", "--address", OwnLoopback()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return command;
}

struct Mistake {
  std::string name;
  std::vector<std::string> arguments;
  std::string says;
};
std::ostream& operator<<(std::ostream& stream, const Mistake& m) { return stream << m.name; }

class ServerMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(ServerMistakes, GetOneLineAndExitCodeTwo) {
  const Finished finished = RunProgram(Serve(GetParam().arguments));
  EXPECT_EQ(finished.exit_code, 2) << finished.out;
  EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    Typical, ServerMistakes,
    testing::Values(
        Mistake{"StartBeyondALimit",
                {"--q-start", "0,-0.8,0,0.5,0,1.6,0.8"},
                "--q-start: joint 4 must be between -3.0718 and -0.0698 rad, is 0.5"},
        Mistake{"StartOfSixJoints", {"--q-start", "0,-0.8,0,-2,0,1.6"}, "--q-start"},
        Mistake{"UnknownClock", {"--clock", "sundial"}, "--clock"},
        Mistake{
            "FaultsThatAreNotThere", {"--faults", "nowhere.yaml"}, "nowhere.yaml: no such file"},
        Mistake{"ScenarioOfAnotherRobot",
                {"--scenario", "wam_single_pillar"},
                "--scenario: its robot must be the panda, is 'wam'"},
        Mistake{
            "SpeedOfNoScenario", {"--speed", "0.5"}, "--speed: is of the things of a --scenario"},
        Mistake{"SettingOfNoScenario", {"--set", "planner.qc=2"}, "--set: is of a --scenario"}),
    [](const auto& test) { return test.param.name; });

TEST(FciServerCommand, SaysInOneLineThatThePortIsTaken) {
  const robot::fci::Listener other(OwnLoopback(), robot::fci::kCommandPort);
  const Finished finished = RunProgram(Serve({}));
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_EQ(finished.err, "--address: " + OwnLoopback() + ":1337: Address already in use\n");
}

TEST(FciServerCommand, RefusesAnAddressOfAnotherMachine) {
  const Finished finished = RunProgram({SIDESTEP_PROGRAM, "fci-server", "--address", "192.0.2.1"});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_THAT(finished.err, HasSubstr("--address: 192.0.2.1:1337: "));
}

TEST(FciServerCommand, EndsByCtrlCWithCodeZero) {
  std::vector<std::string> command = {"timeout", "--preserve-status", "-s", "INT", "1"};
  const std::vector<std::string> serve = Serve({});
  command.insert(command.end(), serve.begin(), serve.end());
  const Finished finished = RunProgram(command);
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("simulated Panda at " + OwnLoopback()));
}

std::unique_ptr<hardware::RawFciDriver> ConnectOnceThere() {
  for (int attempt = 0; attempt < 1000; ++attempt) {
    try {
      return std::make_unique<hardware::RawFciDriver>(OwnLoopback());
    } catch (const hardware::FciError&) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  return nullptr;
}

TEST(FciServerCommand, TellsWhatHappens) {
  const TemporaryFolder folder;
  const std::string faults = folder.path() / "faults.yaml";
  std::ofstream(faults) << "faults:\n  - {kind: lose_commands, at_s: 0.7, count: 20}\n";
  Finished finished;
  std::thread server([&] { finished = RunProgram(Serve({"--once", "--faults", faults})); });
  if (auto driver = ConnectOnceThere()) {
    const auto hold = [calls = 0](const hardware::RobotSnapshot& state, int) mutable {
      return hardware::Command{state.q_d, ++calls == 100};
    };
    driver->Control(hardware::CommandKind::kPositions, hold);
    EXPECT_THROW(driver->Control(hardware::CommandKind::kPositions,
                                 [calls = 0](const hardware::RobotSnapshot& state, int) mutable {
                                   return hardware::Command{state.q_d, ++calls == 2000};
                                 }),
                 hardware::FciError);
    driver->Recover();
  }
  server.join();
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(finished.err, "");
  for (const char* const line :
       {"connected from 127.", "0.000 s: motion started: joint positions", "s: motion finished\n",
        "s: motion aborted: communication_constraints_violation\n", "s: recovered\n",
        "s: disconnected: ", "least clearance  "}) {
    EXPECT_THAT(finished.out, HasSubstr(line));
  }
}

TEST(FciServerCommand, WritesATraceOfWhatTrulyHappened) {
  const TemporaryFolder folder;
  const std::string out = folder.path() / "out";
  Finished finished;
  std::thread server([&] { finished = RunProgram(Serve({"--once", "--out", out})); });
  if (auto driver = ConnectOnceThere()) {
    const auto swing = [t_s = 0.0, start = robot::fci::Joints{}](
                           const hardware::RobotSnapshot& state, int elapsed) mutable {
      hardware::Command command{state.q_d, false};
      t_s += 1e-3 * elapsed;
      if (t_s == 0) start = state.q_d;
      command.values = start;
      command.values[0] += 0.1 * (1 - std::cos(M_PI * std::min(t_s, 2.0)));
      command.finished = t_s > 2.3;
      return command;
    };
    driver->Control(hardware::CommandKind::kPositions, swing);
  }
  server.join();
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("written          " + out + "/trace.h5\n"));
  const record::Recording recording = record::ReadRecording(out + "/trace.h5");
  ASSERT_GT(recording.control.size(), 2300u);
  EXPECT_EQ(recording.truth.size(), recording.control.size() / 10 + 1);
  double farthest_rad = 0;
  for (const ControlSample& tick : recording.control) {
    farthest_rad = std::max(farthest_rad, tick.q(0) - recording.q_start(0));
    EXPECT_LT((tick.q_command - tick.q).cwiseAbs().maxCoeff(), 0.02);
  }
  EXPECT_NEAR(farthest_rad, 0.2, 0.005);
  EXPECT_FALSE(std::filesystem::exists(out + "/trace.journal"));
}

}  // namespace
}  // namespace sidestep::fci_server_command_test
