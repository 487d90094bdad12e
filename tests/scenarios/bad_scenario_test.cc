#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "sidestep/bench/scenario_planner.h"
#include "sidestep/core/input_error.h"
#include "sidestep/scenarios/scenario.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::scenarios::bad_scenario_test {
namespace {

namespace fs = std::filesystem;

// Every scenario of tests/data/bad_scenarios: its first line is "# expect: " and the exact message,
// in which @FOLDER@ stands for that folder.
std::vector<std::string> BadScenarios() {
  std::vector<std::string> names;
  for (const auto& entry :
       fs::directory_iterator(SIDESTEP_SOURCE_DIR "/tests/data/bad_scenarios")) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string MessageOf(const std::string& path) {
  try {
    Scenario scenario = LoadScenario(path);
    if (!scenario.robot.empty()) bench::ResolvePlanner(scenario);
  } catch (const InputError& error) {
    return error.what();
  }
  return "was accepted";
}

class BadScenario : public ::testing::TestWithParam<std::string> {};

TEST_P(BadScenario, IsRefusedAsItsFirstLineExpects) {
  const std::string folder = SIDESTEP_SOURCE_DIR "/tests/data/bad_scenarios/";
  std::ifstream stream(folder + GetParam() + ".yaml");
  std::string expected;
  ASSERT_TRUE(std::getline(stream, expected));
  ASSERT_EQ(expected.rfind("# expect: ", 0), 0u) << "the first line must say what is expected";
  const std::string mark = "@FOLDER@";
  const std::size_t place = expected.find(mark);
  if (place != std::string::npos) expected.replace(place, mark.size(), folder);
  EXPECT_EQ(MessageOf(folder + GetParam() + ".yaml"), folder + expected.substr(10));
}

INSTANTIATE_TEST_SUITE_P(Data, BadScenario, ::testing::ValuesIn(BadScenarios()),
                         [](const auto& test) { return test.param; });

TEST(BadScenarioFile, AMissingOneIsNamed) {
  EXPECT_EQ(MessageOf("/nowhere/scene.yaml"), "/nowhere/scene.yaml: no such file");
}

TEST(BadScenarioFile, AFolderIsNotAFile) {
  EXPECT_EQ(MessageOf("/"), "/: is a directory, not a file");
}

class ScratchFile : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text) {
    const fs::path path = folder_.path() / name;
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }

 private:
  const TemporaryFolder folder_;
};

TEST_F(ScratchFile, AnEmptyOneIsRefused) {
  const std::string path = Write("sidestep_empty.yaml", "");
  EXPECT_EQ(MessageOf(path), path + ":1: is empty");
}

TEST_F(ScratchFile, AHundredMegabytesAreRefusedUnread) {
  const std::string path = Write("sidestep_large.yaml", "");
  fs::resize_file(path, 100'000'000);  // a hole: takes no room on the disk
  EXPECT_EQ(MessageOf(path), path + ": is 100000000 bytes long, must be at most 1048576");
}

TEST_F(ScratchFile, BinaryIsRefusedAtItsLine) {
  const std::string path = Write("sidestep_binary.yaml", std::string("a: 1\nb: \x7f"
                                                                     "ELF\x01\x02",
                                                                     14));
  EXPECT_EQ(MessageOf(path), path + ":2: is not a text file (byte 1)");
}

}  // namespace
}  // namespace sidestep::scenarios::bad_scenario_test
