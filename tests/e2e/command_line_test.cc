// The command line as a person meets it: help, mistakes, exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "sidestep/bench/database/run_database.h"
#include "sidestep/core/csv.h"
#include "tests/support/bytes_of.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::command_line_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Finished Sidestep(std::vector<std::string> arguments,
                  const std::vector<std::string>& environment = {},
                  const std::string& working_directory = "") {
  arguments.insert(arguments.begin(), SIDESTEP_PROGRAM);
  return RunProgram(arguments, environment, working_directory);
}

struct Mistake {
  const char* name;
  std::vector<std::string> arguments;
  std::vector<std::string> says;  // parts of the one line
};
std::ostream& operator<<(std::ostream& stream, const Mistake& m) { return stream << m.name; }

class Mistakes : public ::testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, GetOneLineAndExitCodeTwo) {
  const TemporaryFolder folder;  // others are run at the same time, and a run has its folder alone
  const Finished finished = Sidestep(GetParam().arguments, {}, folder.path());
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_EQ(finished.out, "");
  EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
  for (const std::string& part : GetParam().says) EXPECT_THAT(finished.err, HasSubstr(part));
}

const std::string kBad = SIDESTEP_SOURCE_DIR "/tests/data/bad_scenarios/";

INSTANTIATE_TEST_SUITE_P(
    Typical, Mistakes,
    ::testing::Values(
        Mistake{"NoCommand", {}, {"subcommand"}}, Mistake{"UnknownCommand", {"fly"}, {"fly"}},
        Mistake{"NoScenario", {"run"}, {"SCENARIO"}},
        Mistake{"UnknownScenario", {"run", "hsr_walkaway"}, {"hsr_walkaway", "hsr_walkway"}},
        Mistake{"MissingFile", {"run", "./nowhere.yaml"}, {"./nowhere.yaml: no such file"}},
        Mistake{"Folder", {"run", "/"}, {"/: is a directory"}},
        Mistake{"UnknownFlag", {"run", "hsr_walkway", "--sped", "1"}, {"--sped"}},
        Mistake{"UnknownKnowledge",
                {"run", "hsr_walkway", "--knowledge", "oracle"},
                {"--knowledge: must be one of static,", "'oracle'"}},
        Mistake{"UnknownPredictor",
                {"run", "hsr_walkway", "--predictor", "crystal_ball"},
                {"--predictor: must be one of", "'crystal_ball'"}},
        Mistake{"NegativeSpeed", {"run", "hsr_walkway", "--speed", "-1"}, {"--speed"}},
        Mistake{"SpeedIsAWord", {"run", "hsr_walkway", "--speed", "fast"}, {"--speed", "fast"}},
        Mistake{"SpeedIsNotANumber", {"run", "hsr_walkway", "--speed", "nan"}, {"--speed"}},
        Mistake{"NegativeSeed", {"run", "hsr_walkway", "--seed", "-3"}, {"--seed"}},
        Mistake{"SeedHasLeadingZeros",
                {"run", "hsr_walkway", "--seed", "010"},
                {"--seed", "must be a number from 0 to 2147483647 without leading zeros"}},
        Mistake{"SeedOfACheckHasLeadingZeros",
                {"check-robot", "models/panda", "--seed", "010"},
                {"--seed", "without leading zeros"}},
        Mistake{"DetoursHaveLeadingZeros",
                {"run", "hsr_walkway", "--set", "planner.detours=010"},
                {"--set planner.detours: must be a whole number without leading zeros, is '010'"}},
        Mistake{"NegativeEpsilon", {"run", "hsr_walkway", "--epsilon", "-0.1"}, {"--epsilon"}},
        Mistake{"EpsilonIsInMillimetres",
                {"run", "hsr_walkway", "--set", "planner.epsilon_m=200"},
                {"--set planner.epsilon_m: must be at most 256 cells of the workspace"}},
        Mistake{"EpsilonIsManyOfTheScenariosCells",
                {"run", "hsr_walkway", "--set", "workspace.cell_m=0.01", "--epsilon", "9"},
                {"--epsilon: must be at most 256 cells of the workspace"}},
        Mistake{"SpeedIsAboveTheScenariosMaximum",
                {"run", "walkway_behaviours", "--set", "behaviour=speed_up_2", "--speed", "90"},
                {"--speed: is above the max_speed_m_s of 'hsr'"}},
        Mistake{"StudyOfAPredictorTwice",
                {"study", "hsr_walkway", "--predictor", "imm,imm", "--down", "predictor",
                 "--across", "predictor"},
                {"predictor: 'imm' is given twice"}},
        Mistake{"StudyOfAnUnknownPredictor",
                {"study", "hsr_walkway", "--predictor", "imm,crystal_ball", "--down", "predictor",
                 "--across", "predictor"},
                {"--predictor: must be one of", "'crystal_ball'"}},
        Mistake{"StudyOfTheSearchAsKnowledge",
                {"study", "hsr_walkway", "--knowledge", "search", "--down", "knowledge", "--across",
                 "knowledge"},
                {"--knowledge: 'search' is asked for by --search"}},
        Mistake{"StudyOfSeedsAndASeed",
                {"study", "hsr_walkway", "--episodes", "2", "--set", "seed=9", "--down", "seed",
                 "--across", "seed"},
                {"--set seed: is what --episodes varies"}},
        Mistake{"StudyOfSeedsThatChangeNothing",
                {"study", "hsr_walkway", "--episodes", "2"},
                {"--episodes: a seed changes nothing in this scenario"}},
        Mistake{"StudyOfAFactorThatIsNone",
                {"study", "hsr_walkway", "--speed", "1,2", "--down", "pace"},
                {"--down: 'pace' is no factor of this study (there are: speed_m_s)"}},
        Mistake{"StudyOfNoFactors",
                {"study", "hsr_walkway", "--down", "foo"},
                {"--down: 'foo' is no factor of this study (it has none: nothing is given to "
                 "vary)"}},
        Mistake{"StudyOfKnowledgeTwice",
                {"study", "hsr_walkway", "--set", "knowledge=static", "--knowledge", "prediction"},
                {"--set knowledge: is what --knowledge varies"}},
        Mistake{"StudyOfNoEpisodes",
                {"study", "walkway_behaviours", "--episodes", "0"},
                {"--episodes", "must be a number from 1 to 100000"}},
        Mistake{"StudyOfOneFactorDownAndAcross",
                {"study", "hsr_walkway", "--speed", "1,2", "--down", "speed_m_s", "--across",
                 "speed_m_s"},
                {"--across: 'speed_m_s' is listed down already"}},
        Mistake{"StudyOfASpeedThatIsSet",
                {"study", "hsr_walkway", "--speed", "1,2", "--set",
                 "moving_obstacles[0].motion.linear.speed_m_s=3"},
                {"--set moving_obstacles[0].motion.linear.speed_m_s: is given by --speed as well"}},
        Mistake{"StudyOfAnotherSpelling",
                {"study", "hsr_walkway", "--set", "planner..qc=1"},
                {"--set planner..qc: is no path"}},
        Mistake{"ValidateAnUnknownPlanner",
                {"validate", "crystal_ball", "--scenario", "hardware_single_table"},
                {"PLANNER: must be one of", "'crystal_ball'"}},
        Mistake{"ValidateWithoutSupervision",
                {"validate", "gpmp", "--scenario", "hsr_walkway"},
                {"hsr_walkway.yaml:", "safety.profile: must be lab to be validated"}},
        Mistake{"ValidateWithoutCapsules",
                {"validate", "gpmp", "--scenario", "wam_single_pillar", "--set",
                 "safety={profile: lab}"},
                {"robot.model: wam has no capsules to be supervised by"}},
        Mistake{"ValidateWithoutARobot",
                {"validate", "gpmp", "--scenario", "field_one_box"},
                {"--scenario: 'field_one_box' has no robot"}},
        Mistake{"ValidateNoSeeds",
                {"validate", "gpmp", "--scenario", "hardware_single_table", "--seeds", "0"},
                {"--seeds", "must be a number from 1 to 1000"}},
        Mistake{"ValidateAnUnknownCase",
                {"validate", "gpmp", "--scenario", "hardware_single_table", "--only", "one"},
                {"--only: 'one' is no case of this validation"}},
        Mistake{"ValidateTwoPlanners",
                {"validate", "gpmp", "--scenario", "hardware_single_table", "--set",
                 "planner.name=gpmp_fast"},
                {"--set planner.name: is given by PLANNER as well"}},
        Mistake{"ValidateIntoAFile",
                {"validate", "gpmp", "--scenario", "hardware_single_table", "--out",
                 SIDESTEP_SOURCE_DIR "/README.md"},
                {"--out: '" SIDESTEP_SOURCE_DIR "/README.md' cannot be made a folder"}},
        Mistake{"SeedTwice", {"run", "hsr_walkway", "--seed", "3", "--seed", "4"}, {"--seed"}},
        Mistake{"SeedByFlagAndSetting",
                {"run", "hsr_walkway", "--seed", "3", "--set", "seed=3"},
                {"--set seed: is given by --seed as well"}},
        Mistake{"KnowledgeByFlagAndSetting",
                {"run", "hsr_walkway", "--knowledge", "static", "--set", "knowledge=static"},
                {"--set knowledge: is given by --knowledge as well"}},
        Mistake{"PredictorByFlagAndSetting",
                {"field", "hsr_walkway", "--out", "x.png", "--predictor", "imm", "--set",
                 "predictor=imm"},
                {"--set predictor: is given by --predictor as well"}},
        Mistake{"LatencyByFlagAndSettingOfAllOfIt",
                {"run", "hsr_walkway", "--latency-ms", "30", "--set",
                 "replanning={rate_hz: 10, latency_s: 0.1}"},
                {"--set replanning: is given by --latency-ms as well"}},
        Mistake{"EpsilonByFlagAndSetting",
                {"run", "hsr_walkway", "--epsilon", "0.2", "--set", "planner.epsilon_m=0.1"},
                {"--set planner.epsilon_m: is given by --epsilon as well"}},
        Mistake{"SpeedByFlagAndSetting",
                {"run", "hsr_walkway", "--speed", "1", "--set",
                 "moving_obstacles[0].motion.linear.speed_m_s=1"},
                {"--set moving_obstacles[0].motion.linear.speed_m_s: is given by --speed"}},
        Mistake{"SettingOfAPartOfAnother",
                {"run", "hsr_walkway", "--set", "task.dwell_s=1", "--set", "task={}"},
                {"--set task.dwell_s: is given by --set task as well"}},
        Mistake{"SlowerThanAnyHorizon",
                {"run", "hsr_walkway", "--set", "planner.velocity_scale=0.001"},
                {"planner.velocity_scale: ", "direct motion takes 1189"}},
        Mistake{"SettingOfAFloorAboveTheRobot",
                {"run", "hsr_walkway", "--set", "floor_m=1"},
                {"--set floor_m: task.start: the robot's sphere"}},
        Mistake{"SettingOfAShapeTooLargeForAFieldOfItsOwn",
                {"run", "hsr_walkway", "--knowledge", "full_knowledge", "--set",
                 "moving_obstacles[0].shape={sphere: {radius_m: 1000}}", "--set",
                 "moving_obstacles[0].motion.linear.start_m=[0, 2000, 0]"},
                {"--set moving_obstacles[0].shape: its field would have 1.25e+14 cells of 0.04 m, "
                 "it may have 1.34e+08: make 'hsr' smaller or workspace.cell_m larger"}},
        Mistake{"SettingOfABaseThatIsNowhere",
                {"run", "hsr_walkway", "--set", "robot.base.position_m=[1e12, 0, 0]"},
                {"--set robot.base.position_m: must be within 1000 km"}},
        Mistake{"SettingOfASensorWithoutItsSettings",
                {"run", "hsr_walkway", "--set", "sensor.name=tags"},
                {"--set sensor.name: sensor.tags: is missing"}},
        Mistake{
            "SettingOfACameraWithoutItsSettings",
            {"run", "hsr_walkway", "--set", "sensor.name=tag_images"},
            {"--set sensor.name: sensor.tag_images: is missing; the sensor 'tag_images' needs it"}},
        Mistake{"CalibrationOfNoCamera",
                {"hardware", "run", "hardware_single_table", "--calibration", "none.yaml"},
                {"none.yaml: "}},
        Mistake{"FieldAboveTheWorkspace",
                {"field", "hsr_walkway", "--out", "x.png", "--height", "7"},
                {"--height: must be within the workspace, from -1.02 to 2.82 m, is 7"}},
        Mistake{"LatencyBeyondHorizon",
                {"run", "hsr_walkway", "--latency-ms", "4000"},
                {"--latency-ms: must not exceed the horizon"}},
        Mistake{"LatencyOfNone",
                {"run", "hsr_walkway", "--latency", "none", "--latency-ms", "30"},
                {"--latency-ms: nothing is charged: the latency is none"}},
        Mistake{"SettingWithoutAValue", {"run", "hsr_walkway", "--set", "seed"}, {"KEY=VALUE"}},
        Mistake{"RunWithoutARobot",
                {"run", "field_one_box"},
                {"SCENARIO: 'field_one_box' has no robot", "sidestep field"}},
        Mistake{"SettingGivenTwice",
                {"run", "hsr_walkway", "--set", "seed=1", "--set", "seed=2"},
                {"--set seed: is given twice"}},
        Mistake{"UnknownPair",
                {"run", "wam_single_pillar", "--set", "pair=8"},
                {"--set pair: must be one of 1, 2, 3, 4, 5, 6, 7, is '8'"}},
        Mistake{"SettingOfNoKey",
                {"run", "hsr_walkway", "--set", "planner.epsilon=1"},
                {"--set planner.epsilon: is not a known key"}},
        Mistake{"SettingOfAGoalThatIsNotThere",
                {"run", "hsr_walkway", "--set", "task.goal=nowhere"},
                {"--set task.goal: 'nowhere' is no configuration of panda"}},
        Mistake{"SettingOfAStartThatTouchesItself",
                {"run", "hsr_walkway", "--set", "task.start=[0, -1.7, 0, -3, 0, 0.1, 0]"},
                {"--set task.start: the robot's spheres 2 and 11 overlap by 58.8 mm"}},
        Mistake{"OutIsAFile",
                {"run", "hsr_walkway", "--out", SIDESTEP_PROGRAM},
                {"--out", "cannot be made a folder"}},
        Mistake{
            "BadFile",
            {"run", kBad + "negative_radius.yaml"},
            {"negative_radius.yaml:19: moving_obstacles[1].shape.sphere.radius_m: must be > 0"}},
        Mistake{"CompareNothing", {"compare"}, {"DIR"}},
        Mistake{"CompareNowhere", {"compare", "/nowhere"}, {"/nowhere/result.json: no such file"}},
        Mistake{"CompareAFile",
                {"compare", SIDESTEP_PROGRAM},
                {"DIR: '", "' is a file: name the folder that a run left"}},
        Mistake{"RenderNothing", {"render"}, {"TRACE"}},
        Mistake{"FieldWithoutAFile", {"field", "hsr_walkway"}, {"--out"}},
        Mistake{"FieldAheadIsAWord",
                {"field", "hsr_walkway", "--out", "x.png", "--ahead", "0,soon"},
                {"--ahead", "soon"}},
        Mistake{
            "AuditOfAnUnknownScenario", {"audit", "hsr_walkaway"}, {"hsr_walkaway", "hsr_walkway"}},
        Mistake{"AuditAheadIsAWord", {"audit", "hsr_walkway", "--ahead", "0,soon"}, {"--ahead"}},
        Mistake{"AuditAheadIsInThePast", {"audit", "hsr_walkway", "--ahead=-1"}, {"--ahead"}},
        Mistake{"AuditOfNoPoints", {"audit", "hsr_walkway", "--points", "0"}, {"--points"}},
        Mistake{"AuditOutIsAFile",
                {"audit", "hsr_walkway", "--out", SIDESTEP_PROGRAM},
                {"--out", "cannot be made a folder"}},
        Mistake{"BenchOfNothing", {"bench"}, {"bench: needs one of planner"}},
        Mistake{"BenchOfAnUnknownPlanner",
                {"bench", "planner", "--planners", "gpmp,chomp"},
                {"--planners", "chomp"}},
        Mistake{"BenchOfAnUnknownProblem",
                {"bench", "planner", "--problems", "hsr,tsr"},
                {"--problems", "tsr"}},
        Mistake{"BenchOfCyclesOfNothing", {"bench", "cycle"}, {"SCENARIO"}},
        Mistake{"BenchOfCyclesOfAnUnknownPlanner",
                {"bench", "cycle", "hsr_walkway", "--planners", "gpmp,chomp"},
                {"--planners", "chomp"}},
        Mistake{"BenchOfCyclesOfTwoPlannersAtOnce",
                {"bench", "cycle", "hsr_walkway", "--set", "planner.name=gpmp", "--planners",
                 "gpmp_fast"},
                {"--set planner.name: is given by --planners as well"}},
        Mistake{"BenchOfCyclesThatAreNeverTheSame",
                {"bench", "cycle", "hsr_walkway", "--set", "replanning.latency=measured"},
                {"--set replanning.latency: is measured: no two runs have the same cycles"}},
        Mistake{"BenchOfNoPairs", {"bench", "planner", "--pairs", "0"}, {"--pairs"}},
        Mistake{"ListOfAnUnknownKind", {"list", "wishes"}, {"KIND: must be one of scenarios,"}},
        Mistake{"SensorWithoutItsSettings",
                {"run", "hsr_walkway", "--set", "sensor.name=depth_camera"},
                {"sensor.camera: is missing; the sensor 'depth_camera' needs it"}}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(Bench, TimesTheStagesOfEachPlannersCycles) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "rows.json";
  const Finished finished = Sidestep({"bench", "cycle", "hsr_walkway", "--planners",
                                      "gpmp_fast,straight_line", "--runs", "1", "--json", file});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("gpmp_fast      goal\nstraight_line  collision\n"));
  const nlohmann::json json = nlohmann::json::parse(std::ifstream(file));
  ASSERT_EQ(json["rows"].size(), 14u);
  for (std::size_t planner = 0; planner < 2; ++planner) {
    double sum_ms = 0;
    for (std::size_t stage = 0; stage < 6; ++stage) {
      const nlohmann::json& row = json["rows"][7 * planner + stage];
      EXPECT_LE(row["median_ms"], row["p99_ms"]) << row;
      sum_ms += row["first_ms"].get<double>();
    }
    const nlohmann::json& whole = json["rows"][7 * planner + 6];
    EXPECT_EQ(whole["stage"], "cycle");
    EXPECT_GT(whole["cycles"], 20);
    EXPECT_NEAR(whole["first_ms"], sum_ms, 1e-9);
  }
}

TEST(Bench, PrintsARowForEachPlannerAndStartAndWritesThem) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "rows.json";
  const Finished finished =
      Sidestep({"bench", "planner", "--problems", "hsr", "--planners", "gpmp_fast,straight_line",
                "--pairs", "2", "--runs", "1", "--json", file});
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("warm, 2 cm off"));
  std::ifstream stream(file);
  const nlohmann::json json = nlohmann::json::parse(stream);
  ASSERT_EQ(json["rows"].size(), 4u) << "straight motions are hit, so that nothing warm is left";
  EXPECT_EQ(json["rows"][0]["planner"], "gpmp_fast");
  EXPECT_EQ(json["rows"][0]["free"], 2);
  EXPECT_EQ(json["rows"][1]["planner"], "straight_line");
  EXPECT_EQ(json["rows"][1]["free"], 0);
}

TEST(Help, NamesEveryCommandAndTheExitCodes) {
  const Finished finished = Sidestep({"--help"});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_THAT(finished.out, HasSubstr("Exit codes"));
  for (const std::string command : {"run", "compare", "render", "list", "doctor", "reproduce",
                                    "study", "audit", "bench", "field", "fci-server", "validate"}) {
    EXPECT_THAT(finished.out, HasSubstr("\n  " + command + " "));
    const Finished help = Sidestep({command, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out, HasSubstr("Usage: sidestep " + command));
  }
}

class Field : public ::testing::TestWithParam<std::string> {};

TEST_P(Field, IsDrawnOneSliceForEachTimeAhead) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "field.png";
  const Finished finished =
      Sidestep({"field", GetParam(), "--time", "0.2", "--ahead", "0,0.4", "--out", file});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  std::ifstream stream(file, std::ios::binary);
  const std::string png{std::istreambuf_iterator<char>(stream), {}};
  ASSERT_GT(png.size(), 24u);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  const auto big_endian = [&](std::size_t at) {
    return static_cast<unsigned char>(png[at]) * 256 + static_cast<unsigned char>(png[at + 1]);
  };
  EXPECT_GT(big_endian(18), 2 * 3 * 96);  // two slices of 96 cells, each in its axes
  EXPECT_LT(big_endian(18), 3 * 3 * 96);
  EXPECT_GT(big_endian(22), 3 * 96 + 40);  // a title, an axis and a scale
  EXPECT_LT(big_endian(22), 3 * 96 + 100);
}

INSTANTIATE_TEST_SUITE_P(WithAndWithoutARobot, Field,
                         ::testing::Values("hsr_walkway", "field_two_pillars"),
                         [](const auto& test) { return test.param; });

TEST(Audit, LeavesATableFieldsAndAPicture) {
  const TemporaryFolder temporary;
  const std::string folder = temporary.path();
  const Finished finished = Sidestep({"audit", "hsr_walkway", "--knowledge", "full_knowledge",
                                      "--points", "2000", "--ahead", "0,1", "--out", folder});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("knowledge: full_knowledge"), HasSubstr("margin"),
                                  HasSubstr("most wrong in free space")));
  const auto size = [&](const char* file) { return std::filesystem::file_size(folder + file); };
  const std::uintmax_t num_cells = 96 * 96 * 96;
  for (const char* file : {"/field.nrrd", "/truth.nrrd", "/difference.nrrd"}) {
    EXPECT_GT(size(file), 4 * num_cells) << file;
  }
  EXPECT_GT(size("/occupancy.nrrd"), num_cells);
  EXPECT_GT(size("/slice.png"), 1000u);
  std::ifstream stream(folder + "/audit.json");
  const nlohmann::json audit = nlohmann::json::parse(stream);
  // Who knows the truth is wrong by what cells cannot tell: the tables end half a cell off.
  std::size_t num_zones = 0;
  for (const auto& row : audit.at("errors")) {
    if (row.at("zone") != "margin") continue;
    ++num_zones;
    EXPECT_LT(row.at("median_m").get<double>(), 0.0205);
    EXPECT_LT(row.at("p99_m").get<double>(), 0.04);
  }
  EXPECT_EQ(num_zones, 2u);
}

TEST(Audit, TakesSettingsAndTellsOfNoErrorWhereThereIsNone) {
  const TemporaryFolder folder;
  const Finished finished =
      Sidestep({"audit", "hsr_walkway", "--points", "500", "--ahead", "0", "--set",
                "moving_obstacles=[]", "--set", "static_world=exact", "--set",
                "horizon.duration_s=1", "--out", folder.path().string()});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("no point in free space was wrong"));
  EXPECT_THAT(finished.out, ::testing::Not(HasSubstr("inf")));
}

// A study whose episodes take a moment: no optimiser, and short.
Finished QuickStudy(const std::filesystem::path& out, std::vector<std::string> further,
                    const std::vector<std::string>& environment = {}) {
  std::vector<std::string> arguments = {
      "study", "walkway_behaviours",   "--set", "planner.name=straight_line",
      "--set", "horizon.duration_s=1", "--out", out.string()};
  arguments.insert(arguments.end(), further.begin(), further.end());
  return Sidestep(arguments, environment);
}

TEST(Study, ThatIsToHaveMoreEpisodesRunsOnlyThose) {
  const TemporaryFolder folder;
  const auto study = [&](const std::string& episodes, const std::string& out) {
    const Finished finished = QuickStudy(
        folder.path() / out,
        {"--set", "behaviour=stop", "--knowledge", "static,prediction", "--episodes", episodes});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return finished.err;
  };
  study("2", "whole");
  study("1", "parts");
  EXPECT_THAT(study("2", "parts"), HasSubstr("2 of 4 runs, from before"));
  EXPECT_EQ(BytesOf(folder.path() / "parts/results.csv"),
            BytesOf(folder.path() / "whole/results.csv"));
  EXPECT_THAT(study("2", "parts"), HasSubstr("4 of 4 runs, from before"));
}

// The rows of a study's table, by column.
std::vector<std::map<std::string, std::string>> RowsIn(const std::filesystem::path& out) {
  const CsvFile csv = ReadCsv((out / "results.csv").string());
  std::vector<std::map<std::string, std::string>> rows;
  for (const CsvRow& line : csv.rows) {
    std::map<std::string, std::string>& row = rows.emplace_back();
    for (std::size_t i = 0; i < csv.columns.size(); ++i) row[csv.columns[i]] = line.fields[i];
  }
  return rows;
}

TEST(Study, KeepsTracesAndSaysWhatRunsAnEpisodeAgainToTheBit) {
  const TemporaryFolder folder;
  const Finished finished =
      QuickStudy(folder.path() / "study", {"--set", "behaviour=random_walk", "--knowledge",
                                           "static", "--episodes", "2", "--traces", "all"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  std::string last_trace;
  const auto rows = RowsIn(folder.path() / "study");
  EXPECT_EQ(rows.size(), 2u);
  for (const auto& row : rows) {
    EXPECT_NE(row.at("drawn_delay_s"), "");
    const std::string& command = row.at("command");
    ASSERT_THAT(command, StartsWith("sidestep run walkway_behaviours "));
    const std::string trace = BytesOf(folder.path() / "study" / row.at("trace"));
    // As it stands in the table: each row has a folder of its own to go into.
    const Finished run = RunProgram({"/bin/sh", "-c", SIDESTEP_PROGRAM + command.substr(8)}, {},
                                    folder.path().string());
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const std::filesystem::path again = folder.path() / command.substr(command.find("--out ") + 6);
    EXPECT_TRUE(BytesOf(again / "trace.h5") == trace) << command;
    EXPECT_NE(trace, last_trace);
    last_trace = trace;
  }
}

TEST(Study, MakesARowOfACombinationThatIsRefusedAndGoesOn) {
  const TemporaryFolder folder;
  const Finished finished =
      QuickStudy(folder.path(), {"--set", "behaviour=speed_up_2", "--speed", "1,90"});
  EXPECT_EQ(finished.exit_code, 1);
  const auto rows = RowsIn(folder.path());
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[1].at("outcome"), "failed");
  EXPECT_EQ(rows[1].at("error"), "speed_m_s: is above the max_speed_m_s of 'hsr'");
  EXPECT_EQ(rows[1].at("command"), "");
  EXPECT_THAT(finished.out, HasSubstr("| speed_m_s | episodes |"));
}

TEST(Study, LeavesOutWhatIsNotAskedForAndSaysSo) {
  const TemporaryFolder folder;
  const auto study = [&](const std::string& episodes) {
    return QuickStudy(folder.path(), {"--set", "behaviour=stop", "--episodes", episodes});
  };
  EXPECT_EQ(study("2").exit_code, 0);
  const Finished fewer = study("1");
  EXPECT_EQ(fewer.exit_code, 0) << fewer.err;
  EXPECT_EQ(RowsIn(folder.path()).size(), 1u);
  EXPECT_THAT(fewer.out, HasSubstr("1 rows of other runs in this folder are left out"));
}

TEST(Study, SaysOnItsPageWhatItIsOf) {
  const TemporaryFolder folder;
  const Finished finished = QuickStudy(
      folder.path(), {"--set", "behaviour=stop", "--knowledge", "static,prediction", "-j", "1"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(BytesOf(folder.path() / "summary.md"),
              AllOf(StartsWith("# walkway_behaviours\n"),
                    HasSubstr("- varied: knowledge = static, prediction\n"),
                    HasSubstr("- fixed: behaviour = stop\n"),
                    HasSubstr("sidestep study walkway_behaviours --set"),
                    HasSubstr("| knowledge | episodes |")));
}

TEST(Study, VariesKeysTogetherAndSetsTheSameEpisodesBesideEachOther) {
  const TemporaryFolder folder;
  const Finished finished = QuickStudy(
      folder.path(), {"--vary", "behaviour=stop,turn", "--vary",
                      "replanning.latency_s/replanning.rate_hz=0.1/10,0.02/50", "--episodes", "2"});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(BytesOf(folder.path() / "results.csv"),
              HasSubstr("--set replanning.latency_s=0.02 --set replanning.rate_hz=50"));
  EXPECT_THAT(
      BytesOf(folder.path() / "summary.md"),
      AllOf(
          HasSubstr("| behaviour, by replanning.latency_s/replanning.rate_hz | 0.1/10 | 0.02/50 |"),
          HasSubstr("\n| turn | 0.02/50 | 2 |"), HasSubstr("\n| all | 0.1/10 | 4 |")));
}

TEST(Bench, WritesPairsThatAStudyRuns) {
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "pairs.yaml").string();
  const Finished written = Sidestep({"bench", "pairs", "hsr", "--pairs", "2", "--out", file});
  EXPECT_EQ(written.exit_code, 0) << written.err;
  const Finished study =
      Sidestep({"study", file, "--set", "planner.name=straight_line", "--knowledge", "static",
                "--out", (folder.path() / "study").string()});
  EXPECT_EQ(study.exit_code, 0) << study.err;
  EXPECT_THAT(study.out, HasSubstr("| all | 0/2 |\n| collision | 2 |"));
  EXPECT_THAT(Sidestep({"bench", "pairs", "tsr"}).err,
              StartsWith("PROBLEM: must be one of hsr, person_high, wam, is 'tsr'"));
}

TEST(Study, GoesIntoAFolderOfItsScenario) {
  const TemporaryFolder folder;
  const Finished finished =
      RunProgram({SIDESTEP_PROGRAM, "study", "hsr_walkway", "--set", "planner.name=straight_line",
                  "--set", "horizon.duration_s=1"},
                 {}, folder.path().string());
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/study/hsr_walkway/results.csv"));
}

// A folder of data with these scenarios.
class OwnScenarios : public ::testing::Test {
 protected:
  void SetUp() override {
    namespace fs = std::filesystem;
    fs::create_directories(folder_.path() / "scenarios");
    fs::create_directory_symlink(SIDESTEP_SOURCE_DIR "/models", folder_.path() / "models");
  }
  std::string Path(const std::string& name) const {
    return folder_.path() / "scenarios" / (name + ".yaml");
  }
  void Write(const std::string& name, const std::string& old_text, const std::string& new_text) {
    std::string text = BytesOf(SIDESTEP_SOURCE_DIR "/scenarios/hsr_walkway.yaml");
    text.replace(text.find(old_text), old_text.size(), new_text);
    std::ofstream(Path(name)) << text;
  }
  Finished Run(const std::vector<std::string>& arguments) const {
    return Sidestep(arguments, {"SIDESTEP_DATA_DIR=" + folder_.path().string()});
  }

  const TemporaryFolder folder_;
};

TEST_F(OwnScenarios, AreListedThoughOneIsWrong) {
  Write("bad", "seed: ", "sed: ");
  Write("good", "description: ", "description: Good: ");
  Write("good", "description: ", "description: >\n  ");
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"list"},
                                                    {"list", "scenarios"},
                                                    {"list", "scenarios", "--names"}}) {
    const Finished finished = Run(arguments);
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_THAT(finished.out, HasSubstr("good"));
    EXPECT_THAT(finished.err, StartsWith(Path("bad") + ":"));
    EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1);
  }
  EXPECT_EQ(Run({"list", "robots"}).exit_code, 0);
}

TEST_F(OwnScenarios, ShowNoControlCharactersOnATerminal) {
  Write("esc", "description: ", "name: \"a\\e[31mb\\x9b1m|c\"\ndescription: \"\\e]0;x\\a\" #");
  const Finished list = Run({"list"});
  EXPECT_THAT(list.out, HasSubstr("\\x1B]0;x\\x07"));
  EXPECT_EQ(list.out.find('\x1b'), std::string::npos);
  const std::string out = folder_.path() / "out";
  const std::vector<std::string> quick = {
      "--set", "planner.name=straight_line", "--set", "horizon.duration_s=1", "--out", out};
  std::vector<std::string> run = {"run", "esc"};
  run.insert(run.end(), quick.begin(), quick.end());
  EXPECT_EQ(Run(run).exit_code, 0);
  std::filesystem::create_directory(folder_.path() / "\x1b[31m");
  std::filesystem::copy(out, folder_.path() / "\x1b[31m");
  const Finished compare = Run({"compare", out, folder_.path() / "\x1b[31m"});
  EXPECT_EQ(compare.exit_code, 0) << compare.err;
  EXPECT_THAT(compare.out, HasSubstr("\\x1B[31m"));
  EXPECT_EQ(compare.out.find('\x1b'), std::string::npos);
}

TEST(List, SaysWhatPlannersPredictorsAndSensorsDo) {
  for (const std::string kind : {"planners", "predictors", "sensors"}) {
    std::istringstream lines(Sidestep({"list", kind}).out);
    std::istringstream names(Sidestep({"list", kind, "--names"}).out);
    for (std::string line, name; std::getline(lines, line);) {
      if (line.starts_with("    --set ")) continue;  // of the planner above
      ASSERT_TRUE(std::getline(names, name));
      EXPECT_THAT(line, StartsWith(name + " "));
      EXPECT_GT(line.size(), 35u) << line;
    }
  }
}

TEST(Run, TellsWhatWasTouchedAndTheDwellThatWasAskedFor) {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& dwell_s) {
    return Sidestep({"run", "hsr_walkway", "--knowledge", "static", "--set",
                     "task.dwell_s=" + dwell_s, "--out", folder.path()});
  };
  const Finished with = run("0.1");
  EXPECT_THAT(with.out, AllOf(HasSubstr("outcome          collision with hsr\n"),
                              HasSubstr("dwell of 0.1 s")));
  EXPECT_EQ(nlohmann::json::parse(BytesOf(folder.path() / "result.json")).at("touched"), "hsr");
  EXPECT_THAT(Sidestep({"compare", folder.path()}).out, HasSubstr("collision with hsr"));
  EXPECT_THAT(run("0").out, ::testing::Not(HasSubstr("dwell")));
}

TEST(Hindsight, TellsOfATraceThatCannotBeReadAndLooksAtTheOthers) {
  const TemporaryFolder folder;
  const std::string good = folder.path() / "trace.h5", broken = folder.path() / "broken.h5",
                    missing = folder.path() / "missing.h5";
  ASSERT_EQ(Sidestep({"run", "hsr_walkway", "--set", "planner.name=straight_line", "--knowledge",
                      "static", "--out", folder.path()})
                .exit_code,
            0);
  std::ofstream(broken) << "no trace";
  const Finished hindsight =
      Sidestep({"hindsight", "--brief", "--guesses", "1", broken, good, missing, good});
  EXPECT_EQ(hindsight.exit_code, 2);
  EXPECT_THAT(hindsight.err,
              ::testing::MatchesRegex(broken + ": [^\n]*\n" + missing + ": no such file\n"));
  EXPECT_EQ(std::count(hindsight.out.begin(), hindsight.out.end(), '\n'), 2) << hindsight.out;
  EXPECT_THAT(hindsight.out, StartsWith(good + ": "));
  EXPECT_EQ(Sidestep({"hindsight", "--brief", "--guesses", "1", good}).exit_code, 0);
}

TEST(Compare, TellsWhichRunsWouldHaveTripped) {
  const TemporaryFolder folder;
  const auto run = [&](const std::string& name, const std::string& horizon_s) {
    const std::string out = folder.path() / name;
    EXPECT_EQ(Sidestep({"run", "hsr_walkway", "--set", "planner.name=straight_line", "--set",
                        "horizon.duration_s=" + horizon_s, "--out", out})
                  .exit_code,
              0);
    return out;
  };
  const auto trips = [](const std::string& out) {
    return nlohmann::json::parse(BytesOf(out + "/result.json")).at("would_trip");
  };
  const std::string quick = run("quick", "1"), slow = run("slow", "20");
  EXPECT_EQ(trips(quick), nlohmann::json::array({"acceleration_use", "commanded_torque_rate_use",
                                                 "tool_acceleration_use", "tool_reflex_use"}));
  EXPECT_EQ(trips(slow), nlohmann::json::array());
  std::istringstream lines(Sidestep({"compare", quick, slow}).out);
  std::string heads, units, of_quick, of_slow;
  std::getline(lines, heads);
  std::getline(lines, units);
  std::getline(lines, of_quick);
  std::getline(lines, of_slow);
  const std::size_t column = heads.find("would trip");
  ASSERT_NE(column, std::string::npos) << heads;
  EXPECT_THAT(of_quick.substr(column),
              StartsWith("acceleration, torque rate, tool acceleration, tool reflex "));
  EXPECT_THAT(of_slow.substr(column), StartsWith("no "));
}

TEST(Compare, TellsRunsApartByFolderAndByWhatDiffers) {
  const TemporaryFolder folder;
  std::vector<std::string> compare = {"compare"};
  for (const char* const epsilon : {"0.100001", "0.15123456"}) {
    compare.push_back((folder.path() / epsilon).string());
    const Finished run =
        Sidestep({"run", "hsr_walkway", "--set", "planner.name=straight_line", "--set",
                  "horizon.duration_s=1", "--epsilon", epsilon, "--out", compare.back()});
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }
  const Finished finished = Sidestep(compare);
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_THAT(finished.out, HasSubstr("  outcome "));
  EXPECT_THAT(finished.out, AllOf(HasSubstr("epsilon_m"), HasSubstr(compare[1]),
                                  HasSubstr("  0.1512  "), ::testing::Not(HasSubstr("seed"))));
}

TEST(Compare, LeavesTheRunsAsASweepDoesForAReport) {
  const TemporaryFolder folder;
  std::vector<std::string> compare = {"compare", "--out", folder.path() / "both"};
  for (const std::string knowledge : {"static", "prediction"}) {
    compare.push_back(folder.path() / knowledge);
    const Finished run =
        Sidestep({"run", "hsr_walkway", "--set", "planner.name=straight_line", "--set",
                  "horizon.duration_s=1", "--knowledge", knowledge, "--out", compare.back()});
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }
  const Finished finished = Sidestep(compare);
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("planner knows"), HasSubstr("both/results.db")));
  const bench::RunDatabase database(folder.path() / "both/results.db");
  ASSERT_EQ(database.factors().size(), 1u);
  EXPECT_EQ(database.factors()[0].name, "knowledge");
  auto row = database.Select("outcome, knowledge, trace, command");
  ASSERT_TRUE(row.Step());
  const auto result = nlohmann::json::parse(BytesOf(folder.path() / "static/result.json"));
  EXPECT_EQ(row.Text(0), result.at("outcome"));
  EXPECT_EQ(row.Text(1), "static");
  EXPECT_EQ(row.Text(2), "../static/trace.h5");
  EXPECT_TRUE(row.IsNull(3));
  const Finished report = Sidestep(
      {"report", folder.path() / "both/results.db", "--out", folder.path() / "report.html"});
  EXPECT_EQ(report.exit_code, 0) << report.err;
  EXPECT_THAT(report.out, HasSubstr("n = 1 pairs"));
  EXPECT_THAT(BytesOf(folder.path() / "report.html"), HasSubstr("replay in 3-D"));
}

TEST(List, ShowsWhatCanBeNamed) {
  const Finished finished = Sidestep({"list"});
  EXPECT_EQ(finished.exit_code, 0);
  EXPECT_THAT(finished.out, AllOf(HasSubstr("hsr_walkway"), HasSubstr("full_knowledge"),
                                  HasSubstr("gpmp"), HasSubstr("two_frame"), HasSubstr("panda"),
                                  HasSubstr("min_clearance_m"), HasSubstr("--set pair=1|2|3")));
}

TEST(Doctor, FindsNothingMissingWhereTheTestsRun) {
  const Finished finished = Sidestep({"doctor"});
  EXPECT_EQ(finished.exit_code, 0) << finished.out;
  EXPECT_THAT(finished.out,
              AllOf(HasSubstr("mujoco"), HasSubstr("rendering"), HasSubstr("libx264")));
}

TEST(Doctor, NamesTheRemedyForAGlThatIsNotThere) {
  const Finished finished = Sidestep({"doctor"}, {"MUJOCO_GL=glfw"});
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_THAT(finished.out,
              AllOf(HasSubstr("MISSING"), HasSubstr("MUJOCO_GL"), HasSubstr("remedy")));
}

TEST(Data, FromAFolderThatHoldsNoneIsRefused) {
  const Finished finished = Sidestep({"list"}, {"SIDESTEP_DATA_DIR=/nowhere"});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_THAT(finished.err, StartsWith("SIDESTEP_DATA_DIR: "));
}

// Of what the planner may not see while the verdict does.
TEST(ThinThings, AreWarnedOfOnceEachWhereOnlyCentresCount) {
  const TemporaryFolder folder;
  const auto err = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {
        "run",   SIDESTEP_SOURCE_DIR "/tests/data/hard_scenarios/thin_sheet.yaml",
        "--out", folder.path(),
        "--set", "planner.name=straight_line"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished finished = Sidestep(arguments);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return finished.err;
  };
  const std::string sheet = err({"--set", "sensor.cells=centre"});
  EXPECT_THAT(sheet, testing::StartsWith("warning: "));
  EXPECT_THAT(sheet, HasSubstr("thin_sheet.yaml:"));
  EXPECT_THAT(sheet, HasSubstr("static_boxes["));
  EXPECT_EQ(std::count(sheet.begin(), sheet.end(), '\n'), 1) << sheet;
  EXPECT_EQ(err({}), "");
  EXPECT_EQ(err({"--set", "sensor.cells=centre", "--set", "static_world=exact"}), "");
}

TEST(ThinThings, ThatMoveAreWarnedOfToo) {
  const TemporaryFolder folder;
  for (const std::string command : {"run", "audit"}) {
    const Finished finished = Sidestep({command, "hsr_walkway", "--out", folder.path(), "--set",
                                        "planner.name=straight_line", "--set",
                                        "moving_obstacles[0].shape={cylinder: {radius_m: 0.015, "
                                        "length_m: 1.2}}"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_THAT(finished.err, HasSubstr("warning: --set moving_obstacles[0].shape: 'hsr' is 0.03 m "
                                        "thin, less than a cell of 0.04 m"));
  }
}

}  // namespace
}  // namespace sidestep::command_line_test
