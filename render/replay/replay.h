#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/core/field_samples.h"
#include "sidestep/core/pose.h"
#include "sidestep/core/time.h"
#include "sidestep/render/captions.h"
#include "sidestep/render/trace_model.h"
#include "sidestep/robot/robot_model.h"

namespace sidestep::render {

// What is shown of a trace in a browser, as plain values; times are seconds of the episode.

enum class ReplayShape { kPlane, kSphere, kCapsule, kEllipsoid, kCylinder, kBox, kMesh };
/// What a thing is part of.
enum class ReplayRole {
  kScenery,
  kRobot,
  kObstacle,
  kContactBox  ///< what an obstacle collides with, where its picture is another body
};

/// One solid of the scene.
struct ReplayGeom {
  ReplayShape shape = ReplayShape::kBox;
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< as MuJoCo's geom_size
  std::array<float, 4> rgba = {};
  ReplayRole role = ReplayRole::kScenery;
  int mesh = -1;  ///< of Replay::meshes, for a mesh
  int body = -1;  ///< of Replay::X_WB; -1: it never moves
  Pose X_BG;      ///< in its body; of what never moves, in W
};

/// Triangles, in the frame of the geoms that show them.
struct ReplayMesh {
  Eigen::Matrix3Xf vertices_m;
  Eigen::Matrix3Xi triangles;  ///< of vertices, by their columns
};

/// Where the arm's tip was to go by a plan, from when it took effect.
struct ReplayPlan {
  double effect_s = 0, step_s = 0;
  Eigen::Matrix3Xd p_WTip;  ///< [m] one a step
};

/// Where a planning cycle expected one object to be.
struct ReplayPrediction {
  double effect_s = 0;  ///< of the cycle's plan
  Eigen::Vector3d half_extents_m = Eigen::Vector3d::Zero();
  std::vector<double> t_s;
  std::vector<Pose> X_WO;
};

/// What is said of a trace from a time on.
struct ReplayStatus {
  double t_s = 0;
  Status status;
};

/// Something that happened at a moment, for the time line.
struct ReplayMark {
  double t_s = 0;
  std::string what, kind;  ///< kind: contact, plan, track, safety
};

struct Replay {
  Title title;
  std::string name, place;
  std::vector<std::pair<std::string, std::string>> facts;
  double end_s = 0, step_s = 0;  ///< of the frames: step k is at k times step_s
  std::vector<ReplayGeom> geoms;
  std::vector<ReplayMesh> meshes;
  std::vector<std::vector<Pose>> X_WB;     ///< of each frame, of each body that moves
  std::vector<double> obstacle_speed_m_s;  ///< of each frame; NaN: not known
  std::vector<ReplayStatus> statuses;
  double trail_step_s = 0;
  Eigen::Matrix3Xd p_WTrail;  ///< [m] where the arm's tip was
  std::vector<ReplayPlan> plans;
  std::vector<ReplayPrediction> predictions;
  std::vector<double> clearance_t_s, clearance_m;
  std::optional<double> margin_m;  ///< what the planner was to keep clear of
  std::vector<ReplayMark> marks;
  std::vector<std::pair<double, Eigen::Vector3d>> touches;  ///< [s], [m]: contacts

  std::vector<double> sphere_radii_m;  ///< of the planner's spheres
  std::vector<Eigen::Matrix3Xd> p_WS;  ///< of each frame, their centres [m]
  std::string why_no_spheres;
  FieldSamples field;
};

/// What a replay shows beyond the trace itself.
struct ReplayExtras {
  const robot::RobotModel* robot = nullptr;  ///< null: its spheres are not shown
  std::string why_no_robot;
  FieldSamples field;
  std::optional<double> margin_m;
  std::string speeds;  ///< of what moves, in words; empty: not known
};

/// Moves the trace to other moments.
Replay MakeReplay(TraceModel& trace, ReplayExtras extras);

}  // namespace sidestep::render
