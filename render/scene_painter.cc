#include "sidestep/render/scene_painter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sidestep/core/input_error.h"
#include "sidestep/sim/mujoco_model.h"
#include "sidestep/sim/mujoco_pose.h"

namespace sidestep::render {
namespace {

constexpr int kMaxSceneGeoms = 2000;
constexpr double kSceneFieldOfView_deg = 32;  // upright; narrow enough to keep shapes true
constexpr double kPathWidth = 0.011;          // of the picture's height
constexpr double kShadowMargin = 1.2;
constexpr HorizonOffset kTouchShown(0.25);
constexpr double kTouchRadius_m = 0.045;

// Sets what the model says about its own drawing. Software draws it, so nothing is finer than it
// can be seen: round shapes have the more corners the larger the picture, up to MuJoCo's own
// number.
mjModel& Prepare(mjModel& model, int width, int height) {
  model.vis.global.offwidth = width;
  model.vis.global.offheight = height;
  model.vis.global.fovy = static_cast<float>(kSceneFieldOfView_deg);
  model.vis.quality.offsamples = 4;
  model.vis.quality.shadowsize = 2048;
  model.vis.quality.numslices = std::clamp(height / 16, 14, 28);
  model.vis.quality.numstacks = model.vis.quality.numslices / 2;
  model.vis.quality.numquads = 1;
  return model;
}

// The path without points that are too near to the one before; pieces of a line that are shorter
// than it is wide look like a comb. The last point stays.
Eigen::Matrix3Xd Thinned(const Eigen::Matrix3Xd& path) {
  constexpr double kApart_m = 0.015;
  Eigen::Matrix3Xd thinned(3, path.cols());
  Eigen::Index count = 0;
  for (Eigen::Index i = 0; i < path.cols(); ++i) {
    const bool is_last = i + 1 == path.cols();
    if (count > 0 && !is_last && (path.col(i) - thinned.col(count - 1)).norm() < kApart_m) continue;
    thinned.col(count++) = path.col(i);
  }
  return thinned.leftCols(count);
}

// No point of a box is further from where it was than this.
double MostMoved(const Pose& before, const Pose& after, const Eigen::Vector3d& half_extents_m) {
  return (after.translation() - before.translation()).norm() +
         after.rotation().angularDistance(before.rotation()) * half_extents_m.norm();
}

}  // namespace

ScenePainter::ScenePainter(const GlContext&, TraceModel& trace, int width, int height)
    : trace_(trace),
      scene_(Prepare(trace.model(), width, height), kMaxSceneGeoms),
      drawing_(trace.model()) {
  scene_.get().flags[mjRND_SHADOW] = 1;
  scene_.get().flags[mjRND_REFLECTION] = 0;
  mjv_defaultFreeCamera(&trace_.model(), &camera_);
}

Frustum ScenePainter::FullFrustum(int width, int height) {
  const double up = std::tan(kSceneFieldOfView_deg / 2 * std::numbers::pi / 180);
  const double right = up * width / height;
  return {-right, right, -up, up};
}

void ScenePainter::LookFrom(const CameraView& view) {
  constexpr double kDegrees = 180 / std::numbers::pi;
  mjv_defaultCamera(&camera_);
  camera_.type = mjCAMERA_FREE;
  std::copy(view.lookat_m.data(), view.lookat_m.data() + 3, camera_.lookat);
  camera_.distance = view.distance_m;
  camera_.azimuth = view.azimuth_rad * kDegrees;
  camera_.elevation = view.elevation_rad * kDegrees;
  shadow_center_m_ = view.lookat_m;
  shadow_radius_m_ = kShadowMargin * view.distance_m *
                     FullFrustum(drawing_.viewport().width, drawing_.viewport().height).right;
  drawing_.SetShadowRadius(shadow_radius_m_);
}

void ScenePainter::LookThrough(const std::string& camera) {
  const mjModel& model = trace_.model();
  const int id = mj_name2id(&model, mjOBJ_CAMERA, camera.c_str());
  if (id < 0) {
    std::string known;
    for (int i = 0; i < model.ncam; ++i) {
      const char* const name = mj_id2name(&model, mjOBJ_CAMERA, i);
      if (name != nullptr) known += (known.empty() ? "" : ", ") + std::string(name);
    }
    throw InputError("--camera", "'" + camera + "' is not in " + trace_.name() + "; it has " +
                                     (known.empty() ? "none" : known));
  }
  mjv_defaultCamera(&camera_);
  camera_.type = mjCAMERA_FIXED;
  camera_.fixedcamid = id;
}

// What an obstacle collides with, where its picture is another body.
void ScenePainter::DrawContactBoxes(Overlay& overlay) const {
  constexpr int kFirstHiddenGroup = 3;
  constexpr Color kGlass = {70, 84, 104};
  const mjModel& model = trace_.model();
  for (int geom = 0; geom < model.ngeom; ++geom) {
    const bool is_hidden = model.geom_group[geom] >= kFirstHiddenGroup;
    const bool collides = model.geom_contype[geom] != 0 || model.geom_conaffinity[geom] != 0;
    if (trace_.ObstacleOf(geom) < 0 || !is_hidden || !collides ||
        model.geom_type[geom] != mjGEOM_BOX) {
      continue;
    }
    overlay.DrawBox(sim::GeomPose(trace_.data(), geom),
                    Eigen::Map<const Eigen::Vector3d>(model.geom_size + 3 * geom), kGlass, 0.06,
                    0.55);
  }
}

void ScenePainter::DrawPredictions(Overlay& overlay, const CycleRecord& cycle, EpisodeTime t) {
  constexpr double kOpacities[] = {0.28, 0.20, 0.14, 0.10};
  constexpr HorizonOffset kStep(0.3);
  constexpr double kApart_m = 0.02;  // nearer ones would be drawn into one another
  for (const PredictedObject& object : cycle.objects) {
    if (object.X_WO.empty()) continue;
    EpisodeTime moment = t;
    std::optional<Pose> previous;
    for (const double opacity : kOpacities) {
      moment = moment + kStep;
      const Pose X_WO = PoseAt(object.t, object.X_WO, moment);
      if (previous && MostMoved(*previous, X_WO, object.half_extents_m) < kApart_m) continue;
      previous = X_WO;
      overlay.DrawBox(X_WO, object.half_extents_m, kPredictionColor, opacity / 3, 3 * opacity);
    }
  }
}

// Leaves out what is well outside the picture; MuJoCo would draw it all the same, three times with
// shadows. The margin keeps what may throw a shadow into the picture.
void ScenePainter::DropUnseen() {
  constexpr double kShadowLength_m = 1.5;
  mjvScene& scene = scene_.get();
  const mjvGLCamera eye = mjv_averageCamera(&scene.camera[0], &scene.camera[1]);
  const auto vector = [](const float* v) { return Eigen::Vector3d(v[0], v[1], v[2]); };
  const Eigen::Vector3d right = vector(eye.forward).cross(vector(eye.up));
  const double top = eye.frustum_top / eye.frustum_near;
  const double side = top * drawing_.viewport().width / drawing_.viewport().height;
  const auto is_unseen = [&](const mjvGeom& geom) {
    if (geom.modelrbound == 0) return false;  // endless
    const Eigen::Vector3d p = vector(geom.pos) - vector(eye.pos);
    const double reach = geom.modelrbound + kShadowLength_m;
    const double depth = p.dot(vector(eye.forward));
    return depth < -reach || std::abs(p.dot(right)) - side * depth > reach * std::hypot(1, side) ||
           std::abs(p.dot(vector(eye.up))) - top * depth > reach * std::hypot(1, top);
  };
  scene.ngeom = static_cast<int>(std::remove_if(scene.geoms, scene.geoms + scene.ngeom, is_unseen) -
                                 scene.geoms);
}

// A directional light lights the same from anywhere, but MuJoCo's shadow map is a square around its
// axis. Moved over what is seen, and no larger than that, the map gives sharp shadows.
void ScenePainter::AimShadows() {
  if (shadow_radius_m_ == 0) return;
  mjvScene& scene = scene_.get();
  for (int i = 0; i < scene.nlight; ++i) {
    mjvLight& light = scene.lights[i];
    if (!light.directional || !light.castshadow) continue;
    for (int axis = 0; axis < 3; ++axis) {
      light.pos[axis] =
          static_cast<float>(shadow_center_m_[axis] - 2 * shadow_radius_m_ * light.dir[axis]);
    }
  }
}

void ScenePainter::TintTouched(const record::Touch& touch) {
  constexpr float kShare = 0.6F;
  const float tint[] = {static_cast<float>(kContactColor.r) / 255,
                        static_cast<float>(kContactColor.g) / 255,
                        static_cast<float>(kContactColor.b) / 255};
  mjvScene& scene = scene_.get();
  for (int i = 0; i < scene.ngeom; ++i) {
    mjvGeom& geom = scene.geoms[i];
    if (geom.objtype != mjOBJ_GEOM || !trace_.BelongsTo(geom.objid, touch.object)) continue;
    for (int c = 0; c < 3; ++c) geom.rgba[c] += kShare * (tint[c] - geom.rgba[c]);
  }
}

Image ScenePainter::Draw(EpisodeTime t) {
  const CycleRecord* const cycle = CycleInForce(trace_.recording(), t);
  const Eigen::Matrix3Xd plan =
      cycle == nullptr ? Eigen::Matrix3Xd(3, 0) : trace_.TipPlan(*cycle, t);
  const std::optional<record::Touch> touch =
      record::TouchWithin(trace_.recording(), t, kTouchShown);
  trace_.MoveTo(t);
  mjvOption option;
  mjv_defaultOption(&option);
  mjv_updateScene(&trace_.model(), &trace_.data(), &option, nullptr, &camera_, mjCAT_ALL,
                  &scene_.get());
  DropUnseen();
  if (touch) TintTouched(*touch);
  AimShadows();
  try {
    drawing_.Render(scene_.get());
  } catch (const sim::SimulationError& error) {  // there is nothing in it but the trace's model
    throw InputError(trace_.name() + ": model_xml", error.what());
  }
  {
    Overlay overlay(scene_.get(), drawing_.viewport());
    const mjrRect picture = drawing_.viewport();
    const double line = std::max(1.5, kPathWidth * std::sqrt(picture.width * picture.height));
    DrawContactBoxes(overlay);
    if (cycle != nullptr) DrawPredictions(overlay, *cycle, t);
    overlay.DrawPath(Thinned(trace_.TipTrail(t)), kTrailColor, line);
    overlay.DrawPath(Thinned(plan), kPlanColor, line);
    if (touch) overlay.DrawSpot(touch->p_W, kTouchRadius_m, kContactColor);
  }
  return drawing_.Read();
}

}  // namespace sidestep::render
