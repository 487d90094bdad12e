#include "sidestep/sim/robot_agreement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "sidestep/core/input_error.h"
#include "sidestep/sim/arm_file.h"
#include "sidestep/sim/simulation.h"
#include "tests/sim/two_link.h"
#include "tests/support/bytes_of.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::sim::robot_agreement_test {
namespace {

namespace fs = std::filesystem;

const std::string kBadModels = SIDESTEP_SOURCE_DIR "/tests/data/bad_models/";

// What follows `label` on the next line.
std::string NextLine(std::istream& stream, const std::string& label) {
  std::string line;
  if (!std::getline(stream, line) || line.rfind(label, 0) != 0) {
    throw std::runtime_error("expected '" + label + "'");
  }
  return line.substr(label.size());
}

// The two-link robot in a folder of its own, with parts of its files replaced.
class AlteredTwoLink {
 public:
  AlteredTwoLink() {
    fs::copy(kTestModels + "/two_link", models_ / "two_link", fs::copy_options::recursive);
  }

  void Replace(const std::string& file, const std::string& old_text, const std::string& new_text) {
    const std::string path = (models_ / "two_link" / file).string();
    std::string text = BytesOf(path);
    const std::size_t at = text.find(old_text);
    ASSERT_NE(at, std::string::npos) << file << " has no " << old_text;
    text.replace(at, old_text.size(), new_text);
    std::ofstream(path) << text;
  }

  // Why no world can be made with it, without the folder; empty if it can.
  std::string Message(const scenarios::Scenario& scenario) const {
    try {
      const robot::RobotModel robot =
          robot::RobotModel::Load(models_.string(), "two_link", scenario.X_WB);
      const Simulation simulation(scenario, robot, models_.string());
      return "";
    } catch (const InputError& error) {
      std::string message = error.what();
      const std::string folder = (models_ / "two_link").string() + "/";
      for (std::size_t at; (at = message.find(folder)) != std::string::npos;) {
        message.erase(at, folder.size());
      }
      return message;
    }
  }

 private:
  TemporaryFolder folder_;
  fs::path models_ = folder_.path();
};

std::vector<std::string> BadModels() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kBadModels)) {
    names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class BadModel : public ::testing::TestWithParam<std::string> {};

// Each file says first what is expected and then, three lines a change, what makes the two-link
// robot of tests/sim/models bad.
TEST_P(BadModel, IsRefusedAsItsFirstLineExpects) {
  AlteredTwoLink robot;
  std::ifstream stream(kBadModels + GetParam() + ".txt");
  const std::string expected = NextLine(stream, "# expect: ");
  do {
    const std::string file = NextLine(stream, "file: ");
    const std::string old_text = NextLine(stream, "old: ");
    ASSERT_NO_FATAL_FAILURE(robot.Replace(file, old_text, NextLine(stream, "new: ")));
  } while (stream.peek() != std::ifstream::traits_type::eof());
  scenarios::Scenario scenario = TwoLinkScenario();
  EXPECT_EQ(robot.Message(scenario), expected);
  // Wherever it stands, and whatever it stands on.
  scenario.X_WB = Pose::FromRollPitchYaw({0.3, -0.2, 1}, {0.4, -2, 0.6});
  scenario.static_obstacles = {{"table", Pose::Translation({3, 0, 0.2}), Box{{0.8, 1.2, 0.4}}}};
  scenario.mount = "table";
  EXPECT_EQ(robot.Message(scenario), expected);
}

INSTANTIATE_TEST_SUITE_P(Data, BadModel, ::testing::ValuesIn(BadModels()),
                         [](const auto& test) { return test.param; });

TEST(RobotAgreement, ForgivesWhatFourDigitsLeave) {
  AlteredTwoLink robot;
  robot.Replace("robot.yaml", "alpha_rad: 1.5707963267948966", "alpha_rad: 1.5708");
  robot.Replace("two_link.xml", "range=\"-3 3\"", "range=\"-2.99995 3.00005\"");
  robot.Replace("two_link.xml", "pos=\"0.6 0 0\" euler=\"1.5707963267948966 0 0\"",
                "pos=\"0.60005 0 0\" euler=\"1.5708 0 0\"");
  EXPECT_EQ(robot.Message(TwoLinkScenario()), "");
}

TEST(RobotAgreement, HoldsForEveryRobotThatIsShipped) {
  for (const std::string models :
       {SIDESTEP_SOURCE_DIR "/models", SIDESTEP_SOURCE_DIR "/examples/robot"}) {
    for (const std::string& name : robot::RobotModel::ListNames(models)) {
      const robot::RobotModel robot = robot::RobotModel::Load(models, name, Pose());
      const std::string mjcf = models + "/" + name + "/" + name + ".xml";
      EXPECT_NO_THROW(CheckAgreement(robot, *LoadArmFile(mjcf), mjcf)) << name;
    }
  }
}

}  // namespace
}  // namespace sidestep::sim::robot_agreement_test
