#include "sidestep/bench/sensor_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace sidestep::bench::sensor_watch_test {
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
  SensorWatch watch({"overdue", &sensor}, false);
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
  SensorWatch watch({"overdue", &sensor}, false);
  std::vector<double> taken_s;
  for (int i = 0; i < 6; ++i) {
    if (const auto scan = watch.Read(EpisodeTime(0.5))) taken_s.push_back(scan->t.seconds());
  }
  EXPECT_EQ(taken_s, (std::vector<double>{0.1, 0.2, 0.3}));
  EXPECT_EQ(watch.num_left_out(), 3);
}

TEST(SensorWatch, PutsTheSensorsNameOnItsScans) {
  Overdue sensor({0.1});
  EXPECT_EQ(SensorWatch({"left", &sensor}, false).Read(EpisodeTime(0.5))->sensor, "left");
}

// A camera at 30 Hz whose clock is wrong by `offset_s(k)` in its frame k, all of which take 60 ms.
std::vector<int> FramesTaken(SensorWatch& watch, int count) {
  std::vector<int> taken;
  for (int k = 0; k < count; ++k) {
    if (watch.Read(EpisodeTime(k / 30.0 + 0.06))) taken.push_back(k);
  }
  return taken;
}
Overdue Camera(int count, const std::function<double(int)>& offset_s) {
  std::vector<double> times_s;
  for (int k = 0; k < count; ++k) times_s.push_back(k / 30.0 + offset_s(k));
  return Overdue(times_s);
}

TEST(SensorWatch, LeavesOutTheScansOfAClockThatHasJumpedForward) {
  Overdue sensor = Camera(60, [](int k) { return k < 30 ? 0 : 0.055; });
  SensorWatch watch({"camera", &sensor}, true);
  EXPECT_EQ(FramesTaken(watch, 60).size(), 30u);
  EXPECT_EQ(watch.num_left_out(), 30);
  EXPECT_NEAR(watch.TakeClockJump().value(), -0.055, 1e-9);
  EXPECT_FALSE(watch.TakeClockJump()) << "it is told once";
}

// A third of a second later, when all of the latest scans are older than any was.
TEST(SensorWatch, LeavesOutTheScansOfAClockThatHasJumpedBackUntilItJumpsOn) {
  Overdue sensor = Camera(90, [](int k) { return k < 30 || k >= 60 ? 0 : -0.2; });
  SensorWatch watch({"camera", &sensor}, true);
  const std::vector<int> taken = FramesTaken(watch, 90);
  EXPECT_EQ(std::count_if(taken.begin(), taken.end(), [](int k) { return k >= 40 && k < 60; }), 0);
  EXPECT_EQ(std::count_if(taken.begin(), taken.end(), [](int k) { return k >= 60; }), 30);
  EXPECT_NEAR(watch.TakeClockJump().value(), 0.2, 1e-9);
}

TEST(SensorWatch, TakesScansThatAreOnlyLateAndClocksThatDiffer) {
  const std::function<double(int)> offsets[] = {
      [](int k) { return 3 + (k % 5 == 4 ? -0.03 : 0); },  // the clock of another machine; jitter
      [](int k) { return k < 30 ? 0 : 0.045; },            // a small jump
  };
  for (const auto& offset : offsets) {
    Overdue sensor = Camera(60, offset);
    SensorWatch watch({"camera", &sensor}, true);
    EXPECT_EQ(FramesTaken(watch, 60).size(), 60u);
    EXPECT_FALSE(watch.TakeClockJump());
  }
}

TEST(SensorWatch, AsksNothingOfTheClockOfWhatIsSimulated) {
  Overdue sensor = Camera(60, [](int k) { return k < 30 ? 0 : 0.2; });
  SensorWatch watch({"simulated", &sensor}, false);
  EXPECT_EQ(FramesTaken(watch, 60).size(), 60u);
}

}  // namespace
}  // namespace sidestep::bench::sensor_watch_test
