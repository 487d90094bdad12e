// A planner that avoids what moves passes, and one that only waits for it does not: whole, with
// each of their items.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep {
namespace {

// Of each item by its number, with obstacles from one place each. Everything is slow, so that the
// tool is.
std::map<int, std::string> VerdictsOf(const std::string& planner, int exit_code) {
  const TemporaryFolder folder;
  const Finished finished =
      RunProgram({SIDESTEP_PROGRAM, "validate", planner, "--scenario", "hardware_single_table",
                  "--seeds", "1", "--set", "planner.velocity_scale=0.2", "--out", folder.path()});
  EXPECT_EQ(finished.exit_code, exit_code) << finished.err;
  std::ifstream stream(folder.path() / "validation.json");
  std::map<int, std::string> verdicts;
  for (const auto& item : nlohmann::json::parse(stream)["items"]) {
    verdicts[item["number"]] = item["verdict"];
    std::cout << item["number"] << " " << item["verdict"] << ": " << item["evidence"] << "\n";
  }
  return verdicts;
}

void ExpectSafe(const std::map<int, std::string>& verdicts) {
  for (const int number : {1, 2, 3, 4, 5, 6, 8, 9, 11, 14, 15}) {
    EXPECT_EQ(verdicts.at(number), "pass") << number;
  }
  for (const int number : {13, 16, 17, 19}) EXPECT_EQ(verdicts.at(number), "not run") << number;
}

TEST(ValidationVerdicts, LetGpmpPass) { ExpectSafe(VerdictsOf("gpmp_fast", 0)); }

TEST(ValidationVerdicts, LetAStraightLineFailItsTask) {
  const std::map<int, std::string> verdicts = VerdictsOf("straight_line", 1);
  ExpectSafe(verdicts);
  EXPECT_EQ(verdicts.at(18), "fail");
  EXPECT_EQ(verdicts.at(20), "fail");
}

}  // namespace
}  // namespace sidestep
