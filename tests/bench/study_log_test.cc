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

StudyRow Row(const std::string& seed) {
  StudyRow row;
  row.factors = {{"behaviour", "stop"}, {"seed", seed}};
  row.outcome = "failed";
  row.error = "a \"word\",\nquoted";
  row.metrics = {{"min_clearance_m", 0.1 + 1e-17}, {"first_contact_s", NAN}};
  return row;
}

class StudyLogTest : public ::testing::Test {
 protected:
  void WriteText(const std::string& text) const { std::ofstream(path_) << text; }
  std::string MessageOfResuming(const std::string& study) const {
    try {
      StudyLog log(path_, study, /*resume=*/true);
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
    StudyLog log(path_, "mine", /*resume=*/false);
    log.Append(Row("1"));
    log.Append(Row("2"));
  }
  const StudyLog log(path_, "mine", /*resume=*/true);
  const StudyRow* const row = log.Find(Row("2").factors);
  ASSERT_NE(row, nullptr);
  EXPECT_EQ(row->outcome, "failed");
  EXPECT_EQ(row->error, Row("2").error);
  EXPECT_EQ(row->metrics.at("min_clearance_m"), 0.1 + 1e-17);
  EXPECT_TRUE(std::isnan(row->metrics.at("first_contact_s")));
  EXPECT_EQ(log.Find(Row("3").factors), nullptr);
}

TEST_F(StudyLogTest, LosesAtMostTheRowThatWasBeingWritten) {
  {
    StudyLog log(path_, "mine", /*resume=*/false);
    log.Append(Row("1"));
    log.Append(Row("2"));
  }
  const auto size = std::filesystem::file_size(path_);
  std::filesystem::resize_file(path_, size - 3);
  {
    StudyLog log(path_, "mine", /*resume=*/true);
    EXPECT_NE(log.Find(Row("1").factors), nullptr);
    EXPECT_EQ(log.Find(Row("2").factors), nullptr);
    log.Append(Row("2"));
  }
  EXPECT_EQ(std::filesystem::file_size(path_), size);
  EXPECT_NE(StudyLog(path_, "mine", /*resume=*/true).Find(Row("2").factors), nullptr);
}

TEST_F(StudyLogTest, BeginsAnewWhereNothingIsToBeResumed) {
  { StudyLog(path_, "mine", /*resume=*/true).Append(Row("1")); }
  EXPECT_EQ(StudyLog(path_, "mine", /*resume=*/false).Find(Row("1").factors), nullptr);
}

TEST_F(StudyLogTest, RefusesWhatIsNotTheSameStudy) {
  { StudyLog log(path_, "mine", /*resume=*/false); }
  EXPECT_THAT(MessageOfResuming("another"), HasSubstr("study.jsonl: is of a study with another"));
  WriteText("seed,outcome\n1,goal\n");
  EXPECT_THAT(MessageOfResuming("mine"), HasSubstr("study.jsonl:1: is no row of a study"));
  WriteText("{\"study\":\"mine\"}\n{\"outcome\":\"goal\"}\n");
  EXPECT_THAT(MessageOfResuming("mine"), HasSubstr("study.jsonl:2: is no row of a study"));
  WriteText("{\"study\":\"mi");
  EXPECT_THAT(MessageOfResuming("mine"), HasSubstr("study.jsonl: is no log of a study"));
}

TEST_F(StudyLogTest, SaysWhereItCannotBeWritten) {
  EXPECT_THROW(StudyLog("/nowhere/study.jsonl", "mine", /*resume=*/false), InputError);
}

}  // namespace
}  // namespace sidestep::bench
