#include "sidestep/sim/simulated_truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sidestep/sim/simulation.h"
#include "tests/sim/two_link.h"

namespace sidestep::sim::simulated_truth_test {
namespace {

using Eigen::Vector3d;

std::vector<TruthSample> Watch(const scenarios::Scenario& scenario, double duration_s) {
  Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  simulation.robot().AdvanceTo(EpisodeTime(duration_s));
  return simulation.truth().TakeSamples();
}

const TruthSample* FirstContact(const std::vector<TruthSample>& samples) {
  const auto found = std::find_if(samples.begin(), samples.end(),
                                  [](const TruthSample& sample) { return sample.in_contact; });
  return found == samples.end() ? nullptr : &*found;
}

TEST(SimulatedTruth, SamplesAtAHundredHertzFromTheStart) {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.moving_obstacles = {Passing("cart", Sphere{0.1}, {2, 0, 1}, {0, 1, 0}, 0.7)};
  Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  EXPECT_THAT(simulation.truth().TakeSamples(), testing::SizeIs(1));
  simulation.robot().AdvanceTo(EpisodeTime(0.5));
  const std::vector<TruthSample> samples = simulation.truth().TakeSamples();
  ASSERT_THAT(samples, testing::SizeIs(50));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t = static_cast<double>(i + 1) / 100;
    EXPECT_NEAR(samples[i].t.seconds(), t, 1e-12);
    ASSERT_THAT(samples[i].X_WO, testing::SizeIs(1));
    EXPECT_LT((samples[i].X_WO[0].translation() - Vector3d(2, 0.7 * t, 1)).norm(), 1e-12);
  }
  EXPECT_THAT(simulation.truth().TakeSamples(), testing::IsEmpty());
}

TEST(SimulatedTruth, KnowsWhereObstaclesWillBe) {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.moving_obstacles = {Passing("cart", Sphere{0.1}, {2, 0, 1}, {0, 1, 0}, 0.7)};
  Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  const auto later = simulation.truth().ObstaclesAt(EpisodeTime(2));
  ASSERT_THAT(later, testing::SizeIs(1));
  EXPECT_EQ(later[0].id, "cart");
  EXPECT_EQ(later[0].t, EpisodeTime(2));
  EXPECT_LT((later[0].X_WO.translation() - Vector3d(2, 1.4, 1)).norm(), 1e-12);
}

// What comes straight at the ball at the arm's end (radius 0.05 at (0.6, 0, 0.3)) touches it when
// it has gone `gap_m`.
struct Approach {
  const char* name;
  Shape shape;
  Vector3d start_m, direction;
  double gap_m;
};
void PrintTo(const Approach& a, std::ostream* out) { *out << a.name; }

class SomethingComes : public testing::TestWithParam<Approach> {};

TEST_P(SomethingComes, AndContactIsSeenInThatVeryMillisecond) {
  const Approach& a = GetParam();
  for (const double speed_m_s : {0.3, 1.4}) {
    scenarios::Scenario scenario = TwoLinkScenario();
    scenario.floor_m = -1;
    scenario.moving_obstacles = {Passing("guest", a.shape, a.start_m, a.direction, speed_m_s)};
    const double t_contact = a.gap_m / speed_m_s;
    const std::vector<TruthSample> samples = Watch(scenario, t_contact + 0.05);
    const TruthSample* contact = FirstContact(samples);
    ASSERT_NE(contact, nullptr);
    EXPECT_GE(contact->contact_s, t_contact - 1e-6);
    EXPECT_LE(contact->contact_s, t_contact + 0.001 + 1e-6);
    EXPECT_GE(contact->t.seconds(), contact->contact_s);
    EXPECT_LT(contact->t.seconds(), contact->contact_s + 0.01);
    EXPECT_EQ(contact->contact_object, "guest");
    for (const TruthSample& sample : samples) {  // the arm rests until then
      const double gap_m = a.gap_m - speed_m_s * sample.t.seconds();
      if (gap_m < 0) break;
      EXPECT_NEAR(sample.clearance_m, gap_m, 1e-6);
      EXPECT_EQ(sample.nearest_object, "guest");
      EXPECT_EQ(sample.nearest_robot_part, "ball");
      EXPECT_FALSE(sample.in_contact);
      EXPECT_TRUE(std::isnan(sample.contact_s));
    }
    EXPECT_LT(samples.back().clearance_m, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(
    SimulatedTruth, SomethingComes,
    testing::Values(
        Approach{"SphereAhead", Sphere{0.1}, {1, 0, 0.3}, {-1, 0, 0}, 0.25},
        Approach{"BoxAhead", Box{{0.2, 0.4, 0.3}}, {1, 0.02, 0.3}, {-1, 0, 0}, 0.25},
        Approach{"CylinderAhead", Cylinder{0.1, 0.3}, {1, 0, 0.25}, {-1, 0, 0}, 0.25},
        Approach{"CapsuleAhead", Capsule{0.1, 0.3}, {1, 0, 0.25}, {-1, 0, 0}, 0.25},
        Approach{"EllipsoidAhead", Ellipsoid{{0.1, 0.2, 0.15}}, {1, 0, 0.3}, {-1, 0, 0}, 0.25},
        // Past the centre by 0.09: the radii, 0.15 together, meet 0.12 before it.
        Approach{"BoxFromTheSide", Box{{0.1, 0.4, 0.3}}, {0.6, 0.48, 0.3}, {0, -1, 0}, 0.23}),
    [](const auto& test) { return test.param.name; });

TEST(SimulatedTruth, ReportsWhereAndHowDeep) {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.moving_obstacles = {Passing("guest", Sphere{0.1}, {0.74, 0, 0.3}, {-1, 0, 0}, 0)};
  const std::vector<TruthSample> samples = Watch(scenario, 0);
  ASSERT_THAT(samples, testing::SizeIs(1));
  EXPECT_TRUE(samples[0].in_contact);
  EXPECT_EQ(samples[0].contact_s, 0);
  EXPECT_NEAR(samples[0].clearance_m, -0.01, 1e-9);
  EXPECT_LT((samples[0].p_WContact - Vector3d(0.645, 0, 0.3)).norm(), 1e-9);
}

TEST(SimulatedTruth, TellsTheDepthInClosedFormWhileAPoleGoesThroughTheFoot) {
  // Two upright cylinders, of radius 0.06 and 0.2, whose axes pass 0.1 m from each other.
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.floor_m = -1;
  scenario.moving_obstacles = {
      Passing("pole", Cylinder{0.2, 1.8}, {-0.1, -0.6, 0.5}, {0, 1, 0}, 1)};
  const std::vector<TruthSample> samples = Watch(scenario, 1.2);
  double least_m = 1;
  for (const TruthSample& sample : samples) {
    const double wanted_m = std::hypot(0.1, sample.t.seconds() - 0.6) - 0.06 - 0.2;
    EXPECT_NEAR(sample.clearance_m, wanted_m, 1e-6) << sample.t.seconds();
    EXPECT_EQ(sample.nearest_robot_part, "foot") << sample.t.seconds();
    least_m = std::min(least_m, sample.clearance_m);
  }
  EXPECT_NEAR(least_m, -0.16, 1e-6);
}

TEST(SimulatedTruth, SeesABriefContactBetweenItsSamples) {
  // A bead that rushes past and is over the ball for less than 10 ms.
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.moving_obstacles = {Passing("bead", Sphere{0.005}, {0.6, 1.0, 0.352}, {0, -1, 0}, 8)};
  const std::vector<TruthSample> samples = Watch(scenario, 0.3);
  const auto touching = std::count_if(samples.begin(), samples.end(),
                                      [](const TruthSample& s) { return s.in_contact; });
  EXPECT_GE(touching, 1);
  EXPECT_LE(touching, 2);
  const double half_way = std::sqrt(0.055 * 0.055 - 0.052 * 0.052);
  EXPECT_NEAR(FirstContact(samples)->contact_s, (1.0 - half_way) / 8, 0.0011);
}

TEST(SimulatedTruth, TellsOfAContactThatNoSampleHoldsYet) {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.moving_obstacles = {Passing("guest", Sphere{0.1}, {1, 0, 0.3}, {-1, 0, 0}, 1)};
  Simulation simulation(scenario, TwoLink(scenario), kTestModels);
  simulation.robot().AdvanceTo(EpisodeTime(0.2495));  // it is there after 0.25 s
  EXPECT_FALSE(simulation.truth().ContactSinceLastSample().has_value());
  simulation.robot().AdvanceTo(EpisodeTime(0.255));
  EXPECT_EQ(FirstContact(simulation.truth().TakeSamples()), nullptr);
  const auto contact = simulation.truth().ContactSinceLastSample();
  ASSERT_TRUE(contact.has_value());
  EXPECT_TRUE(contact->in_contact);
  EXPECT_EQ(contact->t.seconds(), contact->contact_s);
  EXPECT_NEAR(contact->contact_s, 0.25, 0.0011);
  EXPECT_EQ(contact->contact_object, "guest");
  EXPECT_EQ(contact->nearest_object, "guest");
  EXPECT_LE(contact->clearance_m, 0);
  EXPECT_GE(contact->clearance_m, -0.0011);
  ASSERT_THAT(contact->X_WO, testing::SizeIs(1));
  EXPECT_NEAR(contact->X_WO[0].translation().x(), 1 - contact->contact_s, 1e-12);

  simulation.robot().AdvanceTo(EpisodeTime(0.26));
  const std::vector<TruthSample> samples = simulation.truth().TakeSamples();
  ASSERT_THAT(samples, testing::SizeIs(1));
  EXPECT_EQ(samples[0].contact_s, contact->contact_s);
  EXPECT_EQ(samples[0].t.seconds(), 0.26);
  EXPECT_LT(samples[0].clearance_m, contact->clearance_m);
  EXPECT_FALSE(simulation.truth().ContactSinceLastSample().has_value());
}

TEST(SimulatedTruth, JudgesTheFixedBaseAgainstWhatMoves) {
  // MuJoCo itself never looks for contacts between the foot, which is bolted to the world, and an
  // obstacle that follows a path.
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.floor_m = -1;
  scenario.moving_obstacles = {Passing("low", Sphere{0.05}, {-1, 0, 0.1}, {1, 0, 0}, 1)};
  const std::vector<TruthSample> samples = Watch(scenario, 1);
  const TruthSample* contact = FirstContact(samples);
  ASSERT_NE(contact, nullptr);
  EXPECT_NEAR(contact->contact_s, 1 - 0.06 - 0.05, 0.0011);
  EXPECT_EQ(samples[50].nearest_robot_part, "foot");
}

TEST(SimulatedTruth, IgnoresTheMountForTheLinksThatStandOnIt) {
  scenarios::Scenario scenario = TwoLinkScenario();
  // The block reaches up into the turret (0.25 to 0.35 m), but not to the bar.
  scenario.static_obstacles = {{"block", Pose::Translation({0, 0, 0.13}), Box{{0.14, 0.14, 0.26}}}};
  scenario.mount = "block";
  const std::vector<TruthSample> mounted = Watch(scenario, 0.1);
  EXPECT_EQ(FirstContact(mounted), nullptr);
  EXPECT_EQ(mounted.front().nearest_robot_part, "bar");
  EXPECT_EQ(mounted.front().nearest_object, "block");
  EXPECT_NEAR(mounted.front().clearance_m, std::hypot(0.03, 0.04) - 0.03, 1e-6);

  scenario.mount = "";
  const std::vector<TruthSample> stuck = Watch(scenario, 0.1);
  ASSERT_NE(FirstContact(stuck), nullptr);
  EXPECT_EQ(stuck.front().nearest_robot_part, "turret");
}

TEST(SimulatedTruth, LetsTheLinksAtTheFootTouchTheFloorWithoutAMount) {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.q_start = Eigen::Vector2d(0, 0.3);  // the ball is up
  scenario.floor_m = 0.26;  // up into the turret (0.25 to 0.35 m), but not to the bar
  const std::vector<TruthSample> standing = Watch(scenario, 0.1);
  EXPECT_EQ(FirstContact(standing), nullptr);
  EXPECT_EQ(standing.front().nearest_object, "floor");
  EXPECT_NE(standing.front().nearest_robot_part, "turret");
  EXPECT_GT(standing.front().clearance_m, 0);

  scenario.static_obstacles = {{"block", Pose::Translation({5, 0, 0}), Box{{0.1, 0.1, 0.1}}}};
  scenario.mount = "block";  // now it is not the floor that it stands on
  const std::vector<TruthSample> stuck = Watch(scenario, 0.1);
  ASSERT_NE(FirstContact(stuck), nullptr);
  EXPECT_EQ(stuck.front().nearest_robot_part, "turret");
  EXPECT_EQ(stuck.front().nearest_object, "floor");
}

TEST(SimulatedTruth, MeasuresToTheFloor) {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.q_start = Eigen::Vector2d(0, -0.3);
  scenario.floor_m = -0.1;
  const std::vector<TruthSample> samples = Watch(scenario, 0);
  EXPECT_EQ(samples[0].nearest_object, "floor");
  EXPECT_EQ(samples[0].nearest_robot_part, "ball");
  EXPECT_NEAR(samples[0].clearance_m, 0.3 - 0.6 * std::sin(0.3) - 0.05 + 0.1, 1e-9);
}

TEST(SimulatedTruth, CallsTheRobotItselfWhenItsOwnLinksTouch) {
  scenarios::Scenario scenario = TwoLinkScenario();
  scenario.q_start = Eigen::Vector2d(0, -1.45);  // the bar hangs down along the foot
  scenario.floor_m = -1;
  const std::vector<TruthSample> samples = Watch(scenario, 0);
  EXPECT_TRUE(samples[0].in_contact);
  EXPECT_EQ(samples[0].contact_object, "self");
  EXPECT_GT(samples[0].clearance_m, 0);  // to other things
}

}  // namespace
}  // namespace sidestep::sim::simulated_truth_test
