#include "render/view_choice.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "render/timeline.h"

namespace sidestep {
namespace {

constexpr double kStep_s = 0.25;
constexpr double kWatched_s = 3;
constexpr double kAfterPassing_s = 0.4;
constexpr double kElevation_rad = -0.5;
constexpr int kNumDirections = 24;

using Points = std::vector<Eigen::Vector3d>;

// Half the extents of a box around a geom, along the geom's axes; zero for a plane.
Eigen::Vector3d HalfExtents(const mjModel& model, int geom) {
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
  const Eigen::Vector3d half = HalfExtents(trace.model(), geom);
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R_WG(trace.data().geom_xmat +
                                                                            9 * geom);
  const Eigen::Map<const Eigen::Vector3d> p_WG(trace.data().geom_xpos + 3 * geom);
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3d sign((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                               (corner & 4) != 0 ? 1 : -1);
    points->push_back(p_WG + R_WG * sign.cwiseProduct(half));
  }
}

bool IsPlane(const mjModel& model, int geom) { return model.geom_type[geom] == mjGEOM_PLANE; }

// Until when each obstacle is watched: a little after it is nearest to the robot's base.
std::vector<EpisodeTime> EndsOfApproach(const TraceModel& trace, const Eigen::Vector3d& p_WBase) {
  std::vector<EpisodeTime> ends(trace.recording().obstacles.size());
  std::vector<double> nearest_m(ends.size(), std::numeric_limits<double>::infinity());
  const double end_s = std::min(kWatched_s, EndOf(trace.recording()).seconds());
  for (double t_s = 0; t_s <= end_s; t_s += kStep_s / 5) {
    const std::vector<Pose> poses = ObstaclesAt(trace.recording(), EpisodeTime(t_s));
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const double distance_m = (poses[i].translation() - p_WBase).norm();
      if (distance_m >= nearest_m[i]) continue;
      nearest_m[i] = distance_m;
      ends[i] = EpisodeTime(std::min(end_s, t_s + kAfterPassing_s));
    }
  }
  return ends;
}

struct Moment {
  TraceModel* trace;
  EpisodeTime t;
};

// Every kStep_s, of each trace.
std::vector<Moment> Moments(const std::vector<TraceModel*>& traces) {
  std::vector<Moment> moments;
  for (TraceModel* const trace : traces) {
    const double end_s = std::min(kWatched_s, EndOf(trace->recording()).seconds());
    for (double t_s = 0; t_s <= end_s; t_s += kStep_s) {
      moments.push_back({trace, EpisodeTime(t_s)});
    }
  }
  return moments;
}

Eigen::Vector3d BasePosition(const TraceModel& trace) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (int geom = 0; geom < trace.model().ngeom; ++geom) {
    if (!trace.IsRobot(geom)) continue;
    sum += Eigen::Map<const Eigen::Vector3d>(trace.data().geom_xpos + 3 * geom);
    ++count;
  }
  return count == 0 ? sum : Eigen::Vector3d(sum / count);
}

Eigen::Matrix3Xd PointsToShow(const std::vector<TraceModel*>& traces) {
  Points points;
  for (TraceModel* const trace : traces) {
    trace->MoveTo(EpisodeTime(0));
    const std::vector<EpisodeTime> ends = EndsOfApproach(*trace, BasePosition(*trace));
    for (const Moment& moment : Moments({trace})) {
      trace->MoveTo(moment.t);
      for (int geom = 0; geom < trace->model().ngeom; ++geom) {
        if (IsPlane(trace->model(), geom)) continue;
        const int obstacle = trace->ObstacleOf(geom);
        if (obstacle >= 0 && moment.t > ends[static_cast<std::size_t>(obstacle)]) continue;
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

// The share of the arms' geoms that nothing hides from each of the views.
std::vector<double> Visibility(const std::vector<Moment>& moments,
                               const std::vector<CameraView>& views) {
  std::vector<double> seen(views.size(), 0);
  int count = 0;
  const mjtByte drawn_groups[mjNGROUP] = {1, 1, 1, 0, 0, 0};
  for (const Moment& moment : moments) {
    moment.trace->MoveTo(moment.t);
    const mjModel& model = moment.trace->model();
    const mjData& data = moment.trace->data();
    for (int geom = 0; geom < model.ngeom; ++geom) {
      if (!moment.trace->IsRobot(geom) || model.geom_group[geom] > 2) continue;
      ++count;
      for (std::size_t i = 0; i < views.size(); ++i) {
        const Eigen::Vector3d from = views[i].position_m();
        const Eigen::Vector3d ray =
            Eigen::Map<const Eigen::Vector3d>(data.geom_xpos + 3 * geom) - from;
        int hit = -1;
        const double share = mj_ray(&model, &data, from.data(), ray.data(), drawn_groups,
                                    /*flg_static=*/1, /*bodyexclude=*/-1, &hit);
        if (hit < 0 || share >= 1 || moment.trace->IsRobot(hit)) ++seen[i];
      }
    }
  }
  for (double& share : seen) share /= std::max(1, count);
  return seen;
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
    views.push_back(FitCamera(points, azimuth_rad, kElevation_rad, frustum));
    least_distance_m = std::min(least_distance_m, views.back().distance_m);
  }
  const std::vector<double> visibility = Visibility(Moments(traces), views);
  const Eigen::Vector3d travel = DirectionOfTravel(traces);
  std::size_t best = 0;
  double best_score = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < views.size(); ++i) {
    const double across = travel.cross(views[i].forward()).norm();
    const double size = least_distance_m / views[i].distance_m;
    const double score = visibility[i] + 0.3 * across + 0.5 * size;
    if (score > best_score) {
      best_score = score;
      best = i;
    }
  }
  return views[best];
}

}  // namespace sidestep
