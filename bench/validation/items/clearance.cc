// How near the arm comes to what moves, as long as it moves itself.
#include <fmt/core.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sidestep/bench/validation/support.h"
#include "sidestep/record/questions.h"

namespace sidestep::bench {
namespace {

constexpr double kNear_m = 0.05, kMostNear = 0.01, kCalibration_m = 0.01, kSureSigmas = 2;

// The standard deviation of where a scan says that things are, in its worst direction.
double SigmaOf(const record::ObservationRecord& scan) {
  double most_m2 = 0;
  for (const record::SeenObject& object : scan.objects) {
    const Eigen::Matrix3d covariance = object.covariance.topLeftCorner<3, 3>();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance, Eigen::EigenvaluesOnly);
    most_m2 = std::max(most_m2, solver.eigenvalues().maxCoeff());
  }
  return std::sqrt(most_m2);
}

Facts MeasureClearance(const ValidationRun& run) {
  const record::Recording& recording = run.result.recording;
  if (recording.truth.empty()) return {};
  double least_m = std::numeric_limits<double>::infinity(), sure_m = least_m, sigma_m = 0;
  int moving = 0, near = 0;
  auto scan = recording.observations.begin();
  for (const TruthSample& sample : recording.truth) {
    for (; scan != recording.observations.end() && scan->t_arrival <= sample.t; ++scan) {
      sigma_m = SigmaOf(*scan);
    }
    const ControlSample* const tick = record::TickAt(recording, sample.t);
    if (tick == nullptr || !IsToldToMove(*tick)) continue;
    const double distance_m = DistanceToObstacles(run.scenario, run.robot, tick->q, sample.X_WO);
    least_m = std::min(least_m, distance_m);
    sure_m = std::min(sure_m, distance_m - kSureSigmas * sigma_m - kCalibration_m);
    ++moving;
    near += distance_m < kNear_m ? 1 : 0;
  }
  if (moving == 0) return {{"samples_in_motion", 0.0}, {"samples_near", 0.0}};
  return {{"samples_in_motion", static_cast<double>(moving)},
          {"samples_near", static_cast<double>(near)},
          {"lack_of_clearance_m", -least_m},
          {"sure_lack_of_clearance_m", -sure_m}};
}

ItemFinding JudgeClearance(const Evidence& evidence) {
  const std::vector<Told> lack = LargestFirst(evidence, "lack_of_clearance_m", IsEnvelopeOrSoak);
  const std::vector<Told> sure =
      LargestFirst(evidence, "sure_lack_of_clearance_m", IsEnvelopeOrSoak);
  if (lack.empty()) return NothingRun("the arm never moved where its clearance is known");
  const double moving = SumOf(LargestFirst(evidence, "samples_in_motion", IsEnvelopeOrSoak));
  const double near = SumOf(LargestFirst(evidence, "samples_near", IsEnvelopeOrSoak));
  ItemFinding finding;
  const bool passes = near <= kMostNear * moving && sure.front().value < 0;
  finding.verdict = passes ? ItemVerdict::kPass : ItemVerdict::kFail;
  finding.evidence = fmt::format(
      "as long as the arm moved, it was at least {:.0f} mm from what moves, and nearer than 50 mm "
      "for {:.2f} % of the time; at least {:.0f} mm are left of that if perception is off by two "
      "standard deviations and calibration by 10 mm",
      -1e3 * lack.front().value, 100 * near / moving, -1e3 * sure.front().value);
  for (const Told& one : lack) {
    if (finding.worst.size() == 3) break;
    finding.worst.push_back({NameOf(*one.row), fmt::format("{:.0f} mm", -1e3 * one.value)});
  }
  return finding;
}

}  // namespace

ValidationItem ClearanceItem() {
  return {7,
          "clearance of a moving arm",
          "1st percentile at least 50 mm; more than 0 less 2 sigma of perception and 10 mm of "
          "calibration",
          "capsules that cover the arm, true obstacles; noise of tags as published",
          MeasureClearance,
          JudgeClearance};
}

}  // namespace sidestep::bench
