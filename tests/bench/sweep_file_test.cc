#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "sidestep/bench/sweep/sweep.h"
#include "sidestep/core/input_error.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench::sweep_file_test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

Sweep Parse(const std::string& text) { return ParseSweep(text, "some/pace.yaml"); }

std::map<std::string, std::vector<std::string>> AxesOf(const std::string& text) {
  std::map<std::string, std::vector<std::string>> axes;
  for (const SweepAxis& axis : Parse("scenarios: [hall]\naxes:\n" + text).axes) {
    axes[axis.name] = axis.values;
  }
  return axes;
}

TEST(SweepFile, HasAName) { EXPECT_EQ(Parse("scenarios: [hall]").name, "pace"); }

struct AxisCase {
  const char* text;
  const char* name;
  std::vector<std::string> values;
};

TEST(SweepFile, TakesEveryKindOfValueAsSetTakesIt) {
  const AxisCase cases[] = {
      {"  planner.qc: [1, 2.50, 1e-3]\n", "planner.qc", {"1", "2.50", "1e-3"}},
      {"  knowledge: [static, \"prediction\"]\n", "knowledge", {"static", "prediction"}},
      {"  task.goal: [[0, 1.5], home]\n", "task.goal", {"[0, 1.5]", "home"}},
      {"  moving_obstacles[0].shape:\n    - box: {size_m: [1, 2, 3]}\n    - sphere: {radius_m: "
       "1}\n",
       "moving_obstacles[0].shape",
       {"{box: {size_m: [1, 2, 3]}}", "{sphere: {radius_m: 1}}"}},
      {"  robot.model: [./my arm, panda]\n", "robot.model", {"./my arm", "panda"}},
      {"  a/b: [[0.1, 10], [0.02, 50]]\n", "a/b", {"0.1/10", "0.02/50"}},
      {"  a/b: [[x/y, [1, 2]], [z, null]]\n", "a/b", {"\"x/y\"/[1, 2]", "z/null"}},
      {"  speed_m_s: {from: 0.1, to: 0.5, step: 0.1}\n",
       "speed_m_s",
       {"0.1", "0.2", "0.3", "0.4", "0.5"}},
      {"  speed_m_s: {from: -1, to: 1, step: 0.75}\n", "speed_m_s", {"-1", "-0.25", "0.5"}},
  };
  for (const AxisCase& one : cases)
    EXPECT_EQ(AxesOf(one.text).at(one.name), one.values) << one.text;
}

TEST(SweepFile, CountsSeedsOrNamesThem) {
  const auto seeds = [](const std::string& text) {
    return Parse("scenarios: [hall]\n" + text).seeds;
  };
  EXPECT_THAT(seeds(""), ElementsAre(1));
  EXPECT_THAT(seeds("seeds: 3"), ElementsAre(1, 2, 3));
  EXPECT_THAT(seeds("seeds: [7, 0]"), ElementsAre(7, 0));
  EXPECT_THAT(seeds("seeds: {from: 5, to: 7}"), ElementsAre(5, 6, 7));
}

// Every sweep of tests/data/bad_sweeps: its first line is "# expect: " and the message.
std::vector<std::string> BadSweeps() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(SIDESTEP_SOURCE_DIR "/tests/data/bad_sweeps")) {
    names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

class BadSweep : public ::testing::TestWithParam<std::string> {};

TEST_P(BadSweep, IsRefusedAsItsFirstLineExpects) {
  const std::string folder = SIDESTEP_SOURCE_DIR "/tests/data/bad_sweeps/";
  const std::string path = folder + GetParam() + ".yaml";
  std::ifstream stream(path);
  std::string expected;
  ASSERT_TRUE(std::getline(stream, expected));
  ASSERT_EQ(expected.rfind("# expect: ", 0), 0u) << "the first line must say what is expected";
  try {
    ReadSweep(path);
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), folder + expected.substr(10));
  }
}

INSTANTIATE_TEST_SUITE_P(Data, BadSweep, ::testing::ValuesIn(BadSweeps()),
                         [](const auto& test) { return test.param; });

TEST(ShippedSweeps, CanBeRead) {
  const std::string folder = SIDESTEP_SOURCE_DIR "/scenarios/sweeps";
  const std::vector<std::string> names = scenarios::ScenarioNames(folder);
  EXPECT_FALSE(names.empty());
  for (const std::string& name : names) {
    const SweepPlan plan(ReadSweep(folder + "/" + name + ".yaml"));
    EXPECT_FALSE(plan.sweep().description.empty()) << name;
    EXPECT_GT(plan.num_runs(), 1u) << name;
  }
}

const char* const kGrid =
    "scenarios: [hall, yard]\naxes:\n  speed_m_s: [1, 2, 3]\n  knowledge: [static, search]\n"
    "search: 40\nset: {planner.qc: 2}\nseeds: 5\n";

TEST(SweepPlan, HoldsEveryCombinationOnceSeedsInnermost) {
  const SweepPlan plan(Parse(kGrid));
  ASSERT_EQ(plan.num_runs(), 2u * 3 * 2 * 5);
  ASSERT_EQ(plan.num_combinations(), 12u);
  std::set<std::string> seen;
  for (std::uint64_t i = 0; i < plan.num_runs(); ++i) {
    const PlannedRun run = plan.At(i);
    EXPECT_EQ(run.combination, i / 5);
    EXPECT_EQ(run.seed, i % 5 + 1);
    seen.insert(run.scenario + run.factors.at("speed_m_s") + run.factors.at("knowledge") +
                std::to_string(run.seed));
  }
  EXPECT_EQ(seen.size(), plan.num_runs());
  EXPECT_EQ(plan.At(0).scenario, "hall");
  EXPECT_EQ(plan.At(5).factors.at("knowledge"), "search");
  EXPECT_EQ(plan.At(10).factors.at("speed_m_s"), "2");
  EXPECT_EQ(plan.At(59).scenario, "yard");
}

TEST(SweepPlan, FindsEachRunByItsKey) {
  const SweepPlan plan(Parse(kGrid));
  std::set<std::uint64_t> keys;
  for (std::uint64_t i = 0; i < plan.num_runs(); ++i) {
    keys.insert(plan.KeyOf(i));
    EXPECT_EQ(plan.Find(plan.KeyOf(i)), i);
    EXPECT_EQ(KeyFromText(KeyText(plan.KeyOf(i))), plan.KeyOf(i));
  }
  EXPECT_EQ(keys.size(), plan.num_runs());
  EXPECT_EQ(plan.Find(plan.KeyOf(0) + 1), std::nullopt);
}

// Rows of a sweep that has grown, or whose file was put in another order, are still its own.
TEST(SweepPlan, CallsARunTheSameWhateverElseIsPlanned) {
  const SweepPlan before(Parse("scenarios: [hall]\naxes: {a: [1, 2], b: [x]}\nseeds: 2\n"));
  const std::string others[] = {
      "scenarios: [yard, hall]\naxes: {b: [y, x], a: [3, 2, 1]}\nseeds: 9\ntraces: all\n",
      "scenarios: [hall]\nset: {b: x}\naxes: {a: [1, 2]}\nseeds: [2, 1]\ndescription: More\n"};
  for (const std::string& text : others) {
    const SweepPlan after(Parse(text));
    for (std::uint64_t i = 0; i < before.num_runs(); ++i) {
      const auto place = after.Find(before.KeyOf(i));
      ASSERT_TRUE(place) << text;
      EXPECT_EQ(after.At(*place).factors.at("a"), before.At(i).factors.at("a"));
      EXPECT_EQ(after.At(*place).seed, before.At(i).seed);
      EXPECT_EQ(after.At(*place).scenario, "hall");
    }
    EXPECT_NE(after.Hash(), before.Hash());
  }
}

TEST(SweepPlan, CallsARunAnotherOneWhereAnyOfItChanges) {
  const std::string one =
      "scenarios: [hall]\nset: {b: x, knowledge: search}\nseeds: [1]\nsearch: 4\n";
  const std::uint64_t key = SweepPlan(Parse(one)).KeyOf(0);
  for (const auto& [what, with] : std::map<std::string, std::string>{{"hall", "yard"},
                                                                     {"b: x", "b: y"},
                                                                     {"b: x", "c: x"},
                                                                     {"[1]", "[2]"},
                                                                     {"search: 4", "search: 5"}}) {
    std::string other = one;
    other.replace(other.find(what), what.size(), with);
    EXPECT_NE(SweepPlan(Parse(other)).KeyOf(0), key) << other;
  }
}

TEST(SweepPlan, OfAMillionRunsHasAMillionKeys) {
  const SweepPlan plan(
      Parse("scenarios: [hall]\naxes: {a: {from: 1, to: 100, step: 1}, b: {from: 1, to: 100, step: "
            "1}}\nseeds: 100\n"));
  ASSERT_EQ(plan.num_runs(), 1'000'000u);
  EXPECT_EQ(plan.Find(plan.KeyOf(999'999)), 999'999u);  // looks whether any two are equal
}

TEST(SweepPlan, RefusesMoreRunsThanAnybodyHasTimeFor) {
  EXPECT_THROW(SweepPlan(Parse("scenarios: [hall]\naxes: {a: {from: 1, to: 100000, step: 1}}\n"
                               "seeds: 100000\n")),
               InputError);
}

}  // namespace
}  // namespace sidestep::bench::sweep_file_test
