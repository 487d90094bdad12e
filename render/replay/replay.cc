#include "sidestep/render/replay/replay.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "sidestep/core/number_text.h"
#include "sidestep/record/questions.h"
#include "sidestep/render/timeline.h"
#include "sidestep/sim/mujoco_pose.h"

namespace sidestep::render {
namespace {

constexpr double kFrameStep_s = 0.02;
constexpr int kMostFrames = 3000, kMostTrailPoints = 6000, kMostClearances = 6000;
constexpr double kPathStep_s = 0.04;
constexpr int kFirstHiddenGroup = 3;  // MuJoCo's own drawing leaves it out too

std::optional<ReplayShape> ShapeOf(int mujoco_type) {
  switch (mujoco_type) {
    case mjGEOM_PLANE:
      return ReplayShape::kPlane;
    case mjGEOM_SPHERE:
      return ReplayShape::kSphere;
    case mjGEOM_CAPSULE:
      return ReplayShape::kCapsule;
    case mjGEOM_ELLIPSOID:
      return ReplayShape::kEllipsoid;
    case mjGEOM_CYLINDER:
      return ReplayShape::kCylinder;
    case mjGEOM_BOX:
      return ReplayShape::kBox;
    case mjGEOM_MESH:
      return ReplayShape::kMesh;
    default:
      return std::nullopt;  // no trace holds any other
  }
}

Pose PoseFrom(const mjtNum* position, const mjtNum* quaternion) {
  return Pose(Eigen::Quaterniond(quaternion[0], quaternion[1], quaternion[2], quaternion[3]),
              {position[0], position[1], position[2]});
}

bool NeverMoves(const mjModel& model, int body) {
  return model.body_weldid[body] == 0 && model.body_mocapid[model.body_rootid[body]] < 0;
}

// Which geoms are shown, and the bodies that carry those of them that move.
class Shown {
 public:
  Shown(const TraceModel& trace, Replay* replay) : trace_(trace) {
    for (int geom = 0; geom < trace.model().ngeom; ++geom) Add(geom, replay);
  }

  std::vector<Pose> BodyPoses() const {
    std::vector<Pose> poses;
    for (const int body : bodies_) {
      poses.push_back(PoseFrom(trace_.data().xpos + 3 * body, trace_.data().xquat + 4 * body));
    }
    return poses;
  }

 private:
  void Add(int geom, Replay* replay) {
    const mjModel& model = trace_.model();
    const std::optional<ReplayShape> shape = ShapeOf(model.geom_type[geom]);
    const bool is_hidden = model.geom_group[geom] >= kFirstHiddenGroup;
    const bool collides = model.geom_contype[geom] != 0 || model.geom_conaffinity[geom] != 0;
    const bool is_obstacle = trace_.ObstacleOf(geom) >= 0;
    if (!shape || (is_hidden && !(is_obstacle && collides))) return;
    ReplayGeom shown;
    shown.shape = *shape;
    const mjtNum* const size = model.geom_size + 3 * geom;
    shown.size_m = {size[0], size[1], size[2]};
    const int material = model.geom_matid[geom];
    const float* const rgba =
        material >= 0 ? model.mat_rgba + 4 * material : model.geom_rgba + 4 * geom;
    std::copy(rgba, rgba + 4, shown.rgba.begin());
    if (shown.shape == ReplayShape::kPlane) shown.rgba = {0.7F, 0.72F, 0.74F, 1};
    shown.role = is_hidden              ? ReplayRole::kContactBox
                 : is_obstacle          ? ReplayRole::kObstacle
                 : trace_.IsRobot(geom) ? ReplayRole::kRobot
                                        : ReplayRole::kScenery;
    if (shown.shape == ReplayShape::kMesh) shown.mesh = MeshOf(model.geom_dataid[geom], replay);
    const int body = model.geom_bodyid[geom];
    if (NeverMoves(model, body)) {
      shown.X_BG = sim::GeomPose(trace_.data(), geom);
    } else {
      const auto [known, is_new] = places_.try_emplace(body, static_cast<int>(bodies_.size()));
      if (is_new) bodies_.push_back(body);
      shown.body = known->second;
      shown.X_BG = PoseFrom(model.geom_pos + 3 * geom, model.geom_quat + 4 * geom);
    }
    replay->geoms.push_back(shown);
  }

  int MeshOf(int id, Replay* replay) {
    const auto [known, is_new] = meshes_.try_emplace(id, static_cast<int>(replay->meshes.size()));
    if (!is_new) return known->second;
    const mjModel& model = trace_.model();
    ReplayMesh& mesh = replay->meshes.emplace_back();
    mesh.vertices_m = Eigen::Map<const Eigen::Matrix3Xf>(
        model.mesh_vert + 3 * model.mesh_vertadr[id], 3, model.mesh_vertnum[id]);
    mesh.triangles = Eigen::Map<const Eigen::Matrix3Xi>(
        model.mesh_face + 3 * model.mesh_faceadr[id], 3, model.mesh_facenum[id]);
    return known->second;
  }

  const TraceModel& trace_;
  std::map<int, int> meshes_;  // of a mesh of the model, in Replay::meshes
  std::map<int, int> places_;  // of a body, in bodies_
  std::vector<int> bodies_;
};

// At most so many of them: every second, third, ... one.
Eigen::Index StrideFor(Eigen::Index count, Eigen::Index most) {
  return std::max<Eigen::Index>(1, (count + most - 1) / most);
}

// Every stride-th column and the last one.
Eigen::Matrix3Xd EveryNth(const Eigen::Matrix3Xd& points, Eigen::Index stride) {
  if (points.cols() == 0) return points;
  const Eigen::Index count = (points.cols() - 1 + stride - 1) / stride + 1;
  Eigen::Matrix3Xd thinned(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    thinned.col(i) = points.col(std::min(i * stride, points.cols() - 1));
  }
  return thinned;
}

void AddFrames(TraceModel& trace, const ReplayExtras& extras, Replay* replay) {
  const record::Recording& recording = trace.recording();
  trace.MoveTo(EpisodeTime(0));
  const Shown shown(trace, replay);
  replay->end_s = record::EndOf(recording).seconds();
  const int steps =
      std::clamp(static_cast<int>(std::ceil(replay->end_s / kFrameStep_s)), 1, kMostFrames);
  replay->step_s = replay->end_s / steps;
  for (int k = 0; k <= steps; ++k) {
    const EpisodeTime t(replay->step_s * k);
    trace.MoveTo(t);
    replay->X_WB.push_back(shown.BodyPoses());
    replay->obstacle_speed_m_s.push_back(ObstacleSpeedAt(recording, t));
    Status status = StatusAt(recording, t);
    if (replay->statuses.empty() || replay->statuses.back().status.text != status.text) {
      replay->statuses.push_back({t.seconds(), std::move(status)});
    }
    if (extras.robot != nullptr) {
      replay->p_WS.push_back(
          extras.robot->ComputeSphereCenters(JointsAt(recording, t), /*with_jacobian=*/false).p_WS);
    }
  }
  if (extras.robot != nullptr) {
    const Eigen::VectorXd& radii = extras.robot->sphere_radii_m();
    replay->sphere_radii_m.assign(radii.begin(), radii.end());
  }
}

void AddPaths(TraceModel& trace, Replay* replay) {
  const record::Recording& recording = trace.recording();
  const Eigen::Matrix3Xd trail = trace.TipTrail(record::EndOf(recording));
  const Eigen::Index stride = StrideFor(trail.cols(), kMostTrailPoints);
  replay->p_WTrail = EveryNth(trail, stride);
  replay->trail_step_s = TraceModel::kTrailStep_s * static_cast<double>(stride);
  for (const CycleRecord& cycle : recording.cycles) {
    if (!cycle.accepted || cycle.plan.num_states() == 0) continue;
    const Eigen::Matrix3Xd path = trace.TipPlan(cycle, cycle.t_effect);
    const Eigen::Index every = std::lround(kPathStep_s / TraceModel::kPlanStep_s);
    replay->plans.push_back({cycle.t_effect.seconds(), kPathStep_s, EveryNth(path, every)});
    for (const PredictedObject& object : cycle.objects) {
      if (object.X_WO.empty()) continue;
      ReplayPrediction& prediction = replay->predictions.emplace_back();
      prediction.effect_s = cycle.t_effect.seconds();
      prediction.half_extents_m = object.half_extents_m;
      for (const EpisodeTime t : object.t) prediction.t_s.push_back(t.seconds());
      prediction.X_WO = object.X_WO;
    }
  }
}

// Of each stretch of samples that are left out, the least clearance stands for all.
void AddClearance(const record::Recording& recording, Replay* replay) {
  const std::vector<TruthSample>& truth = recording.truth;
  const auto stride =
      static_cast<std::size_t>(StrideFor(static_cast<Eigen::Index>(truth.size()), kMostClearances));
  for (std::size_t begin = 0; begin < truth.size(); begin += stride) {
    const auto end =
        truth.begin() + static_cast<std::ptrdiff_t>(std::min(begin + stride, truth.size()));
    const auto least = std::min_element(
        truth.begin() + static_cast<std::ptrdiff_t>(begin), end,
        [](const TruthSample& a, const TruthSample& b) { return a.clearance_m < b.clearance_m; });
    replay->clearance_t_s.push_back(least->t.seconds());
    replay->clearance_m.push_back(least->clearance_m);
  }
}

std::string Spaced(std::string words) {
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

void AddMarks(const record::Recording& recording, Replay* replay) {
  bool touched = false;
  for (const TruthSample& sample : recording.truth) {
    if (sample.in_contact) {
      const double t_s = std::isnan(sample.contact_s) ? sample.t.seconds() : sample.contact_s;
      replay->touches.push_back({t_s, sample.p_WContact});
      if (!touched) replay->marks.push_back({t_s, "touches " + sample.contact_object, "contact"});
    }
    touched = sample.in_contact;
  }
  for (const CycleRecord& cycle : recording.cycles) {
    if (cycle.accepted || cycle.status == "kept") continue;
    const std::string why = cycle.reason.empty() ? "" : ": " + cycle.reason;
    replay->marks.push_back({cycle.t.seconds(), "planning: " + Spaced(cycle.status) + why, "plan"});
  }
  for (const SafetyEvent& event : recording.safety) {
    replay->marks.push_back({event.t.seconds(),
                             "supervisor: " + Spaced(event.check) + ", " + Spaced(event.reaction),
                             "safety"});
  }
  for (const TrackEvent& event : recording.events) {
    replay->marks.push_back({event.t.seconds(),
                             "object " + std::to_string(event.id) + " " + Spaced(event.what),
                             "track"});
  }
  std::stable_sort(replay->marks.begin(), replay->marks.end(),
                   [](const ReplayMark& a, const ReplayMark& b) { return a.t_s < b.t_s; });
}

void AddFacts(const record::Recording& recording, const std::string& speeds, Replay* replay) {
  for (const char* const key :
       {"scenario", "robot", "planner", "knowledge", "predictor", "seed", "outcome", "reason"}) {
    const auto fact = recording.header.find(key);
    if (fact != recording.header.end()) replay->facts.push_back(*fact);
  }
  if (!speeds.empty()) replay->facts.emplace_back("speed", speeds);
  const struct {
    const char *metric, *format, *name;
  } shown[] = {{"time_to_goal_s", "{:.3f} s", "time to goal"},
               {"min_clearance_m", "{:.4f} m", "least clearance"},
               {"gp_cost", "{:.3f}", "GP cost"}};
  for (const auto& [metric, format, name] : shown) {
    const auto found = recording.metrics.find(metric);
    if (found == recording.metrics.end() || !std::isfinite(found->second)) continue;
    replay->facts.push_back({name, FiniteText(format, found->second)});
  }
}

}  // namespace

Replay MakeReplay(TraceModel& trace, ReplayExtras extras) {
  const record::Recording& recording = trace.recording();
  Replay replay;
  replay.name = trace.name();
  replay.title = TitleOf(recording, trace.name());
  replay.place = PlaceOf(recording);
  AddFrames(trace, extras, &replay);
  AddPaths(trace, &replay);
  AddClearance(recording, &replay);
  AddMarks(recording, &replay);
  AddFacts(recording, extras.speeds, &replay);
  replay.why_no_spheres = extras.why_no_robot;
  replay.margin_m = extras.margin_m;
  replay.field = std::move(extras.field);
  return replay;
}

}  // namespace sidestep::render
