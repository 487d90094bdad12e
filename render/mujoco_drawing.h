#pragma once

#include <mujoco/mujoco.h>

#include "sidestep/render/image.h"

namespace sidestep::render {

/// What MuJoCo keeps on the graphics side for one model; draws into its off-screen buffer, whose
/// size is the model's vis.global.offwidth x offheight. Needs a GlContext that outlives it.
class DrawingContext {
 public:
  explicit DrawingContext(const mjModel& model, mjtFontScale font_scale = mjFONTSCALE_100);
  ~DrawingContext();
  DrawingContext(const DrawingContext&) = delete;
  DrawingContext& operator=(const DrawingContext&) = delete;

  /// Half the width of the square that a directional light's shadow map covers [m].
  void SetShadowRadius(double radius_m) { context_.shadowClip = static_cast<float>(radius_m); }

  mjrRect viewport() const { return {0, 0, context_.offWidth, context_.offHeight}; }

  /// Draws a scene into the buffer, over all of it. The buffer stays bound for what OpenGL may add.
  void Render(mjvScene& scene) const;
  /// What the buffer holds.
  Image Read() const;

  const mjrContext& context() const { return context_; }

 private:
  mjrContext context_;
};

/// Owns a scene: what MuJoCo is to draw at one moment.
class Scene {
 public:
  Scene(const mjModel& model, int max_geoms);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  mjvScene& get() { return scene_; }

 private:
  mjvScene scene_;
};

}  // namespace sidestep::render
