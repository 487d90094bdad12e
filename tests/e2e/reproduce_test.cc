// `sidestep reproduce` as a person meets it: what it writes, what it says, how it ends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::reproduce_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string ReadFile(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  EXPECT_TRUE(stream.good()) << path;
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string WriteFile(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

Finished Reproduce(std::vector<std::string> arguments,
                   const std::vector<std::string>& environment = {}) {
  arguments.insert(arguments.begin(), {SIDESTEP_PROGRAM, "reproduce"});
  return RunProgram(arguments, environment);
}

// Pair 1 of the Panda at 1.4 m/s as published; without obstacle costs, which are not compared then.
std::string PublishedRow(const std::string& counts) {
  return "pair,speed_m_per_s,n_colliding_states_static,n_colliding_states_execute_update,"
         "n_colliding_states_full_knowledge,gp_cost_static\n1,1.4," +
         counts + ",9.00678449925957\n";
}

std::vector<std::string> OneRow(const std::string& folder) {
  return {"panda_hsr", "--pairs", "1", "--speeds", "1.4", "-j", "1", "--out", folder};
}

TEST(Reproduce, LeavesOutTheExclusionsWhereAPublishedKindOfKnowledgeIsNotRun) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = OneRow(folder.path());
  arguments.insert(arguments.end(), {"--case", "prediction"});
  const Finished finished = Reproduce(arguments);
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("all_rows: 1 rows"),
                                  HasSubstr("published_exclusions: left out, they need")));
  EXPECT_EQ(nlohmann::json::parse(ReadFile(folder.path() / "statistics.json")).size(), 1u);
}

TEST(Reproduce, EndsWellWhereThePublishedCountsAgree) {
  const TemporaryFolder temporary;
  const std::string folder = temporary.path();
  std::vector<std::string> arguments = OneRow(folder);
  arguments.insert(arguments.end(),
                   {"--published", WriteFile(folder + "/published.csv", PublishedRow("6,0,0"))});
  const Finished finished = Reproduce(arguments);
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("colliding-state counts: 3 of 3 agree"),
                                  HasSubstr("gp_cost_static"), Not(HasSubstr("differs:"))));
  EXPECT_THAT(ReadFile(folder + "/rows.csv"),
              HasSubstr("pair,speed_m_per_s,n_colliding_states_static,"));
  const auto statistics = nlohmann::json::parse(ReadFile(folder + "/statistics.json"));
  EXPECT_EQ(statistics.at(0).at("filter"), "all_rows");
  EXPECT_EQ(statistics.at(1).at("filter"), "published_exclusions");
  EXPECT_EQ(statistics.at(0).at("rows"), 1);
  const std::string page = ReadFile(folder + "/index.html");
  EXPECT_THAT(page, AllOf(HasSubstr("3 of 3 entries"), HasSubstr("data:image/svg+xml")));
  EXPECT_THAT(page, Not(HasSubstr("src=\"http"))) << "the page must stand alone";
  EXPECT_GT(std::filesystem::file_size(folder + "/figure.png"), 1000u);
}

TEST(Reproduce, EndsWithOneWhereACountDiffers) {
  const TemporaryFolder temporary;
  const std::string folder = temporary.path();
  std::vector<std::string> arguments = OneRow(folder);
  arguments.insert(arguments.end(),
                   {"--published", WriteFile(folder + "/published.csv", PublishedRow("6,1,0"))});
  const Finished finished = Reproduce(arguments);
  EXPECT_EQ(finished.exit_code, 1) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("2 of 3 agree"),
                                  HasSubstr("differs: pair 1, 1.4 m/s, "
                                            "n_colliding_states_execute_update: 0, published 1")));
}

TEST(Reproduce, SaysWhichSpheresItIgnoresInTheIntendedGeometry) {
  const TemporaryFolder temporary;
  const std::string folder = temporary.path();
  std::vector<std::string> arguments = OneRow(folder);
  arguments.insert(arguments.end(), {"--intended-geometry", "--once", "--case", "static"});
  const Finished finished = Reproduce(arguments);
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("ignored, for they overlap what the robot stands on"));
  EXPECT_THAT(ReadFile(folder + "/index.html"),
              AllOf(HasSubstr("Ignored in planning"), HasSubstr("where they were meant to"),
                    HasSubstr("solved once")));
}

TEST(Reproduce, DoesWithoutGnuplotAndSaysSo) {
  const TemporaryFolder temporary;
  const std::string folder = temporary.path();
  std::vector<std::string> arguments = OneRow(folder);
  arguments.insert(arguments.end(), {"--once", "--case", "static"});
  const Finished finished = Reproduce(arguments, {"PATH=" + folder});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("not drawn: "), HasSubstr("gnuplot-nox")));
  EXPECT_THAT(ReadFile(folder + "/index.html"), Not(HasSubstr("<img")));
  EXPECT_FALSE(std::filesystem::exists(folder + "/figure.svg"));
}

TEST(Reproduce, TimesPredictedFieldsInTheScenesAndSizesAskedFor) {
  const TemporaryFolder temporary;
  const std::string folder = temporary.path();
  const Finished finished = Reproduce(
      {"sdf_timing", "--sizes", "32,48", "--scenes", "field_one_box", "--published",
       WriteFile(folder + "/published.csv", "voxels_per_side,full_computation_mean_ms\n48,5.25\n"),
       "--out", folder});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, AllOf(HasSubstr("48 voxels a side, 0.07 m"), HasSubstr("(5.25)"),
                                  HasSubstr("composite off the exact by   0 m in free space")));
  EXPECT_THAT(ReadFile(folder + "/rows.csv"), HasSubstr("voxels_per_side,cell_size_m,"));
  EXPECT_THAT(ReadFile(folder + "/index.html"), HasSubstr("data:image/svg+xml"));
}

TEST(Reproduce, LeavesItsOpenLoopAsRunsThatAReportIsMadeOf) {
  const TemporaryFolder temporary;
  const std::string folder = temporary.path();
  const Finished finished =
      Reproduce({"panda_hsr", "--pairs", "1-3", "--speeds", "1.4", "--case",
                 "execute_and_update,prediction", "-j", "1", "--out", folder});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  const Finished report = RunProgram(
      {SIDESTEP_PROGRAM, "report", folder + "/results.db", "--out", folder + "/report.html"});
  EXPECT_EQ(report.exit_code, 0) << report.err;
  EXPECT_THAT(report.out, HasSubstr("n = 3 pairs"));
  const Finished verify = RunProgram({SIDESTEP_PROGRAM, "verify", folder + "/results.db"});
  EXPECT_EQ(verify.exit_code, 2);
  EXPECT_THAT(verify.err, HasSubstr("does not say how run 1 is made again"));
}

TEST(Reproduce, LeavesTheRunsOfItsClosedLoopToBeMadeAgain) {
  const TemporaryFolder temporary;
  const std::string folder = temporary.path();
  const Finished finished = Reproduce({"closed_loop", "--sizes", "32,96", "--out", folder});
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  const Finished verify = RunProgram({SIDESTEP_PROGRAM, "verify", folder + "/results.db"});
  EXPECT_EQ(verify.exit_code, 0) << verify.out << verify.err;
  EXPECT_THAT(verify.out, HasSubstr("3 of 3 runs came out the same, bit for bit"));
  EXPECT_THAT(ReadFile(folder + "/results.csv"), HasSubstr("prediction.h5"));
  const Finished report = RunProgram(
      {SIDESTEP_PROGRAM, "report", folder + "/results.db", "--out", folder + "/report.html"});
  EXPECT_EQ(report.exit_code, 0) << report.err;
  EXPECT_THAT(report.out, HasSubstr("With knowledge prediction the robot reached its goal and "
                                    "touched nothing in 1 of 1 runs"));
}

struct Mistake {
  const char* name;
  std::vector<std::string> arguments;
  const char* says;
};
std::ostream& operator<<(std::ostream& stream, const Mistake& m) { return stream << m.name; }

class ReproduceMistakes : public ::testing::TestWithParam<Mistake> {};

TEST_P(ReproduceMistakes, GetOneLineAndExitCodeTwo) {
  const Finished finished = Reproduce(GetParam().arguments);
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_EQ(finished.out, "");
  EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
  EXPECT_THAT(finished.err, HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    Typical, ReproduceMistakes,
    ::testing::Values(
        Mistake{"NoExperiment", {}, "reproduce: needs one of "},
        Mistake{"UnknownExperiment", {"moon_landing"}, "moon_landing"},
        Mistake{"SpeedsAreTwo", {"panda_hsr", "--speeds", "1:2"}, "--speeds: must be one speed"},
        Mistake{"SpeedIsAWord", {"panda_hsr", "--speeds", "fast"}, "--speeds: 'fast'"},
        Mistake{"NoSuchPair", {"panda_hsr", "--pairs", "49"}, "--pairs: '49'"},
        Mistake{"PairTwice", {"panda_hsr", "--pairs", "1-3,2"}, "--pairs: names '2' twice"},
        Mistake{"NoSuchCase", {"panda_hsr", "--case", "oracle"}, "--case: unknown knowledge"},
        Mistake{"CaseTwice", {"panda_hsr", "--case", "static,static"}, "--case: names 'static'"},
        Mistake{"NoSuchPredictor", {"panda_hsr", "--predictor", "crystal_ball"}, "--predictor: "},
        Mistake{"NegativeSigma", {"panda_hsr", "--sigma-obs", "-1"}, "--sigma-obs"},
        Mistake{"NoSuchTable", {"panda_hsr", "--published", "/nowhere.csv"}, "/nowhere.csv"},
        Mistake{"NoSuchScene",
                {"sdf_timing", "--scenes", "field_of_dreams"},
                "--scenes: must be one of field_one_box"},
        Mistake{"SizeIsTooLarge", {"sdf_timing", "--sizes", "4096"}, "--sizes"},
        Mistake{
            "NoSuchRates", {"closed_loop", "--published-loops", "/nowhere.csv"}, "/nowhere.csv"},
        Mistake{"OutIsAFile", {"panda_hsr", "--out", SIDESTEP_PROGRAM}, "--out: "}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace sidestep::reproduce_test
