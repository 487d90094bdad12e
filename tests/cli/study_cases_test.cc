#include "sidestep/cli/study_cases.h"

#include <gtest/gtest.h>

#include "sidestep/cli/shell_quote.h"
#include "sidestep/core/input_error.h"

namespace sidestep::cli {
namespace {

std::vector<bench::Factors> Of(const std::vector<std::pair<std::string, int>>& counts) {
  std::vector<bench::Factors> cases = {{}};
  for (const auto& [factor, count] : counts) {
    std::vector<bench::Factors> crossed;
    for (const bench::Factors& one : cases) {
      for (int i = 0; i < count; ++i) {
        crossed.push_back(one);
        crossed.back()[factor] = std::to_string(i);
      }
    }
    cases = crossed;
  }
  return cases;
}

struct Choice {
  std::vector<std::pair<std::string, int>> factors;  // and how many values each has
  std::string asked_down, asked_across, down, across;
};

TEST(ChooseAxes, TakesWhatVaries) {
  const Choice choices[] = {
      {{}, "", "", "", ""},
      {{{"seed", 9}}, "", "", "", ""},
      {{{"speed_m_s", 3}}, "", "", "speed_m_s", ""},
      {{{"predictor", 3}, {"seed", 9}}, "", "", "predictor", ""},
      {{{"behaviour", 3}, {"knowledge", 2}}, "", "", "behaviour", "knowledge"},
      {{{"behaviour", 3}, {"predictor", 2}}, "", "", "behaviour", "predictor"},
      {{{"behaviour", 3}, {"speed_m_s", 2}}, "", "", "behaviour", "speed_m_s"},
      {{{"knowledge", 3}, {"predictor", 2}}, "", "", "predictor", "knowledge"},
      {{{"behaviour", 1}, {"speed_m_s", 2}}, "", "", "speed_m_s", ""},
      {{{"behaviour", 1}, {"speed_m_s", 2}}, "behaviour", "", "behaviour", "speed_m_s"},
      {{{"behaviour", 3}, {"knowledge", 2}}, "knowledge", "", "knowledge", "behaviour"},
      {{{"behaviour", 3}, {"seed", 9}}, "", "seed", "behaviour", "seed"},
  };
  for (const Choice& choice : choices) {
    const bench::TableAxes axes =
        ChooseAxes(Of(choice.factors), {choice.asked_down, choice.asked_across});
    EXPECT_EQ(axes.down, choice.down);
    EXPECT_EQ(axes.across, choice.across);
  }
}

TEST(ChooseAxes, RefusesWhatIsNoFactor) {
  EXPECT_THROW(ChooseAxes(Of({{"speed_m_s", 2}}), {"pace", ""}), InputError);
  EXPECT_THROW(ChooseAxes(Of({{"speed_m_s", 2}}), {"speed_m_s", "speed_m_s"}), InputError);
}

TEST(RunCommandOf, NamesEveryFactor) {
  EXPECT_EQ(RunCommandOf("scenes/my room.yaml", {{"behaviour", "stop"},
                                                 {"knowledge", "static"},
                                                 {"planner.qc", "2"},
                                                 {"seed", "3"},
                                                 {"speed_m_s", "0.8"}}),
            "sidestep run 'scenes/my room.yaml' --set behaviour=stop --knowledge static "
            "--set planner.qc=2 --seed 3 --speed 0.8");
  EXPECT_EQ(RunCommandOf("a", {{"knowledge", "search"}}), "");
}

TEST(ShellQuoted, LeavesPlainWordsAndQuotesTheOthers) {
  EXPECT_EQ(ShellQuoted("planner.qc=2"), "planner.qc=2");
  EXPECT_EQ(ShellQuoted(""), "''");
  EXPECT_EQ(ShellQuoted("a b"), "'a b'");
  EXPECT_EQ(ShellQuoted("sensor={rate_hz: 30}"), "'sensor={rate_hz: 30}'");
  EXPECT_EQ(ShellQuoted("it's"), "'it'\\''s'");
  EXPECT_EQ(ShellQuoted("caf\xe9\n'1"), "$'caf\\351\\012\\0471'");
}

}  // namespace
}  // namespace sidestep::cli
