#include "tests/support/full_recording.h"

#include <cmath>
#include <limits>

namespace sidestep {
namespace {

Pose TurnedPose(double angle, double x) {
  return Pose(
      Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d(1, -2, 0.5).normalized())),
      {x, -x, 2 * x});
}

}  // namespace

record::Recording FullRecording(int num_control) {
  record::Recording recording;
  recording.header = {{"knowledge", "prediction"}, {"scenario", "allée à piétons"}, {"empty", ""}};
  recording.scenario_yaml = "name: test\nspeed: 1.4\n";
  recording.model_xml = "<mujoco/>";
  recording.joints = {"shoulder", "elbow"};
  recording.obstacles = {"trolley", "ball", "door"};
  recording.q_start = Eigen::Vector2d(0.1, -0.2);
  recording.q_goal = Eigen::Vector2d(1.0 / 3, std::nextafter(1.0, 2.0));
  recording.dwell_s = 0.25;
  recording.tolerance_scale = Eigen::Vector2d(1, 0.25);
  recording.robot_limits = {Eigen::Vector2d(2.175, 2.61), Eigen::Vector2d(15, 7.5),
                            Eigen::Vector2d(7501, 3750), Eigen::Vector2d(1001, 901)};
  recording.tool_a_max = 13;
  recording.limits = {Eigen::Vector2d(2.1, 2.6), Eigen::Vector2d(7.5, 3.75),
                      Eigen::Vector2d(7500, std::numeric_limits<double>::infinity()),
                      Eigen::Vector2d(1000, 900)};
  for (int i = 0; i < num_control; ++i) {
    ControlSample sample;
    sample.t = EpisodeTime(0.001 * i);
    sample.q_command = Eigen::Vector2d(i, 0.5 * i);
    sample.v_command = Eigen::Vector2d(i + 0.1, -i);
    sample.a_command = Eigen::Vector2d(std::sin(i), std::cos(i));
    sample.q = Eigen::Vector2d(i + 0.2, 1e-300 * i);
    sample.v = Eigen::Vector2d(i + 0.3, -0.0);
    sample.torque = Eigen::Vector2d(i + 0.4, 1e300);
    recording.control.push_back(sample);
    recording.p_WTool.push_back({std::sin(i), 0.1 * i, -1.0 / (i + 1)});
  }
  for (int i = 0; i < 3; ++i) {
    TruthSample sample;
    sample.t = EpisodeTime(0.01 * i);
    sample.clearance_m = 0.1 - 0.07 * i;
    sample.nearest_robot_part = i == 0 ? "hand" : "forearm";
    sample.nearest_object = i == 0 ? "table" : "trolley";
    sample.in_contact = i == 2;
    if (sample.in_contact) {
      sample.contact_s = 0.0195;
      sample.contact_object = "trolley";
      sample.p_WContact = {0.7, -0.8, 0.9};
    }
    for (int k = 0; k < 3; ++k) sample.X_WO.push_back(TurnedPose(0.3 * i + k, i - 2.0 * k));
    recording.truth.push_back(sample);
  }
  for (int i = 0; i < 3; ++i) {
    CycleRecord cycle;
    cycle.t = EpisodeTime(0.1 * i);
    cycle.t_effect = EpisodeTime(0.1 * i + 0.1);
    cycle.status = i == 1 ? "not_converged" : "solved";
    cycle.accepted = i != 1;
    cycle.iterations = 7 + i;
    cycle.cut_short = i == 1;
    cycle.cost = 12.5 * i;
    cycle.predicted_clearance_m = 0.04 - i;
    cycle.samples_outside_grid = 5 * i;
    cycle.plan_start = EpisodeTime(0.1 * i + 0.05);
    if (i != 1) {
      const int num_states = 3 + i;
      cycle.plan.t_s = Eigen::VectorXd::LinSpaced(num_states, 0, 3);
      cycle.plan.q = Eigen::MatrixXd::Constant(2, num_states, 0.25 * i);
      cycle.plan.q(1, 2) = 9;
      cycle.plan.v = cycle.plan.q.array() + 1;
    }
    for (int k = 0; k < i; ++k) {
      PredictedObject object;
      object.id = 10 * i + k;
      object.half_extents_m = {0.1 + k, 0.2 + k, 0.3 + k};
      for (int m = 0; m <= k; ++m) {
        object.t.push_back(EpisodeTime(0.1 * i + 0.5 * m));
        object.X_WO.push_back(TurnedPose(0.1 * m, 3 + m));
      }
      cycle.objects.push_back(object);
    }
    recording.cycles.push_back(cycle);
  }
  recording.events = {{EpisodeTime(0.1), "appeared", 1, 0, {0.4, 2, 0.6}},
                      {EpisodeTime(0.3), "merged", 2, 1, {0.5, 1, 0.7}}};
  recording.safety = {{EpisodeTime(0.05), "perception_stale", "hold", 0.31, 0.3},
                      {EpisodeTime(0.2), "stop_path", "brake", -0.01, 0}};
  for (int i = 0; i < 3; ++i) {
    record::ObservationRecord observation;
    observation.t = EpisodeTime(0.1 * i);
    observation.t_arrival = EpisodeTime(0.1 * i + 0.05);
    for (int k = 0; k < 2 * i; ++k) observation.changed_cells.push_back(100 * i + k);
    for (int k = 0; k < 2 - i; ++k) {
      record::SeenObject object;
      object.id = k == 0 ? "trolley" : "ball";
      object.X_WO = TurnedPose(0.2 * k, i + k);
      object.covariance.setConstant(0.1 * i + k);
      observation.objects.push_back(object);
    }
    recording.observations.push_back(observation);
  }
  recording.metrics = {{"min_clearance_m", -0.04},
                       {"time_to_goal_s", std::numeric_limits<double>::quiet_NaN()}};
  return recording;
}

}  // namespace sidestep
