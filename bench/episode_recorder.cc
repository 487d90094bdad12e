#include "sidestep/bench/episode_recorder.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>

#include "sidestep/scenarios/yaml_text.h"

namespace sidestep::bench {
namespace {

// Appends the indices at which two grids of one size differ. Most of a scan is as it was, and most
// of the time of a plain loop would go into finding that out.
void AppendChanges(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& now,
                   std::vector<std::int64_t>& changed) {
  constexpr std::size_t kBlock = 256;
  for (std::size_t begin = 0; begin < now.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, now.size());
    if (std::memcmp(&before[begin], &now[begin], end - begin) == 0) continue;
    for (std::size_t i = begin; i < end; ++i) {
      if (now[i] != before[i]) changed.push_back(static_cast<std::int64_t>(i));
    }
  }
}

record::AskedLimits LimitsAskedFor(const scenarios::Scenario& scenario,
                                   const robot::RobotModel& robot) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const double v_scale = scenario.velocity_limits ? scenario.velocity_scale : kNone;
  const double a_scale = scenario.acceleration_limits ? scenario.acceleration_scale : kNone;
  const Eigen::Index n = robot.num_joints();
  record::AskedLimits asked = {Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n),
                               Eigen::VectorXd(n)};
  for (Eigen::Index j = 0; j < n; ++j) {
    const robot::JointLimits& joint = robot.limits()[static_cast<std::size_t>(j)];
    asked.v_max(j) = v_scale * joint.v_max;
    asked.a_max(j) = a_scale * joint.a_max;
    asked.jerk_max(j) = joint.jerk_max;
    asked.torque_rate_max(j) = joint.torque_rate_max;
  }
  return asked;
}

record::Recording BeginRecording(const scenarios::Scenario& scenario,
                                 const robot::RobotModel& robot, const EpisodeWorld& world) {
  record::Recording recording;
  recording.header = {{"scenario", scenario.name},       {"robot", robot.name()},
                      {"planner", scenario.planner},     {"knowledge", scenario.knowledge},
                      {"predictor", scenario.predictor}, {"seed", std::to_string(scenario.seed)}};
  for (const auto& [choice, chosen] : scenario.choices) {
    recording.header["choice." + choice] = chosen;
  }
  for (const auto& [key, value] : scenario.drawn) {
    recording.header["drawn." + key] = scenarios::Number(value);
  }
  recording.scenario_yaml = scenarios::ToYaml(scenario);
  recording.model_xml = world.model_xml;
  recording.joints = world.joints;
  recording.obstacles = world.obstacles;
  recording.q_start = scenario.q_start;
  recording.q_goal = scenario.q_goal;
  recording.dwell_s = scenario.dwell_s;
  recording.v_max.resize(robot.num_joints());
  for (int i = 0; i < robot.num_joints(); ++i) {
    recording.v_max(i) = robot.limits()[static_cast<std::size_t>(i)].v_max;
  }
  recording.limits = LimitsAskedFor(scenario, robot);
  return recording;
}

}  // namespace

EpisodeRecorder::EpisodeRecorder(const scenarios::Scenario& scenario,
                                 const robot::RobotModel& robot, const EpisodeWorld& world)
    : recording_(BeginRecording(scenario, robot, world)) {}

void EpisodeRecorder::Keep(const Scan& scan, EpisodeTime t_arrival,
                           const OccupancyGrid& occupancy) {
  record::ObservationRecord& record = recording_.observations.emplace_back();
  record.t = scan.t;
  record.t_arrival = t_arrival;
  const std::vector<std::uint8_t>& cells = occupancy.cells;
  last_cells_.resize(cells.size(), 0);
  AppendChanges(last_cells_, cells, record.changed_cells);
  last_cells_ = cells;
  for (const ObjectObservation& object : scan.objects) {
    record.objects.push_back({object.id, object.X_WO, object.covariance});
  }
}

}  // namespace sidestep::bench
