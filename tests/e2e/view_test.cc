// The page of `sidestep view`, in a real browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/browser.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::view_test {
namespace {

using ::testing::IsEmpty;

// How many colours a small copy of the picture has, and a number that tells two pictures apart.
constexpr const char* kLook = R"((() => {
  sidestepReplay.render();
  const copy = document.createElement("canvas");
  copy.width = 200; copy.height = 120;
  const pen = copy.getContext("2d");
  pen.drawImage(sidestepReplay.canvas, 0, 0, 200, 120);
  const pixels = pen.getImageData(0, 0, 200, 120).data, colors = new Set();
  let mark = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    const color = pixels[i] << 16 | pixels[i + 1] << 8 | pixels[i + 2];
    colors.add(color);
    mark = (31 * mark + color) % 1000000007;
  }
  return {colors: colors.size, mark};
})())";

class ViewPage : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!Browser::IsInstalled()) return;
    folder_ = new TemporaryFolder;
    browser_ = new Browser;
    for (const std::string knowledge : {"static", "prediction"}) {
      const Finished run = RunProgram({SIDESTEP_PROGRAM, "run", "hsr_walkway", "--knowledge",
                                       knowledge, "--out", Path(knowledge)});
      ASSERT_EQ(run.exit_code, 0) << run.err;
    }
    Make({"prediction"}, "one.html");
    Make({"static", "prediction"}, "two.html",
         {"</script><script>document.title='out'</script>", "b"});
  }
  static void TearDownTestSuite() {
    delete browser_;
    delete folder_;
  }
  void SetUp() override {
    if (browser_ == nullptr) GTEST_SKIP() << "chromium is not installed";
    browser_->Resize(1200, 900);
    browser_->PreferDark(false);
  }

  static std::string Path(const std::string& name) { return (folder_->path() / name).string(); }
  static void Make(const std::vector<std::string>& runs, const std::string& page,
                   const std::vector<std::string>& titles = {}) {
    std::vector<std::string> command = {SIDESTEP_PROGRAM, "view"};
    for (const std::string& run : runs) command.push_back(Path(run) + "/trace.h5");
    for (const std::string& title : titles) command.insert(command.end(), {"--title", title});
    command.insert(command.end(), {"--out", Path(page)});
    const Finished made = RunProgram(command);
    ASSERT_EQ(made.exit_code, 0) << made.err;
  }

  nlohmann::json State() { return browser_->Evaluate("sidestepReplay.state()"); }

  static TemporaryFolder* folder_;
  static Browser* browser_;
};
TemporaryFolder* ViewPage::folder_ = nullptr;
Browser* ViewPage::browser_ = nullptr;

TEST_F(ViewPage, IsSmallAndOpensWithoutAComplaintOrTheNetwork) {
  EXPECT_LE(std::filesystem::file_size(Path("one.html")), 3'000'000u);
  browser_->Open(Path("one.html"));
  EXPECT_TRUE(State()["webgl"]);
  EXPECT_EQ(State()["traces"], 1);
  EXPECT_GT(browser_->Evaluate(kLook)["colors"], 200);
  EXPECT_THAT(browser_->complaints(), IsEmpty());
}

TEST_F(ViewPage, SaysOnTopWhichCaseItIs) {
  browser_->Open(Path("two.html"));
  EXPECT_EQ(browser_->Evaluate("document.querySelector('.replay h1').textContent"),
            "hsr_walkway, seed 1, 1.4 m/s");
}

TEST_F(ViewPage, ShowsAnotherPictureAtAnotherTimeAndTheSameAtTheSame) {
  browser_->Open(Path("one.html"), "t=0.5");
  const nlohmann::json early = browser_->Evaluate(kLook);
  browser_->Evaluate("sidestepReplay.seek(1.4)");
  EXPECT_NE(browser_->Evaluate(kLook)["mark"], early["mark"]);
  browser_->Evaluate("sidestepReplay.seek(0.5)");
  EXPECT_EQ(browser_->Evaluate(kLook)["mark"], early["mark"]);
}

TEST_F(ViewPage, ShowsEachLayerThatIsAskedFor) {
  browser_->Open(Path("one.html"), "t=1.2&hide=trail,plan,prediction");
  for (const std::string layer : {"trail", "plan", "prediction", "spheres", "field"}) {
    const nlohmann::json without = browser_->Evaluate(kLook);
    browser_->Evaluate("sidestepReplay.toggle('" + layer + "', true)");
    EXPECT_NE(browser_->Evaluate(kLook)["mark"], without["mark"]) << layer;
    browser_->Evaluate("sidestepReplay.toggle('" + layer + "', false)");
  }
  EXPECT_THAT(browser_->complaints(), IsEmpty());
}

TEST_F(ViewPage, ObeysKeys) {
  browser_->Open(Path("one.html"));
  browser_->Press("ArrowRight");
  EXPECT_NEAR(State()["t"], 0.02, 1e-9);
  browser_->Press("End");
  EXPECT_EQ(State()["t"], State()["end"]);
  browser_->Press("Home");
  browser_->Press(" ");
  EXPECT_TRUE(State()["playing"]);
  browser_->Press(" ");
  EXPECT_FALSE(State()["playing"]);
  browser_->Press("f");
  EXPECT_TRUE(State()["show"]["field"]);
  const int layer = State()["show"]["layer"];
  browser_->Press("ArrowUp");
  EXPECT_EQ(State()["show"]["layer"], layer + 1);
  browser_->Press("d");
  EXPECT_EQ(State()["theme"], "dark");
}

TEST_F(ViewPage, PlaysToTheEndAndStopsThere) {
  browser_->Open(Path("one.html"), "t=3.3");
  browser_->Evaluate("sidestepReplay.play()");
  const nlohmann::json stopped = browser_->Evaluate(
      "new Promise((done) => { const wait = () => sidestepReplay.state().playing ? "
      "requestAnimationFrame(wait) : done(sidestepReplay.state()); wait(); })");
  EXPECT_EQ(stopped["t"], stopped["end"]);
}

TEST_F(ViewPage, ShowsSeveralTracesInStepAndTheirTitlesAsText) {
  browser_->Open(Path("two.html"), "t=1.5");
  EXPECT_EQ(State()["traces"], 2);
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('.panel').length"), 2);
  EXPECT_EQ(browser_->Evaluate("document.title"), "hsr_walkway");
  EXPECT_EQ(browser_->Evaluate("document.querySelector('.panel-title b').textContent"),
            "</script><script>document.title='out'</script>");
  EXPECT_THAT(browser_->Evaluate("document.querySelector('.panel-status').textContent"),
              ::testing::Truly([](const nlohmann::json& text) {
                return text.get<std::string>().starts_with("CONTACT at 1.3");
              }));
  EXPECT_EQ(browser_->Evaluate("document.querySelectorAll('.replay-chart path').length"), 2);
  EXPECT_THAT(browser_->complaints(), IsEmpty());
}

TEST_F(ViewPage, FitsAPhoneAndTurnsUnderAFinger) {
  browser_->Resize(390, 844, /*mobile=*/true);
  for (const char* const page : {"one.html", "two.html"}) {
    browser_->Open(Path(page), "t=1.2");
    EXPECT_LE(browser_->Evaluate("document.documentElement.scrollWidth"), 390) << page;
    const nlohmann::json before = browser_->Evaluate(kLook);
    browser_->Swipe(150, 250, 120, 0);
    EXPECT_NE(browser_->Evaluate(kLook)["mark"], before["mark"]) << page;
    EXPECT_EQ(browser_->Evaluate("scrollY"), 0) << page;
    EXPECT_THAT(browser_->complaints(), IsEmpty()) << page;
  }
}

TEST_F(ViewPage, IsDarkWherePeopleWantThat) {
  constexpr const char* kPaper =
      "parseInt(getComputedStyle(document.querySelector('.replay')).backgroundColor.slice(4))";
  browser_->Open(Path("one.html"));
  EXPECT_GT(browser_->Evaluate(kPaper), 200);
  browser_->PreferDark(true);
  EXPECT_LT(browser_->Evaluate(kPaper), 60);
  EXPECT_EQ(State()["theme"], "dark");
}

TEST(View, RefusesWhatIsNoTraceAndToWriteOverOne) {
  const TemporaryFolder folder;
  const std::string page = (folder.path() / "view.html").string();
  const Finished none = RunProgram({SIDESTEP_PROGRAM, "view", "/dev/null", "--out", page});
  EXPECT_EQ(none.exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(page));
  const std::string trace = (folder.path() / "trace.h5").string();
  std::ofstream(trace) << "anything";
  const Finished over = RunProgram({SIDESTEP_PROGRAM, "view", trace, "--out", trace});
  EXPECT_EQ(over.exit_code, 2);
  EXPECT_EQ(over.err, trace + ": is a trace to draw, it must not be written over\n");
}

}  // namespace
}  // namespace sidestep::view_test
