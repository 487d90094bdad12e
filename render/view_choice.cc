#include "sidestep/render/view_choice.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "sidestep/record/questions.h"
#include "sidestep/render/timeline.h"
#include "sidestep/sim/mujoco_pose.h"

namespace sidestep::render {
namespace {

constexpr double kStep_s = 0.25;
constexpr double kWatched_s = 3;
constexpr double kBeforePassing_s = 0.7, kAfterPassing_s = 0.4;
constexpr double kElevations_rad[] = {-0.4, -0.6};
constexpr int kNumDirections = 24;
constexpr double kWeightVisibility = 2, kWeightPath = 1.5, kWeightSize = 0.5, kWeightAcross = 0.1;

using Points = std::vector<Eigen::Vector3d>;

// Half the extents of a box around a geom, along the geom's axes; zero for a plane.
Eigen::Vector3d GeomHalfExtents(const mjModel& model, int geom) {
  const mjtNum* const size = model.geom_size + 3 * geom;
  switch (model.geom_type[geom]) {
    case mjGEOM_PLANE:
      return Eigen::Vector3d::Zero();
    case mjGEOM_SPHERE:
      return Eigen::Vector3d::Constant(size[0]);
    case mjGEOM_CAPSULE:
      return {size[0], size[0], size[0] + size[1]};
    case mjGEOM_CYLINDER:
      return {size[0], size[0], size[1]};
    case mjGEOM_BOX:
    case mjGEOM_ELLIPSOID:
      return {size[0], size[1], size[2]};
    default:
      return Eigen::Vector3d::Constant(model.geom_rbound[geom]);
  }
}

void AppendCorners(const TraceModel& trace, int geom, Points* points) {
  const Eigen::Vector3d half = GeomHalfExtents(trace.model(), geom);
  const Pose X_WG = sim::GeomPose(trace.data(), geom);
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                               (corner & 4) != 0 ? 1 : -1);
    points->push_back(X_WG * sign.cwiseProduct(half));
  }
}

bool IsPlane(const mjModel& model, int geom) { return model.geom_type[geom] == mjGEOM_PLANE; }

struct Interval {
  EpisodeTime begin, end;
  bool Contains(EpisodeTime t) const { return begin <= t && t <= end; }
};

std::vector<double> TimesUntil(double end_s, double step_s) {
  std::vector<double> times;
  for (int i = 0; i * step_s <= end_s; ++i) times.push_back(i * step_s);
  return times;
}

// When each obstacle passes the robot: around the moment when it is nearest to it.
std::vector<Interval> TimesOfPassing(const TraceModel& trace, const Eigen::Vector3d& p_WRobot) {
  std::vector<Interval> passing(trace.recording().obstacles.size());
  std::vector<double> nearest_m(passing.size(), std::numeric_limits<double>::infinity());
  const double end_s = std::min(kWatched_s, record::EndOf(trace.recording()).seconds());
  for (const double t_s : TimesUntil(end_s, kStep_s / 5)) {
    const std::vector<Pose> poses = ObstaclesAt(trace.recording(), EpisodeTime(t_s));
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const double distance_m = (poses[i].translation() - p_WRobot).norm();
      if (distance_m >= nearest_m[i]) continue;
      nearest_m[i] = distance_m;
      passing[i] = {EpisodeTime(t_s - kBeforePassing_s), EpisodeTime(t_s + kAfterPassing_s)};
    }
  }
  return passing;
}

struct Moment {
  TraceModel* trace;
  EpisodeTime t;
};

// Every kStep_s, of each trace.
std::vector<Moment> Moments(const std::vector<TraceModel*>& traces) {
  std::vector<Moment> moments;
  for (TraceModel* const trace : traces) {
    const double end_s = std::min(kWatched_s, record::EndOf(trace->recording()).seconds());
    for (const double t_s : TimesUntil(end_s, kStep_s)) {
      moments.push_back({trace, EpisodeTime(t_s)});
    }
  }
  return moments;
}

Eigen::Vector3d RobotPosition(const TraceModel& trace) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (int geom = 0; geom < trace.model().ngeom; ++geom) {
    if (!trace.IsRobot(geom)) continue;
    sum += sim::GeomPosition(trace.data(), geom);
    ++count;
  }
  return count == 0 ? sum : Eigen::Vector3d(sum / count);
}

Eigen::Matrix3Xd PointsToShow(const std::vector<TraceModel*>& traces) {
  Points points;
  for (TraceModel* const trace : traces) {
    trace->MoveTo(EpisodeTime(0));
    const std::vector<Interval> passing = TimesOfPassing(*trace, RobotPosition(*trace));
    for (const Moment& moment : Moments({trace})) {
      trace->MoveTo(moment.t);
      for (int geom = 0; geom < trace->model().ngeom; ++geom) {
        if (IsPlane(trace->model(), geom)) continue;
        const int obstacle = trace->ObstacleOf(geom);
        if (obstacle >= 0 && !passing[static_cast<std::size_t>(obstacle)].Contains(moment.t)) {
          continue;
        }
        AppendCorners(*trace, geom, &points);
      }
    }
  }
  Eigen::Matrix3Xd matrix(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    matrix.col(static_cast<Eigen::Index>(i)) = points[i];
  }
  return matrix;
}

// Whether the straight line from `from` on towards `direction` meets the box around a geom.
bool MeetsBox(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, const Pose& X_WG,
              const Eigen::Vector3d& half) {
  const Eigen::Vector3d p_G = X_WG.Inverse() * from;
  const Eigen::Vector3d v_G = X_WG.RotateInverse(direction);
  double enter = 0, leave = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3;
       ++axis) {  // A slab each; a quotient by zero is infinite, as it is to be.
    const double a = (-half[axis] - p_G[axis]) / v_G[axis];
    const double b = (half[axis] - p_G[axis]) / v_G[axis];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

// Whether the centre of a geom of the robot is in sight, with no obstacle before or behind it: the
// two would be hard to tell apart.
bool StandsOut(const TraceModel& trace, int geom, const Eigen::Vector3d& from) {
  const mjModel& model = trace.model();
  const Eigen::Vector3d ray = sim::GeomPosition(trace.data(), geom) - from;
  for (int other = 0; other < model.ngeom; ++other) {
    if (trace.ObstacleOf(other) >= 0 &&
        MeetsBox(from, ray, sim::GeomPose(trace.data(), other), GeomHalfExtents(model, other))) {
      return false;
    }
  }
  const mjtByte drawn_groups[mjNGROUP] = {1, 1, 1, 0, 0, 0};
  int hit = -1;
  const double share = mj_ray(&model, &trace.data(), from.data(), ray.data(), drawn_groups,
                              /*flg_static=*/1, /*bodyexclude=*/-1, &hit);
  return hit < 0 || share >= 1 || trace.IsRobot(hit);
}

// The share of the arms' geoms that stand out, from each of the views.
std::vector<double> Visibility(const std::vector<Moment>& moments,
                               const std::vector<CameraView>& views) {
  std::vector<double> seen(views.size(), 0);
  int count = 0;
  for (const Moment& moment : moments) {
    const TraceModel& trace = *moment.trace;
    moment.trace->MoveTo(moment.t);
    for (int geom = 0; geom < trace.model().ngeom; ++geom) {
      if (!trace.IsRobot(geom) || trace.model().geom_group[geom] > 2) continue;
      ++count;
      for (std::size_t i = 0; i < views.size(); ++i) {
        if (StandsOut(trace, geom, views[i].position_m())) ++seen[i];
      }
    }
  }
  for (double& share : seen) share /= std::max(1, count);
  return seen;
}

// How long the paths of the arms' tips look from a view, as a share of their length.
double ApparentLength(const std::vector<TraceModel*>& traces, const CameraView& view) {
  double apparent_m = 0, true_m = 0;
  for (const TraceModel* const trace : traces) {
    const Eigen::Matrix3Xd path = trace->TipTrail(EpisodeTime(kWatched_s));
    for (Eigen::Index i = 1; i < path.cols(); ++i) {
      const Eigen::Vector3d step = path.col(i) - path.col(i - 1);
      apparent_m += step.cross(view.forward()).norm();
      true_m += step.norm();
    }
  }
  return true_m > 0 ? apparent_m / true_m : 1;
}

// The level direction in which the obstacles travel; zero if they stand.
Eigen::Vector3d DirectionOfTravel(const std::vector<TraceModel*>& traces) {
  Eigen::Vector3d travel = Eigen::Vector3d::Zero();
  for (const TraceModel* const trace : traces) {
    const std::vector<Pose> first = ObstaclesAt(trace->recording(), EpisodeTime(0));
    const std::vector<Pose> last = ObstaclesAt(trace->recording(), EpisodeTime(kWatched_s));
    for (std::size_t i = 0; i < first.size(); ++i) {
      travel += last[i].translation() - first[i].translation();
    }
  }
  travel.z() = 0;
  return travel.norm() < 0.01 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(travel.normalized());
}

}  // namespace

CameraView ChooseView(const std::vector<TraceModel*>& traces, const Frustum& frustum) {
  const Eigen::Matrix3Xd points = PointsToShow(traces);
  std::vector<CameraView> views;
  double least_distance_m = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kNumDirections; ++i) {
    const double azimuth_rad = 2 * std::numbers::pi * i / kNumDirections;
    for (const double elevation_rad : kElevations_rad) {
      views.push_back(FitCamera(points, azimuth_rad, elevation_rad, frustum));
      least_distance_m = std::min(least_distance_m, views.back().distance_m);
    }
  }
  const std::vector<double> visibility = Visibility(Moments(traces), views);
  const Eigen::Vector3d travel = DirectionOfTravel(traces);
  std::size_t best = 0;
  double best_score = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < views.size(); ++i) {
    const double heading = views[i].azimuth_rad;
    const double across = std::abs(travel.x() * std::sin(heading) - travel.y() * std::cos(heading));
    const double size = least_distance_m / views[i].distance_m;
    const double score = kWeightVisibility * visibility[i] +
                         kWeightPath * ApparentLength(traces, views[i]) + kWeightSize * size +
                         kWeightAcross * across;
    if (score > best_score) {
      best_score = score;
      best = i;
    }
  }
  return views[best];
}

}  // namespace sidestep::render
