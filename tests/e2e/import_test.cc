// `sidestep import` of the URDFs of tests/data/urdf, as a person uses it: what it writes is the arm
// that the URDF says, and plans and runs.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>
#include <sys/file.h>
#include <tinyxml2.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/robot/robot_model.h"
#include "tests/support/bytes_of.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::import_test {
namespace {

namespace fs = std::filesystem;
using Eigen::Isometry3d;
using Eigen::Vector3d;
using tinyxml2::XMLElement;

const fs::path kSource = SIDESTEP_SOURCE_DIR;

struct Case {
  const char* name;
  const char* file;  // in tests/data/urdf
  std::vector<std::string> options;
  std::map<std::string, double> held;  // by --fix
  const char* tool;                    // link
  int num_joints;
  const char* goal;  // of the motion from home
};

std::ostream& operator<<(std::ostream& out, const Case& one) { return out << one.name; }

// The forward kinematics of a URDF, from its numbers alone.
class UrdfKinematics {
 public:
  explicit UrdfKinematics(const std::string& path) {
    document_.LoadFile(path.c_str());
    const XMLElement* const root = document_.RootElement();
    for (const XMLElement* joint = root->FirstChildElement("joint"); joint != nullptr;
         joint = joint->NextSiblingElement("joint")) {
      joints_.push_back(joint);
    }
  }

  // Where a link is in the frame of the root, or of `base`.
  Isometry3d PoseOf(const std::string& link, const std::map<std::string, double>& q,
                    const std::string& base) const {
    if (link == base) return Isometry3d::Identity();
    for (const XMLElement* const joint : joints_) {
      if (link != joint->FirstChildElement("child")->Attribute("link")) continue;
      const std::string parent = joint->FirstChildElement("parent")->Attribute("link");
      return PoseOf(parent, q, base) * OriginOf(*joint) * MotionOf(*joint, q);
    }
    return Isometry3d::Identity();
  }

 private:
  static Vector3d Numbers(const XMLElement* element, const char* attribute, Vector3d otherwise) {
    const char* const text = element == nullptr ? nullptr : element->Attribute(attribute);
    if (text == nullptr) return otherwise;
    std::istringstream words(text);
    words >> otherwise.x() >> otherwise.y() >> otherwise.z();
    return otherwise;
  }

  static Isometry3d OriginOf(const XMLElement& joint) {
    const XMLElement* const origin = joint.FirstChildElement("origin");
    const Vector3d rpy = Numbers(origin, "rpy", Vector3d::Zero());
    return Eigen::Translation3d(Numbers(origin, "xyz", Vector3d::Zero())) *
           Eigen::AngleAxisd(rpy.z(), Vector3d::UnitZ()) *
           Eigen::AngleAxisd(rpy.y(), Vector3d::UnitY()) *
           Eigen::AngleAxisd(rpy.x(), Vector3d::UnitX()) * Isometry3d::Identity();
  }

  double PositionOf(const XMLElement& joint, const std::map<std::string, double>& q) const {
    if (const auto found = q.find(joint.Attribute("name")); found != q.end()) return found->second;
    const XMLElement* const mimic = joint.FirstChildElement("mimic");
    if (mimic == nullptr) return 0;
    for (const XMLElement* const leader : joints_) {
      if (std::string(leader->Attribute("name")) != mimic->Attribute("joint")) continue;
      return mimic->DoubleAttribute("multiplier", 1) * PositionOf(*leader, q) +
             mimic->DoubleAttribute("offset", 0);
    }
    return 0;
  }

  Isometry3d MotionOf(const XMLElement& joint, const std::map<std::string, double>& q) const {
    const std::string type = joint.Attribute("type");
    if (type == "fixed") return Isometry3d::Identity();
    const Vector3d axis =
        Numbers(joint.FirstChildElement("axis"), "xyz", Vector3d::UnitX()).normalized();
    const double position = PositionOf(joint, q);
    if (type == "prismatic") return Isometry3d(Eigen::Translation3d(position * axis));
    return Isometry3d(Eigen::AngleAxisd(position, axis));
  }

  tinyxml2::XMLDocument document_;
  std::vector<const XMLElement*> joints_;
};

double Apart(const Isometry3d& a, const Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff();
}

class Import : public ::testing::TestWithParam<Case> {
 protected:
  Import() {
    fs::create_directories(models_);
    fs::create_directories(data_ / "scenarios");
  }

  Finished Sidestep(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), SIDESTEP_PROGRAM);
    return RunProgram(arguments, {"SIDESTEP_DATA_DIR=" + data_.string()});
  }

  std::string Urdf() const { return (kSource / "tests/data/urdf" / GetParam().file).string(); }

  void ImportIt() {
    std::vector<std::string> arguments = {"import",     Urdf(), "--out", (models_ / "arm").string(),
                                          "--cover-mm", "30"};  // finer covers take longer
    arguments.insert(arguments.end(), GetParam().options.begin(), GetParam().options.end());
    const Finished finished = Sidestep(arguments);
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
  }

  const TemporaryFolder folder_;
  const fs::path data_ = folder_.path(), models_ = data_ / "models";
};

TEST_P(Import, WritesTheKinematicsOfTheUrdf) {
  ASSERT_NO_FATAL_FAILURE(ImportIt());
  const robot::RobotModel robot = robot::RobotModel::Load(models_.string(), "arm", Pose());
  EXPECT_EQ(robot.num_joints(), GetParam().num_joints);
  const std::string mjcf = (models_ / "arm/arm.xml").string();
  char error[1000] = "";
  const std::unique_ptr<mjModel, decltype(&mj_deleteModel)> model(
      mj_loadXML(mjcf.c_str(), nullptr, error, sizeof error), &mj_deleteModel);
  ASSERT_NE(model, nullptr) << error;
  const std::unique_ptr<mjData, decltype(&mj_deleteData)> data(mj_makeData(model.get()),
                                                               &mj_deleteData);
  const UrdfKinematics urdf(Urdf());
  const std::string base = robot.base() == "world_link" ? "world" : robot.base();
  RandomStream random(1, "q");
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::VectorXd q(robot.num_joints());
    std::map<std::string, double> named = GetParam().held;
    for (int i = 0; i < q.size(); ++i) {
      q(i) = random.Uniform(-2, 2);
      named[robot.joint_names()[static_cast<std::size_t>(i)]] = q(i);
    }
    const std::vector<Pose> links = robot.ComputeLinkPoses(q);
    for (const robot::Joint& joint : robot.joints()) {
      const int id = mj_name2id(model.get(), mjOBJ_JOINT, joint.name.c_str());
      if (id < 0) continue;
      data->qpos[model->jnt_qposadr[id]] = joint.multiplier * q(joint.coordinate) + joint.offset;
    }
    mj_kinematics(model.get(), data.get());
    for (std::size_t i = 0; i < links.size(); ++i) {
      const std::string& link = robot.joints()[i].link;
      const Isometry3d truth = urdf.PoseOf(link, named, base);
      Isometry3d in_yaml = Isometry3d::Identity(), in_mjcf = in_yaml;
      in_yaml.linear() = links[i].rotation().toRotationMatrix();
      in_yaml.translation() = links[i].translation();
      const int body = mj_name2id(model.get(), mjOBJ_BODY, link.c_str());
      ASSERT_GE(body, 0) << link;
      in_mjcf.linear() =
          Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data->xmat + 9 * body);
      in_mjcf.translation() = Eigen::Map<const Vector3d>(data->xpos + 3 * body);
      EXPECT_LT(Apart(in_yaml, truth), 1e-9) << link;
      EXPECT_LT(Apart(in_mjcf, truth), 1e-9) << link;
    }
    Isometry3d tool = Isometry3d::Identity();
    tool.linear() = robot.ComputeToolPose(q).rotation().toRotationMatrix();
    tool.translation() = robot.ComputeToolPose(q).translation();
    EXPECT_LT(Apart(tool, urdf.PoseOf(GetParam().tool, named, base)), 1e-9);
  }
}

// A ball rolls by, at a height and distance at which these arms reach.
TEST_P(Import, WritesARobotThatMovesAmongMovingThings) {
  ASSERT_NO_FATAL_FAILURE(ImportIt());
  const std::string scenario = (data_ / "scenarios/passing_ball.yaml").string();
  std::ofstream(scenario) << R"(
description: An imported arm moves while a ball passes
robot: {model: arm, base: {position_m: [0, 0, 0]}}
task: {start: home, goal: )"
                          << GetParam().goal << R"(}
horizon: {duration_s: 3.0, step_s: 0.1}
workspace: {first_center_m: [-1.2, -1.2, 0.02], cell_m: 0.04, cells: [60, 60, 40]}
floor_m: 0
moving_obstacles:
  - name: ball
    shape: {sphere: {radius_m: 0.1}}
    motion:
      linear: {start_m: [0.9, -1, 0.5], direction: [0, 1, 0], speed_m_s: 0.5}
planner: {name: gpmp, epsilon_m: 0.1, sigma_obs: 0.05, n_int: 1}
knowledge: prediction
predictor: kalman_cv
replanning: {rate_hz: 10, latency_s: 0.1}
sensor: {name: occupancy, rate_hz: 30}
seed: 1
)";
  const fs::path out = data_ / "out";
  const Finished finished = Sidestep({"run", scenario, "--out", out.string()});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const auto result = nlohmann::json::parse(BytesOf(out / "result.json"));
  EXPECT_EQ(result["outcome"], "goal") << finished.out;
  const bool is_drawn = GetParam().name == std::string("SevenAxisOfMeshes");
  if (!is_drawn) return;
  const std::string still = (out / "still.png").string();
  const Finished drawn = Sidestep(
      {"render", (out / "trace.h5").string(), "--still", still, "--at", "1", "--size", "320x240"});
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
}

INSTANTIATE_TEST_SUITE_P(
    Urdfs, Import,
    ::testing::Values(
        Case{"SixAxis", "six_axis.urdf", {}, {}, "wrist_3", 6, "[0.8, -0.7, 0.9, 0.3, 0.5, 0]"},
        Case{"SevenAxisOfMeshes",
             "arm_parts/urdf/seven_axis.urdf",
             {},
             {},
             "ee",
             7,
             "[0.8, 0.6, 0, 0.8, 0, -0.5, 0]"},
        Case{"SlidingJoints", "slider.urdf", {}, {}, "quill", 4, "[0.3, 0.6, -0.8, 0.05]"},
        Case{"MimicGripper",
             "mimic_gripper.urdf",
             {},
             {},
             "left_finger",
             7,
             "[0.8, -0.7, 0.9, 0.3, 0.5, 0, 0.03]"},
        Case{"HeldGripper",
             "mimic_gripper.urdf",
             {"--tip", "grasp", "--fix", "left_finger_joint=0.02"},
             {{"left_finger_joint", 0.02}},
             "grasp",
             6,
             "[0.8, -0.7, 0.9, 0.3, 0.5, 0]"},
        Case{"OneOfTwoArms",
             "branch.urdf",
             {"--tip", "left_hand"},
             {},
             "left_hand",
             3,
             "[-1, 0.6, -0.8]"},
        Case{"FixedChains",
             "fixed_chains.urdf",
             {},
             {},
             "tool_tip",
             6,
             "[0.8, -0.7, 0.9, 0.3, 0.5, 0]"},
        Case{"XacroOutput",
             "xacro_output.urdf",
             {"--cylinders-as-capsules", "--ramp-s", "0.3"},
             {},
             "lab_wrist_3",
             6,
             "[0.8, -0.7, 0.9, 0.3, 0.5, 0]"}),
    [](const auto& test) { return std::string(test.param.name); });

struct DeleteModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using ModelPtr = std::unique_ptr<mjModel, DeleteModel>;
using DataPtr = std::unique_ptr<mjData, DeleteModel>;

const fs::path kClasses = kSource / "tests/data/mjcf/classes_and_meshes.xml";

class ImportMjcf : public ::testing::Test {
 protected:
  Finished Sidestep(const fs::path& file, const std::vector<std::string>& options) const {
    std::vector<std::string> command = {SIDESTEP_PROGRAM, "import", file.string(), "--out",
                                        (folder_.path() / "arm").string()};
    command.insert(command.end(), options.begin(), options.end());
    return RunProgram(command);
  }
  // The test's model with a text replaced, in a folder of its own.
  fs::path Altered(const std::string& old_text, const std::string& new_text) const {
    fs::copy(kClasses.parent_path() / "assets", folder_.path() / "assets");
    std::string text = BytesOf(kClasses);
    text.replace(text.find(old_text), old_text.size(), new_text);
    std::ofstream(folder_.path() / "model.xml") << text;
    return folder_.path() / "model.xml";
  }
  const TemporaryFolder folder_;
};

// Links stand where the model's bodies do, those that a joint moves at its anchor.
TEST_F(ImportMjcf, KeepsTheKinematicsOfTheModel) {
  const Finished finished =
      Sidestep(kClasses, {"--tip", "tcp", "--velocity", "2", "--cover-mm", "30"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, testing::HasSubstr("left out, for they stand beside the arm: table"));
  EXPECT_THAT(finished.out, testing::HasSubstr("<option>, <statistic>, <keyframe>"));
  const robot::RobotModel robot = robot::RobotModel::Load(folder_.path().string(), "arm", Pose());
  ASSERT_EQ(robot.joint_names(), (std::vector<std::string>{"turn", "lift", "bend", "roll"}));
  EXPECT_EQ(robot.limits()[0].torque_max, 87);
  EXPECT_EQ(robot.limits()[3].torque_max, 12);

  // What this MuJoCo reads of it: without the option it does not know.
  const std::string text = BytesOf(Altered("integrator=\"implicitfast\"", ""));
  char error[1000] = "";
  const ModelPtr model(
      mj_loadXML((folder_.path() / "model.xml").c_str(), nullptr, error, sizeof error));
  ASSERT_NE(model, nullptr) << error;
  const DataPtr data(mj_makeData(model.get()));
  RandomStream random(1, "q");
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::VectorXd q(4);
    for (int i = 0; i < 4; ++i) {
      q(i) = random.Uniform(-2, 2);
      const int id = mj_name2id(model.get(), mjOBJ_JOINT,
                                robot.joint_names()[static_cast<std::size_t>(i)].c_str());
      data->qpos[model->jnt_qposadr[id]] = q(i);
    }
    mj_kinematics(model.get(), data.get());
    const int base = mj_name2id(model.get(), mjOBJ_BODY, "base");
    const Vector3d p_WB = Eigen::Map<const Vector3d>(data->xpos + 3 * base);
    const std::vector<Pose> links = robot.ComputeLinkPoses(q);
    for (std::size_t i = 0; i < links.size(); ++i) {
      const int body = mj_name2id(model.get(), mjOBJ_BODY, robot.joints()[i].link.c_str());
      ASSERT_GE(body, 0);
      Vector3d p = Eigen::Map<const Vector3d>(data->xpos + 3 * body);
      if (model->body_jntnum[body] > 0) {
        p = Eigen::Map<const Vector3d>(data->xanchor + 3 * model->body_jntadr[body]);
      }
      EXPECT_LT((links[i].translation() - (p - p_WB)).norm(), 1e-9) << robot.joints()[i].link;
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(data->xmat + 9 * body);
      EXPECT_LT((links[i].rotation().toRotationMatrix() - R).norm(), 1e-9)
          << robot.joints()[i].link;
    }
  }
}

TEST_F(ImportMjcf, LeavesTheDampingOfAServoToTheWorldsController) {
  const Finished finished = Sidestep(Altered("<general class=\"arm\" name=\"a1\" joint=\"turn\"/>",
                                             "<position kp=\"3500\" joint=\"turn\"/>"),
                                     {"--tip", "tcp", "--velocity", "2", "--cover-mm", "30"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, testing::HasSubstr("joints with <position> actuators, turn\n"));
  char error[1000] = "";
  const ModelPtr model(
      mj_loadXML((folder_.path() / "arm/arm.xml").c_str(), nullptr, error, sizeof error));
  ASSERT_NE(model, nullptr) << error;
  const auto damping = [&](const char* joint) {
    return model->dof_damping[model->jnt_dofadr[mj_name2id(model.get(), mjOBJ_JOINT, joint)]];
  };
  EXPECT_EQ(damping("turn"), 0);
  EXPECT_EQ(damping("lift"), 1);
}

TEST_F(ImportMjcf, KeepsAFingerThatMimicsAnother) {
  const Finished finished =
      Sidestep(kClasses, {"--tip", "left_finger", "--velocity", "2", "--cover-mm", "30"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const robot::RobotModel robot = robot::RobotModel::Load(folder_.path().string(), "arm", Pose());
  EXPECT_EQ(robot.num_joints(), 5);
}

TEST_F(ImportMjcf, MakesNoMoreSpheresThanItMay) {
  const Finished finished =
      Sidestep(kClasses, {"--tip", "tcp", "--velocity", "2", "--spheres", "20"});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const robot::RobotModel robot = robot::RobotModel::Load(folder_.path().string(), "arm", Pose());
  EXPECT_LE(robot.num_spheres(), 20);
  EXPECT_THAT(Sidestep(kClasses, {"--tip", "tcp", "--velocity", "2", "--spheres", "5"}).err,
              testing::HasSubstr("--out: "));  // it is there
}

TEST_F(ImportMjcf, IsRefusedWhileAnotherCommandWritesThere) {
  const std::string out = (folder_.path() / "arm").string();
  fs::create_directories(out);
  const int other = open(out.c_str(), O_RDONLY | O_DIRECTORY);
  ASSERT_EQ(flock(other, LOCK_EX), 0);
  const Finished finished = Sidestep(kClasses, {"--tip", "tcp", "--velocity", "2"});
  close(other);
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_THAT(finished.err, testing::HasSubstr("another command is writing here just now"));
  EXPECT_TRUE(fs::is_empty(out));
}

TEST_F(ImportMjcf, SaysWhatNeedsANewerMujoco) {
  const Finished finished =
      Sidestep(Altered("<body name=\"upper\"", "<body gravcomp=\"1\" name=\"upper\""),
               {"--tip", "tcp", "--velocity", "2"});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_THAT(finished.err, testing::HasSubstr("model.xml:42: body: "));
  EXPECT_THAT(finished.err, testing::HasSubstr("gravcomp"));
  EXPECT_THAT(finished.err, testing::HasSubstr("it needs a newer MuJoCo than 2.2.2"));
}

TEST_F(ImportMjcf, RefusesWhatIsNoArm) {
  const Finished finished =
      Sidestep(Altered("<joint name=\"bend\"", "<joint name=\"more\"/><joint name=\"bend\""),
               {"--tip", "tcp", "--velocity", "2"});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_THAT(finished.err, testing::HasSubstr("model.xml:46: body 'lower': has several joints"));
}

}  // namespace
}  // namespace sidestep::import_test
