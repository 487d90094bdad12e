#include "sidestep/bench/episode_recorder.h"

#include <algorithm>
#include <string>
#include <utility>

#include "sidestep/robot/tolerance_scale.h"
#include "sidestep/scenarios/yaml_text.h"

namespace sidestep::bench {
namespace {

// The robot's times these; scales are infinite where nothing was asked for.
record::MotionLimits LimitsOf(const robot::RobotModel& robot, double v_scale = 1,
                              double a_scale = 1) {
  const Eigen::Index n = robot.num_joints();
  record::MotionLimits limits = {Eigen::VectorXd(n), Eigen::VectorXd(n), Eigen::VectorXd(n),
                                 Eigen::VectorXd(n)};
  for (Eigen::Index j = 0; j < n; ++j) {
    const robot::JointLimits& joint = robot.limits()[static_cast<std::size_t>(j)];
    limits.v_max(j) = v_scale * joint.v_max;
    limits.a_max(j) = a_scale * joint.a_max;
    limits.jerk_max(j) = joint.jerk_max;
    limits.torque_rate_max(j) = joint.torque_rate_max;
  }
  return limits;
}

record::Recording BeginRecording(const scenarios::Scenario& scenario,
                                 const robot::RobotModel& robot, const EpisodeWorld& world) {
  record::Recording recording;
  recording.header = {{"scenario", scenario.name},       {"robot", robot.name()},
                      {"planner", scenario.planner},     {"knowledge", scenario.knowledge},
                      {"predictor", scenario.predictor}, {"seed", std::to_string(scenario.seed)}};
  recording.header.insert(world.facts.begin(), world.facts.end());
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
  recording.tolerance_scale = robot::ToleranceScale(robot);
  recording.robot_limits = LimitsOf(robot);
  recording.limits =
      LimitsOf(robot, scenario.velocity_limits ? scenario.velocity_scale : record::kNoLimit,
               scenario.acceleration_limits ? scenario.acceleration_scale : record::kNoLimit);
  recording.tool_a_max = robot.tool_limits().a_max;
  recording.tool_a_reflex = robot.tool_limits().a_reflex;
  return recording;
}

}  // namespace

EpisodeRecorder::EpisodeRecorder(const scenarios::Scenario& scenario,
                                 const robot::RobotModel& robot, const EpisodeWorld& world)
    : robot_(robot), recording_(BeginRecording(scenario, robot, world)) {}

void EpisodeRecorder::Keep(ControlSample tick) {
  recording_.p_WTool.push_back(robot_.ComputeToolPose(tick.q_command).translation());
  recording_.control.push_back(std::move(tick));
}

void EpisodeRecorder::Keep(const std::vector<Scan>& scans, EpisodeTime t_arrival,
                           std::span<const std::size_t> changed_cells) {
  record::ObservationRecord& record = recording_.observations.emplace_back();
  record.t = scans.front().t;
  record.t_arrival = t_arrival;
  record.changed_cells.assign(changed_cells.begin(), changed_cells.end());
  for (const Scan& scan : scans) {
    for (const ObjectObservation& object : scan.objects) {
      record.objects.push_back({object.id, object.X_WO, object.covariance});
    }
  }
}

}  // namespace sidestep::bench
