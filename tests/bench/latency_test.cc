#include "sidestep/bench/latency.h"

#include <gtest/gtest.h>

namespace sidestep::bench::latency_test {
namespace {

scenarios::Scenario With(scenarios::Latency kind, double latency_s) {
  scenarios::Scenario scenario;
  scenario.latency = kind;
  scenario.latency_s = latency_s;
  scenario.replan_rate_hz = 20;
  return scenario;
}

TEST(Latency, ChargedIsTheSameWhateverACycleNeeds) {
  LatencyModel latency(With(scenarios::Latency::kCharged, 0.1));
  latency.Learn(0.7);
  EXPECT_EQ(latency.Expected(), HorizonOffset(0.1));
  EXPECT_EQ(latency.Charge(0.7), HorizonOffset(0.1));
}

TEST(Latency, NoneIsNone) {
  LatencyModel latency(With(scenarios::Latency::kNone, 0.1));
  latency.Learn(0.7);
  EXPECT_EQ(latency.Expected(), HorizonOffset(0));
  EXPECT_EQ(latency.Charge(0.7), HorizonOffset(0));
}

TEST(Latency, MeasuredExpectsHalfAsMuchAgainAsTheLongestOfTheLatestFive) {
  LatencyModel latency(With(scenarios::Latency::kMeasured, 0.1));
  EXPECT_EQ(latency.Expected(), HorizonOffset(0.1)) << "nothing is known yet";
  latency.Learn(0.04);
  for (int i = 0; i < 4; ++i) latency.Learn(0.01);
  EXPECT_NEAR(latency.Expected().seconds(), 0.06, 1e-12);
  latency.Learn(0.01);
  EXPECT_NEAR(latency.Expected().seconds(), 0.015, 1e-12);
  EXPECT_EQ(latency.Charge(0.017), HorizonOffset(0.017));
}

TEST(Latency, MeasuredStaysBetweenAMillisecondAndTheMost) {
  for (const auto& [latency_s, most_s] : {std::pair(0.1, 0.1), {0.0, 0.05}}) {
    LatencyModel latency(With(scenarios::Latency::kMeasured, latency_s));
    EXPECT_EQ(latency.Expected(), HorizonOffset(most_s));
    latency.Learn(1e-5);
    EXPECT_EQ(latency.Expected(), HorizonOffset(1e-3));
    latency.Learn(3);
    EXPECT_EQ(latency.Expected(), HorizonOffset(most_s));
  }
}

}  // namespace
}  // namespace sidestep::bench::latency_test
