// The main scene, run as a person would run it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/bytes_of.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::walkway_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double kRounded = 0.501;  // of the last digit that is printed

class Walkway : public ::testing::Test {
 protected:
  // Runs an episode into `folder_/name` and reads its result.json.
  Json Run(const std::string& name, const std::vector<std::string>& options) {
    std::vector<std::string> command = {SIDESTEP_PROGRAM, "run", "hsr_walkway", "--out",
                                        (folder_ / name).string()};
    command.insert(command.end(), options.begin(), options.end());
    const Finished finished = RunProgram(command, {}, folder_.string());
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return Json::parse(BytesOf(folder_ / name / "result.json"), nullptr, false);
  }

  const TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

// One cell of the first table of docs/walkway.md, as it is printed there: "51 mm, 2.998 s", or
// "touched at 1.72 s".
struct Promise {
  std::string speed, knowledge, text;
};
std::ostream& operator<<(std::ostream& stream, const Promise& promise) {
  return stream << promise.speed << " m/s, " << promise.knowledge << ": " << promise.text;
}

std::vector<std::string> CellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  std::string cell;
  std::getline(stream, cell, '|');  // what stands before the first bar
  while (std::getline(stream, cell, '|')) {
    const std::size_t first = cell.find_first_not_of(" `"), last = cell.find_last_not_of(" `");
    cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
  }
  return cells;
}

std::vector<Promise> Promises() {
  std::istringstream page(BytesOf(SIDESTEP_SOURCE_DIR "/docs/walkway.md"));
  std::string line;
  while (std::getline(page, line) && line.rfind("| speed [m/s] |", 0) != 0) {
  }
  const std::vector<std::string> knowledge = CellsOf(line);
  std::getline(page, line);  // the rule below the header
  std::vector<Promise> promises;
  while (std::getline(page, line) && line.rfind("|", 0) == 0) {
    const std::vector<std::string> cells = CellsOf(line);
    for (std::size_t i = 1; i < cells.size(); ++i) {
      promises.push_back({cells[0], knowledge.at(i), cells[i]});
    }
  }
  return promises;
}

class WalkwayPromise : public Walkway, public ::testing::WithParamInterface<Promise> {};

TEST_P(WalkwayPromise, IsKeptToTheDigitsThatArePrinted) {
  const auto& [speed, knowledge, text] = GetParam();
  const Json result = Run(knowledge, {"--speed", speed, "--knowledge", knowledge});
  double clearance_mm = 0, goal_s = 0, contact_s = 0;
  if (std::sscanf(text.c_str(), "touched at %lf s", &contact_s) == 1) {
    EXPECT_EQ(result["outcome"], "collision");
    ASSERT_TRUE(result["first_contact_s"].is_number());
    EXPECT_NEAR(result["first_contact_s"].get<double>(), contact_s, kRounded * 0.01);
    EXPECT_LE(result["min_clearance_m"].get<double>(), 0);
  } else {
    ASSERT_EQ(std::sscanf(text.c_str(), "%lf mm, %lf s", &clearance_mm, &goal_s), 2) << text;
    EXPECT_EQ(result["outcome"], "goal");
    EXPECT_TRUE(result["first_contact_s"].is_null());
    EXPECT_NEAR(1e3 * result["min_clearance_m"].get<double>(), clearance_mm, kRounded);
    ASSERT_TRUE(result["time_to_goal_s"].is_number());
    EXPECT_NEAR(result["time_to_goal_s"].get<double>(), goal_s, kRounded * 0.001);
    EXPECT_LE(result["time_to_goal_s"].get<double>(), 3.0);
  }
}

INSTANTIATE_TEST_SUITE_P(OfTheDocumentation, WalkwayPromise, ::testing::ValuesIn(Promises()),
                         [](const auto& test) {
                           std::string name = "v" + test.param.speed + "_" + test.param.knowledge;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

TEST(WalkwayDocumentation, PromisesThatKnowingTheFutureIsWhatKeepsTheArmFree) {
  const std::vector<Promise> promises = Promises();
  EXPECT_EQ(promises.size(), 44u);  // 11 speeds, 4 kinds of knowledge
  for (const Promise& promise : promises) {
    const bool knows = promise.knowledge == "prediction" || promise.knowledge == "full_knowledge";
    EXPECT_EQ(promise.text.find("touched") == std::string::npos, knows) << promise;
  }
}

TEST_F(Walkway, EqualRunsGiveEqualBytesUnderAnyLoad) {
  Json first = Run("first", {});
  std::atomic<bool> stop = false;
  std::vector<std::thread> load;
  for (int i = 0; i < 3; ++i) {
    load.emplace_back([&stop] {
      while (!stop) {
      }
    });
  }
  Json second = Run("second", {});
  stop = true;
  for (std::thread& thread : load) thread.join();

  EXPECT_EQ(BytesOf(folder_ / "first/trace.h5"), BytesOf(folder_ / "second/trace.h5"));
  EXPECT_TRUE(first.contains("wall_clock"));
  first.erase("wall_clock");
  second.erase("wall_clock");
  EXPECT_EQ(first.dump(), second.dump());
}

TEST_F(Walkway, EveryKindOfKnowledgeRunsAndLeavesNothingElseBehind) {
  for (const char* const knowledge :
       {"static", "execute_and_update", "prediction", "full_knowledge"}) {
    const Json result = Run(knowledge, {"--knowledge", knowledge});
    EXPECT_EQ(result["knowledge"], knowledge);
    EXPECT_GT(result["replans"].get<double>(), 10);
    EXPECT_TRUE(fs::exists(folder_ / knowledge / "trace.h5"));
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 4);
}

TEST_F(Walkway, ReportsEveryStageOfThePlanningCycle) {
  const Json result = Run("stages", {});
  for (const char* const stage :
       {"sense", "map", "segment", "track", "predict", "optimise", "cycle"}) {
    const Json& row = result["wall_clock"]["cycle_cpu"][stage];
    EXPECT_GE(row["p50_ms"].get<double>(), 0) << stage;
    EXPECT_LE(row["p50_ms"], row["p95_ms"]) << stage;
    EXPECT_LE(row["p95_ms"], row["p99_ms"]) << stage;
  }
}

TEST_F(Walkway, PrintsTheResultAsJsonWhenAsked) {
  const Finished finished =
      RunProgram({SIDESTEP_PROGRAM, "run", "hsr_walkway", "--json", "--out", folder_.string()});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_EQ(finished.out, BytesOf(folder_ / "result.json"));
}

}  // namespace
}  // namespace sidestep::walkway_test
