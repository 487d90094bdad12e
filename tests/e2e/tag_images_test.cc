// An episode seen through rendered pictures alone: slow, since software draws them.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sidestep/hardware/tag_detector.h"
#include "tests/support/bytes_of.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep {
namespace {

using Json = nlohmann::json;

class TagImages : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!hardware::CanFindTags()) GTEST_SKIP() << "built without libapriltag and OpenCV";
  }

  Json Run(const std::string& name, const std::vector<std::string>& options) const {
    std::vector<std::string> command = {SIDESTEP_PROGRAM, "run", "hardware_single_table", "--out",
                                        (folder_.path() / name).string()};
    command.insert(command.end(), options.begin(), options.end());
    const Finished finished = RunProgram(command);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return Json::parse(BytesOf(folder_.path() / name / "result.json"), nullptr, false);
  }

  const TemporaryFolder folder_;
};

TEST_F(TagImages, ReachesTheGoalOfTheLaboratorysTableTwiceAlike) {
  const Json once = Run("once", {"--set", "seen_by=camera"});
  EXPECT_EQ(once["outcome"], "goal") << once.dump(1);
  Run("again", {"--set", "seen_by=camera"});
  EXPECT_EQ(BytesOf(folder_.path() / "once/trace.h5"), BytesOf(folder_.path() / "again/trace.h5"));
}

}  // namespace
}  // namespace sidestep
