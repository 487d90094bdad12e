// The command that says whether a planner may be tried on a robot: a few cases of it, and what
// becomes of a work that is interrupted.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/bytes_of.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::validate_test {
namespace {

using ::testing::HasSubstr;

Finished Validate(const std::string& planner, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(),
                   {SIDESTEP_PROGRAM, "validate", planner, "--scenario", "hardware_single_table"});
  return RunProgram(arguments);
}

TEST(Validate, RunsACaseOfAReportAgainToTheSameBytes) {
  const TemporaryFolder folder;
  for (const std::string out : {"one", "two"}) {
    const Finished finished = Validate(
        "straight_line", {"--only", "envelope:cross:0.25:1", "--out", folder.path() / out});
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_THAT(finished.out, HasSubstr("tool_speed_m_s"));
    EXPECT_THAT(finished.out, ::testing::ContainsRegex("\ncommands_hash +[0-9]+\n"));
  }
  const std::string trace = BytesOf(folder.path() / "one" / "trace.h5");
  EXPECT_GT(trace.size(), 10000u);
  EXPECT_TRUE(trace == BytesOf(folder.path() / "two" / "trace.h5"));
}

TEST(Validate, RunsACaseAtARobotServerOfItsOwn) {
  const TemporaryFolder folder;
  const Finished finished = Validate(
      "straight_line", {"--only", "fault:cross:0.1:user_stop:wire:1", "--out", folder.path()});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  const auto json = nlohmann::json::parse(BytesOf(folder.path() / "result.json"));
  EXPECT_EQ(json["outcome"], "aborted");
  EXPECT_THAT(json["reason"].get<std::string>(), HasSubstr("the user stop is pressed"));
}

TEST(Validate, KeepsWhatWasDoneWhenItIsInterrupted) {
  const TemporaryFolder folder;
  const Finished finished =
      RunProgram({"timeout", "-s", "INT", "6", SIDESTEP_PROGRAM, "validate", "straight_line",
                  "--scenario", "hardware_single_table", "--out", folder.path()});
  EXPECT_THAT(finished.err, HasSubstr("it was stopped by Ctrl-C"));
  const auto json = nlohmann::json::parse(BytesOf(folder.path() / "validation.json"));
  EXPECT_LT(json["episodes"], json["episodes_asked"]);
  EXPECT_NE(json["verdict"], "pass");
  for (const auto& item : json["items"]) {
    EXPECT_NE(item["verdict"], "pass") << item["name"] << ": nothing is settled yet";
  }
  EXPECT_THAT(BytesOf(folder.path() / "validation.md"), HasSubstr("# Validation of straight_line"));
}

}  // namespace
}  // namespace sidestep::validate_test
