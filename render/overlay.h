#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>

#include "sidestep/core/pose.h"
#include "sidestep/render/image.h"

namespace sidestep::render {

/// Draws signs into the picture of a scene: things to be told apart from the world, so they have
/// neither light nor shadow, but the world hides what lies behind it. Make one after MuJoCo drew
/// the scene and before the picture is read; it draws into the same buffer with the same camera.
class Overlay {
 public:
  Overlay(const mjvScene& scene, const mjrRect& viewport);
  ~Overlay();
  Overlay(const Overlay&) = delete;
  Overlay& operator=(const Overlay&) = delete;

  /// A line through the points (3 x N, m), `width` pixels wide.
  void DrawPath(const Eigen::Matrix3Xd& points, Color color, double width);
  /// A box of glass with clear edges, centred on O. Opacities are of a face and of an edge.
  void DrawBox(const Pose& X_WO, const Eigen::Vector3d& half_extents_m, Color color,
               double face_opacity, double edge_opacity);
  /// A round spot that faces the camera and that nothing hides.
  void DrawSpot(const Eigen::Vector3d& p_W, double radius_m, Color color);

 private:
  Eigen::Vector3d right_, up_;  // of the camera
};

}  // namespace sidestep::render
