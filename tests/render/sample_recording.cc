#include "tests/render/sample_recording.h"

#include <algorithm>
#include <cmath>

namespace sidestep::render {
namespace {

constexpr const char* kModel = R"(
<mujoco model="sample">
  <visual>
    <headlight ambient="0.35 0.35 0.35" diffuse="0.35 0.35 0.35" specular="0 0 0"/>
  </visual>
  <asset>
    <texture type="skybox" builtin="gradient" rgb1="0.85 0.89 0.94" rgb2="0.6 0.68 0.78"
             width="64" height="64"/>
    <texture name="tiles" type="2d" builtin="checker" rgb1="0.80 0.81 0.83"
             rgb2="0.74 0.75 0.78" width="256" height="256"/>
    <material name="tiles" texture="tiles" texrepeat="12 12"/>
  </asset>
  <worldbody>
    <light pos="1 1 4" dir="-0.2 -0.2 -1" directional="true" diffuse="0.5 0.5 0.5"
           specular="0 0 0"/>
    <camera name="from_above" pos="0.4 0 5" xyaxes="0 1 0 -1 0 0"/>
    <geom name="floor" type="plane" size="6 6 0.1" material="tiles"/>
    <body name="near_table" pos="-0.3 0 0.2">
      <geom type="box" size="0.4 0.5 0.2" rgba="0.55 0.42 0.30 1"/>
    </body>
    <body name="far_table" pos="1.2 0 0.2">
      <geom type="box" size="0.3 0.5 0.2" rgba="0.55 0.42 0.30 1"/>
    </body>
    <body name="robot" pos="-0.1 0 0.4">
      <geom type="cylinder" size="0.08 0.05" pos="0 0 0.05" rgba="0.1 0.75 0.25 1"/>
      <body pos="0 0 0.1">
        <joint name="pan" axis="0 0 1"/>
        <geom type="capsule" fromto="0 0 0 0 0 0.3" size="0.06" rgba="0.1 0.75 0.25 1"/>
        <body pos="0 0 0.3">
          <joint name="shoulder" axis="0 1 0"/>
          <geom type="capsule" fromto="0 0 0 0 0 0.35" size="0.05" rgba="0.1 0.75 0.25 1"/>
          <body pos="0 0 0.35">
            <joint name="elbow" axis="0 1 0"/>
            <geom type="capsule" fromto="0 0 0 0 0 0.3" size="0.045" rgba="0.1 0.75 0.25 1"/>
            <site name="tip" pos="0 0 0.35"/>
          </body>
        </body>
      </body>
    </body>
    <body name="trolley" mocap="true" pos="0.55 2 0.5">
      <geom type="box" size="0.2 0.25 0.5" rgba="0.15 0.3 0.9 1"/>
    </body>
  </worldbody>
</mujoco>)";

constexpr double kContactAt_s = 1.0, kContactFor_s = 0.1;

// From the right of the near table to its front.
Eigen::Vector3d JointsOfSample(double share) {
  const double s = share * share * (3 - 2 * share);
  return {-1.4 * (1 - s), 0.9 + 0.2 * s, 0.8 - 0.3 * s};
}

}  // namespace

Pose TrolleyPoseAt(double t_s) {
  return Pose::Translation({0.55, 1.5 - kTrolleySpeed_m_s * t_s, 0.5});
}

record::Recording MakeSampleRecording(const SampleEpisode& episode) {
  record::Recording recording;
  recording.header = {{"scenario", "sample"}, {"knowledge", episode.knowledge}};
  recording.model_xml = kModel;
  recording.joints = {"pan", "shoulder", "elbow"};
  recording.obstacles = {"trolley"};
  recording.q_start = JointsOfSample(0);
  recording.q_goal = JointsOfSample(1);
  const Eigen::Vector3d limit(2, 2, 2);
  recording.limits = recording.robot_limits = {limit, limit, limit, limit};
  const int num_control = static_cast<int>(std::lround(1000 * episode.duration_s));
  for (int i = 0; i <= num_control; ++i) {
    ControlSample sample;
    sample.t = EpisodeTime(1e-3 * i);
    sample.q = JointsOfSample(static_cast<double>(i) / num_control);
    sample.q_command = sample.q;
    sample.v_command = sample.a_command = sample.v = sample.torque = Eigen::Vector3d::Zero();
    recording.control.push_back(sample);
  }
  const int num_truth = static_cast<int>(std::lround(100 * episode.duration_s));
  for (int i = 0; i <= num_truth; ++i) {
    TruthSample sample;
    const double t_s = 0.01 * i;
    sample.t = EpisodeTime(t_s);
    sample.clearance_m = 0.031 + 0.2 * std::abs(t_s - 1.25);
    sample.nearest_robot_part = "forearm";
    sample.nearest_object = "trolley";
    sample.X_WO = {TrolleyPoseAt(t_s)};
    if (episode.contact && i >= 100 && t_s < kContactAt_s + kContactFor_s) {
      sample.clearance_m = -0.004;
      sample.in_contact = true;
      sample.contact_s = t_s;
      sample.contact_object = "trolley";
      sample.p_WContact = TrolleyPoseAt(t_s).translation() + Eigen::Vector3d(-0.2, 0, 0.35);
    }
    recording.truth.push_back(sample);
  }
  for (int i = 0; i * 0.1 < episode.duration_s - 0.1; ++i) {
    CycleRecord cycle;
    cycle.t = EpisodeTime(0.1 * i);
    cycle.t_effect = EpisodeTime(0.1 * i + 0.05);
    cycle.status = "solved";
    cycle.accepted = true;
    cycle.plan_start = cycle.t;
    const int num_states = 21;
    cycle.plan.t_s = Eigen::VectorXd::LinSpaced(num_states, 0, episode.duration_s - 0.1 * i);
    cycle.plan.q.resize(3, num_states);
    cycle.plan.v = Eigen::MatrixXd::Zero(3, num_states);
    for (int k = 0; k < num_states; ++k) {
      cycle.plan.q.col(k) =
          JointsOfSample(std::min(1.0, (0.1 * i + cycle.plan.t_s(k)) / episode.duration_s));
    }
    PredictedObject object;
    object.id = 1;
    object.half_extents_m = {0.2, 0.25, 0.5};
    for (int k = 0; k <= 20; ++k) {
      const double t_s = 0.1 * i + 0.1 * k;
      object.t.push_back(EpisodeTime(t_s));
      object.X_WO.push_back(TrolleyPoseAt(episode.knowledge == "static" ? 0 : t_s));
    }
    cycle.objects = {object};
    recording.cycles.push_back(cycle);
  }
  recording.metrics = {{"time_to_goal_s", 0.95 * episode.duration_s}};
  return recording;
}

}  // namespace sidestep::render
