// Two planners, validated whole: one that avoids what moves, and one that only waits for it, which
// does not do its task.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep {
namespace {

// Of each item by its number, with obstacles from one place each.
std::map<int, std::string> VerdictsOf(const std::string& planner) {
  const TemporaryFolder folder;
  const Finished finished =
      RunProgram({SIDESTEP_PROGRAM, "validate", planner, "--scenario", "hardware_single_table",
                  "--seeds", "1", "--out", folder.path()});
  std::ifstream stream(folder.path() / "validation.json");
  std::map<int, std::string> verdicts;
  const nlohmann::json report = nlohmann::json::parse(stream);
  for (const auto& item : report["items"]) {
    verdicts[item["number"]] = item["verdict"];
    std::cout << item["number"] << " " << item["verdict"] << ": " << item["evidence"] << "\n";
  }
  const bool fails = std::any_of(verdicts.begin(), verdicts.end(),
                                 [](const auto& verdict) { return verdict.second == "fail"; });
  EXPECT_EQ(finished.exit_code, fails ? 1 : 0) << finished.err;
  return verdicts;
}

// Whatever the planner: what the supervisor and the follower see to.
void ExpectWellBehaved(const std::map<int, std::string>& verdicts) {
  for (const int number : {1, 2, 3, 4, 11, 12, 14, 15}) {
    EXPECT_EQ(verdicts.at(number), "pass") << number;
  }
  for (const int number : {13, 16, 17, 19}) EXPECT_EQ(verdicts.at(number), "not run") << number;
}

TEST(ValidationVerdicts, FindThePredictionOfAPlannerThatAvoidsWorthWhile) {
  const std::map<int, std::string> verdicts = VerdictsOf("gpmp_fast");
  ExpectWellBehaved(verdicts);
  EXPECT_EQ(verdicts.at(18), "pass");
}

TEST(ValidationVerdicts, FindAStraightLineOfNoUse) {
  const std::map<int, std::string> verdicts = VerdictsOf("straight_line");
  ExpectWellBehaved(verdicts);
  for (const int number : {5, 6, 9}) EXPECT_EQ(verdicts.at(number), "pass") << number;
  EXPECT_EQ(verdicts.at(18), "fail");
  EXPECT_EQ(verdicts.at(20), "fail");
}

}  // namespace
}  // namespace sidestep
