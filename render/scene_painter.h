#pragma once

#include <string>

#include "sidestep/record/questions.h"
#include "sidestep/render/camera.h"
#include "sidestep/render/gl_context.h"
#include "sidestep/render/image.h"
#include "sidestep/render/mujoco_drawing.h"
#include "sidestep/render/overlay.h"
#include "sidestep/render/timeline.h"
#include "sidestep/render/trace_model.h"

namespace sidestep::render {

/// What colours mean, in the scene as in the legend.
inline constexpr Color kPlanColor = {38, 145, 255};
inline constexpr Color kTrailColor = {255, 176, 46};
inline constexpr Color kPredictionColor = {168, 112, 232};
inline constexpr Color kContactColor = {232, 40, 40};

/// Draws one trace at any moment: the world; the path that the plan in force gives the arm's tip,
/// and its path so far; the obstacles as they were predicted for the next second, paler the later;
/// contacts. Without captions.
class ScenePainter {
 public:
  /// `trace` must outlive it; its model's drawing settings are changed.
  ScenePainter(const GlContext& gl, TraceModel& trace, int width, int height);

  /// How much of the world a picture of this shape shows.
  static Frustum FullFrustum(int width, int height);

  void LookFrom(const CameraView& view);
  /// @throws InputError if the model has no camera of this name; the message lists what it has.
  void LookThrough(const std::string& camera);

  Image Draw(EpisodeTime t);

 private:
  void DropUnseen();
  void AimShadows();
  void TintTouched(const record::Touch& touch);
  void DrawContactBoxes(Overlay& overlay) const;
  static void DrawPredictions(Overlay& overlay, const CycleRecord& cycle, EpisodeTime t);

  TraceModel& trace_;
  Scene scene_;
  DrawingContext drawing_;
  mjvCamera camera_;
  Eigen::Vector3d shadow_center_m_ = Eigen::Vector3d::Zero();
  double shadow_radius_m_ = 0;  // zero: leave the lights where the model has them
};

}  // namespace sidestep::render
