#include "sidestep/bench/run_identity.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "sidestep/core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::bench::run_identity_test {
namespace {

namespace fs = std::filesystem;

class RunIdentityTest : public ::testing::Test {
 protected:
  RunIdentityTest() {
    for (const char* const model : {"panda", "hsr", "wam"}) {
      fs::copy(fs::path(SIDESTEP_SOURCE_DIR "/models") / model, models_ / model,
               fs::copy_options::recursive);
    }
  }
  void Append(const std::string& file, const std::string& text) const {
    std::ofstream(models_ / file, std::ios::app) << text;
  }
  RunIdentity Now(const scenarios::Settings& settings = {}) const {
    return IdentifyRun(scenarios::ParseScenario(text_, "hsr_walkway.yaml", settings),
                       models_.string(), "b");
  }

  const TemporaryFolder folder_;
  const fs::path models_ = folder_.path();
  std::string text_ =
      scenarios::ToYaml(scenarios::LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/hsr_walkway.yaml"));
};

TEST_F(RunIdentityTest, StaysWhereOnlyACommentOfTheScenarioChanges) {
  const RunIdentity before = Now();
  text_ = "# another comment\n" + text_;
  EXPECT_EQ(RunId(Now()), RunId(before));
}

TEST_F(RunIdentityTest, ChangesWithEveryValueOfTheScenario) {
  EXPECT_NE(Now({{"planner.qc", "1.0000001"}}).scenario, Now().scenario);
  EXPECT_NE(Now({{"seed", "2"}}).scenario, Now().scenario);
  EXPECT_EQ(Now({{"seed", "2"}}).models, Now().models);
}

TEST_F(RunIdentityTest, ChangesWithEveryFileOfTheRobotAndOfWhatIsDrawn) {
  for (const char* const file :
       {"panda/robot.yaml", "panda/panda.xml", "hsr/hsr.xml", "panda/new"}) {
    const RunIdentity before = Now();
    Append(file, "\n");
    EXPECT_NE(Now().models, before.models) << file;
    EXPECT_EQ(Now().scenario, before.scenario);
    EXPECT_NE(RunId(Now()), RunId(before));
  }
}

TEST_F(RunIdentityTest, DoesNotAskForRobotsThatAreNotThere) {
  const RunIdentity before = Now();
  Append("wam/robot.yaml", "\n");
  EXPECT_EQ(Now().models, before.models);
}

TEST_F(RunIdentityTest, ChangesWithTheBuildAndTheMethod) {
  RunIdentity other = Now();
  other.build = "c";
  EXPECT_NE(RunId(other), RunId(Now()));
  other = Now();
  other.method = "search 40";
  EXPECT_NE(RunId(other), RunId(Now()));
}

TEST_F(RunIdentityTest, OfAModelThatIsGoneIsAnError) {
  fs::remove_all(models_ / "panda");
  EXPECT_THROW(Now(), InputError);
}

}  // namespace
}  // namespace sidestep::bench::run_identity_test
