#include "sidestep/scenarios/variations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <variant>

#include "sidestep/core/input_error.h"

namespace sidestep::scenarios {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Scenario Load(const std::string& name, const Settings& settings) {
  return LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/" + name + ".yaml", settings);
}

double SpeedOf(const MovingObstacle& obstacle) {
  return std::visit([](const auto& motion) { return motion.speed_m_s; }, obstacle.motion);
}

TEST(Variations, AreDecidedByTheSeedAndTheSameForAllObstacles) {
  double last_speed_m_s = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    const Settings settings = {{"behaviour", "crossing"}, {"seed", std::to_string(seed)}};
    const Scenario scenario = Load("walkway_behaviours", settings);
    EXPECT_EQ(ToYaml(scenario), ToYaml(Load("walkway_behaviours", settings)));
    const auto& hsr = std::get<LinearMotion>(scenario.moving_obstacles[0].motion);
    const auto& trolley = std::get<LinearMotion>(scenario.moving_obstacles[1].motion);
    const double factor = scenario.drawn.at("speed_factor"), delay_s = scenario.drawn.at("delay_s");
    EXPECT_GE(factor, 0.75);
    EXPECT_LE(factor, 1.3);
    EXPECT_GE(delay_s, 0);
    EXPECT_LE(delay_s, 0.5);
    EXPECT_EQ(hsr.speed_m_s, 1.4 * factor);
    EXPECT_EQ(trolley.speed_m_s, 1.2 * factor);
    EXPECT_EQ(hsr.begin_at_s, delay_s);
    EXPECT_EQ(trolley.begin_at_s, delay_s);
    EXPECT_NE(hsr.speed_m_s, last_speed_m_s);
    last_speed_m_s = hsr.speed_m_s;
  }
}

TEST(Variations, FillTheirRangesEvenly) {
  constexpr int kSeeds = 200;
  double factors = 0, delays_s = 0, products = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const Scenario scenario = Load("walkway_behaviours", {{"seed", std::to_string(seed)}});
    const double factor = (scenario.drawn.at("speed_factor") - 1.025) / 0.55;
    const double delay = (scenario.drawn.at("delay_s") - 0.25) / 0.5;
    factors += factor / kSeeds;
    delays_s += delay / kSeeds;
    products += 12 * factor * delay / kSeeds;
  }
  const double four_standard_errors = 4 / std::sqrt(12.0 * kSeeds);
  EXPECT_NEAR(factors, 0, four_standard_errors);
  EXPECT_NEAR(delays_s, 0, four_standard_errors);
  EXPECT_NEAR(products, 0, 4 / std::sqrt(1.0 * kSeeds));  // neither follows from the other
}

TEST(Variations, DoNotDependOnEachOther) {
  const Scenario both = Load("walkway_behaviours", {{"seed", "5"}});
  const Scenario one =
      Load("walkway_behaviours", {{"seed", "5"}, {"variations", "{delay_s: [0, 0.5]}"}});
  EXPECT_EQ(one.drawn.at("delay_s"), both.drawn.at("delay_s"));
  EXPECT_EQ(one.drawn.count("speed_factor"), 0u);
}

TEST(Variations, AreWrittenAsWhatTheyCameTo) {
  const Scenario scenario = Load("walkway_behaviours", {{"behaviour", "stop"}, {"seed", "3"}});
  const Scenario again = ParseScenario(ToYaml(scenario), "written.yaml");
  EXPECT_THAT(again.drawn, IsEmpty());
  for (const double t_s : {0.0, 0.4, 1.3, 3.0}) {
    EXPECT_EQ(PoseAt(again.moving_obstacles[0], EpisodeTime(t_s)).translation(),
              PoseAt(scenario.moving_obstacles[0], EpisodeTime(t_s)).translation());
  }
}

TEST(Variations, OfAnObstacleBeyondItsHighestSpeedCanBeReadBack) {
  const Scenario scenario = Load("walkway_behaviours", {{"behaviour", "speed_up_2"},
                                                        {"variations", "{speed_factor: [5, 6]}"}});
  EXPECT_GT(SpeedOf(scenario.moving_obstacles[0]), 2.5);  // the file's max_speed_m_s
  const Scenario again = ParseScenario(ToYaml(scenario), "written.yaml");
  EXPECT_EQ(SpeedOf(again.moving_obstacles[0]), SpeedOf(scenario.moving_obstacles[0]));
}

TEST(SetSpeed, TakesThePlaceOfTheFilesSpeedAndIsVariedAsItWas) {
  Scenario scenario = Load("walkway_behaviours", {{"seed", "3"}});
  SetSpeed(scenario, 0.8);
  EXPECT_EQ(SpeedOf(scenario.moving_obstacles[0]), 0.8 * scenario.drawn.at("speed_factor"));
}

TEST(WhatTheSeedChanges, IsNothingWhereNothingIsRandom) {
  EXPECT_THAT(WhatTheSeedChanges(Load("hsr_walkway", {})), IsEmpty());
  EXPECT_THAT(WhatTheSeedChanges(Load("hsr_walkway", {{"sensor.dropout", "0"}})), IsEmpty());
  EXPECT_THAT(WhatTheSeedChanges(Load("hsr_walkway", {{"sensor.noise", "{false_free: 0}"}})),
              IsEmpty());
}

TEST(WhatTheSeedChanges, NamesEverythingThatIsRandom) {
  EXPECT_THAT(WhatTheSeedChanges(Load("walkway_behaviours", {{"behaviour", "random_walk"}})),
              ElementsAre("variations.delay_s", "variations.speed_factor",
                          "moving_obstacles[0].motion.random_walk"));
  const Scenario noisy = Load("hsr_walkway", {{"sensor.jitter_s", "0.01"},
                                              {"sensor.dropout", "0.1"},
                                              {"sensor.noise", "{false_free: 0.1}"}});
  EXPECT_THAT(WhatTheSeedChanges(noisy),
              ElementsAre("sensor.jitter_s", "sensor.dropout", "sensor.noise"));
}

std::string Complaint(const std::string& variations) {
  try {
    Load("walkway_behaviours", {{"variations", variations}});
  } catch (const InputError& error) {
    return error.what();
  }
  return "was accepted";
}

TEST(Variations, ThatAreNoRangesAreRefused) {
  EXPECT_EQ(
      Complaint("{speed_factor: [1.3, 0.75]}"),
      "--set variations.speed_factor: must be [LEAST, MOST] with 0 <= LEAST < MOST <= 100, is "
      "[1.3, 0.75]");
  EXPECT_THAT(Complaint("{delay_s: [-1, 1]}"), HasSubstr("variations.delay_s: must be [LEAST,"));
  EXPECT_THAT(Complaint("{delay_s: 1}"), HasSubstr("variations.delay_s: must be a list"));
  EXPECT_THAT(Complaint("{delay_s: [1]}"), HasSubstr("variations.delay_s: must have 2 numbers"));
  EXPECT_THAT(Complaint("{delay: [0, 1]}"), HasSubstr("variations.delay: is not a known key"));
  EXPECT_THAT(Complaint("[0, 1]"), HasSubstr("variations: must be a map"));
}

}  // namespace
}  // namespace sidestep::scenarios
