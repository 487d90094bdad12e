#include "sidestep/render/trace_model.h"

#include <algorithm>
#include <cmath>

#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"
#include "sidestep/core/trajectory.h"
#include "sidestep/render/timeline.h"
#include "sidestep/sim/foreign_model.h"
#include "sidestep/sim/tied_joints.h"

namespace sidestep::render {
namespace {

Eigen::Vector3d ToVector(const mjtNum* values) { return {values[0], values[1], values[2]}; }

// A picture begins and ends so far from the camera, and MuJoCo draws none if it begins nowhere.
void CheckView(const mjModel& model, const std::string& name) {
  const auto near_m = static_cast<float>(model.stat.extent * model.vis.map.znear);
  const auto far_m = static_cast<float>(model.stat.extent * model.vis.map.zfar);
  if (near_m >= 1e-6F && near_m < far_m && std::isfinite(far_m)) return;
  throw InputError(name, "a picture of it would reach from " + ShortestText(near_m) + " to " +
                             ShortestText(far_m) +
                             " m (statistic extent times map znear, zfar): needs 0 < near < far");
}

bool IsInSubtree(const mjModel& model, int body, int root) {
  while (body > root) body = model.body_parentid[body];
  return body == root;
}

}  // namespace

TraceModel::TraceModel(const record::Recording& recording, const std::string& name)
    : recording_(recording), name_(name) {
  if (recording.control.empty()) throw InputError(name, "holds no motion, so nothing to draw");
  if (recording.joints.empty()) throw InputError(name, "names no joints, so nothing to draw");
  if (recording.model_xml.empty()) throw InputError(name, "holds no model, so nothing to draw");
  model_ = sim::LoadForeignModel(recording.model_xml, name + ": model_xml");
  CheckView(*model_, name + ": model_xml");
  data_ = sim::MakeMujocoData(*model_);
  int last_joint = 0;
  for (const std::string& joint : recording.joints) {
    const int id = mj_name2id(model_.get(), mjOBJ_JOINT, joint.c_str());
    if (id < 0) throw InputError(name, "its model has no joint '" + joint + "'");
    if (model_->jnt_type[id] != mjJNT_HINGE && model_->jnt_type[id] != mjJNT_SLIDE) {
      throw InputError(name, "its joint '" + joint + "' is neither a hinge nor a slider");
    }
    joint_addresses_.push_back(model_->jnt_qposadr[id]);
    last_joint = id;
  }
  for (const std::string& obstacle : recording.obstacles) {
    const int body = mj_name2id(model_.get(), mjOBJ_BODY, obstacle.c_str());
    if (body < 0 || model_->body_mocapid[body] < 0) {
      throw InputError(name, "its model has no mocap body '" + obstacle + "'");
    }
    obstacle_bodies_.push_back(body);
  }
  for (const ControlSample& sample : recording.control) {
    if (!sample.q.allFinite()) throw InputError(name, "holds a joint position that is not finite");
  }
  tip_body_ = model_->jnt_bodyid[last_joint];
  robot_root_ = model_->body_rootid[tip_body_];
  FindTip();
  RecordTrail();
  MoveTo(EpisodeTime(0));
}

// The last site beyond the last joint; without one, the body at the end of the chain, where a
// gripper's fingers branch off at the latest.
void TraceModel::FindTip() {
  const int wrist = tip_body_;
  for (int site = 0; site < model_->nsite; ++site) {
    if (IsInSubtree(*model_, model_->site_bodyid[site], wrist)) tip_site_ = site;
  }
  for (int body = wrist + 1; body < model_->nbody; ++body) {
    if (model_->body_parentid[body] != tip_body_) continue;
    const int* const parents = model_->body_parentid;
    if (std::count(parents, parents + model_->nbody, tip_body_) > 1) break;
    tip_body_ = body;
  }
}

void TraceModel::RecordTrail() {
  const double end_s = recording_.control.back().t.seconds();
  const double begin_s = recording_.control.front().t.seconds();
  const auto count = static_cast<Eigen::Index>(std::floor((end_s - begin_s) / kTrailStep_s)) + 1;
  trail_.resize(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    SetJoints(JointsAt(recording_, EpisodeTime(begin_s + kTrailStep_s * static_cast<double>(i))));
    mj_kinematics(model_.get(), data_.get());
    trail_.col(i) = TipPosition();
  }
}

void TraceModel::SetJoints(const Eigen::VectorXd& q) {
  for (std::size_t i = 0; i < joint_addresses_.size(); ++i) {
    data_->qpos[joint_addresses_[i]] = q(static_cast<Eigen::Index>(i));
  }
  sim::FollowLeaders(*model_, data_.get());
}

Eigen::Vector3d TraceModel::TipPosition() const {
  return ToVector(tip_site_ >= 0 ? data_->site_xpos + 3 * tip_site_ : data_->xpos + 3 * tip_body_);
}

void TraceModel::MoveTo(EpisodeTime t) {
  SetJoints(JointsAt(recording_, t));
  const std::vector<Pose> poses = ObstaclesAt(recording_, t);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const int mocap = model_->body_mocapid[obstacle_bodies_[i]];
    const Eigen::Vector3d& p = poses[i].translation();
    const Eigen::Quaterniond& R = poses[i].rotation();
    const double quaternion[] = {R.w(), R.x(), R.y(), R.z()};
    std::copy(p.data(), p.data() + 3, data_->mocap_pos + 3 * mocap);
    std::copy(quaternion, quaternion + 4, data_->mocap_quat + 4 * mocap);
  }
  mj_kinematics(model_.get(), data_.get());
  mj_comPos(model_.get(), data_.get());
  mj_camlight(model_.get(), data_.get());
}

bool TraceModel::IsRobot(int geom) const {
  return model_->body_rootid[model_->geom_bodyid[geom]] == robot_root_;
}

int TraceModel::ObstacleOf(int geom) const {
  const int root = model_->body_rootid[model_->geom_bodyid[geom]];
  const auto found = std::find(obstacle_bodies_.begin(), obstacle_bodies_.end(), root);
  return found == obstacle_bodies_.end() ? -1 : static_cast<int>(found - obstacle_bodies_.begin());
}

bool TraceModel::BelongsTo(int geom, const std::string& object) const {
  const int body = mj_name2id(model_.get(), mjOBJ_BODY, object.c_str());
  if (body > 0) return IsInSubtree(*model_, model_->geom_bodyid[geom], body);
  return mj_name2id(model_.get(), mjOBJ_GEOM, object.c_str()) == geom;
}

Eigen::Matrix3Xd TraceModel::TipTrail(EpisodeTime t) const {
  const double elapsed_s = (t - recording_.control.front().t).seconds();
  const auto steps = static_cast<Eigen::Index>(std::floor(std::max(0.0, elapsed_s) / kTrailStep_s));
  return trail_.leftCols(std::min(steps + 1, trail_.cols()));
}

Eigen::Matrix3Xd TraceModel::TipPlan(const CycleRecord& cycle, EpisodeTime t) {
  const Trajectory& plan = cycle.plan;
  const double begin_s = std::max(0.0, (t - cycle.plan_start).seconds());
  const double end_s = plan.t_s(plan.num_states() - 1);
  if (begin_s >= end_s) return Eigen::Matrix3Xd(3, 0);
  const auto count = static_cast<Eigen::Index>(std::ceil((end_s - begin_s) / kPlanStep_s)) + 1;
  Eigen::Matrix3Xd path(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double offset_s = std::min(end_s, begin_s + kPlanStep_s * static_cast<double>(i));
    SetJoints(Sample(plan, HorizonOffset(offset_s)).q);
    mj_kinematics(model_.get(), data_.get());
    path.col(i) = TipPosition();
  }
  return path;
}

}  // namespace sidestep::render
