// An episode seen through rendered pictures alone: slow, since software draws them.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "sidestep/hardware/tag_detector.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep {
namespace {

using Json = nlohmann::json;

std::string Slurp(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

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
    return Json::parse(Slurp(folder_.path() / name / "result.json"), nullptr, false);
  }

  const TemporaryFolder folder_;
};

TEST_F(TagImages, ReachesTheGoalOfTheLaboratorysTableTwiceAlike) {
  const Json once = Run("once", {"--set", "seen_by=camera"});
  EXPECT_EQ(once["outcome"], "goal") << once.dump(1);
  Run("again", {"--set", "seen_by=camera"});
  EXPECT_EQ(Slurp(folder_.path() / "once/trace.h5"), Slurp(folder_.path() / "again/trace.h5"));
}

}  // namespace
}  // namespace sidestep
