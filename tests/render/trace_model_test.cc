#include "sidestep/render/trace_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "sidestep/core/input_error.h"
#include "tests/render/sample_recording.h"

namespace sidestep::render::trace_model_test {
namespace {

using ::testing::StartsWith;

// The tip of the sample's arm, by hand.
Eigen::Vector3d TipOfSample(const Eigen::Vector3d& q) {
  const double reach = 0.35 * std::sin(q(1)) + 0.35 * std::sin(q(1) + q(2));
  const double height = 0.8 + 0.35 * std::cos(q(1)) + 0.35 * std::cos(q(1) + q(2));
  return {-0.1 + reach * std::cos(q(0)), reach * std::sin(q(0)), height};
}

TEST(TraceModel, PutsJointsAndObstaclesWhereTheRecordingHasThem) {
  const record::Recording recording = MakeSampleRecording({});
  TraceModel trace(recording, "sample");
  trace.MoveTo(EpisodeTime(0.75));
  const int site = mj_name2id(&trace.model(), mjOBJ_SITE, "tip");
  const Eigen::Vector3d tip(trace.data().site_xpos + 3 * site);
  EXPECT_LT((tip - TipOfSample(recording.control[750].q)).norm(), 1e-12);
  const int trolley = mj_name2id(&trace.model(), mjOBJ_BODY, "trolley");
  const Eigen::Vector3d position(trace.data().xpos + 3 * trolley);
  EXPECT_LT((position - TrolleyPoseAt(0.75).translation()).norm(), 1e-12);
}

TEST(TraceModel, TracesTheTipSoFarAndAsPlanned) {
  const record::Recording recording = MakeSampleRecording({});
  TraceModel trace(recording, "sample");
  const Eigen::Matrix3Xd trail = trace.TipTrail(EpisodeTime(0.5));
  ASSERT_EQ(trail.cols(), 51);
  EXPECT_LT((trail.col(50) - TipOfSample(recording.control[500].q)).norm(), 1e-9);
  EXPECT_EQ(trace.TipTrail(EpisodeTime(99)).cols(), 201);
  EXPECT_EQ(trace.TipTrail(EpisodeTime(-1)).cols(), 1);

  const CycleRecord& cycle = recording.cycles[4];  // a plan from 0.4 s to 2 s
  const Eigen::Matrix3Xd plan = trace.TipPlan(cycle, EpisodeTime(0.4));
  EXPECT_LT((plan.leftCols<1>() - TipOfSample(cycle.plan.q.col(0))).norm(), 1e-9);
  EXPECT_LT((plan.rightCols<1>() - TipOfSample(recording.q_goal)).norm(), 1e-9);
  EXPECT_GT(trace.TipPlan(cycle, EpisodeTime(0.4)).cols(),
            trace.TipPlan(cycle, EpisodeTime(1.4)).cols());
  EXPECT_EQ(trace.TipPlan(cycle, EpisodeTime(2)).cols(), 0);
}

TEST(TraceModel, TellsRobotObstaclesAndNamesApart) {
  const record::Recording recording = MakeSampleRecording({});
  const TraceModel trace(recording, "sample");
  int robot = 0, obstacle = 0, table = 0, floor = 0;
  for (int geom = 0; geom < trace.model().ngeom; ++geom) {
    robot += trace.IsRobot(geom);
    obstacle += trace.ObstacleOf(geom) == 0;
    EXPECT_EQ(trace.ObstacleOf(geom) == 0, trace.BelongsTo(geom, "trolley"));
    table += trace.BelongsTo(geom, "near_table");
    floor += trace.BelongsTo(geom, "floor");
    EXPECT_FALSE(trace.BelongsTo(geom, "unheard of"));
  }
  EXPECT_EQ(robot, 4);
  EXPECT_EQ(obstacle, 1);
  EXPECT_EQ(table, 1);
  EXPECT_EQ(floor, 1);
}

TEST(TraceModel, TakesTheEndOfTheChainForTheTipWhereThereIsNoSite) {
  record::Recording recording = MakeSampleRecording({});
  const std::string site = "<site name=\"tip\" pos=\"0 0 0.35\"/>";
  const std::string hand =
      "<body pos=\"0 0 0.2\"><geom size=\"0.02\"/>"
      "<body pos=\"0 0.1 0\"><geom size=\"0.01\"/></body>"
      "<body pos=\"0 -0.1 0\"><geom size=\"0.01\"/></body></body>";
  recording.model_xml.replace(recording.model_xml.find(site), site.size(), hand);
  const TraceModel trace(recording, "sample");
  const Eigen::Vector3d q = recording.control[0].q;
  const Eigen::Vector3d elbow_to_hand =
      0.2 * Eigen::Vector3d(std::sin(q(1) + q(2)) * std::cos(q(0)),
                            std::sin(q(1) + q(2)) * std::sin(q(0)), std::cos(q(1) + q(2)));
  const Eigen::Vector3d elbow_to_tip = 1.75 * elbow_to_hand;
  EXPECT_LT(
      (trace.TipTrail(EpisodeTime(0)).col(0) - (TipOfSample(q) - elbow_to_tip + elbow_to_hand))
          .norm(),
      1e-9);
}

TEST(TraceModel, RefusesRecordingsItCannotDraw) {
  const struct {
    std::function<void(record::Recording&)> spoil;
    const char* message;
  } cases[] = {
      {[](record::Recording& r) { r.control.clear(); }, "t.h5: holds no motion"},
      {[](record::Recording& r) { r.joints.clear(); }, "t.h5: names no joints"},
      {[](record::Recording& r) { r.joints[1] = "knee"; }, "t.h5: its model has no joint 'knee'"},
      {[](record::Recording& r) { r.obstacles[0] = "near_table"; },
       "t.h5: its model has no mocap body 'near_table'"},
      {[](record::Recording& r) { r.control[5].q(0) = std::numeric_limits<double>::quiet_NaN(); },
       "t.h5: holds a joint position that is not finite"},
      {[](record::Recording& r) {
         r.model_xml = "<mujoco>\n<worldbody>\n<geom/></worldbody></mujoco>";
       },
       "t.h5: model_xml:3: sizes must be positive"},
      {[](record::Recording& r) {
         r.model_xml = "<mujoco>\n<asset><mesh file='/etc/passwd'/></asset></mujoco>";
       },
       "t.h5: model_xml:2: file: a model must not refer to other files"},
      {[](record::Recording& r) { r.model_xml.clear(); }, "t.h5: holds no model"},
  };
  for (const auto& c : cases) {
    record::Recording recording = MakeSampleRecording({});
    c.spoil(recording);
    try {
      const TraceModel trace(recording, "t.h5");
      ADD_FAILURE() << "accepted: " << c.message;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), StartsWith(c.message));
    }
  }
}

}  // namespace
}  // namespace sidestep::render::trace_model_test
