#include "sidestep/import/joint_choice.h"

#include <algorithm>
#include <set>

#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"

namespace sidestep::imports {
namespace {

class JointChooser {
 public:
  JointChooser(const robot::RobotTree& tree, const ArmChoices& choices)
      : tree_(tree), choices_(choices) {
    for (const robot::TreeJoint& joint : tree.joints) {
      children_[joint.parent].push_back(joint.name);
    }
  }

  JointChoice Run() {
    CheckFixed();
    chosen_.base = choices_.base.empty() ? tree_.root : choices_.base;
    RequireLink("--base", chosen_.base);
    ChooseTip();
    GiveRoles();
    Order(chosen_.base);
    CheckOrder();
    return chosen_;
  }

 private:
  const robot::TreeJoint& JointOf(const std::string& name) const { return *tree_.FindJoint(name); }

  void RequireLink(const std::string& flag, const std::string& link) const {
    if (tree_.FindLink(link) != nullptr) return;
    std::vector<std::string> known;
    for (const robot::TreeLink& one : tree_.links) known.push_back(one.link.name);
    throw InputError(flag, "there is no link '" + link + "' (there are: " + Joined(known) + ")");
  }

  void CheckFixed() const {
    for (const auto& [name, position] : choices_.fix) {
      const robot::TreeJoint* const joint = tree_.FindJoint(name);
      if (joint == nullptr) throw InputError("--fix", "there is no joint '" + name + "'");
      if (joint->kind == robot::JointKind::kFixed) {
        throw InputError("--fix", "the joint '" + name + "' is fixed anyway");
      }
      if (position < joint->q_min || position > joint->q_max) {
        throw InputError("--fix", "'" + name + "' must be from " + ShortestText(joint->q_min) +
                                      " to " + ShortestText(joint->q_max) + ", is " +
                                      ShortestText(position));
      }
    }
  }

  // Whether a joint can have a number of its own in a configuration.
  bool CanMove(const robot::TreeJoint& joint) const {
    return joint.kind != robot::JointKind::kFixed && !joint.mimic &&
           choices_.fix.count(joint.name) == 0;
  }

  // Joints from the base down to a link; none if it is not below.
  std::vector<std::string> PathTo(const std::string& link) const {
    std::vector<std::string> path;
    std::string at = link;
    while (at != chosen_.base) {
      const robot::TreeJoint* const joint = tree_.JointUnder(at);
      if (joint == nullptr) return {};
      path.push_back(joint->name);
      at = joint->parent;
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
      CollectLeaves(JointOf(joint).child, leaves);
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
      throw InputError(tree_.file,
                       "no joint from '" + chosen_.base + "' to '" + chosen_.tip + "' can move");
    }
    for (const std::string& leaf : leaves) {
      if (leaf != chosen_.tip) chosen_.other_leaves.push_back(leaf);
    }
  }

  bool MovesByMimic() const {
    const std::vector<std::string> path = PathTo(chosen_.tip);
    return std::any_of(path.begin(), path.end(), [this](const std::string& name) {
      return JointOf(name).mimic && CanMove(*LeaderOf(JointOf(name)).joint);
    });
  }

  struct Leader {
    const robot::TreeJoint* joint;
    double multiplier, offset;
  };
  // Through joints that mimic joints that mimic.
  Leader LeaderOf(const robot::TreeJoint& joint) const {
    Leader leader{&joint, 1, 0};
    while (leader.joint->mimic && choices_.fix.count(leader.joint->name) == 0) {
      const robot::TreeMimic& mimic = *leader.joint->mimic;
      leader.offset += leader.multiplier * mimic.offset;
      leader.multiplier *= mimic.multiplier;
      leader.joint = &JointOf(mimic.joint);
    }
    return leader;
  }

  void GiveRoles() {
    std::set<std::string> moving;
    for (const std::string& name : PathTo(chosen_.tip)) {
      const robot::TreeJoint& joint = JointOf(name);
      if (joint.kind == robot::JointKind::kFixed) continue;
      const robot::TreeJoint& leader = *LeaderOf(joint).joint;
      if (CanMove(leader)) moving.insert(leader.name);
    }
    for (const robot::TreeJoint& joint : tree_.joints) {
      const std::string& name = joint.name;
      JointRole role;
      if (joint.kind == robot::JointKind::kFixed) {
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
    const auto below = children_.find(JointOf(name).child);
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
      Order(JointOf(name).child);
    }
  }

  void CheckOrder() const {
    for (auto joint = chosen_.joints.begin(); joint != chosen_.joints.end(); ++joint) {
      const JointRole& role = chosen_.roles.at(*joint);
      if (role.kind != JointRole::Kind::kMimics) continue;
      if (std::find(chosen_.joints.begin(), joint, role.leader) != joint) continue;
      throw InputError(tree_.file, JointOf(*joint).line, "joint '" + *joint + "': mimic",
                       "'" + role.leader + "', which it mimics, must not be behind it or outside " +
                           "of what is below '" + chosen_.base + "'; hold both by --fix");
    }
  }

  const robot::RobotTree& tree_;
  const ArmChoices& choices_;
  std::map<std::string, std::vector<std::string>> children_;  // joints by their parent link
  JointChoice chosen_;
};

}  // namespace

JointChoice ChooseJoints(const robot::RobotTree& tree, const ArmChoices& choices) {
  return JointChooser(tree, choices).Run();
}

}  // namespace sidestep::imports
