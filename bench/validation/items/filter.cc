// What a camera says of its own errors is true.
#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "sidestep/bench/validation/support.h"

namespace sidestep::bench {
namespace {

constexpr const char* kCamera = "tag_images";
constexpr double kInside = 7.815;  // 95 % of chi^2 with 3 degrees of freedom
constexpr double kLeastInsideShare = 0.90;

// True poses at `t`, interpolated linearly between samples of 100 Hz.
Eigen::Vector3d TruePosition(const record::Recording& recording, std::size_t obstacle,
                             EpisodeTime t) {
  const std::vector<TruthSample>& truth = recording.truth;
  const auto next =
      std::lower_bound(truth.begin(), truth.end(), t,
                       [](const TruthSample& sample, EpisodeTime at) { return sample.t < at; });
  if (next == truth.begin()) return truth.front().X_WO[obstacle].translation();
  if (next == truth.end()) return truth.back().X_WO[obstacle].translation();
  const TruthSample &a = *std::prev(next), &b = *next;
  const double share = (t - a.t).seconds() / (b.t - a.t).seconds();
  return (1 - share) * a.X_WO[obstacle].translation() + share * b.X_WO[obstacle].translation();
}

Facts MeasureFilter(const ValidationRun& run) {
  const record::Recording& recording = run.result.recording;
  if (run.scenario.sensor.name != kCamera || recording.truth.empty()) return {};
  double seen = 0, inside = 0;
  for (const record::ObservationRecord& scan : recording.observations) {
    for (const record::SeenObject& object : scan.objects) {
      const auto& obstacles = run.scenario.moving_obstacles;
      const auto is_it = [&](const auto& obstacle) { return obstacle.name == object.id; };
      const auto found = std::find_if(obstacles.begin(), obstacles.end(), is_it);
      if (found == obstacles.end()) continue;
      const auto index = static_cast<std::size_t>(found - obstacles.begin());
      const Eigen::Vector3d error =
          object.X_WO.translation() - TruePosition(recording, index, scan.t);
      const Eigen::Matrix3d covariance = object.covariance.topLeftCorner<3, 3>();
      const double nees = error.dot(covariance.ldlt().solve(error));
      ++seen;
      inside += nees <= kInside ? 1 : 0;
    }
  }
  return {{"poses_seen", seen}, {"poses_inside_95", inside}};
}

ItemFinding JudgeFilter(const Evidence& evidence) {
  if (evidence.scenario.sensor.name != kCamera) {
    return NothingRun(
        "no camera in this scenario: errors of a noise model are as they are said to be");
  }
  const auto is_nominal = [](const RunRow& row) {
    return IsOfGroup(row, validation_group::kEnvelope);
  };
  const double seen = SumOf(LargestFirst(evidence, "poses_seen", is_nominal));
  const std::vector<Told> told = LargestFirst(evidence, "poses_inside_95", is_nominal);
  if (seen == 0) return NothingRun("the camera saw no tag");
  const double share = SumOf(told) / seen;
  ItemFinding finding;
  finding.verdict = share >= kLeastInsideShare ? ItemVerdict::kPass : ItemVerdict::kFail;
  finding.evidence = fmt::format(
      "{:.1f} % of {:.0f} poses that the camera told lie within its own 95 % of the truth",
      100 * share, seen);
  return finding;
}

}  // namespace

ValidationItem FilterItem() {
  return {16,
          "consistency of what the camera says",
          "90 % of poses within the 95 % ellipsoid of their covariance",
          "chi-squared test of normalised errors",
          MeasureFilter,
          JudgeFilter};
}

}  // namespace sidestep::bench
