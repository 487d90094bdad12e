#include "sidestep/bench/sensor_watch.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>
#include <vector>

namespace sidestep::bench {
namespace {

// Always overdue; gives scans of these times, then nothing.
class Overdue final : public robot::Sensor {
 public:
  explicit Overdue(std::vector<double> times_s) : times_s_(std::move(times_s)) {}
  EpisodeTime NextDue() const override { return EpisodeTime(-1); }
  std::optional<Scan> Read(EpisodeTime) override {
    if (next_ == times_s_.size()) return std::nullopt;
    Scan scan;
    scan.t = EpisodeTime(times_s_[next_++]);
    return scan;
  }

 private:
  std::vector<double> times_s_;
  std::size_t next_ = 0;
};

TEST(SensorWatch, AsksAnOverdueSensorAgainAMillisecondAfterItHadNothing) {
  Overdue sensor({0.1, 0.2});
  SensorWatch watch({"overdue", &sensor});
  EXPECT_LT(watch.NextDue(), EpisodeTime(0)) << "at once";
  EXPECT_TRUE(watch.Read(EpisodeTime(0.5)).has_value());
  EXPECT_LT(watch.NextDue(), EpisodeTime(0)) << "there may be more";
  EXPECT_TRUE(watch.Read(EpisodeTime(0.5)).has_value());
  EXPECT_FALSE(watch.Read(EpisodeTime(0.5)).has_value());
  EXPECT_NEAR(watch.NextDue().seconds(), 0.501, 1e-12);
  EXPECT_FALSE(watch.Read(EpisodeTime(0.501)).has_value());
  EXPECT_NEAR(watch.NextDue().seconds(), 0.502, 1e-12);
}

TEST(SensorWatch, LeavesOutAndCountsScansThatWereNotCapturedOneAfterTheOther) {
  Overdue sensor({0.1, 0.1, 0.05, 0.2, std::numeric_limits<double>::lowest(), 0.3});
  SensorWatch watch({"overdue", &sensor});
  std::vector<double> taken_s;
  for (int i = 0; i < 6; ++i) {
    if (const auto scan = watch.Read(EpisodeTime(0.5))) taken_s.push_back(scan->t.seconds());
  }
  EXPECT_EQ(taken_s, (std::vector<double>{0.1, 0.2, 0.3}));
  EXPECT_EQ(watch.num_left_out(), 3);
}

TEST(SensorWatch, PutsTheSensorsNameOnItsScans) {
  Overdue sensor({0.1});
  EXPECT_EQ(SensorWatch({"left", &sensor}).Read(EpisodeTime(0.5))->sensor, "left");
}

}  // namespace
}  // namespace sidestep::bench
