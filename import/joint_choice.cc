#include "sidestep/import/joint_choice.h"

#include <algorithm>
#include <set>

#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"

namespace sidestep::import {
namespace {

class Choice {
 public:
  Choice(const UrdfFile& file, const ArmChoices& choices) : file_(file), choices_(choices) {
    for (const std::string& name : file.joint_order) {
      children_[JointOf(name).parent_link_name].push_back(name);
    }
  }

  JointChoice Run() {
    CheckFixed();
    chosen_.base = choices_.base.empty() ? file_.model->getRoot()->name : choices_.base;
    RequireLink("--base", chosen_.base);
    ChooseTip();
    GiveRoles();
    Order(chosen_.base);
    CheckOrder();
    return chosen_;
  }

 private:
  const urdf::Joint& JointOf(const std::string& name) const {
    return *file_.model->joints_.at(name);
  }

  void RequireLink(const std::string& flag, const std::string& link) const {
    if (file_.model->links_.count(link) > 0) return;
    std::vector<std::string> known;
    for (const auto& [name, one] : file_.model->links_) known.push_back(name);
    throw InputError(flag, "there is no link '" + link + "' (there are: " + Joined(known) + ")");
  }

  void CheckFixed() const {
    for (const auto& [name, position] : choices_.fix) {
      const auto found = file_.model->joints_.find(name);
      if (found == file_.model->joints_.end()) {
        throw InputError("--fix", "there is no joint '" + name + "'");
      }
      const urdf::Joint& joint = *found->second;
      if (joint.type == urdf::Joint::FIXED) {
        throw InputError("--fix", "the joint '" + name + "' is fixed anyway");
      }
      const bool limited = joint.type != urdf::Joint::CONTINUOUS && joint.limits != nullptr;
      if (limited && (position < joint.limits->lower || position > joint.limits->upper)) {
        throw InputError(
            "--fix", "'" + name + "' must be from " + ShortestText(joint.limits->lower) + " to " +
                         ShortestText(joint.limits->upper) + ", is " + ShortestText(position));
      }
    }
  }

  // Whether a joint can have a number of its own in a configuration.
  bool CanMove(const urdf::Joint& joint) const {
    return joint.type != urdf::Joint::FIXED && joint.mimic == nullptr &&
           choices_.fix.count(joint.name) == 0;
  }

  // Joints from the base down to a link; none if it is not below.
  std::vector<std::string> PathTo(const std::string& link) const {
    std::vector<std::string> path;
    std::string at = link;
    while (at != chosen_.base) {
      const urdf::JointSharedPtr joint = file_.model->links_.at(at)->parent_joint;
      if (joint == nullptr) return {};
      path.push_back(joint->name);
      at = joint->parent_link_name;
    }
    std::reverse(path.begin(), path.end());
    return path;
  }

  long CountMoving(const std::string& link) const {
    const std::vector<std::string> path = PathTo(link);
    return std::count_if(path.begin(), path.end(),
                         [this](const std::string& name) { return CanMove(JointOf(name)); });
  }

  void CollectLeaves(const std::string& link, std::vector<std::string>* leaves) const {
    const auto below = children_.find(link);
    if (below == children_.end()) {
      leaves->push_back(link);
      return;
    }
    for (const std::string& joint : below->second) {
      CollectLeaves(JointOf(joint).child_link_name, leaves);
    }
  }

  void ChooseTip() {
    std::vector<std::string> leaves;
    CollectLeaves(chosen_.base, &leaves);
    if (!choices_.tip.empty()) {
      RequireLink("--tip", choices_.tip);
      chosen_.tip = choices_.tip;
      if (PathTo(chosen_.tip).empty()) {
        throw InputError("--tip",
                         "the link '" + chosen_.tip + "' is not below '" + chosen_.base + "'");
      }
    } else {
      long most = 0;
      for (const std::string& leaf : leaves) most = std::max(most, CountMoving(leaf));
      std::vector<std::string> best;
      for (const std::string& leaf : leaves) {
        if (CountMoving(leaf) == most) best.push_back(leaf);
      }
      if (most > 0 && best.size() > 1) {
        throw InputError("--tip", "must be given: " + std::to_string(most) +
                                      " joints lead to each of " + Joined(best));
      }
      chosen_.tip = best.front();
    }
    if (CountMoving(chosen_.tip) == 0 && !MovesByMimic()) {
      throw InputError(file_.path,
                       "no joint from '" + chosen_.base + "' to '" + chosen_.tip + "' can move");
    }
    for (const std::string& leaf : leaves) {
      if (leaf != chosen_.tip) chosen_.other_leaves.push_back(leaf);
    }
  }

  bool MovesByMimic() const {
    const std::vector<std::string> path = PathTo(chosen_.tip);
    return std::any_of(path.begin(), path.end(), [this](const std::string& name) {
      return JointOf(name).mimic != nullptr && CanMove(*LeaderOf(JointOf(name)).joint);
    });
  }

  struct Leader {
    const urdf::Joint* joint;
    double multiplier, offset;
  };
  // Through joints that mimic joints that mimic.
  Leader LeaderOf(const urdf::Joint& joint) const {
    Leader leader{&joint, 1, 0};
    while (leader.joint->mimic != nullptr && choices_.fix.count(leader.joint->name) == 0) {
      const urdf::JointMimic& mimic = *leader.joint->mimic;
      leader.offset += leader.multiplier * mimic.offset;
      leader.multiplier *= mimic.multiplier;
      leader.joint = &JointOf(mimic.joint_name);
    }
    return leader;
  }

  void GiveRoles() {
    std::set<std::string> moving;
    for (const std::string& name : PathTo(chosen_.tip)) {
      const urdf::Joint& joint = JointOf(name);
      if (joint.type == urdf::Joint::FIXED) continue;
      const urdf::Joint& leader = *LeaderOf(joint).joint;
      if (CanMove(leader)) moving.insert(leader.name);
    }
    for (const std::string& name : file_.joint_order) {
      const urdf::Joint& joint = JointOf(name);
      JointRole role;
      if (joint.type == urdf::Joint::FIXED) {
        // holds its link where its origin says
      } else if (moving.count(name) > 0) {
        role.kind = JointRole::Kind::kMoves;
      } else {
        const Leader leader = LeaderOf(joint);
        if (moving.count(leader.joint->name) > 0 && leader.multiplier != 0) {
          role = {JointRole::Kind::kMimics, 0, leader.joint->name, leader.multiplier,
                  leader.offset};
        } else {
          const auto held = choices_.fix.find(leader.joint->name);
          const double at = held == choices_.fix.end() ? 0 : held->second;
          role.position = leader.multiplier * at + leader.offset;
        }
      }
      chosen_.roles[name] = role;
    }
  }

  // Whether a joint that others mimic is at or below this one.
  bool HoldsALeader(const std::string& name) const {
    const auto is_led_by = [&name](const auto& one) { return one.second.leader == name; };
    if (std::any_of(chosen_.roles.begin(), chosen_.roles.end(), is_led_by)) return true;
    const auto below = children_.find(JointOf(name).child_link_name);
    return below != children_.end() &&
           std::any_of(below->second.begin(), below->second.end(),
                       [this](const std::string& child) { return HoldsALeader(child); });
  }

  // As MuJoCo orders bodies: each with all that is below it, before the next.
  void Order(const std::string& link) {
    const auto below = children_.find(link);
    if (below == children_.end()) return;
    std::vector<std::string> joints = below->second;
    std::stable_partition(joints.begin(), joints.end(),
                          [this](const std::string& name) { return HoldsALeader(name); });
    for (const std::string& name : joints) {
      chosen_.joints.push_back(name);
      Order(JointOf(name).child_link_name);
    }
  }

  void CheckOrder() const {
    for (auto joint = chosen_.joints.begin(); joint != chosen_.joints.end(); ++joint) {
      const JointRole& role = chosen_.roles.at(*joint);
      if (role.kind != JointRole::Kind::kMimics) continue;
      if (std::find(chosen_.joints.begin(), joint, role.leader) != joint) continue;
      throw InputError(file_.path, file_.LineOf("joint " + *joint), "joint '" + *joint + "': mimic",
                       "'" + role.leader + "', which it mimics, must not be behind it or outside " +
                           "of what is below '" + chosen_.base + "'; hold both by --fix");
    }
  }

  const UrdfFile& file_;
  const ArmChoices& choices_;
  std::map<std::string, std::vector<std::string>> children_;  // joints by their parent link
  JointChoice chosen_;
};

}  // namespace

JointChoice ChooseJoints(const UrdfFile& file, const ArmChoices& choices) {
  return Choice(file, choices).Run();
}

}  // namespace sidestep::import
