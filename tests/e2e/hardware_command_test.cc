// `sidestep hardware` as a person meets it, with `sidestep fci-server` in lock-step.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <string>
#include <thread>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/hardware/raw_fci_driver.h"
#include "sidestep/record/recording_file.h"
#include "tests/hardware/own_loopback.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::hardware_command_test {
namespace {

namespace fs = std::filesystem;
using hardware::OwnLoopback;
using robot::fci::RobotMode;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kScenario = "hardware_single_table";
constexpr const char* kAside = "-1.44,-0.785,0,-2.356,0,1.57,0.785";  // of its start

// A server, once it listens.
class Server : public Running {
 public:
  explicit Server(const std::vector<std::string>& further = {"--scenario", kScenario})
      : Running(Command(further)) {
    if (!Prints("Ctrl-C ends it")) throw std::runtime_error("no server: " + Finish().err);
  }

 private:
  static std::vector<std::string> Command(const std::vector<std::string>& further) {
    std::vector<std::string> command = {SIDESTEP_PROGRAM, "fci-server", "--address", OwnLoopback()};
    command.insert(command.end(), further.begin(), further.end());
    return command;
  }
};

class Hardware : public testing::Test {
 protected:
  std::vector<std::string> Command(const std::string& command,
                                   const std::vector<std::string>& further) const {
    std::vector<std::string> words = {SIDESTEP_PROGRAM, "hardware", command, "--robot",
                                      OwnLoopback()};
    words.insert(words.end(), further.begin(), further.end());
    return words;
  }
  std::vector<std::string> Environment() const {
    return {"XDG_STATE_HOME=" + (folder_.path() / "state").string()};
  }
  Finished Run(const std::string& command, const std::vector<std::string>& further = {}) const {
    return RunProgram(Command(command, further), Environment(), folder_.path().string());
  }
  std::string Text(const fs::path& file) const {
    std::ifstream stream(folder_.path() / file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  TemporaryFolder folder_;
};

const std::vector<std::string> kRun = {kScenario, "--clock", "lockstep", "--out", "out"};

TEST_F(Hardware, RunsAScenarioAndLeavesItsResults) {
  const Server server;
  const Finished finished = Run("run", kRun);
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("outcome          unjudged"), HasSubstr("answers  ")));
  const nlohmann::json result = nlohmann::json::parse(Text("out/result.json"));
  EXPECT_GT(result.at("wall_clock").at("answers").at("p99_9_us").get<double>(), 0);
  EXPECT_TRUE(fs::exists(folder_.path() / "out/trace.h5"));
  EXPECT_FALSE(fs::exists(folder_.path() / "state")) << "nothing was refused";
}

// How a run is ended from outside while its robot moves.
constexpr int kLeft = 128;  // and the number of the signal
struct Ending {
  std::string name;
  std::vector<int> signals;
  int exit_code;
  const char* says;    ///< on standard error
  const char* server;  ///< says of the motion
  const char* reaction = "brake";
};
std::ostream& operator<<(std::ostream& stream, const Ending& ending) {
  return stream << ending.name;
}

class HardwareEnds : public Hardware, public testing::WithParamInterface<Ending> {
 protected:
  // What is true of every way out: the arm rests.
  static RobotMode ModeOfTheRestingRobot() {
    hardware::RawFciDriver driver(OwnLoopback());
    const hardware::RobotSnapshot state = driver.ReadOnce();
    for (const double dq : state.dq) EXPECT_LT(std::abs(dq), 1e-3);
    return state.mode;
  }

  // It braked as fast as it may, and what happened until then is in its trace.
  void ExpectItBraked() const {
    const nlohmann::json result = nlohmann::json::parse(Text("out/result.json"));
    EXPECT_EQ(result.at("outcome"), "aborted");
    std::optional<double> asked_s;
    for (const nlohmann::json& event : result.at("safety_events")) {
      if (event.at("check") != "operator_stop") continue;
      if (!asked_s) asked_s = event.at("t_s").get<double>();
    }
    ASSERT_TRUE(asked_s);
    const record::Recording trace = record::ReadRecording(folder_.path() / "out/trace.h5");
    ASSERT_FALSE(trace.control.empty());
    const ControlSample& last = trace.control.back();
    EXPECT_TRUE(last.v_command.isZero(1e-9));
    double rests_since_s = last.t.seconds();
    for (auto tick = trace.control.rbegin();
         tick != trace.control.rend() && tick->v_command.isZero(1e-9); ++tick) {
      rests_since_s = tick->t.seconds();
    }
    EXPECT_LE(rests_since_s, *asked_s + 0.35);
  }
};

TEST_P(HardwareEnds, AndItsRobotComesToRest) {
  const Ending& ending = GetParam();
  Server server;
  Running run(Command("run", kRun), Environment(), folder_.path().string());
  ASSERT_TRUE(server.Prints("motion started"));
  RandomStream random(1, ending.name);
  std::this_thread::sleep_for(std::chrono::duration<double>(random.Uniform(0, 0.15)));
  for (const int signal : ending.signals) run.Signal(signal);
  const Finished finished = run.Finish();
  if (ending.exit_code == kLeft) {
    EXPECT_GT(finished.exit_code, 128) << "whichever comes last";
  } else {
    EXPECT_EQ(finished.exit_code, ending.exit_code) << finished.err;
  }
  EXPECT_THAT(finished.err, HasSubstr(ending.says));
  if (ending.exit_code == kLeft) {
    // Whether the robot has heard the second signal's stop before the third ends all is chance.
    const auto has_ended = [&] {
      const std::string out = server.out();
      return out.find(ending.server) != std::string::npos ||
             out.find("motion stopped by the client") != std::string::npos;
    };
    for (int n = 0; n < 300 && !has_ended(); ++n) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    EXPECT_TRUE(has_ended()) << server.out();
    ModeOfTheRestingRobot();
    return;
  }
  EXPECT_TRUE(server.Prints(ending.server)) << server.out();
  const RobotMode mode = ModeOfTheRestingRobot();
  if (ending.exit_code == 1) {
    EXPECT_EQ(mode, RobotMode::kIdle);
    if (ending.signals.size() == 1) ExpectItBraked();
  } else {
    EXPECT_EQ(mode, RobotMode::kReflex);  // the robot's own, of a client that is gone
    EXPECT_EQ(finished.signal, ending.exit_code == -1 ? SIGKILL : 0);
  }
}

const char* const kGone = "motion aborted: communication_constraints_violation";
INSTANTIATE_TEST_SUITE_P(
    By, HardwareEnds,
    testing::Values(
        Ending{"CtrlC", {SIGINT}, 1, "stopped from outside: Ctrl-C", "motion finished"},
        Ending{"CtrlCLater", {SIGINT}, 1, "stopped from outside: Ctrl-C", "motion finished"},
        Ending{"CtrlCLaterYet", {SIGINT}, 1, "stopped from outside: Ctrl-C", "motion finished"},
        Ending{"SigTerm", {SIGTERM}, 1, "stopped from outside: SIGTERM", "motion finished"},
        Ending{"TheTerminalsEnd", {SIGHUP}, 1, "stopped from outside: SIGHUP", "motion finished"},
        Ending{"TwoSignals", {SIGINT, SIGTERM}, 1, "", "motion stopped by the client"},
        Ending{"ThreeSignals",
               {SIGINT, SIGTERM, SIGHUP},
               kLeft,
               "sidestep: left at the third signal",
               kGone},
        Ending{"SigKill", {SIGKILL}, -1, "", kGone},
        Ending{"SigKillLater", {SIGKILL}, -1, "", kGone},
        Ending{"SigKillLaterYet", {SIGKILL}, -1, "", kGone}),
    [](const auto& test) { return test.param.name; });

class HardwareIsLeft : public HardwareEnds {};

TEST_F(HardwareIsLeft, ByItsStandardInput) {
  Server server;
  int pipe_ends[2];
  ASSERT_EQ(pipe2(pipe_ends, O_CLOEXEC), 0);
  Running run(Command("run", kRun), Environment(), folder_.path().string(), pipe_ends[0]);
  close(pipe_ends[0]);
  ASSERT_TRUE(server.Prints("motion started"));
  close(pipe_ends[1]);
  const Finished finished = run.Finish();
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_THAT(finished.err, HasSubstr("stopped from outside: its standard input has ended"));
  EXPECT_EQ(ModeOfTheRestingRobot(), RobotMode::kIdle);
  ExpectItBraked();
}

TEST_F(HardwareIsLeft, ByTheProgramThatStartedIt) {
  Server server;
  std::string command;
  for (const std::string& word : Command("run", kRun)) command += word + " ";
  Running shell({"/bin/sh", "-c", command + "2> said & wait"}, Environment(),
                folder_.path().string());
  ASSERT_TRUE(server.Prints("motion started"));
  shell.Signal(SIGKILL);
  EXPECT_TRUE(server.Prints("motion finished")) << server.out();
  for (int k = 0; k < 1000 && !fs::exists(folder_.path() / "out/result.json"); ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(ModeOfTheRestingRobot(), RobotMode::kIdle);
  ExpectItBraked();
  EXPECT_THAT(Text("out/result.json"), HasSubstr("the program that started it has ended"));
}

TEST_F(Hardware, RecoversARobotOnceAMinute) {
  std::ofstream(folder_.path() / "faults.yaml")
      << "faults:\n  - {kind: error, at_s: 0.1, name: joint_reflex}\n"
         "  - {kind: error, at_s: 1, name: cartesian_reflex}\n";
  const Server server({"--faults", folder_.path() / "faults.yaml"});
  const auto provoke = [] {
    hardware::RawFciDriver driver(OwnLoopback());
    EXPECT_THROW(driver.Control(hardware::CommandKind::kPositions,
                                [calls = 0](const hardware::RobotSnapshot& state, int) mutable {
                                  return hardware::Command{state.q_d, ++calls == 3000};
                                }),
                 hardware::FciError);
  };
  EXPECT_EQ(Run("recover").exit_code, 0) << "there is nothing to recover from";
  provoke();
  const Finished refused = Run("run", kRun);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--robot: the robot is not idle but in the mode 'reflex'"));
  EXPECT_FALSE(fs::exists(folder_.path() / "out")) << "of what was refused nothing is left";

  const Finished near = Run(
      "recover", {kScenario, "--set", "moving_obstacles[0].motion.linear.start_m=[0.4, 0, 0.4]"});
  EXPECT_EQ(near.exit_code, 1);
  EXPECT_THAT(near.err, HasSubstr("from the arm, the protective distance is 0.27 m"));

  const Finished recovered = Run("recover", {kScenario});
  EXPECT_EQ(recovered.exit_code, 0) << recovered.err;
  EXPECT_EQ(recovered.out,
            "mode             reflex\nlast errors      joint_reflex\nmode             idle\n");
  provoke();
  const Finished again = Run("recover");
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.err, HasSubstr("once a minute"));
  const std::string log = Text("state/sidestep/hardware.csv");
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 5) << log;
  for (const char* const part :
       {",robot_mode,refuse,", ",recovery,refuse,", ",recovery,recovered,,,joint_reflex\n"}) {
    EXPECT_THAT(log, HasSubstr(part));
  }
}

TEST_F(Hardware, RefusesARobotOfAnotherVersion) {
  std::ofstream(folder_.path() / "faults.yaml") << "version: 6\n";
  const Server server({"--faults", folder_.path() / "faults.yaml"});
  const Finished finished = Run("run", kRun);
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_THAT(finished.err,
              HasSubstr("the robot speaks version 6 of the protocol, this program 5"));
  EXPECT_FALSE(fs::exists(folder_.path() / "out"));
  EXPECT_THAT(Text("state/sidestep/hardware.csv"), HasSubstr(",configuration,refuse,"));
}

TEST_F(Hardware, DoesNotRecoverARobotWhoseStopIsPressed) {
  std::ofstream(folder_.path() / "faults.yaml")
      << "faults: [{kind: user_stop, at_s: 0.1, for_s: 3600}]\n";
  const Server server({"--faults", folder_.path() / "faults.yaml"});
  {
    hardware::RawFciDriver driver(OwnLoopback());
    EXPECT_THROW(driver.Control(hardware::CommandKind::kPositions,
                                [](const hardware::RobotSnapshot& state, int) {
                                  return hardware::Command{state.q_d};
                                }),
                 hardware::FciError);
  }
  const Finished finished = Run("recover");
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_EQ(finished.err, "hardware recover: the user stop is pressed: release it first\n");
}

TEST_F(Hardware, GoesToTheStartAndTheServersWorldBeginsAfterwards) {
  const Server server({"--scenario", kScenario, "--q-start", kAside});
  const Finished aside = Run("run", kRun);
  EXPECT_EQ(aside.exit_code, 2);
  EXPECT_THAT(aside.err, HasSubstr("from where the task starts, allowed 0.02"));
  EXPECT_FALSE(fs::exists(folder_.path() / "out"));
  const Finished without_a_yes = Run("go-to-start", {kScenario, "--clock", "lockstep"});
  EXPECT_EQ(without_a_yes.exit_code, 2);
  EXPECT_EQ(without_a_yes.err, "hardware go-to-start: not without a yes\n");

  // Into one file, as somebody reads it.
  std::string command;
  for (const std::string& word :
       Command("go-to-start", {kScenario, "--clock", "lockstep", "--yes"}))
    command += word + " ";
  const Finished gone = RunProgram({"/bin/sh", "-c", command + "2>&1"});
  EXPECT_EQ(gone.exit_code, 0) << gone.out;
  EXPECT_THAT(gone.out, testing::MatchesRegex("The robot at .*\nfrom the start   0.00.. rad\n"));
  EXPECT_EQ(Run("run", kRun).exit_code, 0);
  const std::string told = server.out();
  const std::size_t first = told.find("0.000 s: motion started");
  ASSERT_NE(first, std::string::npos);
  EXPECT_NE(told.find("0.000 s: motion started", first + 1), std::string::npos) << told;
}

TEST_F(Hardware, DryRunMovesNothingAndSaysWhatIsMissing) {
  {
    const Server server;
    const Finished ready = Run("run", {kScenario, "--dry-run"});
    EXPECT_EQ(ready.exit_code, 0) << ready.err;
    EXPECT_THAT(ready.out, AllOf(HasSubstr("mode idle"), HasSubstr("outcome")));
    EXPECT_THAT(server.out(), Not(HasSubstr("motion")));
  }
  const Server server({"--q-start", kAside});
  const Finished not_ready = Run("run", {kScenario, "--dry-run"});
  EXPECT_EQ(not_ready.exit_code, 1);
  EXPECT_EQ(not_ready.err,
            "hardware run: not ready: joint 1 is 0.130 rad from where the task starts, allowed "
            "0.02: first `sidestep hardware go-to-start`\n");
}

TEST_F(Hardware, IsToldThatAnotherProgramIsConnected) {
  const Server server;
  const hardware::RawFciDriver first(OwnLoopback());
  const Finished second = Run("recover");
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_THAT(second.err, HasSubstr("another program may be connected to the robot"));
  EXPECT_THAT(server.out(), HasSubstr("while another one is connected"));
}

TEST_F(Hardware, IsToldOfTheWrongClock) {
  const Server server({"--scenario", kScenario, "--clock", "wall"});
  const Finished finished = Run("run", kRun);
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_THAT(finished.err, HasSubstr("--clock lockstep is for a server that waits"));
}

TEST_F(Hardware, IsToldOfTheOtherWrongClock) {
  const Server server;
  const Finished finished = Run("run", {kScenario, "--out", "out"});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_THAT(finished.err, HasSubstr("for a server in lock-step, --clock lockstep"));
}

struct Mistake {
  std::string name;
  std::vector<std::string> arguments;
  std::string says;
};
std::ostream& operator<<(std::ostream& stream, const Mistake& m) { return stream << m.name; }

class HardwareMistakes : public Hardware, public testing::WithParamInterface<Mistake> {};

TEST_P(HardwareMistakes, GetOneLineAndExitCodeTwo) {
  std::vector<std::string> command = {SIDESTEP_PROGRAM, "hardware"};
  command.insert(command.end(), GetParam().arguments.begin(), GetParam().arguments.end());
  const Finished finished = RunProgram(command, Environment(), folder_.path().string());
  EXPECT_EQ(finished.exit_code, 2) << finished.out;
  EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr(GetParam().says));
  EXPECT_TRUE(fs::is_empty(folder_.path())) << "something was left";
}

INSTANTIATE_TEST_SUITE_P(
    Typical, HardwareMistakes,
    testing::Values(
        Mistake{"NoSuchCommand", {"foo"}, "hardware: no command 'foo' (there are: run, "},
        Mistake{"NoAddress",
                {"run", kScenario, "--robot", ""},
                "--robot: must be an address, is empty"},
        Mistake{"NobodyThere",
                {"run", kScenario, "--robot", "127.99.99.99"},
                "`sidestep fci-server` starts a simulated one"},
        Mistake{"AnotherRobot", {"run", "wam_single_pillar"}, "its robot must be the panda"},
        Mistake{"TheFuture",
                {"run", kScenario, "--knowledge", "full_knowledge"},
                "--knowledge: nobody knows the true future on hardware"},
        Mistake{"WherePlannersKnowToGo",
                {"go-to-start", kScenario, "--knowledge", "static"},
                "--knowledge"},
        Mistake{"ResultsOfADryRun",
                {"run", kScenario, "--dry-run", "--json"},
                "--json: is of a run: --dry-run leaves no results"},
        Mistake{"AFolderOfADryRun",
                {"run", kScenario, "--dry-run", "--out", "x"},
                "--out: is of a run: --dry-run leaves no results"},
        Mistake{"NoLatency",
                {"run", kScenario, "--set", "replanning.latency=none"},
                "replanning.latency: planning takes time"}),
    [](const auto& test) { return test.param.name; });

TEST(HardwareHelp, OffersNothingThatIsRefused) {
  const Finished run = RunProgram({SIDESTEP_PROGRAM, "hardware", "run", "--help"});
  EXPECT_THAT(run.out, AllOf(HasSubstr("static, execute_and_update, prediction"),
                             Not(HasSubstr("full_knowledge"))));
  const Finished go = RunProgram({SIDESTEP_PROGRAM, "hardware", "go-to-start", "--help"});
  for (const char* const flag : {"--knowledge", "--predictor", "--speed", "--seed", "--safety"}) {
    EXPECT_THAT(go.out, Not(HasSubstr(flag)));
  }
}

}  // namespace
}  // namespace sidestep::hardware_command_test
