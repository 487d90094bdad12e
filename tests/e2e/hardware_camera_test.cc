// The laboratory's table as a robot at the end of a wire does it, seen by a camera alone: adapter,
// protocol, simulated server, and the pictures of the server's own world, arm and all. Slow, since
// software draws them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "sidestep/hardware/tag_detector.h"
#include "sidestep/record/questions.h"
#include "sidestep/record/recording_file.h"
#include "tests/hardware/own_loopback.h"
#include "tests/support/bytes_of.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep {
namespace {

constexpr double kToolSpeed_m_s = 0.5;
constexpr const char* kCrossing =
    "{linear: {start_m: [0.4, 1.75, 0.45], direction: [0, -1, 0], speed_m_s: 0.25}}";

// What the box does.
struct Course {
  std::string name;
  std::string motion;
};
std::ostream& operator<<(std::ostream& stream, const Course& course) {
  return stream << course.name;
}

struct Ran {
  nlohmann::json result;    ///< of who drove
  record::Recording truth;  ///< of the server
  std::string bytes;        ///< of the trace of who drove
};

class HardwareCamera : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!hardware::CanFindTags()) GTEST_SKIP() << "built without libapriltag and OpenCV";
  }

  std::vector<std::string> Command(const std::vector<std::string>& words, const std::string& out,
                                   const std::string& motion) const {
    std::vector<std::string> command = {SIDESTEP_PROGRAM};
    command.insert(command.end(), words.begin(), words.end());
    for (const std::string& word : {std::string("--set"), std::string("seen_by=camera"),
                                    std::string("--out"), (folder_.path() / out).string()}) {
      command.push_back(word);
    }
    if (!motion.empty()) {
      command.insert(command.end(), {"--set", "moving_obstacles[0].motion=" + motion});
    }
    return command;
  }

  // The driver is not told where the box goes.
  Ran Run(const std::string& name, const std::string& motion) const {
    Running server(Command({"fci-server", "--address", hardware::OwnLoopback(), "--scenario",
                            "hardware_single_table", "--once", "--grace", "600"},
                           name + "/server", motion));
    EXPECT_TRUE(server.Prints("with a camera; Ctrl-C ends it"));
    const Finished run =
        RunProgram(Command({"hardware", "run", "hardware_single_table", "--robot",
                            hardware::OwnLoopback(), "--clock", "lockstep", "--camera", "server"},
                           name + "/run", ""),
                   {"XDG_STATE_HOME=" + (folder_.path() / "state").string()});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(server.Finish().exit_code, 0);
    return {nlohmann::json::parse(BytesOf(folder_.path() / name / "run/result.json")),
            record::ReadRecording(folder_.path() / name / "server/trace.h5"),
            BytesOf(folder_.path() / name / "run/trace.h5")};
  }

  const TemporaryFolder folder_;
};

double FastestTool_m_s(const record::Recording& recording) {
  double fastest_m_s = 0;
  for (std::size_t i = 1; i < recording.p_WTool.size(); ++i) {
    const double dt_s = (recording.control[i].t - recording.control[i - 1].t).seconds();
    fastest_m_s =
        std::max(fastest_m_s, (recording.p_WTool[i] - recording.p_WTool[i - 1]).norm() / dt_s);
  }
  return fastest_m_s;
}

class HardwareCameraSees : public HardwareCamera, public ::testing::WithParamInterface<Course> {};

TEST_P(HardwareCameraSees, ABoxAndReachesTheGoalWithoutContactOrAbort) {
  const Ran ran = Run("once", GetParam().motion);
  ASSERT_TRUE(ran.result["time_to_goal_s"].is_number()) << ran.result.dump(1);
  const double goal_s = ran.result["time_to_goal_s"];
  const auto least = record::LeastClearance(ran.truth, EpisodeTime(goal_s));
  ASSERT_TRUE(least);
  const double fastest_m_s = FastestTool_m_s(ran.truth);
  std::cout << GetParam().name << ": goal at " << goal_s << " s, least clearance "
            << 1e3 * least->clearance_m << " mm, tool at most " << fastest_m_s << " m/s\n";
  EXPECT_EQ(ran.result["outcome"], "unjudged");
  // The box goes on, and may run into an arm that rests at its goal, once nobody looks any more.
  EXPECT_FALSE(record::FirstTouch(ran.truth, EpisodeTime(goal_s + 0.5)));
  EXPECT_LE(fastest_m_s, kToolSpeed_m_s);
  for (const auto& event : ran.result["safety_events"]) {
    EXPECT_THAT(event["reaction"], ::testing::AnyOf("slow", "ease", "hold", "none"))
        << event.dump();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Box, HardwareCameraSees,
    ::testing::Values(
        Course{"Crosses10cmPerS",
               "{linear: {start_m: [0.4, 1.0, 0.45], direction: [0, -1, 0], speed_m_s: 0.1}}"},
        Course{"Crosses20cmPerS",
               "{linear: {start_m: [0.4, 1.6, 0.45], direction: [0, -1, 0], speed_m_s: 0.2}}"},
        Course{"Crosses25cmPerS", kCrossing},
        Course{"Stops",
               "{linear: {start_m: [0.4, 1.65, 0.45], direction: [0, -1, 0], speed_m_s: 0.25, "
               "stop_at_s: 3.8}}"},
        Course{"Reverses",
               "{waypoints: {points: [{position_m: [0.4, 1.65, 0.45]}, {position_m: [0.4, 0.7, "
               "0.45]}, {position_m: [0.4, 1.65, 0.45]}], speed_m_s: 0.25}}"},
        Course{"TurnsBy90Degrees",
               "{waypoints: {points: [{position_m: [0.4, 1.65, 0.45]}, {position_m: [0.4, 0.7, "
               "0.45]}, {position_m: [1.4, 0.7, 0.45]}], speed_m_s: 0.25}}"}),
    [](const auto& test) { return test.param.name; });

TEST_F(HardwareCamera, DoesItAgainToTheBit) {
  const Ran once = Run("once", kCrossing), again = Run("again", kCrossing);
  EXPECT_GT(once.bytes.size(), 10000u);
  EXPECT_TRUE(once.bytes == again.bytes);
}

}  // namespace
}  // namespace sidestep
