// Somebody sets the time of day while a robot moves: nothing happens.
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <memory>
#include <thread>
#include <vector>

#include "sidestep/hardware/panda_robot.h"
#include "sidestep/hardware/raw_fci_driver.h"
#include "tests/hardware/served_panda.h"

namespace {
std::atomic<long> step_s = 0;
}

// The time of day, set; every other clock as it is.
extern "C" int clock_gettime(clockid_t clock, timespec* time) noexcept {
  const long result = syscall(SYS_clock_gettime, clock, time);
  if (clock == CLOCK_REALTIME) time->tv_sec += step_s;
  return static_cast<int>(result);
}

namespace sidestep::hardware {
namespace {

// Sets the time of day to and fro, by so much, again and again.
class LeapingTime {
 public:
  explicit LeapingTime(long leap_s)
      : thread_([this, leap_s] {
          while (!ends_) {
            step_s = step_s == 0 ? leap_s : 0;
            std::this_thread::sleep_for(std::chrono::microseconds(50));
          }
        }) {}
  ~LeapingTime() {
    ends_ = true;
    thread_.join();
    step_s = 0;
  }

 private:
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

std::vector<ControlSample> Motion() {
  const ServedPanda served;
  PandaOptions options;
  options.lockstep = true;
  PandaRobot panda(std::make_unique<RawFciDriver>(served.address()), served.robot(), options);
  Trajectory way;
  way.t_s = Eigen::VectorXd::LinSpaced(2, 0, 1);
  way.q = Eigen::VectorXd(panda.Read().q).replicate(1, 2);
  way.q(0, 1) += 0.2;
  way.v = Eigen::MatrixXd::Zero(7, 2);
  panda.Submit(way, EpisodeTime(0));
  panda.AdvanceTo(EpisodeTime(1.2));
  return panda.TakeControlLog();
}

TEST(TimeOfDay, ChangesNothingWhenItIsSet) {
  const auto before = std::chrono::system_clock::now();
  step_s = 3600;
  ASSERT_GT(std::chrono::system_clock::now() - before, std::chrono::minutes(59)) << "it is not set";
  step_s = 0;
  const std::vector<ControlSample> still = Motion();
  ASSERT_EQ(still.size(), 1200u);
  for (const long leap_s : {3600L, -7200L}) {
    const LeapingTime time(leap_s);
    const std::vector<ControlSample> leaping = Motion();
    ASSERT_EQ(leaping.size(), still.size());
    for (std::size_t i = 0; i < still.size(); ++i) {
      ASSERT_EQ(leaping[i].q, still[i].q) << i;
      ASSERT_EQ(leaping[i].q_command, still[i].q_command) << i;
    }
  }
}

}  // namespace
}  // namespace sidestep::hardware
