#include "sidestep/cli/run_summary.h"

#include <gtest/gtest.h>

#include <vector>

namespace sidestep::cli {
namespace {

TEST(FindingsText, TellsOfASlowAnswerToARealRobotAlone) {
  const std::vector<SafetyEvent> findings = {
      {EpisodeTime(0.2), "slow_answer", "none", 1.24e-3, 0.3e-3},
      {EpisodeTime(0.3125), "tracking", "brake", 0.03, 0.02}};
  const std::string braked = "supervisor       0.312 s: tracking: brake\n";
  EXPECT_EQ(FindingsText(findings, /*is_real_robot=*/false), braked);
  EXPECT_EQ(
      FindingsText(findings, /*is_real_robot=*/true),
      "slow answer      0.200 s: a command took 1.24 ms to make; Franka leaves 0.30 ms\n" + braked);
  EXPECT_EQ(FindingsText({}, true), "");
}

}  // namespace
}  // namespace sidestep::cli
