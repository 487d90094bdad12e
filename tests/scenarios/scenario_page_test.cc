#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "sidestep/bench/scenario_planner.h"
#include "sidestep/scenarios/scenario.h"
#include "tests/support/key_page.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::scenarios {
namespace {

const std::string kPage = SIDESTEP_SOURCE_DIR "/docs/scenario.md";

// Reads it as a file that has a track beside it.
std::string Read(const std::string& text) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "page.yaml").string();
  std::ofstream(path) << text;
  std::ofstream(folder.path() / "track.csv") << "t,x,y,z\n0,2,0,0.85\n1,2,1,0.85\n";
  Scenario scenario = LoadScenario(path);
  if (!scenario.robot.empty()) bench::ResolvePlanner(scenario);
  return ToYaml(scenario);
}

TEST(ScenarioPage, TellsEveryKeyAsTheReaderHasIt) {
  for (const std::string& difference : KeyPage(kPage, Read).Differences()) {
    ADD_FAILURE() << difference;
  }
}

TEST(ScenarioPage, BeginsWithAScenario) {
  std::ifstream page(kPage);
  std::string text;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("    ", 0) == 0) {
      text += line.substr(4) + "\n";
    } else if (!text.empty()) {
      break;
    }
  }
  EXPECT_EQ(ParseScenario(text, "mine.yaml").robot, "panda") << text;
}

// The page with some rows changed, or its example, and what the test above must then say.
TEST(ScenarioPage, IsFoundOutWhereItDiffers) {
  struct Change {
    const char* old_text;
    const char* new_text;
    const char* message;
  };
  const std::vector<std::vector<Change>> cases = {
      {{"| `planner.sigma_obs` |", "| sigma |", ": has no row for `planner.sigma_obs`"},
       {"| `planner.detours` |", "| `planner.ways` |", "the reader knows no key planner.ways"},
       {"| `planner.growth_limit_m` |", "| `planner.growth_sigmas` |",
        "is a second row for planner.growth_sigmas"},
       {"| `0.95` |", "| `0.9` |", "the default of planner.velocity_scale is not 0.9"},
       {"| `moving_obstacles[].motion.recorded.speed_m_s` |", "| as of any kind |",
        "moving_obstacles[].motion.recorded.speed_m_s need not be given"},
       {"| required | 0.001 to 10 |", "| required | 0.001 to 9 |",
        "takes 9.000009 for workspace.cell_m, which is beyond"}},
      {{"| `0.95` |", "| required |", "planner.velocity_scale need not be given"},
       {"| required | 0.001 to 10 |", "| required | 0.0001 to 10 |",
        "refuses 0.0001, which is within the page's bounds"},
       {"  qc: 1\n", "", "the example at the top of the page lacks planner.qc"}},
      {{"  epsilon_m: 0.2\n", "", "its example is refused"}},
  };
  std::ostringstream page;
  page << std::ifstream(kPage).rdbuf();
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "page.md").string();
  for (const std::vector<Change>& changes : cases) {
    std::string text = page.str();
    for (const Change& change : changes) {
      const std::size_t at = text.find(change.old_text);
      ASSERT_NE(at, std::string::npos) << change.old_text;
      text.replace(at, std::string(change.old_text).size(), change.new_text);
    }
    std::ofstream(path) << text;
    std::string differences;
    for (const std::string& one : KeyPage(path, Read).Differences()) differences += one + "\n";
    for (const Change& change : changes) {
      EXPECT_NE(differences.find(change.message), std::string::npos) << change.message << "\n"
                                                                     << differences;
    }
  }
}

}  // namespace
}  // namespace sidestep::scenarios
