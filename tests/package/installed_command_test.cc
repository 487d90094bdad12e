#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iterator>
#include <sstream>

#include "tests/package/installation.h"
#include "tests/support/bytes_of.h"

namespace sidestep {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

class InstalledCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    const Finished installed = installation_.Install("command");
    ASSERT_EQ(installed.exit_code, 0) << installed.err;
  }
  fs::path Man(const std::string& page) const {
    return installation_.prefix() / "share/man/man1" / page;
  }
  std::vector<std::string> CommandNames() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(installation_.prefix() / "share/man/man1")) {
      const std::string name = entry.path().stem().string();
      if (name != "sidestep") names.push_back(name.substr(std::string("sidestep-").size()));
    }
    return names;
  }
  // What bash would offer for the last word.
  std::vector<std::string> Complete(const std::vector<std::string>& words) const {
    const fs::path bin = installation_.prefix() / "bin";
    std::string line =
        "PATH=" + bin.string() + ":$PATH; source " +
        (installation_.prefix() / "share/bash-completion/completions/sidestep").string() +
        "; COMP_WORDS=(";
    for (const std::string& word : words) line += "'" + word + "' ";
    line += "); COMP_CWORD=" + std::to_string(words.size() - 1) +
            "; _sidestep && printf '%s\\n' \"${COMPREPLY[@]}\"";
    const Finished finished = RunProgram({"/bin/bash", "-c", line});
    EXPECT_EQ(finished.err, "");
    return Lines(finished.out);
  }

  Installation installation_;
};

TEST_F(InstalledCommand, FindsItsOwnDataFromAnywhere) {
  const Finished doctor = installation_.Run({"doctor"});
  EXPECT_EQ(doctor.exit_code, 0) << doctor.out;
  EXPECT_THAT(doctor.out,
              HasSubstr((installation_.prefix() / "share/sidestep/scenarios").string()));
}

TEST_F(InstalledCommand, RunsAScenario) {
  const Finished run =
      installation_.Run({"run", "hsr_walkway", "--knowledge", "static", "--out", "here"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(fs::exists(installation_.folder() / "elsewhere/here/trace.h5"));
}

TEST_F(InstalledCommand, BringsEveryModelAndScenarioOfTheSource) {
  for (const char* const data : {"models", "scenarios"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(SIDESTEP_SOURCE_DIR) / data)) {
      const std::string ending = entry.path().extension().string();
      if (ending != ".yaml" && ending != ".xml" && ending != ".csv") continue;
      const fs::path name = entry.path().lexically_relative(SIDESTEP_SOURCE_DIR);
      EXPECT_EQ(BytesOf(installation_.prefix() / "share/sidestep" / name), BytesOf(entry.path()))
          << name;
    }
  }
}

// A long option as --help shows it, without the help flag's own line.
std::vector<std::string> OptionsIn(const std::string& help) {
  std::vector<std::string> options;
  for (const std::string& line : Lines(help)) {
    const std::size_t at = line.find("--");
    if (line.empty() || line[0] != ' ' || at == std::string::npos || at > 8) continue;
    options.push_back(line.substr(at, line.find_first_of(" ,", at) - at));
  }
  return options;
}

TEST_F(InstalledCommand, HasAManPageForEachVerbWithEveryOptionOfItsHelp) {
  const std::vector<std::string> names = CommandNames();
  EXPECT_THAT(names, ::testing::IsSupersetOf({"run", "compare", "render", "list", "doctor"}));
  const std::string program_help = installation_.Run({"--help"}).out;
  for (const std::string& name : names) {
    EXPECT_THAT(program_help, HasSubstr("  " + name));
    std::string page = BytesOf(Man("sidestep-" + name + ".1"));
    page.erase(std::remove(page.begin(), page.end(), '\\'), page.end());
    const std::vector<std::string> options = OptionsIn(installation_.Run({name, "--help"}).out);
    EXPECT_FALSE(options.empty()) << name;
    for (const std::string& option : options) EXPECT_THAT(page, HasSubstr(option)) << name;
  }
}

TEST_F(InstalledCommand, HasNoPageForAHiddenVerb) {
  EXPECT_FALSE(fs::exists(Man("sidestep-manual.1")));
  EXPECT_THAT(installation_.Run({"--help"}).out, Not(HasSubstr("manual")));
}

TEST_F(InstalledCommand, CompletesCommandsOptionsAndNames) {
  EXPECT_THAT(Complete({"sidestep", "ren"}), ::testing::ElementsAre("render"));
  EXPECT_THAT(Complete({"sidestep", "run", "--know"}), ::testing::ElementsAre("--knowledge"));
  EXPECT_THAT(Complete({"sidestep", "run", "hsr_w"}), ::testing::ElementsAre("hsr_walkway"));
  EXPECT_THAT(Complete({"sidestep", "run", "hsr_walkway", "--knowledge", "pre"}),
              ::testing::ElementsAre("prediction"));
  EXPECT_THAT(Complete({"sidestep", "reproduce", "panda"}), ::testing::ElementsAre("panda_hsr"));
  EXPECT_THAT(Complete({"sidestep", "reproduce", "panda_hsr", "--sigma"}),
              ::testing::ElementsAre("--sigma-obs"));
}

}  // namespace
}  // namespace sidestep
