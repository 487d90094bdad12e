#include "sidestep/render/timeline.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sidestep/record/questions.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::render {
namespace {

// Where `t` falls among increasing times: between `before` and `after`, `share` of the way.
struct Position {
  std::size_t before = 0, after = 0;
  double share = 0;
};

template <typename Samples, typename GetTime>
Position Locate(const Samples& samples, EpisodeTime t, GetTime time_of) {
  const auto next = std::upper_bound(
      samples.begin(), samples.end(), t,
      [&](EpisodeTime moment, const auto& sample) { return moment < time_of(sample); });
  const auto after = static_cast<std::size_t>(next - samples.begin());
  if (after == 0) return {0, 0, 0};
  if (after == samples.size()) return {after - 1, after - 1, 0};
  const EpisodeTime begin = time_of(samples[after - 1]), end = time_of(samples[after]);
  return {after - 1, after, (t - begin).seconds() / (end - begin).seconds()};
}

Pose Between(const Pose& a, const Pose& b, double share) {
  return Pose(a.rotation().slerp(share, b.rotation()),
              a.translation() + share * (b.translation() - a.translation()));
}

std::vector<Pose> PrescribedAt(const record::Recording& recording, EpisodeTime t) {
  std::vector<Pose> poses;
  if (recording.scenario_yaml.empty()) return poses;
  const auto scenario = scenarios::ParseScenario(recording.scenario_yaml, "the recorded scenario");
  for (const scenarios::MovingObstacle& obstacle : scenario.moving_obstacles) {
    poses.push_back(scenarios::PoseAt(obstacle, t));
  }
  return poses;
}

// By a camera that sees what is there; what it never saw is as prescribed at first.
std::vector<Pose> SeenAt(const record::Recording& recording, EpisodeTime t) {
  std::vector<Pose> poses = PrescribedAt(recording, EpisodeTime(0));
  for (std::size_t i = 0; i < std::min(poses.size(), recording.obstacles.size()); ++i) {
    bool was_seen = false;
    for (const record::ObservationRecord& scan : recording.observations) {
      if (was_seen && scan.t > t) break;
      for (const record::SeenObject& object : scan.objects) {
        if (object.id != recording.obstacles[i]) continue;
        poses[i] = object.X_WO;
        was_seen = true;
      }
    }
  }
  return poses;
}

bool IsSeenByCamera(const record::Recording& recording) {
  return recording.truth.empty() && recording.header.contains("camera");
}

// From picture to picture, the error of a place would count as much as the way.
double SeenSpeedAt(const record::Recording& recording, EpisodeTime t) {
  constexpr HorizonOffset kWindow(0.25);
  double fastest_m_s = std::numeric_limits<double>::quiet_NaN();
  for (const std::string& obstacle : recording.obstacles) {
    std::vector<EpisodeTime> times;
    std::vector<Eigen::Vector3d> p_WO;
    for (const record::ObservationRecord& scan : recording.observations) {
      if (scan.t > t) break;
      if (scan.t < t - kWindow) continue;
      for (const record::SeenObject& object : scan.objects) {
        if (object.id != obstacle) continue;
        times.push_back(scan.t);
        p_WO.push_back(object.X_WO.translation());
      }
    }
    if (times.empty() || times.back() <= times.front()) continue;
    const double way_m = (p_WO.back() - p_WO.front()).norm();
    fastest_m_s = std::fmax(fastest_m_s, way_m / (times.back() - times.front()).seconds());
  }
  return fastest_m_s;
}

template <typename Sample>
EpisodeTime TimeOfSample(const Sample& sample) {
  return sample.t;
}

}  // namespace

Eigen::VectorXd JointsAt(const record::Recording& recording, EpisodeTime t) {
  const Position at = Locate(recording.control, t, TimeOfSample<ControlSample>);
  const Eigen::VectorXd& q0 = recording.control[at.before].q;
  return q0 + at.share * (recording.control[at.after].q - q0);
}

Pose PoseAt(const std::vector<EpisodeTime>& times, const std::vector<Pose>& poses, EpisodeTime t) {
  const Position at = Locate(times, t, [](EpisodeTime time) { return time; });
  return Between(poses[at.before], poses[at.after], at.share);
}

std::vector<Pose> ObstaclesAt(const record::Recording& recording, EpisodeTime t) {
  if (recording.truth.empty()) {
    return IsSeenByCamera(recording) ? SeenAt(recording, t) : PrescribedAt(recording, t);
  }
  std::vector<Pose> poses;
  const Position at = Locate(recording.truth, t, TimeOfSample<TruthSample>);
  const std::vector<Pose>& before = recording.truth[at.before].X_WO;
  const std::vector<Pose>& after = recording.truth[at.after].X_WO;
  for (std::size_t i = 0; i < before.size(); ++i) {
    poses.push_back(Between(before[i], after[i], at.share));
  }
  return poses;
}

double ObstacleSpeedAt(const record::Recording& recording, EpisodeTime t) {
  if (IsSeenByCamera(recording)) return SeenSpeedAt(recording, t);
  constexpr HorizonOffset kHalfWindow(0.025);
  const EpisodeTime begin = std::max(EpisodeTime(0), t - kHalfWindow);
  const EpisodeTime end = std::min(record::EndOf(recording), t + kHalfWindow);
  if (end <= begin) return 0;
  const std::vector<Pose> first = ObstaclesAt(recording, begin);
  const std::vector<Pose> last = ObstaclesAt(recording, end);
  double distance_m = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    distance_m = std::max(distance_m, (last[i].translation() - first[i].translation()).norm());
  }
  return distance_m / (end - begin).seconds();
}

const CycleRecord* CycleInForce(const record::Recording& recording, EpisodeTime t) {
  const CycleRecord* in_force = nullptr;
  for (const CycleRecord& cycle : recording.cycles) {
    if (cycle.accepted && cycle.plan.num_states() > 0 && cycle.t_effect <= t) in_force = &cycle;
  }
  return in_force;
}

}  // namespace sidestep::render
