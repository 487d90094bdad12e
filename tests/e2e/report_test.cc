// The page of `sidestep report` in a real browser, and the films of `sidestep render --from`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/browser.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::report_test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kSweep = R"(
description: Does it help <b>to know</b>?
scenarios: [hsr_walkway]
set: {planner.name: gpmp_fast}
variations: {speed_factor: [0.95, 1.05]}
axes:
  speed_m_s: [1.4, 1.6]
  knowledge: [execute_and_update, prediction]
seeds: 2
traces: all
compare: {factor: knowledge, of: prediction, with: execute_and_update}
)";

class Report : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    std::ofstream(Path("sweep.yaml")) << kSweep;
    const Finished sweep =
        RunProgram({SIDESTEP_PROGRAM, "sweep", "run", Path("sweep.yaml"), "--out", Path("sweep")});
    ASSERT_EQ(sweep.exit_code, 0) << sweep.err;
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string Path(const std::string& name) { return (folder_->path() / name).string(); }
  static std::string Database() { return Path("sweep") + "/results.db"; }

  // `sidestep report`, and what it printed.
  static std::string Make(const std::string& page, const std::vector<std::string>& more = {}) {
    std::vector<std::string> command = {SIDESTEP_PROGRAM, "report", Database(), "--out",
                                        Path(page)};
    command.insert(command.end(), more.begin(), more.end());
    const Finished made = RunProgram(command);
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return made.out;
  }

  static TemporaryFolder* folder_;
};
TemporaryFolder* Report::folder_ = nullptr;

TEST_F(Report, ShowsItsAnswerOnTheFirstScreenAndReplaysRuns) {
  if (!Browser::IsInstalled()) GTEST_SKIP() << "chromium is not installed";
  const std::string printed = Make("report.html");
  Browser browser;
  browser.Resize(1280, 900);
  browser.Open(Path("report.html"));

  // One sentence with both rates, their difference, its interval, n and p; one figure.
  const std::string sentence =
      browser.Evaluate("document.querySelector('article:not([hidden]) .sentence').textContent");
  EXPECT_THAT(sentence,
              ::testing::ContainsRegex(
                  "prediction .* in [0-9]+ of 4 runs .*, with execute_and_update in [0-9]+ of "
                  "4 runs .*: a difference of [+-].* percentage points \\(95 % interval .* to "
                  ".*\\), n = 4 pairs of 2 seeds, p = "));
  EXPECT_THAT(printed, HasSubstr(sentence));
  EXPECT_LT(browser.Evaluate("document.querySelector('article:not([hidden]) svg')"
                             ".getBoundingClientRect().bottom"),
            900);
  EXPECT_GE(browser.Evaluate("document.querySelectorAll('svg.figure').length"), 10);
  EXPECT_EQ(browser.Evaluate("document.querySelectorAll('main b b').length"), 0);

  // Another comparison takes its place.
  browser.Evaluate(
      "(() => { const choice = document.getElementById('comparison'); choice.selectedIndex = 1;"
      " choice.dispatchEvent(new Event('change')); })()");
  EXPECT_NE(
      browser.Evaluate("document.querySelector('article:not([hidden]) .sentence').textContent"),
      sentence);
  EXPECT_EQ(browser.Evaluate("document.querySelectorAll('article:not([hidden])').length"), 1);

  browser.Evaluate("document.querySelector('.open-replay').click()");
  EXPECT_EQ(browser.Evaluate("document.querySelector('.replay').sidestepReplay.state().traces"), 2);
  EXPECT_THAT(browser.complaints(), IsEmpty());

  browser.Resize(390, 844, /*mobile=*/true);
  EXPECT_LE(browser.Evaluate("document.documentElement.scrollWidth"), 390);
  constexpr const char* kPaper =
      "parseInt(getComputedStyle(document.body).backgroundColor.slice(4))";
  EXPECT_GT(browser.Evaluate(kPaper), 200);
  browser.PreferDark(true);
  EXPECT_LT(browser.Evaluate(kPaper), 60);
}

TEST_F(Report, LeavesItsFiguresAsFiles) {
  Make("plain.html", {"--replays", "0", "--figures", Path("figures")});
  EXPECT_TRUE(fs::exists(Path("figures/answer.svg")));
  EXPECT_TRUE(fs::exists(Path("figures/clearance_ecdf.svg")));
  EXPECT_TRUE(fs::exists(Path("figures/charged_and_needed.svg")));
  EXPECT_LT(fs::file_size(Path("plain.html")), 400'000u) << "three.js is in it";
}

TEST_F(Report, SaysInOneLineWhatIsWrong) {
  const auto complaint = [](const std::vector<std::string>& arguments) {
    std::vector<std::string> command = {SIDESTEP_PROGRAM, "report"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const Finished run = RunProgram(command, {}, folder_->path().string());
    EXPECT_EQ(run.exit_code, 2);
    return run.err;
  };
  EXPECT_EQ(
      complaint({Database(), "--compare", "knowledge", "prediction", "magic"}),
      "--compare: 'magic' is no value of knowledge (there are: execute_and_update, prediction)\n");
  EXPECT_EQ(complaint({Database(), "--over", "colour"}),
            "--over: 'colour' was not varied (there are: speed_m_s, knowledge)\n");
  EXPECT_EQ(complaint({Database(), "--out", Database()}),
            Database() + ": is the database, it must not be written over\n");
  EXPECT_THAT(complaint({Path("sweep.yaml")}), HasSubstr("sweep.yaml"));
  EXPECT_THAT(complaint({"nothing.db"}), HasSubstr("nothing.db"));
}

TEST_F(Report, FilmsTheRunsThatAreAskedFor) {
  const Finished films = RunProgram(
      {SIDESTEP_PROGRAM, "render", "--from", Database(), "--where", "knowledge = 'prediction'",
       "--order", "abs(min_clearance_m - beside_min_clearance_m) DESC", "--top", "1", "--size",
       "320x240", "--fps", "5", "--out", Path("films")});
  ASSERT_EQ(films.exit_code, 0) << films.err;
  int num_films = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(Path("films"))) {
    EXPECT_TRUE(entry.path().filename().string().starts_with("run-"));
    EXPECT_GT(entry.file_size(), 1000u);
    ++num_films;
  }
  EXPECT_EQ(num_films, 1);

  const auto complaint = [](const std::string& where) {
    const Finished run = RunProgram({SIDESTEP_PROGRAM, "render", "--from", Database(), "--where",
                                     where, "--out", Path("none")});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_FALSE(fs::exists(Path("none")));
    return run.err;
  };
  EXPECT_EQ(complaint("colour = 1"), "--where: no such column: colour\n");
  EXPECT_EQ(complaint("1; DROP TABLE runs"),
            "--where: must be one expression: '1; DROP TABLE runs'\n");
  EXPECT_EQ(complaint("outcome = 'nothing'"),
            "--where: no run of " + Database() + " is like that\n");
}

}  // namespace
}  // namespace sidestep::report_test
