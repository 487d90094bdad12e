// The arm stays away from the ends of its joints.
#include <fmt/core.h>

#include <algorithm>
#include <limits>

#include "sidestep/bench/validation/support.h"

namespace sidestep::bench {
namespace {

constexpr double kRounding_rad = 1e-6;

Facts MeasureJointMargin(const ValidationRun& run) {
  double least_rad = std::numeric_limits<double>::infinity();
  for (const ControlSample& tick : run.result.recording.control) {
    for (int j = 0; j < run.robot.num_joints(); ++j) {
      const robot::JointLimits& limit = run.robot.limits()[static_cast<std::size_t>(j)];
      least_rad =
          std::min({least_rad, tick.q_command(j) - limit.q_min, limit.q_max - tick.q_command(j)});
    }
  }
  return {{"joint_excess_rad", -least_rad}};  // the larger, the worse
}

ItemFinding JudgeJointMargin(const Evidence& evidence) {
  const std::vector<Told> told = LargestFirst(evidence, "joint_excess_rad", [](const auto& row) {
    return !IsOfGroup(row, validation_group::kPrediction);
  });
  if (told.empty()) return NothingRun("no episode was run");
  ItemFinding finding;
  const double least_rad = -told.front().value;
  finding.verdict =
      least_rad >= kLeastJointMargin_rad - kRounding_rad ? ItemVerdict::kPass : ItemVerdict::kFail;
  finding.evidence = fmt::format("at least {:.3f} rad from the ends of the joints", least_rad);
  for (const NamedCase& one : WorstOf(told, -kLeastJointMargin_rad + kRounding_rad, "{:.3f}")) {
    finding.worst.push_back({one.name, one.what.substr(1) + " rad"});
  }
  return finding;
}

}  // namespace

ValidationItem JointMarginItem() {
  return {3,
          "distance from the ends of the joints",
          "at least 0.1 rad",
          "the warning of franka_ros (joint_limit_warning_threshold)",
          MeasureJointMargin,
          JudgeJointMargin};
}

}  // namespace sidestep::bench
