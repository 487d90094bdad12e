// The arm of hardware_single_table under the profile `lab`, and a box that moves at random but
// within what it is declared to do. The arm may be touched at rest, never in motion; and where one
// who knows the future finds a way to the goal, it is mostly reached. The program
// supervised_episodes runs more of them, and others (docs/safety.md).
#include <gtest/gtest.h>

#include <iostream>
#include <map>
#include <string>

#include "tests/support/supervised_episode.h"

namespace sidestep {
namespace {

constexpr std::uint64_t kEpisodes = 200;
constexpr int kGuesses = 20;
constexpr double kSolved = 0.9;

TEST(SupervisedEpisodes, InWhichTheBoxKeepsToItsEnvelopeNeverTouchAMovingArmAndReachTheGoal) {
  const SupervisedEpisodes episodes(SIDESTEP_SOURCE_DIR, Envelope::kWithin);
  std::map<std::string, int> outcomes, findings;
  int solvable = 0, solved = 0;
  for (std::uint64_t seed = 1; seed <= kEpisodes; ++seed) {
    const SupervisedEpisode run = episodes.Run(seed);
    ++outcomes[ToString(run.outcome)];
    for (const auto& [what, count] : run.findings) findings[what] += count;
    EXPECT_FALSE(run.touched_in_motion) << "seed " << seed << ": " << run.touch_s.value() << " s";
    if (!episodes.Search(seed, kGuesses).found) continue;
    ++solvable;
    if (run.outcome == bench::Outcome::kGoal) ++solved;
  }
  std::cout << solved << " of " << solvable << " for which the search finds a free motion\n";
  for (const auto& [outcome, count] : outcomes) std::cout << outcome << " " << count << "\n";
  for (const auto& [what, count] : findings) std::cout << what << " " << count << "\n";
  EXPECT_GE(solved, kSolved * solvable);
  EXPECT_GT(solvable, 100) << "the box is too much in the way";
  EXPECT_GT(findings["stop_path hold"], 20) << "nothing came near";
}

}  // namespace
}  // namespace sidestep
