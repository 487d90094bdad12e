#include "sidestep/bench/result_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "sidestep/bench/metrics/registry.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::bench::result_file_test {
namespace {

EpisodeResult SomeResult() {
  EpisodeResult result;
  result.outcome = Outcome::kCollision;
  for (const Metric& metric : Metrics()) result.recording.metrics[metric.name] = 1.5;
  result.recording.metrics["time_to_goal_s"] = std::numeric_limits<double>::quiet_NaN();
  result.times["cycle"] = {0.001, 0.002, 0.010};
  result.wall_s = 3;
  return result;
}

const RunIdentity kIdentity = {"scene", "models", "build", ""};

scenarios::Scenario SomeScenario() {
  return scenarios::LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/hsr_walkway.yaml");
}

class ResultFile : public ::testing::Test {
 protected:
  const TemporaryFolder folder_;
  const std::string path_ = folder_.path() / "result.json";

  std::string Complaint() const {
    try {
      ReadResult(path_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "was accepted";
  }
};

TEST_F(ResultFile, IsReadBackAsTheRowThatItIs) {
  EpisodeResult result = SomeResult();
  result.cycles_over_charge = 3;
  result.late_plans = 2;
  scenarios::Scenario scenario = SomeScenario();
  scenario.seed = 12;
  scenario.drawn = {{"delay_s", 0.25}};
  WriteFile(path_, ResultJson(result, scenario, kIdentity, {{"build_id", "build"}}));
  const StoredResult stored = ReadResult(path_);
  EXPECT_EQ(stored.scenario, "hsr_walkway");
  EXPECT_EQ(stored.seed, 12u);
  EXPECT_EQ(stored.versions.at("build_id"), "build");
  const RunRow row = RowOf(result, scenario);
  EXPECT_EQ(stored.row.outcome, "collision");
  EXPECT_EQ(stored.row.drawn, scenario.drawn);
  EXPECT_EQ(RunId(stored.row.identity), RunId(kIdentity));
  EXPECT_EQ(stored.row.subject.robot, row.subject.robot);
  EXPECT_EQ(stored.row.subject.planner, row.subject.planner);
  EXPECT_EQ(stored.row.subject.knowledge, "prediction");
  EXPECT_EQ(stored.row.subject.predictor, row.subject.predictor);
  EXPECT_EQ(stored.row.subject.charged_latency_s, 0.1);
  EXPECT_EQ(stored.row.metrics.at("gp_cost"), 1.5);
  EXPECT_TRUE(std::isnan(stored.row.metrics.at("time_to_goal_s")));
  EXPECT_EQ(stored.row.metrics.size(), row.metrics.size());
  EXPECT_DOUBLE_EQ(stored.row.clock.episode_s, 3);
  EXPECT_DOUBLE_EQ(stored.row.clock.cycle_p50_ms, 2);
  EXPECT_DOUBLE_EQ(stored.row.clock.cycle_max_ms, 10);
  EXPECT_EQ(stored.row.clock.cycles_over_charge, 3);
  EXPECT_EQ(stored.row.clock.late_plans, 2);
}

TEST_F(ResultFile, OfAProgramThatToldLessIsReadToo) {
  auto json = nlohmann::json::parse(ResultJson(SomeResult(), SomeScenario(), kIdentity, {}));
  json.erase("charged_latency_s");
  json["wall_clock"]["cycle_cpu"]["cycle"].erase("max_ms");
  WriteFile(path_, json.dump());
  EXPECT_TRUE(std::isnan(ReadResult(path_).row.subject.charged_latency_s));
}

TEST_F(ResultFile, OfAnAbortedRunIsReadBackThoughItHadNoPlanningCycle) {
  EpisodeResult result = SomeResult();
  result.outcome = Outcome::kAborted;
  result.reason = "the robot's \"power\" failed";
  result.times["cycle"].clear();
  WriteFile(path_, ResultJson(result, SomeScenario(), kIdentity, {}));
  const RunRow row = ReadResult(path_).row;
  EXPECT_EQ(row.outcome, "aborted");
  EXPECT_EQ(row.error, result.reason);
  EXPECT_TRUE(std::isnan(row.clock.cycle_p50_ms));
  const auto json = nlohmann::json::parse(ResultJson(result, SomeScenario(), kIdentity, {}));
  EXPECT_EQ(json["reason"], result.reason);
  EXPECT_TRUE(
      nlohmann::json::parse(ResultJson(SomeResult(), SomeScenario(), kIdentity, {}))["reason"]
          .is_null());
}

TEST_F(ResultFile, OfAnUnknownOutcomeIsRefused) {
  auto json = nlohmann::json::parse(ResultJson(SomeResult(), SomeScenario(), kIdentity, {}));
  json["outcome"] = "success";
  WriteFile(path_, json.dump());
  EXPECT_EQ(Complaint(), path_ + ": is not a whole result: no outcome is 'success'");
}

TEST_F(ResultFile, KeepsEverythingThatMayDifferUnderOneKey) {
  EpisodeResult slow = SomeResult();
  slow.wall_s = 30;
  slow.times["cycle"] = {1, 2, 3};
  auto a = nlohmann::json::parse(ResultJson(SomeResult(), SomeScenario(), kIdentity, {}));
  auto b = nlohmann::json::parse(ResultJson(slow, SomeScenario(), kIdentity, {}));
  EXPECT_NE(a, b);
  a.erase("wall_clock");
  b.erase("wall_clock");
  EXPECT_EQ(a, b);
}

TEST_F(ResultFile, HoldsEveryParameterOfTheScenarioAsTheFilesOfScenariosNameThem) {
  const auto json = nlohmann::json::parse(ResultJson(SomeResult(), SomeScenario(), kIdentity, {}));
  EXPECT_EQ(json["parameters"]["planner"]["epsilon_m"], 0.2);
  EXPECT_EQ(json["parameters"]["robot"]["base"]["position_m"], (std::vector<double>{0, 0, 0.4}));
  EXPECT_EQ(json["parameters"]["moving_obstacles"][0]["motion"]["linear"]["speed_m_s"], 1.4);
  EXPECT_EQ(json["parameters"]["planner"]["velocity_limits"], true);
  // The whole of it: what it says is, as YAML, the scenario.
  const scenarios::Scenario again =
      scenarios::ParseScenario(json["parameters"].dump(), "again.yaml");
  EXPECT_EQ(scenarios::ToYaml(again), scenarios::ToYaml(SomeScenario()));
  WriteFile(path_, json.dump());
  const auto parameters = ReadResult(path_).parameters;
  EXPECT_EQ(parameters.at("planner.epsilon_m"), "0.2");
  EXPECT_EQ(parameters.at("moving_obstacles[0].motion.linear.speed_m_s"), "1.4");
  EXPECT_EQ(parameters.at("robot.base.position_m"), "[0,0,0.4]");
}

TEST_F(ResultFile, TellsWhatWasRun) {
  const auto json = nlohmann::json::parse(ResultJson(SomeResult(), SomeScenario(), kIdentity, {}));
  EXPECT_EQ(json["identity"]["run"], RunId(kIdentity));
  EXPECT_EQ(json["identity"]["scenario"], "scene");
  EXPECT_EQ(json["identity"]["models"], "models");
}

TEST_F(ResultFile, WritesCountsAsWholeNumbers) {
  EpisodeResult result = SomeResult();
  result.recording.metrics["replans"] = 35;
  const auto json = nlohmann::json::parse(ResultJson(result, SomeScenario(), kIdentity, {}));
  EXPECT_TRUE(json["replans"].is_number_integer());
  EXPECT_EQ(json["replans"], 35);
}

TEST_F(ResultFile, WritesOutBytesThatJsonCannotHold) {
  scenarios::Scenario scenario = SomeScenario();
  scenario.name = "caf\xE9";
  const std::string text = ResultJson(SomeResult(), scenario, kIdentity, {{"k\xFF", "v\xFE"}});
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json["scenario"], "caf\\xE9");
  EXPECT_EQ(json["versions"]["k\\xFF"], "v\\xFE");
  WriteFile(path_, "\xEF\xBB\xBF" + text);
  EXPECT_EQ(ReadResult(path_).scenario, "caf\\xE9");
}

TEST_F(ResultFile, OfAnotherKindIsRefused) {
  EXPECT_EQ(Complaint(), path_ + ": no such file");
  for (const char* const text : {"", "{", "[]", "{\"format\": 3}", "{\"format\": \"other\"}"}) {
    WriteFile(path_, text);
    EXPECT_EQ(Complaint(), path_ + ": is not a result.json of sidestep") << text;
  }
  WriteFile(path_, "{\"format\": \"sidestep-result-1\"}");
  EXPECT_EQ(Complaint(), path_ + ": is not a whole result: 'scenario' is missing");
  WriteFile(path_, "{\"format\": \"sidestep-result-1\", \"scenario\": 3}");
  EXPECT_EQ(Complaint(), path_ + ": is not a whole result: a value is of the wrong kind");
}

TEST_F(ResultFile, TellsHowLongARobotWaitedForItsCommands) {
  EpisodeResult result = SomeResult();
  const auto answers = [&] {
    return nlohmann::json::parse(ResultJson(result, SomeScenario(), kIdentity, {}))
        .at("wall_clock")
        .at("answers");
  };
  EXPECT_TRUE(answers().is_null());
  result.answers_s.assign(1000, 20e-6);
  result.answers_s[500] = 400e-6;
  EXPECT_EQ(answers().at("count"), 1000);
  EXPECT_NEAR(answers().at("p50_us").get<double>(), 20, 1e-9);
  EXPECT_NEAR(answers().at("p99_9_us").get<double>(), 20, 1);
  EXPECT_NEAR(answers().at("max_us").get<double>(), 400, 1e-9);
}

TEST_F(ResultFile, LeavesNothingBehindWhereItCannotBeWritten) {
  EXPECT_THROW(WriteFile("/nowhere/result.json", "{}"), InputError);
}

}  // namespace
}  // namespace sidestep::bench::result_file_test
