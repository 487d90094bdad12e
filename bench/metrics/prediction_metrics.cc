#include "sidestep/bench/metrics/prediction_metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "sidestep/sdf/tracking/object_tracker.h"

namespace sidestep::bench {
namespace {

constexpr double kRecordedEpsilon_s = 1e-9;  // s; recorded times are sums of steps, rounded

Eigen::Vector3d Interpolated(double t, double t0, const Eigen::Vector3d& p0, double t1,
                             const Eigen::Vector3d& p1) {
  return t1 > t0 ? Eigen::Vector3d(p0 + (t - t0) / (t1 - t0) * (p1 - p0)) : p0;
}

// The first entry of a series at or after t, if t lies within it.
template <class Series, class TimeOf>
std::optional<std::size_t> FindAtOrAfter(const Series& series, EpisodeTime t, TimeOf time_of) {
  const auto found = std::partition_point(series.begin(), series.end(), [&](const auto& entry) {
    return time_of(entry).seconds() < t.seconds() - kRecordedEpsilon_s;
  });
  if (found == series.end()) return std::nullopt;
  const bool before_all =
      found == series.begin() && time_of(*found).seconds() > t.seconds() + kRecordedEpsilon_s;
  if (before_all) return std::nullopt;
  return static_cast<std::size_t>(found - series.begin());
}

// Where every obstacle truly was; empty outside the recording.
std::vector<Eigen::Vector3d> TruePositions(const record::Recording& recording, EpisodeTime t) {
  const auto after =
      FindAtOrAfter(recording.truth, t, [](const TruthSample& sample) { return sample.t; });
  if (!after) return {};
  const TruthSample& next = recording.truth[*after];
  const TruthSample& previous = recording.truth[std::max<std::size_t>(*after, 1) - 1];
  std::vector<Eigen::Vector3d> positions;
  for (std::size_t i = 0; i < next.X_WO.size(); ++i) {
    positions.push_back(Interpolated(t.seconds(), previous.t.seconds(),
                                     previous.X_WO[i].translation(), next.t.seconds(),
                                     next.X_WO[i].translation()));
  }
  return positions;
}

std::optional<Eigen::Vector3d> PredictedPosition(const PredictedObject& object, EpisodeTime t) {
  const auto after = FindAtOrAfter(object.t, t, [](EpisodeTime time) { return time; });
  if (!after) return std::nullopt;
  const std::size_t before = std::max<std::size_t>(*after, 1) - 1;
  return Interpolated(t.seconds(), object.t[before].seconds(), object.X_WO[before].translation(),
                      object.t[*after].seconds(), object.X_WO[*after].translation());
}

}  // namespace

double ThingsMoved(const record::Recording& recording) {
  return static_cast<double>(std::count_if(
      recording.events.begin(), recording.events.end(),
      [](const TrackEvent& event) { return event.what == sdf::track_event::kMoved; }));
}

double PredictionError(const record::Recording& recording, HorizonOffset ahead) {
  double sum = 0, count = 0;
  for (const CycleRecord& cycle : recording.cycles) {
    const std::vector<Eigen::Vector3d> now = TruePositions(recording, cycle.t);
    const std::vector<Eigen::Vector3d> then = TruePositions(recording, cycle.t + ahead);
    if (now.empty() || then.empty()) continue;
    for (const PredictedObject& object : cycle.objects) {
      const auto seen = PredictedPosition(object, cycle.t);
      const auto predicted = PredictedPosition(object, cycle.t + ahead);
      if (!seen || !predicted) continue;
      const auto nearest = std::min_element(
          now.begin(), now.end(),
          [&](const auto& a, const auto& b) { return (a - *seen).norm() < (b - *seen).norm(); });
      sum += (*predicted - then[static_cast<std::size_t>(nearest - now.begin())]).squaredNorm();
      ++count;
    }
  }
  return count > 0 ? std::sqrt(sum / count) : std::numeric_limits<double>::quiet_NaN();
}

double PredictionErrorAfter100Ms(const record::Recording& recording) {
  return PredictionError(recording, HorizonOffset(0.1));
}
double PredictionErrorAfter300Ms(const record::Recording& recording) {
  return PredictionError(recording, HorizonOffset(0.3));
}
double PredictionErrorAfter500Ms(const record::Recording& recording) {
  return PredictionError(recording, HorizonOffset(0.5));
}
double PredictionErrorAfter1000Ms(const record::Recording& recording) {
  return PredictionError(recording, HorizonOffset(1));
}
double PredictionErrorAfter2000Ms(const record::Recording& recording) {
  return PredictionError(recording, HorizonOffset(2));
}

}  // namespace sidestep::bench
