// Scenarios that once ended a run without a result. Each file of tests/data/hard_scenarios begins
// with the outcome that it must have, and a part of the reason if there is one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sidestep/record/recording_file.h"
#include "tests/support/bytes_of.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::hard_scenario_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

const fs::path kSource = SIDESTEP_SOURCE_DIR;
const fs::path kScenarios = kSource / "tests/data/hard_scenarios";

std::vector<std::string> ScenarioNames() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kScenarios)) names.push_back(entry.path().stem());
  std::sort(names.begin(), names.end());
  return names;
}

// "# expect: OUTCOME" or "# expect: OUTCOME: PART OF THE REASON".
struct Expected {
  std::string outcome, reason;
};

Expected ExpectedOf(const fs::path& scenario) {
  const std::string key = "# expect: ", text = BytesOf(scenario);
  const std::string line = text.substr(0, text.find('\n'));
  EXPECT_EQ(line.substr(0, key.size()), key) << scenario;
  const std::string expected = line.substr(key.size());
  const std::size_t colon = expected.find(": ");
  if (colon == std::string::npos) return {expected, ""};
  return {expected.substr(0, colon), expected.substr(colon + 2)};
}

class HardScenario : public ::testing::TestWithParam<std::string> {
 protected:
  // The shipped robots, and those that only tests have.
  void SetUp() override {
    fs::create_directories(data_ / "scenarios");
    fs::create_directories(data_ / "models");
    for (const fs::path& models : {kSource / "models", kSource / "tests/sim/models"}) {
      for (const auto& entry : fs::directory_iterator(models)) {
        if (!entry.is_directory()) continue;
        fs::create_directory_symlink(entry.path(), data_ / "models" / entry.path().filename());
      }
    }
  }

  Finished Sidestep(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), SIDESTEP_PROGRAM);
    return RunProgram(arguments, {"SIDESTEP_DATA_DIR=" + data_.string()}, temporary_.path());
  }

  const TemporaryFolder temporary_;
  const fs::path data_ = temporary_.path() / "data", out_ = temporary_.path() / "out";
  const fs::path scenario_ = kScenarios / (GetParam() + ".yaml");
  const Expected expected_ = ExpectedOf(scenario_);
  const bool is_aborted_ = expected_.outcome == "aborted";
};

TEST_P(HardScenario, EndsWithItsOutcomeReasonAndTrace) {
  const Finished finished = Sidestep({"run", scenario_.string(), "--out", out_.string()});
  EXPECT_EQ(finished.exit_code, is_aborted_ ? 1 : 0);
  if (is_aborted_) {
    EXPECT_THAT(finished.err, ::testing::StartsWith("sidestep: the episode was aborted: "));
    EXPECT_THAT(finished.err, HasSubstr(expected_.reason));
    EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1);
  } else {
    EXPECT_EQ(finished.err, "");
  }

  const auto result = nlohmann::json::parse(BytesOf(out_ / "result.json"));
  std::string told = expected_.outcome;
  if (!result["touched"].is_null()) {
    told += (is_aborted_ ? ", touched " : " with ") + result["touched"].get<std::string>();
  }
  EXPECT_EQ(result["touched"].is_null(), result["first_contact_s"].is_null());
  EXPECT_THAT(finished.out, HasSubstr("outcome          " + told + "\n"));
  const record::Recording recording = record::ReadRecording(out_ / "trace.h5");
  EXPECT_EQ(result["outcome"], expected_.outcome);
  EXPECT_EQ(recording.header.at("outcome"), expected_.outcome);
  EXPECT_FALSE(recording.control.empty());
  EXPECT_FALSE(recording.truth.empty());
  if (expected_.reason.empty()) {
    EXPECT_TRUE(result["reason"].is_null());
    EXPECT_EQ(recording.header.count("reason"), 0u);
  } else {
    EXPECT_THAT(result["reason"].get<std::string>(), HasSubstr(expected_.reason));
    EXPECT_EQ(recording.header.at("reason"), result["reason"]);
  }
  if (expected_.outcome == "collision") {
    EXPECT_TRUE(result["first_contact_s"].is_number());
  }
}

TEST_P(HardScenario, IsComparedLikeAnyOther) {
  Sidestep({"run", scenario_.string(), "--out", out_.string()});
  const Finished finished = Sidestep({"compare", out_.string()});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_EQ(std::count(finished.out.begin(), finished.out.end(), '\n'), 3);
}

TEST_P(HardScenario, IsARowOfAStudy) {
  const Finished finished =
      Sidestep({"study", scenario_.string(), "--knowledge", "prediction", "--out", out_.string()});
  EXPECT_EQ(finished.exit_code, is_aborted_ ? 1 : 0) << finished.err;
  const std::string csv = BytesOf(out_ / "results.csv");
  EXPECT_THAT(csv, HasSubstr("," + expected_.outcome + ","));
  EXPECT_THAT(csv, HasSubstr(expected_.reason));
}

INSTANTIATE_TEST_SUITE_P(Files, HardScenario, ::testing::ValuesIn(ScenarioNames()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace sidestep::hard_scenario_test
