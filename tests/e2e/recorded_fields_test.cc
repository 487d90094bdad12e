// The fields that are made again from a recording are those that the planner saw.
#include "sidestep/bench/recorded_fields.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/resolve.h"
#include "sidestep/sdf/world_model.h"
#include "sidestep/sim/simulation.h"
#include "tests/support/random_points.h"

namespace sidestep {
namespace {

const std::string kModels = SIDESTEP_SOURCE_DIR "/models";

struct Asked {
  double t_s;
  Eigen::VectorXd distance_m;
};

// What a field says of the points, about the moment it was made and later ones.
std::vector<Asked> Ask(const sdf::DistanceField& field, EpisodeTime t,
                       const Eigen::Matrix3Xd& p_WQ) {
  std::vector<Asked> asked;
  for (const double ahead_s : {0.0, 0.37, 1.0, 2.5}) {
    sdf::DistanceSamples samples;
    field.SampleMany(p_WQ, t + HorizonOffset(ahead_s), samples);
    asked.push_back({t.seconds(), samples.distance_m});
  }
  return asked;
}

struct Case {
  std::string name, knowledge;
  scenarios::Settings settings;
};
std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

class RecordedFields : public ::testing::TestWithParam<Case> {};

TEST_P(RecordedFields, AreToTheBitWhatThePlannerSaw) {
  scenarios::Scenario scenario = scenarios::LoadScenario(
      SIDESTEP_SOURCE_DIR "/scenarios/hsr_walkway.yaml", GetParam().settings);
  scenario.knowledge = GetParam().knowledge;
  const robot::RobotModel robot = robot::RobotModel::Load(kModels, scenario.robot, scenario.X_WB);
  bench::ResolveTask(scenario, robot);
  RandomStream random(1, "points");
  const Eigen::Matrix3Xd p_WQ = UniformPoints(random, 2000, 2);

  std::vector<Asked> seen, made;
  bench::EpisodeOptions options;
  options.observe_field = [&](EpisodeTime t, const auto& field, const robot::WorldTruth*) {
    for (Asked& asked : Ask(*field, t, p_WQ)) seen.push_back(std::move(asked));
  };
  const auto make_world = [](const scenarios::Scenario& of, const robot::RobotModel& model) {
    return bench::MakeEpisodeWorld(std::make_shared<sim::Simulation>(of, model, kModels));
  };
  const bench::EpisodeResult result = bench::RunEpisode(scenario, robot, make_world, options);
  bench::RequireWhole(result);

  ASSERT_EQ(bench::WhyNoRecordedFields(result.recording, scenario), "");
  bench::RemakeFields(result.recording, scenario,
                      scenario.epsilon_m + robot.largest_sphere_radius_m(),
                      [&](const CycleRecord& cycle, const sdf::DistanceField& field) {
                        for (Asked& asked : Ask(field, cycle.t, p_WQ)) made.push_back(asked);
                      });
  ASSERT_EQ(made.size(), seen.size());
  ASSERT_GT(seen.size(), 40u);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    ASSERT_EQ(made[i].t_s, seen[i].t_s);
    ASSERT_EQ(made[i].distance_m, seen[i].distance_m) << "cycle at " << seen[i].t_s << " s";
  }
}

TEST(RecordedFieldsOfOtherSensors, AreNotMadeAgainFromWhatCamerasAndTagsSaw) {
  record::Recording recording;
  recording.cycles.resize(1);
  recording.observations.resize(1);
  for (const char* const name : {"walkway_depth", "walkway_tags"}) {
    const scenarios::Scenario scenario = scenarios::LoadScenario(
        std::string(SIDESTEP_SOURCE_DIR "/scenarios/") + name + ".yaml", {});
    EXPECT_NE(bench::WhyNoRecordedFields(recording, scenario), "") << name;
  }
  const scenarios::Scenario scenario =
      scenarios::LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/hsr_walkway.yaml", {});
  EXPECT_EQ(bench::WhyNoRecordedFields(recording, scenario), "");
  recording.observations[0].changed_cells = {std::int64_t{1} << 40};
  EXPECT_NE(bench::WhyNoRecordedFields(recording, scenario), "");
}

INSTANTIATE_TEST_SUITE_P(
    Walkway, RecordedFields,
    ::testing::Values(Case{"static", "static", {}},
                      Case{"execute_and_update", "execute_and_update", {}},
                      Case{"prediction", "prediction", {}},
                      Case{"full_knowledge", "full_knowledge", {}},
                      Case{"kalman_and_growth",
                           "prediction",
                           {{"predictor", "kalman_cv"}, {"planner.growth_sigmas", "2"}}},
                      Case{"exact_static_world", "prediction", {{"static_world", "exact"}}}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace sidestep
