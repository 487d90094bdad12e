#include "sidestep/render/overlay.h"

#include <GL/gl.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace sidestep::render {
namespace {

Eigen::Vector3d FromFloats(const float* values) { return {values[0], values[1], values[2]}; }

void SetColor(Color color, double opacity) {
  glColor4d(color.r / 255.0, color.g / 255.0, color.b / 255.0, opacity);
}

void PutVertex(const Eigen::Vector3d& p_W) { glVertex3d(p_W.x(), p_W.y(), p_W.z()); }

}  // namespace

Overlay::Overlay(const mjvScene& scene, const mjrRect& viewport) {
  glPushAttrib(GL_ALL_ATTRIB_BITS);
  glMatrixMode(GL_PROJECTION);
  glPushMatrix();
  glMatrixMode(GL_MODELVIEW);
  glPushMatrix();

  // The camera as MuJoCo places it: the mean of the two eyes.
  const mjvGLCamera camera = mjv_averageCamera(&scene.camera[0], &scene.camera[1]);
  const double height = camera.frustum_top - camera.frustum_bottom;
  const double half_width = 0.5 * height * viewport.width / viewport.height;
  const Eigen::Vector3d back = -FromFloats(camera.forward).normalized();
  right_ = FromFloats(camera.up).cross(back).normalized();
  up_ = back.cross(right_);
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.block<1, 3>(0, 0) = right_;
  view.block<1, 3>(1, 0) = up_;
  view.block<1, 3>(2, 0) = back;
  view.block<3, 1>(0, 3) = -view.topLeftCorner<3, 3>() * FromFloats(camera.pos);
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  glFrustum(camera.frustum_center - half_width, camera.frustum_center + half_width,
            camera.frustum_bottom, camera.frustum_top, camera.frustum_near, camera.frustum_far);
  glMatrixMode(GL_MODELVIEW);
  glLoadMatrixd(view.data());

  glViewport(viewport.left, viewport.bottom, viewport.width, viewport.height);
  glDisable(GL_LIGHTING);
  glDisable(GL_TEXTURE_2D);
  glDisable(GL_CULL_FACE);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
}

Overlay::~Overlay() {
  glMatrixMode(GL_PROJECTION);
  glPopMatrix();
  glMatrixMode(GL_MODELVIEW);
  glPopMatrix();
  glPopAttrib();
}

void Overlay::DrawPath(const Eigen::Matrix3Xd& points, Color color, double width) {
  SetColor(color, 1);
  glLineWidth(static_cast<float>(width));
  glBegin(GL_LINE_STRIP);
  for (const auto& p_W : points.colwise()) PutVertex(p_W);
  glEnd();
}

void Overlay::DrawBox(const Pose& X_WO, const Eigen::Vector3d& half_extents_m, Color color,
                      double face_opacity, double edge_opacity) {
  const auto corner = [&](int axis, int side, int s, int t) {
    Eigen::Vector3d p_O;
    p_O[axis] = side;
    p_O[(axis + 1) % 3] = s;
    p_O[(axis + 2) % 3] = t;
    return X_WO * p_O.cwiseProduct(half_extents_m);
  };
  SetColor(color, face_opacity);
  glBegin(GL_QUADS);
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      PutVertex(corner(axis, side, -1, -1));
      PutVertex(corner(axis, side, 1, -1));
      PutVertex(corner(axis, side, 1, 1));
      PutVertex(corner(axis, side, -1, 1));
    }
  }
  glEnd();
  SetColor(color, edge_opacity);
  glLineWidth(1.5F);
  glBegin(GL_LINES);
  for (int axis = 0; axis < 3; ++axis) {
    for (const int s : {-1, 1}) {
      for (const int t : {-1, 1}) {
        PutVertex(corner(axis, -1, s, t));
        PutVertex(corner(axis, 1, s, t));
      }
    }
  }
  glEnd();
}

void Overlay::DrawSpot(const Eigen::Vector3d& p_W, double radius_m, Color color) {
  constexpr int kNumCorners = 32;
  constexpr Color kRim = {255, 255, 255};
  glDisable(GL_DEPTH_TEST);
  for (const double share : {1.0, 0.75}) {
    SetColor(share == 1.0 ? kRim : color, 1);
    glBegin(GL_POLYGON);
    for (int i = 0; i < kNumCorners; ++i) {
      const double angle = 2 * std::numbers::pi * i / kNumCorners;
      PutVertex(p_W + share * radius_m * (std::cos(angle) * right_ + std::sin(angle) * up_));
    }
    glEnd();
  }
  glEnable(GL_DEPTH_TEST);
}

}  // namespace sidestep::render
