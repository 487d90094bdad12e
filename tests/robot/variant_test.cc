#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "sidestep/core/input_error.h"
#include "sidestep/core/model_name.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/robot/variant_names.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::robot::variant_test {
namespace {

// models/panda/robot.yaml in a folder of its own, and variants beside it.
class Variant : public ::testing::Test {
 protected:
  Variant() {
    std::filesystem::create_directories(folder_);
    std::filesystem::copy_file(SIDESTEP_SOURCE_DIR "/models/panda/robot.yaml",
                               folder_ / "robot.yaml");
  }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  RobotModel Load(const std::string& variant) const {
    return RobotModel::Load(temporary_.path().string(), "panda:" + variant, Pose());
  }
  // Without the folder.
  std::string Complaint(const std::string& text) const {
    Write("bad.yaml", text);
    try {
      Load("bad");
    } catch (const InputError& error) {
      return std::string(error.what()).substr(folder_.string().size() + 1);
    }
    return "";
  }

  const TemporaryFolder temporary_;
  const std::filesystem::path folder_ = temporary_.path() / "panda";
};

TEST_F(Variant, HasItsOwnSpheresAndAllElseOfTheRobot) {
  Write("round.yaml",
        "extends: robot.yaml\n"
        "spheres:\n"
        "  - {link: link0, center_m: [0, 0, 0.1], radius_m: 0.2}\n"
        "  - {link: hand, center_m: [0, 0, 0.05], radius_m: 0.1}\n"
        "mount: {spheres: [0]}\n"
        "self_collision: [{links: [link0, hand]}]\n");
  const RobotModel robot = RobotModel::Load(temporary_.path().string(), "panda", Pose());
  const RobotModel round = Load("round");
  ASSERT_EQ(round.num_spheres(), 2);
  EXPECT_EQ(round.spheres()[0].link, -1);
  EXPECT_EQ(round.mount_spheres(), std::vector<int>{0});
  ASSERT_EQ(round.self_collision().size(), 1u);
  EXPECT_EQ(round.name(), "panda");
  EXPECT_EQ(round.mount_links(), robot.mount_links());
  EXPECT_EQ(round.limits()[3].v_max, robot.limits()[3].v_max);
  // Whoever finds fault with its joints finds them where they are written.
  EXPECT_EQ(round.file(), robot.file());
  EXPECT_EQ(round.LineOf("joints[3].dh"), robot.LineOf("joints[3].dh"));
  EXPECT_EQ(round.LineOf("mount.links"), robot.LineOf("mount.links"));
}

TEST_F(Variant, KeepsTheRobotsPairsIfItNamesNone) {
  Write("bare.yaml",
        "extends: robot.yaml\n"
        "spheres:\n"
        "  - {link: link1, center_m: [0, 0, 0], radius_m: 0.1}\n"
        "  - {link: link2, center_m: [0, 0, 0], radius_m: 0.1}\n"
        "  - {link: link4, center_m: [0, 0, 0], radius_m: 0.1}\n"
        "  - {link: link5, center_m: [0, 0, 0], radius_m: 0.1}\n"
        "  - {link: link6, center_m: [0, 0, 0], radius_m: 0.1}\n"
        "  - {link: hand, center_m: [0, 0, 0], radius_m: 0.1}\n"
        "mount: {spheres: []}\n");
  EXPECT_EQ(Load("bare").self_collision().size(), 7u);
}

TEST_F(Variant, IsRefusedAtItsLineWhereItIsWrong) {
  const std::string spheres =
      "spheres: [{link: hand, center_m: [0, 0, 0], radius_m: 0.1}]\nmount: {spheres: []}\n"
      "self_collision: []\n";
  EXPECT_EQ(Complaint("extends: robot.yaml\n" + spheres), "");
  EXPECT_EQ(Complaint("extends: robot.yaml\n" + spheres + "name: panda\n").substr(0, 16),
            "bad.yaml:5: name");
  EXPECT_EQ(Complaint("extends: robot.yaml\n"), "bad.yaml:1: spheres: is missing");
  EXPECT_EQ(Complaint("extends: robot.yaml\nspheres: []\n"),
            "bad.yaml:2: spheres: must not be empty");
  EXPECT_EQ(Complaint("extends: bad.yaml\n" + spheres),
            "bad.yaml:1: extends: must be a whole robot, is a variant");
  EXPECT_EQ(Complaint("extends: gone.yaml\n" + spheres).substr(0, 10), "gone.yaml:");
  EXPECT_EQ(Complaint("extends: robot.yaml\nmount: {spheres: [1]}\n" + spheres.substr(0, 60)),
            "bad.yaml:2: mount.spheres: must be whole numbers from 0 to 0");
  EXPECT_EQ(Complaint("extends: robot.yaml\n" + spheres.substr(0, 60) +
                      "mount: {spheres: [], links: [link0]}\n")
                .substr(0, 23),
            "bad.yaml:3: mount.links");
}

TEST_F(Variant, ThatIsNotThereIsToldWithThoseThatAre) {
  Write("round.yaml", "extends: robot.yaml\n");
  Write("whole.yaml", "name: panda\n");
  Write("broken.yaml", "extends: [\n");
  EXPECT_EQ(VariantNames(temporary_.path().string() + "/panda"),
            std::vector<std::string>{"panda:round"});
  try {
    Load("gone");
    FAIL() << "was found";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), temporary_.path().string() +
                                "/panda: holds no variant 'panda:gone' (known: panda:round)");
  }
}

TEST(ModelName, IsAFolderAndMaybeAVariant) {
  EXPECT_EQ(ModelFolder("panda"), "panda");
  EXPECT_EQ(ModelVariant("panda"), "");
  EXPECT_EQ(ModelFolder("panda:covered"), "panda");
  EXPECT_EQ(ModelVariant("panda:covered"), "covered");
  EXPECT_EQ(DescriptionFile(""), "robot.yaml");
  EXPECT_EQ(DescriptionFile("covered"), "covered.yaml");
}

}  // namespace
}  // namespace sidestep::robot::variant_test
