// Scenes that a planner fails in which does not know the floor, or loses thin things between cells.
#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/resolve.h"
#include "sidestep/bench/true_world.h"
#include "sidestep/planner/clearance.h"
#include "sidestep/sim/simulation.h"

namespace sidestep {
namespace {

const std::string kSource = SIDESTEP_SOURCE_DIR;

struct HardRun {
  scenarios::Scenario scenario;
  robot::RobotModel robot;
  bench::EpisodeResult result;
};

HardRun RunHard(const std::string& name, const std::string& knowledge,
                const scenarios::Settings& settings = {}) {
  scenarios::Scenario scenario =
      scenarios::LoadScenario(kSource + "/tests/data/hard_scenarios/" + name + ".yaml", settings);
  scenario.knowledge = knowledge;
  const robot::RobotModel robot =
      robot::RobotModel::Load(kSource + "/models", scenario.robot, scenario.X_WB);
  bench::ResolveTask(scenario, robot);
  const auto make_world = [](const scenarios::Scenario& of, const robot::RobotModel& model) {
    return bench::MakeEpisodeWorld(
        std::make_shared<sim::Simulation>(of, model, kSource + "/models"));
  };
  bench::EpisodeResult result = bench::RunEpisode(scenario, robot, make_world);
  return {scenario, robot, std::move(result)};
}

class LowSweep : public ::testing::TestWithParam<sdf::Knowledge> {};

TEST_P(LowSweep, GoesIntoTheFloorNeitherByAPlanThatIsCalledFreeNorByDeed) {
  const HardRun run = RunHard("low_sweep_under_a_load", ToString(GetParam()));
  for (const TruthSample& sample : run.result.recording.truth) {
    EXPECT_NE(sample.contact_object, "floor") << sample.t.seconds();
  }
  const sdf::ShapeField floor(StaticSolids{{}, {bench::FloorOf(run.scenario)}});
  int num_accepted = 0;
  for (const CycleRecord& cycle : run.result.recording.cycles) {
    if (!cycle.accepted) continue;
    if (cycle.status == "in_collision") continue;  // it says itself that nothing is free any more
    ++num_accepted;
    const EpisodeTime end =
        cycle.plan_start + HorizonOffset(cycle.plan.t_s(cycle.plan.num_states() - 1));
    EXPECT_GE(planner::MeasureClearance(run.robot, floor, cycle.plan, cycle.plan_start,
                                        cycle.t_effect, end)
                  .least_m,
              0)
        << "planned at " << cycle.t.seconds() << " s";
  }
  EXPECT_GT(num_accepted, 0);
}

INSTANTIATE_TEST_SUITE_P(Kinds, LowSweep, ::testing::ValuesIn(sdf::kAllKnowledge),
                         [](const auto& test) { return ToString(test.param); });

TEST(LowSweep, ReachesItsGoalWhereTheLoadIsForeseen) {
  for (const char* const knowledge : {"prediction", "full_knowledge"}) {
    EXPECT_EQ(ToString(RunHard("low_sweep_under_a_load", knowledge).result.outcome), "goal")
        << knowledge;
  }
}

class ThinThing : public ::testing::TestWithParam<const char*> {};

TEST_P(ThinThing, IsSeenAndNotTouched) {
  for (const char* const knowledge : {"prediction", "full_knowledge"}) {
    const HardRun run = RunHard(GetParam(), knowledge);
    EXPECT_EQ(ToString(run.result.outcome), "goal") << knowledge;
    EXPECT_GT(run.result.recording.metrics.at("min_clearance_m"), 0) << knowledge;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ThinThing, ::testing::Values("thin_sheet", "thin_pole"),
                         [](const auto& test) { return std::string(test.param); });

TEST(ThinSheet, IsKnownExactlyHoweverItIsSeenIfTheStaticWorldIs) {
  const HardRun run =
      RunHard("thin_sheet", "prediction", {{"static_world", "exact"}, {"sensor.cells", "centre"}});
  EXPECT_EQ(ToString(run.result.outcome), "goal");
}

TEST(ThinSheet, IsHitWhereOnlyCentresCount) {  // or the scene is no test
  const HardRun run = RunHard("thin_sheet", "prediction", {{"sensor.cells", "centre"}});
  EXPECT_EQ(ToString(run.result.outcome), "collision");
}

}  // namespace
}  // namespace sidestep
