#include "sidestep/bench/scan_order.h"

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace sidestep::bench::scan_order_test {
namespace {

Scan Captured(const std::string& sensor, double t_s) {
  Scan scan;
  scan.sensor = sensor;
  scan.t = EpisodeTime(t_s);
  return scan;
}

// A scan: whose, when it was captured, when it arrives.
struct Arrival {
  const char* sensor;
  double capture_s, arrival_s;
};

struct Case {
  const char* name;
  std::vector<Arrival> arrivals;
  std::vector<std::pair<double, double>> taken_s;  ///< capture, and when it was taken
  int num_too_late = 0;
};
std::ostream& operator<<(std::ostream& stream, const Case& test) { return stream << test.name; }

class ScanOrderOf : public ::testing::TestWithParam<Case> {};

TEST_P(ScanOrderOf, TakesScansInTheOrderOfCaptureAndWaitsNoLongerThanItMust) {
  ScanOrder order({"left", "right"});
  std::vector<std::pair<double, double>> taken_s;
  const auto note = [&](const std::vector<Scan>& scans, EpisodeTime now) {
    for (const Scan& scan : scans) {
      EXPECT_EQ(scan.t, scans.front().t);
      taken_s.emplace_back(scan.t.seconds(), now.seconds());
    }
    return !scans.empty();
  };
  const auto take_until = [&](double until_s) {
    while (order.NextDue() <= EpisodeTime(until_s)) {
      const EpisodeTime now = order.NextDue();
      EXPECT_TRUE(order.Take(now - HorizonOffset(1e-6)).empty());
      note(order.Take(now), now);
    }
  };
  int num_too_late = 0;
  for (const Arrival& arrival : GetParam().arrivals) {
    take_until(arrival.arrival_s - 1e-9);
    const EpisodeTime now(arrival.arrival_s);
    if (!order.Put(Captured(arrival.sensor, arrival.capture_s), now)) ++num_too_late;
    while (note(order.Take(now), now)) continue;
  }
  take_until(1e3);
  EXPECT_EQ(num_too_late, GetParam().num_too_late);
  ASSERT_EQ(taken_s.size(), GetParam().taken_s.size());
  for (std::size_t i = 0; i < taken_s.size(); ++i) {
    EXPECT_EQ(taken_s[i].first, GetParam().taken_s[i].first) << i;
    EXPECT_NEAR(taken_s[i].second, GetParam().taken_s[i].second, 1e-9) << i;
  }
  EXPECT_TRUE(order.Take(EpisodeTime(1e9)).empty());
}

INSTANTIATE_TEST_SUITE_P(
    Sensors, ScanOrderOf,
    ::testing::Values(Case{"OneAloneNeverWaits",
                           {{"left", 0, 0.04}, {"left", 0.1, 0.14}},
                           {{0, 0.04}, {0.1, 0.14}}},
                      Case{"TwoThatAreNeverLate",
                           {{"left", 0, 0}, {"right", 0.05, 0.05}, {"left", 0.1, 0.1}},
                           {{0, 0}, {0.05, 0.05}, {0.1, 0.1}}},
                      // Its first one tells how late it is.
                      Case{"OneIsLate",
                           {{"left", 0, 0},
                            {"left", 0.1, 0.1},
                            {"right", 0.08, 0.13},
                            {"left", 0.2, 0.2},
                            {"right", 0.18, 0.23},
                            {"left", 0.3, 0.3}},
                           {{0, 0}, {0.1, 0.1}, {0.18, 0.23}, {0.2, 0.25}, {0.3, 0.35}},
                           1},
                      // Its newest one shows that none from before can come any more.
                      Case{"OneIsLateAndBringsALaterOneSooner",
                           {{"right", 0, 0.05}, {"left", 0.1, 0.1}, {"right", 0.11, 0.12}},
                           {{0, 0.05}, {0.1, 0.12}, {0.11, 0.12}}},
                      Case{
                          "OneHasComeBackAfterASecond",
                          {{"left", 0, 0}, {"left", 1, 1}, {"right", 0.5, 1.1}, {"left", 1.2, 1.2}},
                          {{0, 0}, {1, 1}, {1.2, 1.3}},
                          1},
                      Case{"TwoOfOneMoment",
                           {{"right", 0, 0.05}, {"left", 0.1, 0.1}, {"right", 0.1, 0.11}},
                           {{0, 0.05}, {0.1, 0.11}, {0.1, 0.11}}},
                      // By a clock that is 0.3 s ahead.
                      Case{"OneIsOfTheFuture",
                           {{"left", 0.3, 0}, {"right", 0.05, 0.05}, {"left", 0.4, 0.1}},
                           {{0.3, 0}, {0.4, 0.1}},
                           1}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace sidestep::bench::scan_order_test
