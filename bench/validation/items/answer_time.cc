// How long the robot waits for its commands is a property of the machine at the robot.
#include "sidestep/bench/validation/support.h"

namespace sidestep::bench {
namespace {

ItemFinding JudgeAnswerTime(const Evidence&) {
  return NothingRun(
      "it is of the machine in the laboratory: communication_test of libfranka, then `sidestep "
      "hardware run` for 10 min, which tells it in result.json under wall_clock.answers");
}

}  // namespace

ValidationItem AnswerTimeItem() {
  return {13,
          "time to answer the robot",
          "99.9 % within 0.2 ms, all within 0.5 ms, 95 % of packets for 10 min, on the machine in "
          "the laboratory",
          "Franka's documentation; libfranka's communication_test",
          nullptr,
          JudgeAnswerTime};
}

}  // namespace sidestep::bench
