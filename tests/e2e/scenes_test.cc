// Robots and scenes of a person's own, from the command line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "sidestep/record/recording_file.h"
#include "tests/support/bytes_of.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::scenes_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

const std::string kSource = SIDESTEP_SOURCE_DIR;
const std::string kMoveIt = kSource + "/tests/data/moveit/";

Finished Sidestep(std::vector<std::string> arguments, const std::string& folder = "") {
  arguments.insert(arguments.begin(), SIDESTEP_PROGRAM);
  return RunProgram(arguments, {}, folder);
}

class Scenes : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(Path(name)) << text;
    return Path(name);
  }
  void Good(const std::vector<std::string>& arguments) {
    last_ = Sidestep(arguments, folder_.path());
    EXPECT_EQ(last_.exit_code, 0) << last_.err;
  }
  void Bad(const std::vector<std::string>& arguments, const std::string& says) {
    last_ = Sidestep(arguments, folder_.path());
    EXPECT_EQ(last_.exit_code, 2);
    EXPECT_EQ(std::count(last_.err.begin(), last_.err.end(), '\n'), 1) << last_.err;
    EXPECT_THAT(last_.err, HasSubstr(says));
  }
  nlohmann::json Result(const std::string& folder) const {
    return nlohmann::json::parse(BytesOf(Path(folder + "/result.json")));
  }

  const TemporaryFolder folder_;
  Finished last_;
};

struct Robot {
  const char* name;
  const char* models;  // from the source's folder; empty: shipped
};
void PrintTo(const Robot& robot, std::ostream* out) { *out << robot.name; }

class NewScenario : public Scenes, public ::testing::WithParamInterface<Robot> {};

TEST_P(NewScenario, RunsAsItIs) {
  std::vector<std::string> models;
  if (GetParam().models[0] != '\0') models = {"--models", kSource + GetParam().models};
  std::vector<std::string> write = {"new-scenario", "--robot", GetParam().name, "--out",
                                    "mine.yaml"};
  write.insert(write.end(), models.begin(), models.end());
  Good(write);
  EXPECT_EQ(last_.out, "written mine.yaml\n");
  const std::string text = BytesOf(Path("mine.yaml"));
  EXPECT_THAT(text, StartsWith("# Made by `sidestep new-scenario --robot "));
  EXPECT_THAT(text, HasSubstr("sidestep run mine.yaml"));
  std::vector<std::string> run = {"run", "mine.yaml", "--out", "out"};
  run.insert(run.end(), models.begin(), models.end());
  Good(run);
  const nlohmann::json result = Result("out");
  EXPECT_EQ(result["robot"], GetParam().name);
  EXPECT_EQ(result["outcome"], "goal") << last_.out;
  // What it is about: who does not see the ball coming runs into it, or has to be lucky.
  EXPECT_LT(result["min_clearance_m"].get<double>(), 1);
}

INSTANTIATE_TEST_SUITE_P(Known, NewScenario,
                         ::testing::Values(Robot{"panda", ""}, Robot{"wam", ""},
                                           Robot{"panda_rail", "/examples/robot"},
                                           Robot{"pointer", "/examples/robot"}),
                         [](const auto& test) { return test.param.name; });

TEST_F(Scenes, NewOnesArePrintedAndDifferByTheirSeed) {
  Good({"new-scenario", "--robot", "panda"});
  const std::string first = last_.out;
  Good({"new-scenario", "--robot", "panda"});
  EXPECT_EQ(last_.out, first);
  Good({"new-scenario", "--robot", "panda", "--seed", "2"});
  EXPECT_NE(last_.out, first);
  Bad({"new-scenario", "--robot", "pandora"}, "--robot: must be one of panda, wam (of ");
  Write("mine.yaml", "precious");
  Bad({"new-scenario", "--robot", "panda", "--out", "mine.yaml"}, "'mine.yaml' is there already");
  EXPECT_EQ(BytesOf(Path("mine.yaml")), "precious");
}

TEST_F(Scenes, ARobotMayBeTheOnesOfAnyFolder) {
  fs::copy(kSource + "/examples/robot", Path("robots"), fs::copy_options::recursive);
  Good({"new-scenario", "--robot", "robots/pointer", "--out", "robots/mine.yaml"});
  EXPECT_THAT(BytesOf(Path("robots/mine.yaml")), HasSubstr("model: \"./pointer\""));
  Good({"run", "robots/mine.yaml", "--out", "by_path"});
  const nlohmann::json by_path = Result("by_path");
  EXPECT_EQ(by_path["robot"], "pointer");

  std::string text = BytesOf(Path("robots/mine.yaml"));
  text.replace(text.find("./pointer"), 9, "pointer");
  Write("named.yaml", text);
  Bad({"run", "named.yaml"}, "named.yaml:");
  EXPECT_THAT(last_.err, HasSubstr("robot.model: must be one of panda, wam (of "));
  Good({"run", "named.yaml", "--models", "robots", "--out", "by_name"});
  const nlohmann::json by_name = Result("by_name");
  EXPECT_EQ(by_name["identity"]["models"], by_path["identity"]["models"]);
  Bad({"run", "named.yaml", "--models", "nowhere"}, "--models: 'nowhere' is no folder");
  fs::create_directory(Path("empty"));
  Bad({"run", "named.yaml", "--models", "empty"},
      "--models: 'empty' holds no robot (NAME/robot.yaml)");

  // What a run is known by has the robot's files in it; its trace is drawn without them.
  std::ofstream(Path("robots/pointer/robot.yaml"), std::ios::app) << "# changed\n";
  Good({"run", "named.yaml", "--models", "robots", "--out", "changed"});
  EXPECT_NE(Result("changed")["identity"]["models"], by_name["identity"]["models"]);
  fs::remove_all(Path("robots"));
  Good({"render", "by_path/trace.h5", "--still", "frame.png", "--at", "0.5"});
  Good({"compare", "by_path", "by_name"});
  Bad({"run", "named.yaml", "--set", "robot.model=./gone"},
      "robot.model: there is no gone/robot.yaml");
}

TEST_F(Scenes, RobotsAreListedWithTheirFolders) {
  Good({"list", "robots", "--models", kSource + "/examples/robot"});
  EXPECT_THAT(last_.out, HasSubstr(kSource + "/examples/robot/pointer\n"));
  EXPECT_THAT(last_.out, HasSubstr("/models/panda\n"));
  Good({"list", "robots", "--names"});
  EXPECT_EQ(last_.out, "panda\npanda:covered\nwam\n");
  // Of two with one name the first one counts.
  fs::copy(kSource + "/models/panda", Path("panda"), fs::copy_options::recursive);
  Good({"list", "robots", "--models", folder_.path()});
  EXPECT_THAT(last_.out, HasSubstr(Path("panda") + "\n"));
  EXPECT_THAT(last_.out, Not(HasSubstr("/models/panda\n")));
}

TEST_F(Scenes, OfMoveItBecomeScenarios) {
  Good({"import-scene", kMoveIt + "scene.yaml", "--request", kMoveIt + "request.yaml", "--robot",
        "panda", "--out", "problem.yaml"});
  EXPECT_EQ(last_.out, "written problem.yaml: 3 things\n");
  EXPECT_THAT(last_.err, HasSubstr("left out: "));
  EXPECT_THAT(last_.err, HasSubstr("'panda_finger_joint1' = 0.065 is no joint of panda\n"));
  EXPECT_THAT(BytesOf(Path("problem.yaml")), HasSubstr("# Left out: "));
  Good({"run", "problem.yaml", "--out", "out"});
  EXPECT_EQ(Result("out")["outcome"], "goal");
}

TEST_F(Scenes, OfMuJoCoBecomeScenarios) {
  const std::string world = Write(
      "kitchen.xml",
      "<mujoco><asset><mesh name='m' vertex='0 0 0 0.3 0 0 0 0.2 0 0 0 0.2'/></asset><worldbody>"
      "<geom type='plane' size='1 1 1'/>"
      "<body name='counter' pos='0 0 0.2' euler='0 0 10'><geom type='box' size='0.4 0.6 "
      "0.2'/></body>"
      "<body name='lamp' pos='0.6 0.5 1' euler='30 0 0'><geom type='capsule' size='0.05 "
      "0.1'/></body>"
      "<geom name='wedge' type='mesh' mesh='m' pos='0.8 -0.5 0.3' euler='0 0 45'/>"
      "<body name='door'><joint/><geom type='box' size='1 1 1'/></body></worldbody></mujoco>");
  Good(
      {"import-scene", world, "--robot", "panda", "--base", "-0.1,0,0.4", "--out", "kitchen.yaml"});
  EXPECT_THAT(last_.err, HasSubstr("changed: 'wedge': the convex hull of its mesh\n"));
  EXPECT_THAT(last_.err, HasSubstr("left out: " + world + ": body 'door': it moves"));
  const std::string text = BytesOf(Path("kitchen.yaml"));
  EXPECT_THAT(text, HasSubstr("mount: \"counter\""));
  EXPECT_THAT(text, HasSubstr("convex_mesh"));
  Good({"run", "kitchen.yaml", "--out", "out"});
  EXPECT_THAT(Result("out")["outcome"].get<std::string>(), Not(HasSubstr("collision")));
  Good({"render", "out/trace.h5", "--still", "frame.png", "--at", "0.5"});
}

TEST_F(Scenes, ThatAreUnusableEndTheCommand) {
  const std::string robot = "panda";
  const auto import = [&](const std::string& file, std::vector<std::string> more = {}) {
    more.insert(more.begin(), {"import-scene", file, "--robot", robot, "--out", "mine.yaml"});
    return more;
  };
  Bad(import("nowhere.yaml"), "nowhere.yaml: no such file");
  Bad(import("nowhere.xml"), "nowhere.xml: no such file");
  Bad(import(Write("a.yaml", "world: {collision_objects: [{id: a, primitives: [{type: box}]}]}\n")),
      "a.yaml:1: world.collision_objects[0].primitives[0].dimensions: is missing");
  // The arm stands in it.
  Bad(import(Write(
          "b.yaml",
          "world: {collision_objects: [{id: a, primitives: [{type: sphere, dimensions: [2]}]}]}")),
      "b.yaml: no start and goal were found");
  Bad(import(
          Write("c.yaml",
                "world: {collision_objects: [{id: a, primitives: [{type: box, dimensions: [1, 1, "
                "1]}], primitive_poses: [{position: [0.5, 0, 0.8]}]}]}"),
          {"--request", kMoveIt + "request.yaml"}),
      "request.yaml:3: task.start: the robot's sphere ");
  EXPECT_FALSE(fs::exists(Path("mine.yaml")));
  Bad(import(Path("c.yaml"), {"--leave-out", "b"}), "--leave-out: the scene has no 'b'");
  Good(import(Path("c.yaml"), {"--request", kMoveIt + "request.yaml", "--leave-out", "a"}));
  EXPECT_THAT(last_.err, HasSubstr("left out: 'a', as asked for\n"));
}

}  // namespace
}  // namespace sidestep::scenes_test
