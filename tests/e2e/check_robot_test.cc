// `sidestep check-robot`, as a person runs it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::check_robot_test {
namespace {

using ::testing::HasSubstr;

Finished Check(std::vector<std::string> arguments) {
  std::vector<std::string> words = {SIDESTEP_PROGRAM, "check-robot"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return RunProgram(words);
}

nlohmann::json Report(const std::string& path) {
  std::ifstream stream(path);
  return nlohmann::json::parse(stream);
}

TEST(CheckRobot, TellsWhatSticksOutAndExitsWithOneWhereThatIsTooMuch) {
  const TemporaryFolder folder;
  const std::string json = (folder.path() / "r.json").string();
  const Finished covered =
      Check({"panda:covered", "--cover-mm", "5", "--json", json, "--configurations", "500"});
  EXPECT_EQ(covered.exit_code, 0) << covered.err;
  EXPECT_THAT(covered.out, HasSubstr("none of them touches itself"));
  const nlohmann::json report = Report(json);
  EXPECT_LE(report["uncovered_m"], 0.005);
  EXPECT_LE(report["frames"]["apart_m"], 1e-12);
  EXPECT_EQ(report["links"].size(), 8u);
  for (const auto& pair : report["self_contact"]["pairs"]) {
    EXPECT_TRUE(pair["touched"] == 0 || pair["in_self_collision"] == true) << pair;
  }
  const Finished bare = Check({"panda", "--cover-mm", "5", "--configurations", "1"});
  EXPECT_EQ(bare.exit_code, 1);
  EXPECT_THAT(bare.err, HasSubstr("check-robot: more than 5 mm sticks out"));
}

TEST(CheckRobot, CoversARobotAnewAndTheVariantCanBeChecked) {
  const TemporaryFolder folder;
  const std::string rail = SIDESTEP_SOURCE_DIR "/examples/robot/pointer";
  const std::string file = (folder.path() / "round.yaml").string();
  const Finished made =
      Check({rail, "--cover-mm", "40", "--write-cover", file, "--configurations", "10"});
  EXPECT_EQ(made.exit_code, 0) << made.err;
  const Finished again = Check({file, "--cover-mm", "40", "--configurations", "10"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(Check({file, "--cover-mm", "20", "--configurations", "10"}).exit_code, 1);
}

TEST(CheckRobot, DrawsSolidsAndSpheres) {
  const TemporaryFolder folder;
  const Finished drawn = Check({"wam", "--out", folder.path().string(), "--configurations", "1"});
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_GT(std::filesystem::file_size(folder.path() / "spheres.png"), 20000u);
}

TEST(CheckRobot, RefusesWhatMakesNoSense) {
  const struct {
    std::vector<std::string> arguments;
    std::string complaint;
  } cases[] = {
      {{"pandas"}, "holds no robot 'pandas'"},
      {{"panda:gone"}, "holds no variant 'panda:gone' (known: panda:covered)"},
      {{"models/gone.yaml"}, "models/gone.yaml: "},
      {{"panda", "--spheres", "5"}, "--spheres: is for --write-cover"},
      {{"panda", "--write-cover", "x.yaml"}, "--write-cover: needs --cover-mm, --spheres, or both"},
      {{"panda", "--write-cover", "x.yaml", "--cover-mm", "0"}, "--cover-mm: must be > 0"},
      {{"panda", "--write-cover", "x.yaml", "--spheres", "7"},
       "--spheres: must be at least one a link with solids: 8"},
      {{"panda", "--cover-mm", "nan"}, "must be a number"}};
  for (const auto& [arguments, complaint] : cases) {
    const Finished refused = Check(arguments);
    EXPECT_EQ(refused.exit_code, 2) << complaint;
    EXPECT_THAT(refused.err, HasSubstr(complaint));
  }
}

}  // namespace
}  // namespace sidestep::check_robot_test
