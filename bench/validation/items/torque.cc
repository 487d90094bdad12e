// The motors can do what is asked of them.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "sidestep/bench/validation/support.h"
#include "sidestep/record/questions.h"

namespace sidestep::bench {
namespace {

constexpr double kMostTorque = 0.95, kMostRate = 1.0;

Facts MeasureTorque(const ValidationRun& run) {
  // What is run into is pushed.
  if (run.one.on_the_wire || record::FirstTouch(run.result.recording)) return {};
  double use = 0;
  for (const ControlSample& tick : run.result.recording.control) {
    for (int j = 0; j < run.robot.num_joints(); ++j) {
      const double most = run.robot.limits()[static_cast<std::size_t>(j)].torque_max;
      use = std::max(use, std::abs(tick.torque(j)) / most);
    }
  }
  return {{"torque_use", use},
          {"torque_rate_use", run.result.recording.metrics.at("commanded_torque_rate_use")}};
}

ItemFinding JudgeTorque(const Evidence& evidence) {
  const std::vector<Told> torques = LargestFirst(evidence, "torque_use", IsWithinEnvelope);
  const std::vector<Told> rates = LargestFirst(evidence, "torque_rate_use", IsWithinEnvelope);
  if (torques.empty() || rates.empty()) return NothingRun("the robot has no such limits");
  ItemFinding finding{ItemVerdict::kPass, "", {}};
  finding.evidence = fmt::format(
      "at most {:.0f} % of the torque and {:.0f} % of its rate, by the simulated motors",
      100 * torques.front().value, 100 * rates.front().value);
  if (torques.front().value > kMostTorque) {
    finding.verdict = ItemVerdict::kFail;
    finding.worst = WorstOf(torques, kMostTorque, "{:.2f} of the torque");
  }
  if (rates.front().value > kMostRate) {
    finding.verdict = ItemVerdict::kFail;
    for (const NamedCase& one : WorstOf(rates, kMostRate, "{:.2f} of the rate")) {
      finding.worst.push_back(one);
    }
  }
  return finding;
}

}  // namespace

ValidationItem TorqueItem() {
  return {5,
          "torques",
          "at most 95 % of the robot's torque limits, which gravity alone comes near at full "
          "reach; their rate within its limit",
          "the robot's table of limits; inertias of franka_description",
          MeasureTorque,
          JudgeTorque};
}

}  // namespace sidestep::bench
