// Names, encodings and disks as people have them: the same answer from every command.
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

namespace sidestep::bytes_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

namespace fs = std::filesystem;

std::string Read(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  EXPECT_TRUE(stream.good()) << path;
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string Write(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

Finished Sidestep(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), SIDESTEP_PROGRAM);
  return RunProgram(arguments);
}

// `redirection` as the shell has it, e.g. "> /dev/full".
Finished SidestepInShell(const std::string& redirection, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(),
                   {"/bin/sh", "-c", "\"$0\" \"$@\" " + redirection, SIDESTEP_PROGRAM});
  return RunProgram(arguments);
}

std::string WalkwayText() { return Read(SIDESTEP_SOURCE_DIR "/scenarios/hsr_walkway.yaml"); }

// What makes an episode short.
const std::vector<std::string> kQuick = {"--set", "planner.name=straight_line", "--set",
                                         "horizon.duration_s=1"};

std::vector<std::string> operator+(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

void ExpectOneLine(const Finished& finished, const std::string& line) {
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_EQ(finished.out, "");
  EXPECT_EQ(finished.err, line + "\n");
}

// --- Encodings -----------------------------------------------------------------------------------

struct Command {
  const char* name;
  std::vector<std::string> before, after;  // what stands before and after the scenario
};
std::ostream& operator<<(std::ostream& stream, const Command& c) { return stream << c.name; }

class CommandOnAScenario : public ::testing::TestWithParam<Command> {
 protected:
  Finished Run(const std::string& bytes) {
    Write(file_, bytes);
    return Sidestep(GetParam().before + std::vector<std::string>{file_} + GetParam().after +
                    std::vector<std::string>{"--out", out_});
  }

  const TemporaryFolder folder_;
  const std::string file_ = folder_.path() / "hall.yaml";
  const std::string out_ = folder_.path() / "out.png";  // a folder may have that name too
};

TEST_P(CommandOnAScenario, RefusesLatin1WithFileAndLineBeforeAnythingIsWritten) {
  ExpectOneLine(Run("# a\n# caf\xE9\n" + WalkwayText()),
                file_ + ":2: must be UTF-8, has the byte \\xE9 (Latin-1?)");
  EXPECT_FALSE(fs::exists(out_));
}

TEST_P(CommandOnAScenario, RefusesUtf16) {
  std::string wide = "\xFF\xFE";
  for (const char c : WalkwayText()) wide += std::string{c, '\0'};
  ExpectOneLine(Run(wide), file_ + ":1: is UTF-16 or UTF-32, must be UTF-8");
  EXPECT_FALSE(fs::exists(out_));
}

TEST_P(CommandOnAScenario, RefusesASettingThatIsNotUtf8) {
  Write(file_, WalkwayText());
  ExpectOneLine(
      Sidestep(GetParam().before + std::vector<std::string>{file_, "--set", "description=caf\xE9"} +
               GetParam().after + std::vector<std::string>{"--out", out_}),
      "--set description: must be UTF-8, is 'caf\\xE9'");
}

INSTANTIATE_TEST_SUITE_P(All, CommandOnAScenario,
                         ::testing::Values(Command{"Run", {"run"}, {}},
                                           Command{"Field", {"field"}, {}},
                                           Command{"Study", {"study"}, {"--knowledge", "static"}}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Audit, RefusesLatin1Too) {
  const TemporaryFolder folder;
  const std::string file = Write(folder.path() / "hall.yaml", "# caf\xE9\n" + WalkwayText());
  ExpectOneLine(Sidestep({"audit", file, "--out", folder.path() / "out"}),
                file + ":1: must be UTF-8, has the byte \\xE9 (Latin-1?)");
}

TEST(Scenario, WithAByteOrderMarkAndWindowsLineEndsIsTheSame) {
  const TemporaryFolder folder;
  std::string windows = "\xEF\xBB\xBF";
  for (const char c : WalkwayText()) windows += c == '\n' ? "\r\n" : std::string(1, c);
  fs::create_directories(folder.path() / "a");
  fs::create_directories(folder.path() / "b");
  const std::string a = Write(folder.path() / "a/hall.yaml", WalkwayText());
  const std::string b = Write(folder.path() / "b/hall.yaml", windows);
  for (const std::string& file : {a, b}) {
    const Finished finished =
        Sidestep(std::vector<std::string>{"run", file, "--out", file + ".out"} + kQuick);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
  }
  EXPECT_EQ(Read(a + ".out/trace.h5"), Read(b + ".out/trace.h5"));
}

// --- Names ---------------------------------------------------------------------------------------

TEST(NameThatIsNotUtf8, LosesNothingAndIsWrittenOut) {
  const TemporaryFolder folder;
  const std::string file = Write(folder.path() / "caf\xE9.yaml", WalkwayText());
  const std::string out = folder.path() / "out\xE9";
  const Finished run = Sidestep(std::vector<std::string>{"run", file, "--out", out} + kQuick);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("out\\xE9/result.json"));
  EXPECT_EQ(nlohmann::json::parse(Read(out + "/result.json")).at("scenario"), "caf\\xE9");

  const Finished compare = Sidestep({"compare", out});
  EXPECT_EQ(compare.exit_code, 0) << compare.err;

  const std::string still = folder.path() / "caf\xE9.png";
  const Finished render =
      Sidestep({"render", out + "/trace.h5", "--still", still, "--size", "320x180"});
  EXPECT_EQ(render.exit_code, 0) << render.err;
  EXPECT_TRUE(fs::exists(still));
  EXPECT_THAT(render.out, HasSubstr("caf\\xE9.png"));

  const Finished missing = Sidestep({"compare", folder.path() / "\xE9"});
  ExpectOneLine(missing, (folder.path() / "\\xE9/result.json: no such file").native());

  const std::string study_out = folder.path() / "study";
  const Finished study = Sidestep(
      std::vector<std::string>{"study", file, "--knowledge", "static", "--out", study_out} +
      kQuick);
  EXPECT_EQ(study.exit_code, 0) << study.err;
}

// --- Disks ---------------------------------------------------------------------------------------

class FullDisk : public ::testing::TestWithParam<std::vector<std::string>> {};

TEST_P(FullDisk, BehindStandardOutputIsAnError) {
  const Finished finished = SidestepInShell("> /dev/full", GetParam());
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_EQ(finished.err, "standard output: cannot be written: No space left on device\n");
}

INSTANTIATE_TEST_SUITE_P(Commands, FullDisk,
                         ::testing::Values(std::vector<std::string>{"list"},
                                           std::vector<std::string>{"list", "robots"},
                                           std::vector<std::string>{"doctor"},
                                           std::vector<std::string>{"--help"},
                                           std::vector<std::string>{"--version"},
                                           std::vector<std::string>{"run", "--help"}));

TEST(NoRoom, IsNoticedByRunAndCompareAndTheFilesAreThere) {
  const TemporaryFolder folder;
  const std::string out = folder.path();
  const std::string no_room = "standard output: cannot be written: No space left on device\n";
  for (const bool json : {true, false}) {
    const Finished run = SidestepInShell(
        "> /dev/full",
        std::vector<std::string>{"run", "hsr_walkway", "--out", out} + kQuick +
            (json ? std::vector<std::string>{"--json"} : std::vector<std::string>{}));
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_EQ(run.err, no_room);
  }
  const Finished compare = SidestepInShell("> /dev/full", {"compare", out});
  EXPECT_EQ(compare.exit_code, 2);
  EXPECT_EQ(compare.err, no_room);
  EXPECT_EQ(nlohmann::json::parse(Read(out + "/result.json")).at("scenario"), "hsr_walkway");
}

TEST(FileSizeLimit, IsAnErrorOfTheFileThatGrowsBeyondIt) {
  const TemporaryFolder folder;
  const std::string out = folder.path();
  const Finished run = RunProgram(
      {"/bin/sh", "-c",
       "ulimit -f 1; \"$0\" run hsr_walkway --out " + out + " --set planner.name=straight_line",
       SIDESTEP_PROGRAM});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_EQ(run.err, out + "/trace.h5: cannot be written: File too large\n");
}

TEST(StandardOutput, WhoseReaderHasGoneIsNoError) {
  for (const std::string arguments : {"list", "--help"}) {
    const Finished finished =
        RunProgram({"/bin/sh", "-c",
                    "{ sleep 0.1; \"$0\" " + arguments + "; echo \"exit code $?\" >&2; } | true",
                    SIDESTEP_PROGRAM});
    EXPECT_EQ(finished.err, "exit code 0\n") << arguments;
  }
}

struct Unwritable {
  const char* name;
  std::vector<std::string> arguments;  // "OUT" stands for the place
  const char* file;                    // in it, that cannot be
};
std::ostream& operator<<(std::ostream& stream, const Unwritable& u) { return stream << u.name; }

class UnwritableOut : public ::testing::TestWithParam<Unwritable> {
 protected:
  Finished RunInto(const std::string& out) const {
    std::vector<std::string> arguments = GetParam().arguments;
    std::replace(arguments.begin(), arguments.end(), std::string("OUT"), out);
    return Sidestep(arguments);
  }
};

// One line and nothing else: whoever has begun to work tells of it.
TEST_P(UnwritableOut, IsFoundBeforeTheWork) {
  ExpectOneLine(RunInto("/proc"), "/proc/" + std::string(GetParam().file) +
                                      ": cannot be written: No such file or directory");
  const Finished behind_a_file = RunInto(std::string(SIDESTEP_PROGRAM) + "/out");
  EXPECT_EQ(behind_a_file.exit_code, 2);
  EXPECT_EQ(behind_a_file.out, "");
  EXPECT_THAT(behind_a_file.err, HasSubstr("Not a directory"));
  EXPECT_EQ(std::count(behind_a_file.err.begin(), behind_a_file.err.end(), '\n'), 1);
}

// The last of its files may be the one that stands in the way.
TEST_P(UnwritableOut, IsFoundBeforeTheWorkForEveryFile) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / GetParam().file);
  ExpectOneLine(RunInto(folder.path()),
                (folder.path() / GetParam().file).native() + ": cannot be written: Is a directory");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

INSTANTIATE_TEST_SUITE_P(
    Commands, UnwritableOut,
    ::testing::Values(
        Unwritable{"Run", {"run", "hsr_walkway", "--out", "OUT"}, "trace.h5"},
        Unwritable{"Audit", {"audit", "hsr_walkway", "--out", "OUT"}, "slice.png"},
        Unwritable{"ReproduceOpenLoop", {"reproduce", "panda_hsr", "--out", "OUT"}, "rows.csv"},
        Unwritable{"ReproduceSdfTiming", {"reproduce", "sdf_timing", "--out", "OUT"}, "rows.csv"},
        Unwritable{"ReproduceClosedLoop",
                   {"reproduce", "closed_loop", "--out", "OUT"},
                   "execute_and_update.h5"},
        Unwritable{"Study",
                   {"study", "hsr_walkway", "--knowledge", "static", "--out", "OUT"},
                   "results.db"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(Field, RefusesANameBeforeItLooks) {
  ExpectOneLine(Sidestep({"field", "hsr_walkway", "--out", "/proc/a.png"}),
                "/proc/a.png: cannot be written: No such file or directory");
  ExpectOneLine(Sidestep({"field", "hsr_walkway", "--out", "a.jpg"}),
                "a.jpg: a picture needs a name that ends in .png");
}

TEST(Reproduce, TakesAPublishedTableWithAByteOrderMarkAndRefusesLatin1) {
  const TemporaryFolder folder;
  const std::string table =
      "pair,speed_m_per_s,n_colliding_states_static,gp_cost_static\r\n1,1.4,6,9.00678449925957\r\n";
  const std::string marked = Write(folder.path() / "marked.csv", "\xEF\xBB\xBF" + table);
  const std::string latin = Write(folder.path() / "latin.csv", table + "2,1.4,\xE9,\r\n");
  const auto reproduce = [&](const std::string& published) {
    return Sidestep({"reproduce", "panda_hsr", "--pairs", "1", "--speeds", "1.4", "--case",
                     "static", "-j", "1", "--published", published, "--out",
                     folder.path() / "out"});
  };
  ExpectOneLine(reproduce(latin), latin + ":3: must be UTF-8, has the byte \\xE9 (Latin-1?)");
  const Finished finished = reproduce(marked);
  EXPECT_EQ(finished.exit_code, 0) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("1 rows compared"));
}

}  // namespace
}  // namespace sidestep::bytes_test
