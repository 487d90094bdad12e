#include "sidestep/scenarios/variations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <variant>

#include "sidestep/core/input_error.h"

namespace sidestep::scenarios::variations_test {
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

// That all obstacles of `there` are where those of `here` are, by what was drawn further to the
// left of where these go first.
void ExpectMovedLeft(const Scenario& here, const Scenario& there) {
  for (std::size_t i = 0; i < here.moving_obstacles.size(); ++i) {
    const MovingObstacle& obstacle = here.moving_obstacles[i];
    const Eigen::Vector3d way = DirectionAt(obstacle.motion, EpisodeTime(0));
    const Eigen::Vector3d left = Eigen::Vector3d(-way.y(), way.x(), 0).normalized();
    EXPECT_GT(left.norm(), 0.5);
    for (const double t_s : {0.0, 0.7, 1.3, 3.0}) {
      const auto position = [&](const MovingObstacle& one) {
        return PoseAt(one, EpisodeTime(t_s)).translation();
      };
      const Eigen::Vector3d moved = position(there.moving_obstacles[i]) - position(obstacle);
      EXPECT_LT((moved - there.drawn.at("sideways_m") * left).norm(), 1e-12)
          << obstacle.name << " at " << t_s;
    }
  }
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

TEST(Variations, MoveEveryKindOfMotionSidewaysOfItsWay) {
  const std::string away = "{sideways_m: [0.1, 0.2]}";
  for (const char* const behaviour :
       {"straight", "turn", "brake_2", "circle", "random_walk", "crossing"}) {
    const Scenario there =
        Load("walkway_behaviours", {{"behaviour", behaviour}, {"variations", away}});
    const Scenario here =
        Load("walkway_behaviours", {{"behaviour", behaviour}, {"variations", "{}"}});
    ExpectMovedLeft(here, there);
  }
  ExpectMovedLeft(Load("walkway_person", {}), Load("walkway_person", {{"variations", away}}));
  ExpectMovedLeft(Load("walkway_people", {{"variations", "{}"}}),
                  Load("walkway_people", {{"variations", away}}));
}

TEST(Variations, OfPeopleAreThoseOfTheSeed) {
  double least = 1, most = -1;
  for (int seed = 1; seed <= 40; ++seed) {
    const Scenario scenario = Load("walkway_people", {{"seed", std::to_string(seed)}});
    const auto& walk = std::get<WalkMotion>(scenario.moving_obstacles[0].motion);
    const double to_the_left_m = walk.start_m.x() - 0.37;  // it walks towards -y
    EXPECT_NEAR(to_the_left_m, scenario.drawn.at("sideways_m"), 1e-12);
    EXPECT_LE(std::abs(to_the_left_m), 0.15);
    EXPECT_EQ(walk.begin_at_s, scenario.drawn.at("delay_s"));
    least = std::min(least, to_the_left_m);
    most = std::max(most, to_the_left_m);
    const Scenario again = ParseScenario(ToYaml(scenario), "written.yaml");
    EXPECT_EQ(ToYaml(again), ToYaml(scenario));
  }
  EXPECT_LT(least, -0.1);
  EXPECT_GT(most, 0.1);
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
  EXPECT_THAT(WhatTheSeedChanges(Load("walkway_people", {})),
              ElementsAre("variations.delay_s", "variations.sideways_m",
                          "moving_obstacles[0].motion.walk"));
  const Scenario noisy = Load("hsr_walkway", {{"sensor.jitter_s", "0.01"},
                                              {"sensor.dropout", "0.1"},
                                              {"sensor.noise", "{false_free: 0.1}"}});
  EXPECT_THAT(WhatTheSeedChanges(noisy),
              ElementsAre("sensor.jitter_s", "sensor.dropout", "sensor.noise"));
  for (const char* const fault : {"partly_hidden", "flips", "outliers", "swaps", "phantoms"}) {
    const Scenario by_tags = Load(
        "walkway_tags",
        {{"tags", "exact"}, {"variations", "{}"}, {"sensor.tags." + std::string(fault), "0.1"}});
    EXPECT_THAT(WhatTheSeedChanges(by_tags), ElementsAre("sensor.tags")) << fault;
  }
}

std::string Complaint(const std::string& variations) {
  try {
    Load("walkway_behaviours", {{"variations", variations}});
  } catch (const InputError& error) {
    return error.what();
  }
  return "was accepted";
}

// Of the two that cross the walkway, one alone.
Scenario CrossingWith(int seed, const std::string& objects) {
  return Load("walkway_behaviours", {{"behaviour", "crossing"},
                                     {"seed", std::to_string(seed)},
                                     {"variations", "{objects: [" + objects + "]}"}});
}

TEST(Variations, OfOneObjectChangeNoOther) {
  const Scenario plain = CrossingWith(3, "");
  const std::string name = plain.moving_obstacles[1].name;
  const Scenario varied =
      CrossingWith(3, "{name: " + name +
                          ", speed_factor: [0.5, 0.9], delay_s: [0.1, 0.4], yaw_rad: [0.2, 0.3], "
                          "within_m: [0.3, 0.2, 0]}");
  EXPECT_EQ(ToYaml(CrossingWith(3, "")), ToYaml(plain));
  for (const double t_s : {0.0, 0.7, 2.0}) {
    EXPECT_EQ(PoseAt(varied.moving_obstacles[0], EpisodeTime(t_s)).translation(),
              PoseAt(plain.moving_obstacles[0], EpisodeTime(t_s)).translation());
  }
  const auto& before = std::get<LinearMotion>(plain.moving_obstacles[1].motion);
  const auto& after = std::get<LinearMotion>(varied.moving_obstacles[1].motion);
  EXPECT_EQ(after.speed_m_s, before.speed_m_s * varied.drawn.at(name + ".speed_factor"));
  EXPECT_EQ(after.begin_at_s, varied.drawn.at(name + ".delay_s"));
  EXPECT_EQ(varied.moving_obstacles[1].rpy_rad.z() - plain.moving_obstacles[1].rpy_rad.z(),
            varied.drawn.at(name + ".yaw_rad"));
  const Eigen::Vector3d by_m(varied.drawn.at(name + ".x_m"), varied.drawn.at(name + ".y_m"), 0);
  EXPECT_LT((after.start_m - before.start_m - by_m).norm(), 1e-12);
  EXPECT_EQ(varied.drawn.count(name + ".z_m"), 0u);
  Scenario faster = varied;
  SetSpeed(faster, 2);
  EXPECT_EQ(SpeedOf(faster.moving_obstacles[1]), 2 * varied.drawn.at(name + ".speed_factor"));
  EXPECT_EQ(SpeedOf(faster.moving_obstacles[0]), 2);
}

TEST(Variations, MoveAnObjectEvenlyOrByANormalDeviate) {
  constexpr int kSeeds = 300;
  double even = 0, even_squares = 0, normal = 0, normal_squares = 0, most = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const double x = CrossingWith(seed, "{name: hsr, within_m: [1, 0, 0]}").drawn.at("hsr.x_m");
    const double y = CrossingWith(seed, "{name: hsr, deviation_m: [0, 1, 0]}").drawn.at("hsr.y_m");
    even += x / kSeeds;
    even_squares += x * x / kSeeds;
    normal += y / kSeeds;
    normal_squares += y * y / kSeeds;
    most = std::max(most, std::abs(x));
  }
  const double error = 1 / std::sqrt(1.0 * kSeeds);
  EXPECT_NEAR(even, 0, 4 * std::sqrt(1.0 / 3) * error);
  EXPECT_NEAR(even_squares, 1.0 / 3, 4 * std::sqrt(1.0 / 5 - 1.0 / 9) * error);
  EXPECT_LE(most, 1);
  EXPECT_NEAR(normal, 0, 4 * error);
  EXPECT_NEAR(normal_squares, 1, 4 * std::sqrt(2.0) * error);
}

TEST(Variations, OfObjectsThatMakeNoSenseAreRefused) {
  EXPECT_EQ(Complaint("{objects: [{name: ghost}]}"),
            "--set variations.objects[0].name: 'ghost' is no moving obstacle");
  EXPECT_THAT(Complaint("{objects: [{name: hsr, within_m: [-1, 0, 0]}]}"),
              HasSubstr("objects[0].within_m: must be three lengths from 0 to 100, is [-1, 0, 0]"));
  EXPECT_THAT(Complaint("{objects: [{name: hsr, within_m: [1, 0, 0], deviation_m: [1, 0, 0]}]}"),
              HasSubstr("deviation_m: must not be given beside within_m"));
  EXPECT_THAT(Complaint("{objects: [{name: hsr, speed_factor: [2, 1]}]}"),
              HasSubstr("objects[0].speed_factor: must be [LEAST, MOST]"));
  EXPECT_THAT(Complaint("{objects: [{name: hsr, sideways_m: [0, 1]}]}"),
              HasSubstr("is not a known key"));
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
}  // namespace sidestep::scenarios::variations_test
