#include "sidestep/bench/study_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "sidestep/core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::bench {
namespace {

using ::testing::HasSubstr;

RunRow Row(const std::string& seed) {
  RunRow row;
  row.factors = {{"behaviour", "stop"}, {"seed", seed}};
  row.drawn = {{"delay_s", 0.1 + 1e-17}};
  row.identity = {"scene", "models", "build", "search 40"};
  row.outcome = "failed";
  row.error = "a \"word\",\nquoted";
  row.metrics = {{"min_clearance_m", 0.1 + 1e-17}, {"first_contact_s", NAN}};
  return row;
}

class StudyLogTest : public ::testing::Test {
 protected:
  void WriteText(const std::string& text) const { std::ofstream(path_) << text; }
  std::string MessageOfOpening(bool resume) const {
    try {
      StudyLog log(path_, resume);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
  const std::string path_ = (folder_.path() / "study.jsonl").string();
};

TEST_F(StudyLogTest, GivesBackTheRowsThatItWasGiven) {
  {
    StudyLog log(path_, /*resume=*/false);
    log.Append(Row("1"));
    log.Append(Row("2"));
  }
  const StudyLog log(path_, /*resume=*/true);
  const RunRow* const row = log.Find(Row("2").factors);
  ASSERT_NE(row, nullptr);
  EXPECT_EQ(row->outcome, "failed");
  EXPECT_EQ(row->error, Row("2").error);
  EXPECT_EQ(row->metrics.at("min_clearance_m"), 0.1 + 1e-17);
  EXPECT_TRUE(std::isnan(row->metrics.at("first_contact_s")));
  EXPECT_EQ(row->drawn, Row("2").drawn);
  EXPECT_EQ(row->identity.scenario, "scene");
  EXPECT_EQ(row->identity.models, "models");
  EXPECT_EQ(row->identity.build, "build");
  EXPECT_EQ(row->identity.method, "search 40");
  EXPECT_EQ(log.Find(Row("3").factors), nullptr);
}

TEST_F(StudyLogTest, LosesAtMostTheRowThatWasBeingWritten) {
  {
    StudyLog log(path_, /*resume=*/false);
    log.Append(Row("1"));
    log.Append(Row("2"));
  }
  const auto size = std::filesystem::file_size(path_);
  std::filesystem::resize_file(path_, size - 3);
  {
    StudyLog log(path_, /*resume=*/true);
    EXPECT_NE(log.Find(Row("1").factors), nullptr);
    EXPECT_EQ(log.Find(Row("2").factors), nullptr);
    log.Append(Row("2"));
  }
  EXPECT_EQ(std::filesystem::file_size(path_), size);
  EXPECT_NE(StudyLog(path_, /*resume=*/true).Find(Row("2").factors), nullptr);
}

TEST_F(StudyLogTest, DoesNotTouchRowsThatNobodyWantsToGoOnWith) {
  { StudyLog(path_, /*resume=*/false).Append(Row("1")); }
  EXPECT_THAT(MessageOfOpening(/*resume=*/false), HasSubstr("study.jsonl: holds a study: go on"));
  EXPECT_NE(StudyLog(path_, /*resume=*/true).Find(Row("1").factors), nullptr);
}

TEST_F(StudyLogTest, BeginsAnewWhereNotEvenTheFirstLineIsWhole) {
  { StudyLog log(path_, /*resume=*/false); }
  const auto whole = std::filesystem::file_size(path_);
  for (const bool resume : {false, true}) {
    for (const std::uintmax_t size : {std::uintmax_t{0}, whole - 1}) {
      std::filesystem::resize_file(path_, size);
      EXPECT_EQ(MessageOfOpening(resume), "");
      EXPECT_EQ(std::filesystem::file_size(path_), whole);
    }
  }
}

TEST_F(StudyLogTest, IsRefusedWhileAnotherStudyHasIt) {
  StudyLog first(path_, /*resume=*/false);
  EXPECT_THAT(MessageOfOpening(/*resume=*/true), HasSubstr("another study is writing here"));
  first.Append(Row("1"));
  EXPECT_THAT(MessageOfOpening(/*resume=*/false), HasSubstr("another study is writing here"));
}

TEST_F(StudyLogTest, TakesTextThatIsNotUtf8) {
  RunRow row = Row("1");
  row.error = "caf\xe9.yaml: no such file";
  { StudyLog(path_, /*resume=*/false).Append(row); }
  const StudyLog log(path_, /*resume=*/true);
  ASSERT_NE(log.Find(row.factors), nullptr);
  EXPECT_THAT(log.Find(row.factors)->error, HasSubstr(".yaml: no such file"));
}

TEST_F(StudyLogTest, RefusesWhatIsNoLog) {
  WriteText("seed,outcome\n1,goal\n");
  EXPECT_THAT(MessageOfOpening(/*resume=*/true), HasSubstr("study.jsonl: is no log of a study"));
  EXPECT_THAT(MessageOfOpening(/*resume=*/false), HasSubstr("study.jsonl: is no log of a study"));
  std::filesystem::remove(path_);
  { StudyLog log(path_, /*resume=*/false); }
  std::ofstream(path_, std::ios::app) << "{\"outcome\":\"goal\"}\n";
  EXPECT_THAT(MessageOfOpening(/*resume=*/true), HasSubstr("study.jsonl:2: is no row of a study"));
}

TEST_F(StudyLogTest, RefusesAnOutcomeThatIsNone) {
  RunRow row = Row("2");
  row.outcome = "great";
  {
    StudyLog log(path_, /*resume=*/false);
    log.Append(Row("1"));
    log.Append(row);
  }
  EXPECT_EQ(MessageOfOpening(/*resume=*/true), path_ + ":3: outcome: no outcome is 'great'");
}

TEST_F(StudyLogTest, SaysWhereItCannotBeWritten) {
  EXPECT_THROW(StudyLog("/nowhere/study.jsonl", /*resume=*/false), InputError);
  EXPECT_THROW(StudyLog("/dev/full", /*resume=*/false), InputError);
}

}  // namespace
}  // namespace sidestep::bench
