// Links that come near each other: distances, against closed forms and MuJoCo's own contacts.

#include "sidestep/planner/self_clearance.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <string>

#include "sidestep/core/model_name.h"
#include "sidestep/core/random.h"
#include "sidestep/planner/clearance.h"
#include "sidestep/planner/first_guess.h"
#include "sidestep/planner/gp_planner.h"
#include "sidestep/robot/variant_names.h"
#include "tests/support/ball_field.h"

namespace sidestep::planner::self_clearance_test {
namespace {

const std::string kModels = SIDESTEP_SOURCE_DIR "/models";

// Two links of 0.5 m in a plane, folded at the elbow by q2, a ball at the far end of either.
robot::RobotModel MakeFoldingArm() {
  return robot::RobotModel::FromFile(SIDESTEP_SOURCE_DIR "/tests/support/folding_arm.yaml", Pose());
}

double GapAt(const robot::RobotModel& arm, double q1, double q2) {
  const Eigen::Vector2d q(q1, q2);
  return SelfClearance(arm).Least(arm.ComputeSphereCenters(q, false).p_WS);
}

TEST(SelfClearance, IsTheGapBetweenTheNearestSpheresOfTheTwoLinks) {
  const robot::RobotModel arm = MakeFoldingArm();
  // The tip lies 0.5 m from the elbow, at an angle of pi - q2 to the upper arm's sphere 0.4 m away.
  for (const double q2 : {0.5, 1.5, 2.8, -2.9}) {
    const double distance_m = std::sqrt(0.25 + 0.16 - 2 * 0.5 * 0.4 * std::cos(M_PI - q2));
    EXPECT_NEAR(GapAt(arm, 0.7, q2), distance_m - 0.05 - 0.08, 1e-12) << q2;
  }
}

TEST(SelfClearance, IsEndlessForARobotThatNamesNoLinks) {
  const robot::RobotModel arm =
      robot::RobotModel::FromFile(SIDESTEP_SOURCE_DIR "/tests/support/planar_arm.yaml", Pose());
  EXPECT_EQ(SelfClearance(arm).num_pairs(), 0);
  EXPECT_EQ(GapAt(arm, 0, 3), std::numeric_limits<double>::infinity());
}

TEST(SelfClearance, CountsInTheVerdictOnAMotion) {
  const robot::RobotModel arm = MakeFoldingArm();
  const BallField nothing({100, 0, 0}, {0, 0, 0}, 0.1);
  const Trajectory folding{Eigen::Vector2d(0, 1),
                           (Eigen::MatrixXd(2, 2) << 0, 0, 0, 2.8).finished(),
                           Eigen::MatrixXd::Zero(2, 2)};
  const EpisodeTime start(0);
  EXPECT_NEAR(
      MeasureClearance(arm, nothing, folding, start, start, start + HorizonOffset(1)).least_m,
      GapAt(arm, 0, 2.8), 1e-12);
}

class FoldingArm : public ::testing::Test {
 protected:
  PlanRequest Request(double q2_start, double v2_start, double q2_goal) const {
    PlanRequest request;
    request.field = &nothing_;
    request.step_s = 0.1;
    request.num_states = 31;
    request.q_start = Eigen::Vector2d(0, q2_start);
    request.v_start = Eigen::Vector2d(0, v2_start);
    request.q_goal = Eigen::Vector2d(0, q2_goal);
    return request;
  }

  const robot::RobotModel arm_ = MakeFoldingArm();
  const BallField nothing_{{100, 0, 0}, {0, 0, 0}, 0.1};
};

TEST_F(FoldingArm, BrakesBeforeItTouchesItself) {
  const PlanRequest request = Request(2.5, 1.8, 2.5);
  const Trajectory direct = MakeDirectMotion(request, Timing::kWholeTime);
  const EpisodeTime start(0);
  EXPECT_LT(
      MeasureClearance(arm_, nothing_, direct, start, start, start + HorizonOffset(3)).least_m, 0);
  const PlanResult result = GpPlanner(arm_, {}).Plan(request);
  EXPECT_FALSE(result.clearance.first_contact);  // whatever that takes of the limits
  EXPECT_GT(result.clearance.least_m, 0);
}

TEST_F(FoldingArm, IsToldWhereEveryWayLeadsThroughItself) {
  EXPECT_EQ(GpPlanner(arm_, {}).Plan(Request(2.3, 0, 4)).status, PlanStatus::kInCollision);
}

class SelfContact : public ::testing::TestWithParam<std::string> {};

// What a planner knows of self-contact are the spheres of some pairs of links. Of the contacts that
// MuJoCo finds at random configurations they miss hardly any, and those not by far, but for
// contacts with the fixed base, which has no spheres.
TEST_P(SelfContact, IsSeenWithinTheMarginOfThePlanner) {
  const robot::RobotModel robot = robot::RobotModel::Load(kModels, GetParam(), Pose());
  const std::string name = ModelFolder(GetParam());
  const std::string path = kModels + ("/" + name + "/" + name + ".xml");
  char error[1000] = "";
  const std::unique_ptr<mjModel, void (*)(mjModel*)> model(
      mj_loadXML(path.c_str(), nullptr, error, sizeof error), mj_deleteModel);
  ASSERT_NE(model, nullptr) << error;
  const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(model.get()), mj_deleteData);
  const auto is_fixed = [&](int geom) { return model->body_weldid[model->geom_bodyid[geom]] == 0; };
  const SelfClearance links(robot);
  constexpr double kMargin_m = 0.05;  // of the planner
  constexpr int kConfigurations = 20000;
  RandomStream random(1, "configurations");
  int num_contacts = 0, num_missed = 0, num_base_missed = 0, num_near = 0, num_touching = 0;
  double furthest_m = 0;
  for (int i = 0; i < kConfigurations; ++i) {
    Eigen::VectorXd q(robot.num_joints());
    for (int j = 0; j < q.size(); ++j) {
      const robot::JointLimits& limits = robot.limits()[static_cast<std::size_t>(j)];
      q(j) = random.Uniform(std::max(limits.q_min, -3.0), std::min(limits.q_max, 3.0));
    }
    std::copy(q.begin(), q.end(), data->qpos);
    mj_kinematics(model.get(), data.get());
    mj_comPos(model.get(), data.get());
    mj_collision(model.get(), data.get());
    const double gap_m = links.Least(robot.ComputeSphereCenters(q, false).p_WS);
    num_near += gap_m < kMargin_m;
    num_touching += data->ncon > 0;
    for (int c = 0; c < data->ncon; ++c) {
      const mjContact& contact = data->contact[c];
      if (is_fixed(contact.geom1) || is_fixed(contact.geom2)) {
        num_base_missed += gap_m >= kMargin_m;
        continue;
      }
      ++num_contacts;
      num_missed += gap_m >= kMargin_m;
      furthest_m = std::max(furthest_m, gap_m);
    }
  }
  EXPECT_GT(num_contacts, 80) << "too few to tell";
  EXPECT_LE(200 * num_missed, num_contacts);
  EXPECT_LT(furthest_m, kMargin_m + 0.025);
  const auto is_of_base = [](const robot::CollisionSphere& sphere) { return sphere.link < 0; };
  if (std::any_of(robot.spheres().begin(), robot.spheres().end(), is_of_base)) {
    EXPECT_EQ(num_base_missed, 0);
  }
  std::cout << GetParam() << ": of " << kConfigurations << " random configurations " << num_touching
            << " touch and " << num_near << " have links nearer than the margin; of "
            << num_contacts << " contacts " << num_missed << " lie outside it, at a gap of at most "
            << furthest_m << " m; so do " << num_base_missed << " with the base\n";
}

std::vector<std::string> RobotsAndVariants() {
  std::vector<std::string> names;
  for (const std::string& name : robot::RobotModel::ListNames(kModels)) {
    names.push_back(name);
    for (const std::string& variant : robot::VariantNames(kModels + ("/" + name)))
      names.push_back(variant);
  }
  return names;
}

INSTANTIATE_TEST_SUITE_P(Models, SelfContact, ::testing::ValuesIn(RobotsAndVariants()),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), ':', '_');
                           return name;
                         });

}  // namespace
}  // namespace sidestep::planner::self_clearance_test
