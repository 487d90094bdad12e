#include "sidestep/sim/tree_reader.h"

#include <mujoco/mujoco.h>
#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <vector>

#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/text_file.h"
#include "sidestep/sim/geom_solids.h"
#include "sidestep/sim/mjcf_lines.h"
#include "sidestep/sim/mjcf_tags.h"
#include "sidestep/sim/mujoco_model.h"

namespace sidestep::sim {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxModelBytes = 16u << 20;

// Of no use for an arm, and where newer attributes stand most often.
constexpr const char* kLeftOut[] = {"option", "size",   "visual",   "statistic",
                                    "custom", "sensor", "keyframe", "extension"};

constexpr const char* kOtherTie = "left out: an <equality> that is no joint's that mimics another";

// Blanks whole elements of a name, so that lines keep their numbers.
bool Blank(const std::string& name, std::string* xml) {
  bool found = false;
  XmlTag tag;
  for (std::size_t from = 0; FindTag(*xml, name, from, &tag); from = tag.end) {
    XmlTag end = tag;
    if ((*xml)[tag.end - 2] != '/' && !FindTag(*xml, "/" + name, tag.end, &end)) end = tag;
    for (std::size_t i = tag.begin; i < end.end; ++i) {
      if ((*xml)[i] != '\n') (*xml)[i] = ' ';
    }
    found = true;
    tag = end;
  }
  return found;
}

// Folders of files, which MuJoCo looks for where the model is: it gets a text without a place.
void AnchorFolders(const std::string& path, std::string* xml) {
  const std::string folder = fs::absolute(path).parent_path().string();
  XmlTag tag;
  std::string meshes = folder, textures = folder;
  for (std::size_t from = 0; FindTag(*xml, "compiler", from, &tag); from = tag.end) {
    std::string text = xml->substr(tag.begin, tag.end - tag.begin);
    const bool is_closed = text[text.size() - 2] == '/';
    tinyxml2::XMLDocument document;
    std::string alone = text;
    if (!is_closed) alone.insert(alone.size() - 1, "/");
    if (document.Parse(alone.data(), alone.size()) != tinyxml2::XML_SUCCESS) return;
    tinyxml2::XMLElement* const compiler = document.RootElement();
    for (const char* const key : {"meshdir", "texturedir"}) {
      const char* const given = compiler->Attribute(key);
      if (given == nullptr) continue;
      compiler->SetAttribute(key, (fs::path(folder) / given).string().c_str());
      (std::string_view(key) == "meshdir" ? meshes : textures) = compiler->Attribute(key);
    }
    tinyxml2::XMLPrinter printer(nullptr, /*compact=*/true);
    document.Print(&printer);
    std::string anchored = printer.CStr();
    if (!is_closed) anchored.erase(anchored.size() - 2, 1);
    anchored.append(static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n')), '\n');
    xml->replace(tag.begin, text.size(), anchored);
    tag.end = tag.begin + anchored.size();
  }
  if (FindTag(*xml, "mujoco", 0, &tag) && (*xml)[tag.end - 2] != '/') {
    tinyxml2::XMLDocument document;
    tinyxml2::XMLElement* const compiler = document.NewElement("compiler");
    document.InsertEndChild(compiler);
    compiler->SetAttribute("meshdir", meshes.c_str());
    compiler->SetAttribute("texturedir", textures.c_str());
    tinyxml2::XMLPrinter printer(nullptr, /*compact=*/true);
    document.Print(&printer);
    xml->insert(tag.end, printer.CStr());
  }
}

MujocoModelPtr CompileTree(const std::string& xml, const std::string& path) {
  try {
    return LoadMujocoModel(xml, path);
  } catch (const InputError& error) {
    const std::string what = error.what();
    for (const char* const sign :
         {"unrecognized attribute", "unrecognized element", "invalid keyword"}) {
      if (what.find(sign) == std::string::npos) continue;
      throw InputError(what, "it needs a newer MuJoCo than " + MujocoVersion() +
                                 ", or is misspelt; leave it out");
    }
    throw;
  }
}

class Reader {
 public:
  Reader(const mjModel& model, const std::string& path, bool visuals_as_collisions)
      : model_(model), lines_(path), visuals_(visuals_as_collisions) {
    tree_.file = path;
  }

  robot::RobotTree Read() {
    const int root = FindRoot();
    tree_.root = BodyName(root);
    for (int body = root; body < model_.nbody; ++body) {
      if (model_.body_rootid[body] != root) continue;
      if (body != root) {
        AddJoint(body);
      } else if (model_.body_jntnum[body] > 0) {
        CheckRoot(body);
      }
      AddLink(body);
    }
    ReadTies();
    ReadExcludes();
    if (!damped_by_servo_.empty()) {
      tree_.notes.push_back(
          "left out, for the world's own controller damps: the damping of joints with <position> "
          "actuators, " +
          Joined(damped_by_servo_));
    }
    return std::move(tree_);
  }

 private:
  [[noreturn]] void Fail(int body, const std::string& why) const {
    throw InputError(tree_.file, lines_.Find("body", "name", BodyName(body)),
                     "body '" + BodyName(body) + "'", why);
  }
  std::string NameOf(int type, int id) const {
    const char* const name = mj_id2name(&model_, type, id);
    return name == nullptr ? "" : name;
  }
  std::string BodyName(int body) const {
    const std::string name = NameOf(mjOBJ_BODY, body);
    return name.empty() ? "body_" + std::to_string(body) : name;
  }
  std::string JointName(int joint) const {
    const std::string name = NameOf(mjOBJ_JOINT, joint);
    return name.empty() ? "joint_" + std::to_string(joint) : name;
  }

  // The one that holds the most joints; others, a table for instance, are no part of the arm.
  int FindRoot() {
    int root = -1, most = -1;
    std::vector<std::string> others;
    for (int body = 1; body < model_.nbody; ++body) {
      if (model_.body_parentid[body] != 0) continue;
      int joints = 0;
      for (int joint = 0; joint < model_.njnt; ++joint) {
        joints += model_.body_rootid[model_.jnt_bodyid[joint]] == body;
      }
      if (joints > most && root >= 0) others.push_back(BodyName(root));
      if (joints <= most) others.push_back(BodyName(body));
      if (joints <= most) continue;
      most = joints;
      root = body;
    }
    if (root < 0) throw InputError(tree_.file, "holds no body");
    if (!others.empty()) {
      tree_.notes.push_back("left out, for they stand beside the arm: " + Joined(others));
    }
    return root;
  }

  void CheckRoot(int body) {
    const int joint = model_.body_jntadr[body];
    if (model_.jnt_type[joint] == mjJNT_FREE) {
      tree_.notes.push_back("body '" + BodyName(body) + "' floats: it becomes the base");
      return;
    }
    Fail(body, "moves by a joint, so that nothing is the base; put a body around it");
  }

  int JointOf(int body) const {
    return model_.body_jntnum[body] > 0 && model_.jnt_type[model_.body_jntadr[body]] != mjJNT_FREE
               ? model_.body_jntadr[body]
               : -1;
  }
  Eigen::Vector3d AnchorOf(int body) const {
    const int joint = JointOf(body);
    if (joint < 0) return Eigen::Vector3d::Zero();
    return Eigen::Map<const Eigen::Vector3d>(model_.jnt_pos + 3 * joint);
  }
  static Pose PoseAt(const mjtNum* p, const mjtNum* q) {
    return Pose(Eigen::Quaterniond(q[0], q[1], q[2], q[3]), Eigen::Map<const Eigen::Vector3d>(p));
  }

  void AddJoint(int body) {
    if (model_.body_jntnum[body] > 1) Fail(body, "has several joints; give each a body of its own");
    const int parent = model_.body_parentid[body];
    robot::TreeJoint joint;
    joint.parent = BodyName(parent);
    joint.child = BodyName(body);
    joint.X_PJ = Pose::Translation(-AnchorOf(parent)) *
                 PoseAt(model_.body_pos + 3 * body, model_.body_quat + 4 * body) *
                 Pose::Translation(AnchorOf(body));
    const int id = JointOf(body);
    if (id < 0) {
      joint.name = BodyName(body) + "_fixed";
      joint.line = lines_.Find("body", "name", BodyName(body));
      tree_.joints.push_back(joint);
      return;
    }
    if (model_.jnt_type[id] == mjJNT_BALL)
      Fail(body, "turns by a ball joint, which no arm here has");
    joint.name = JointName(id);
    joint.line = lines_.Find("joint", "name", joint.name);
    const bool slides = model_.jnt_type[id] == mjJNT_SLIDE;
    joint.kind = slides ? robot::JointKind::kPrismatic : robot::JointKind::kRevolute;
    joint.axis_J = Eigen::Map<const Eigen::Vector3d>(model_.jnt_axis + 3 * id);
    const double reference = model_.qpos0[model_.jnt_qposadr[id]];
    if (reference != 0) {
      joint.X_PJ = joint.X_PJ * robot::MotionOf(joint.kind, joint.axis_J, -reference);
    }
    if (model_.jnt_limited[id] != 0) {
      joint.q_min = model_.jnt_range[2 * id];
      joint.q_max = model_.jnt_range[2 * id + 1];
    }
    const int dof = model_.jnt_dofadr[id];
    joint.dynamics = {model_.dof_damping[dof], model_.dof_frictionloss[dof],
                      model_.dof_armature[dof]};
    ReadActuators(id, &joint);
    tree_.joints.push_back(joint);
  }

  // How hard it is driven, if that is limited.
  void ReadActuators(int id, robot::TreeJoint* joint) {
    for (int motor = 0; motor < model_.nu; ++motor) {
      if (model_.actuator_trntype[motor] != mjTRN_JOINT) continue;
      if (model_.actuator_trnid[2 * motor] != id) continue;
      const double gear = std::abs(model_.actuator_gear[6 * motor]);
      const auto most = [](const mjtNum* range) {
        return std::max(std::abs(range[0]), std::abs(range[1]));
      };
      double force = joint->torque_max;
      if (model_.actuator_forcelimited[motor] != 0) {
        force = most(model_.actuator_forcerange + 2 * motor) * gear;
      } else if (model_.actuator_ctrllimited[motor] != 0 &&
                 model_.actuator_gaintype[motor] == mjGAIN_FIXED &&
                 model_.actuator_biastype[motor] == mjBIAS_NONE) {
        force = most(model_.actuator_ctrlrange + 2 * motor) * gear *
                std::abs(model_.actuator_gainprm[mjNGAIN * motor]);
      }
      if (force > 0) joint->torque_max = std::min(joint->torque_max, force);
      if (!HasServoWithoutDamping(motor) || joint->dynamics.damping == 0) continue;
      joint->dynamics.damping = 0;
      damped_by_servo_.push_back(joint->name);
    }
  }

  // A servo that turns towards a position and has no damping of its own is given it as the joint's.
  bool HasServoWithoutDamping(int motor) const {
    const mjtNum* const bias = model_.actuator_biasprm + mjNBIAS * motor;
    return model_.actuator_biastype[motor] == mjBIAS_AFFINE && bias[1] < 0 && bias[2] == 0;
  }

  void AddLink(int body) {
    robot::TreeLink link;
    link.line = lines_.Find("body", "name", BodyName(body));
    link.link.name = BodyName(body);
    if (model_.body_mass[body] > 0) {
      const Pose X_LI = PoseAt(model_.body_ipos + 3 * body, model_.body_iquat + 4 * body);
      const Eigen::Matrix3d R = X_LI.rotation().toRotationMatrix();
      const Eigen::Map<const Eigen::Vector3d> moments(model_.body_inertia + 3 * body);
      link.link.inertia =
          robot::LinkInertia{model_.body_mass[body], X_LI.translation() - AnchorOf(body),
                             R * moments.asDiagonal() * R.transpose()};
    }
    bool touches = false;
    for (int i = 0; i < model_.body_geomnum[body]; ++i) {
      touches = touches || IsSolid(model_.body_geomadr[body] + i);
    }
    const bool take_pictures = !touches && visuals_;
    for (int i = 0; i < model_.body_geomnum[body]; ++i) {
      const int geom = model_.body_geomadr[body] + i;
      if (IsSolid(geom) || take_pictures) AddSolid(body, geom, &link.link);
    }
    if (!touches && !visuals_ && model_.body_geomnum[body] > 0) {
      tree_.only_drawn.push_back(BodyName(body));
    }
    tree_.links.push_back(std::move(link));
  }

  bool IsSolid(int geom) const {
    return model_.geom_contype[geom] != 0 || model_.geom_conaffinity[geom] != 0;
  }

  void AddSolid(int body, int geom, robot::ArmLink* link) {
    robot::LinkSolid solid;
    solid.X_LS = Pose::Translation(-AnchorOf(body)) *
                 PoseAt(model_.geom_pos + 3 * geom, model_.geom_quat + 4 * geom);
    if (const std::optional<Shape> shape = ShapeOfGeom(model_, geom)) {
      solid.form = *shape;
    } else if (model_.geom_type[geom] == mjGEOM_MESH) {
      const int mesh = model_.geom_dataid[geom];
      solid.source = NameOf(mjOBJ_MESH, mesh);
      solid.form = robot::HullSolid{
          Eigen::Map<const Eigen::Matrix3Xf>(model_.mesh_vert + 3 * model_.mesh_vertadr[mesh], 3,
                                             model_.mesh_vertnum[mesh])
              .cast<double>(),
          {}};
    } else {
      Fail(body, "has a plane or a height field, which no link can be");
    }
    link->solids.push_back(std::move(solid));
  }

  // A joint that is tied to another by a straight line mimics it.
  void ReadTies() {
    for (int tie = 0; tie < model_.neq; ++tie) {
      if (model_.eq_active[tie] == 0) continue;
      const double* const c = model_.eq_data + mjNEQDATA * tie;
      const bool is_line = model_.eq_type[tie] == mjEQ_JOINT && model_.eq_obj2id[tie] >= 0 &&
                           c[2] == 0 && c[3] == 0 && c[4] == 0;
      robot::TreeJoint* follower = nullptr;
      if (is_line) {
        for (robot::TreeJoint& joint : tree_.joints) {
          if (joint.name == JointName(model_.eq_obj1id[tie])) follower = &joint;
        }
      }
      const std::string leader = is_line ? JointName(model_.eq_obj2id[tie]) : "";
      if (follower == nullptr || follower->mimic || Leads(follower->name, leader)) {
        tree_.notes.emplace_back(kOtherTie);
        continue;
      }
      const double reference1 = model_.qpos0[model_.jnt_qposadr[model_.eq_obj1id[tie]]];
      const double reference2 = model_.qpos0[model_.jnt_qposadr[model_.eq_obj2id[tie]]];
      follower->mimic = {leader, c[1], c[0] + reference1 - c[1] * reference2};
    }
  }

  // Whether a joint is at the end of what another mimics.
  bool Leads(const std::string& joint, std::string from) const {
    while (true) {
      if (from == joint) return true;
      const robot::TreeJoint* const at = tree_.FindJoint(from);
      if (at == nullptr || !at->mimic) return at == nullptr;
      from = at->mimic->joint;
    }
  }

  void ReadExcludes() {
    for (int i = 0; i < model_.nexclude; ++i) {
      const int body1 = (model_.exclude_signature[i] >> 16) - 1;
      const int body2 = (model_.exclude_signature[i] & 0xFFFF) - 1;
      if (tree_.FindLink(BodyName(body1)) == nullptr) continue;
      if (tree_.FindLink(BodyName(body2)) == nullptr) continue;
      tree_.without_contact.emplace_back(BodyName(body1), BodyName(body2));
    }
  }

  const mjModel& model_;
  const MjcfLines lines_;
  const bool visuals_;
  robot::RobotTree tree_;
  std::vector<std::string> damped_by_servo_;  // joints
};

}  // namespace

robot::RobotTree ReadMjcfTree(const std::string& path, bool visuals_as_collisions) {
  std::string xml = ReadTextFile(path, kMaxModelBytes);
  XmlTag tag;
  if (FindTag(xml, "include", 0, &tag)) {
    const auto line =
        std::count(xml.begin(), xml.begin() + static_cast<std::ptrdiff_t>(tag.begin), '\n');
    throw InputError(path, static_cast<int>(line) + 1, "include",
                     "is not taken; import the file of the arm itself");
  }
  std::vector<std::string> left_out;
  for (const char* const name : kLeftOut) {
    if (Blank(name, &xml)) left_out.push_back(name);
  }
  AnchorFolders(path, &xml);
  const MujocoModelPtr model = CompileTree(xml, path);
  robot::RobotTree tree = Reader(*model, path, visuals_as_collisions).Read();
  if (!left_out.empty()) {
    tree.notes.push_back("left out, for the world has its own: <" + Joined(left_out, ">, <") + ">");
  }
  return tree;
}

}  // namespace sidestep::sim
