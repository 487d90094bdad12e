#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "sidestep/core/input_error.h"
#include "sidestep/robot/robot_model.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::robot::bad_robot_test {
namespace {

namespace fs = std::filesystem;

const std::string kBadRobots = SIDESTEP_SOURCE_DIR "/tests/data/bad_robots/";

// Every file of tests/data/bad_robots: its first line is "# expect: " and the exact message.
std::vector<std::string> BadRobots() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kBadRobots)) {
    names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class BadRobot : public ::testing::TestWithParam<std::string> {};

TEST_P(BadRobot, IsRefusedAsItsFirstLineExpects) {
  const std::string path = kBadRobots + GetParam() + ".yaml";
  std::ifstream stream(path);
  std::string expected;
  ASSERT_TRUE(std::getline(stream, expected));
  ASSERT_EQ(expected.rfind("# expect: ", 0), 0u) << "the first line must say what is expected";
  try {
    RobotModel::FromFile(path, Pose());
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), kBadRobots + expected.substr(10));
  }
}

INSTANTIATE_TEST_SUITE_P(Data, BadRobot, ::testing::ValuesIn(BadRobots()),
                         [](const auto& test) { return test.param; });

// Folders of models made for one test.
class ModelsFolder : public ::testing::Test {
 protected:
  ModelsFolder() { fs::create_directories(folder_ / "arm"); }

  std::string MessageOf(const std::string& name) const {
    try {
      RobotModel::Load(folder_.string(), name, Pose());
    } catch (const InputError& error) {
      return error.what();
    }
    return "was accepted";
  }

  const TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(ModelsFolder, NamesTheRobotsThereAreWhenOneIsMissing) {
  for (const std::string robot : {"wam", "panda"}) {
    fs::create_directories(folder_ / robot);
    std::ofstream(folder_ / robot / "robot.yaml") << "name: " << robot;
  }
  EXPECT_EQ(MessageOf("arm"), folder_.string() + ": holds no robot 'arm' (known: panda, wam)");
  EXPECT_EQ(MessageOf("../arm"),
            folder_.string() + ": holds no robot '../arm' (known: panda, wam)");
}

TEST_F(ModelsFolder, MayBeMissingItself) {
  fs::remove_all(folder_);
  EXPECT_EQ(MessageOf("arm"), folder_.string() + ": holds no robot 'arm' (known: none)");
}

TEST_F(ModelsFolder, RefusesARobotFileThatIsAFolder) {
  fs::create_directories(folder_ / "arm" / "robot.yaml");
  EXPECT_EQ(MessageOf("arm"),
            (folder_ / "arm" / "robot.yaml").string() + ": is a directory, not a file");
}

TEST_F(ModelsFolder, RefusesARobotOfAnotherName) {
  fs::copy_file(SIDESTEP_SOURCE_DIR "/models/panda/robot.yaml", folder_ / "arm" / "robot.yaml");
  EXPECT_EQ(MessageOf("arm"),
            (folder_ / "arm" / "robot.yaml").string() + ": name: must be the folder's, is 'panda'");
}

TEST_F(ModelsFolder, RefusesAHugeFile) {
  std::ofstream(folder_ / "arm" / "robot.yaml") << std::string((1 << 20) + 1, '#');
  EXPECT_EQ(MessageOf("arm"), (folder_ / "arm" / "robot.yaml").string() +
                                  ": is 1048577 bytes long, must be at most 1048576");
}

}  // namespace
}  // namespace sidestep::robot::bad_robot_test
