#include "sidestep/bench/sensor_watch.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

namespace sidestep::bench {
namespace {

// Always overdue; gives scans of these times, then nothing.
class Overdue final : public robot::Sensor {
 public:
  explicit Overdue(std::vector<double> times_s) : times_s_(std::move(times_s)) {}
  EpisodeTime NextDue() const override { return EpisodeTime(-1); }
  std::optional<Scan> Read() override {
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
  SensorWatch watch(sensor);
  EXPECT_LT(watch.NextDue(), EpisodeTime(0)) << "at once";
  EXPECT_FALSE(watch.has_seen());
  EXPECT_TRUE(watch.Read(EpisodeTime(0.5)).has_value());
  EXPECT_TRUE(watch.has_seen());
  EXPECT_LT(watch.NextDue(), EpisodeTime(0)) << "there may be more";
  EXPECT_TRUE(watch.Read(EpisodeTime(0.5)).has_value());
  EXPECT_FALSE(watch.Read(EpisodeTime(0.5)).has_value());
  EXPECT_NEAR(watch.NextDue().seconds(), 0.501, 1e-12);
  EXPECT_FALSE(watch.Read(EpisodeTime(0.501)).has_value());
  EXPECT_NEAR(watch.NextDue().seconds(), 0.502, 1e-12);
}

TEST(SensorWatch, RefusesScansThatWereNotCapturedOneAfterTheOther) {
  for (const double second_s : {0.1, 0.05, std::numeric_limits<double>::lowest()}) {
    Overdue sensor({0.1, second_s});
    SensorWatch watch(sensor);
    watch.Read(EpisodeTime(0.5));
    EXPECT_THROW(watch.Read(EpisodeTime(0.5)), std::runtime_error) << second_s;
  }
}

}  // namespace
}  // namespace sidestep::bench
