#include "sidestep/core/yaml_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "sidestep/core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::yaml_reader_test {
namespace {

namespace fs = std::filesystem;

// Reads every kind of value once; the files of tests/data/bad_yaml/ each break one of them.
void ReadEverything(const YamlReader& top) {
  top.GetString("name");
  top.GetInt("count");
  if (top.Has("verbose")) top.GetBool("verbose");
  top.GetPositive("length_m");
  top.GetNonNegative("margin_m");
  top.GetDouble("offset_m");
  top.GetVector3("position_m");
  top.GetPositiveVector3("size_m");
  top.GetDoubles("weights");
  top.GetChoice("kind", {"slow", "fast"});
  top.GetStrings("tags");
  top.GetPose("pose");
  const YamlReader motion = top.GetMap("motion");
  motion.GetVector("direction", 2);
  motion.CheckNoUnknownKeys();
  for (const YamlReader& obstacle : top.GetMaps("obstacles")) {
    obstacle.GetString("name");
    obstacle.GetPositive("radius_m");
    obstacle.CheckNoUnknownKeys();
  }
  top.CheckNoUnknownKeys();
}

const char kGood[] = R"(name: hall
count: -3
length_m: 1.5
margin_m: 0
offset_m: -2.5e-1
position_m: [1, 2, 3]
size_m: [0.1, 0.2, 0.3]
weights: []
kind: fast
tags: [a, "b c"]
pose: {position_m: [0, 0, 1], rpy_rad: [0, 0, 1.5]}
motion:
  direction: [1, 0]
obstacles:
  - name: first
    radius_m: 0.2
  - {name: second, radius_m: 0.3}
)";

TEST(YamlReader, ReadsEveryKindOfValue) {
  const YamlReader top = YamlReader::FromText(kGood, "good.yaml");
  EXPECT_EQ(top.GetString("name"), "hall");
  EXPECT_EQ(top.GetInt("count"), -3);
  EXPECT_FALSE(top.Has("verbose"));
  EXPECT_EQ(top.GetPositive("length_m"), 1.5);
  EXPECT_EQ(top.GetNonNegative("margin_m"), 0);
  EXPECT_EQ(top.GetDouble("offset_m"), -0.25);
  EXPECT_EQ(top.GetVector3("position_m"), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(top.GetPositiveVector3("size_m"), Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_TRUE(top.GetDoubles("weights").empty());
  EXPECT_EQ(top.GetChoice("kind", {"slow", "fast"}), "fast");
  EXPECT_EQ(top.GetStrings("tags"), (std::vector<std::string>{"a", "b c"}));
  const Pose pose = top.GetPose("pose");
  EXPECT_EQ(pose.translation(), Eigen::Vector3d(0, 0, 1));
  EXPECT_NEAR(2 * std::asin(pose.rotation().z()), 1.5, 1e-15);
  EXPECT_EQ(top.GetMap("motion").GetVector("direction", 2), Eigen::Vector2d(1, 0));
  EXPECT_TRUE(top.IsScalar("name"));
  EXPECT_FALSE(top.IsScalar("tags"));
  const std::vector<YamlReader> obstacles = top.GetMaps("obstacles");
  ASSERT_EQ(obstacles.size(), 2u);
  EXPECT_EQ(obstacles[1].GetString("name"), "second");
  EXPECT_EQ(obstacles[1].Keys(), (std::vector<std::string>{"name", "radius_m"}));
  EXPECT_NO_THROW(ReadEverything(YamlReader::FromText(kGood, "good.yaml")));
}

TEST(YamlReader, AcceptsWindowsLineEndsAndAByteOrderMark) {
  std::string text = "\xEF\xBB\xBF";
  for (const char c : std::string(kGood)) text += c == '\n' ? "\r\n" : std::string(1, c);
  const YamlReader top = YamlReader::FromText(text, "windows.yaml");
  EXPECT_EQ(top.GetString("name"), "hall");
  EXPECT_EQ(top.GetChoice("kind", {"slow", "fast"}), "fast");
  EXPECT_NO_THROW(ReadEverything(top));
}

// --- Files that must be refused
// -------------------------------------------------------------------

std::vector<fs::path> BadFiles() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(SIDESTEP_SOURCE_DIR "/tests/data/bad_yaml")) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// What `read` is refused with; the folder of the file is taken off.
std::string MessageOf(const std::function<void()>& read, const fs::path& folder) {
  try {
    read();
  } catch (const InputError& error) {
    std::string message = error.what();
    const std::string prefix = folder.string() + "/";
    return message.rfind(prefix, 0) == 0 ? message.substr(prefix.size()) : message;
  }
  return "was accepted";
}

class BadYaml : public ::testing::TestWithParam<fs::path> {};

TEST_P(BadYaml, IsRefusedAsItsFirstLineExpects) {
  const fs::path path = GetParam();
  std::string expected;
  std::ifstream stream(path);
  ASSERT_TRUE(std::getline(stream, expected));
  ASSERT_EQ(expected.rfind("# expect: ", 0), 0u) << "the first line must say what is expected";
  const auto read = [&]() { ReadEverything(YamlReader::FromFile(path.string())); };
  EXPECT_EQ(MessageOf(read, path.parent_path()), expected.substr(10));
}

INSTANTIATE_TEST_SUITE_P(Data, BadYaml, ::testing::ValuesIn(BadFiles()),
                         [](const auto& test) { return test.param.stem().string(); });

// What no file of the repository can be: made in a folder of its own.
class BadFile : public ::testing::Test {
 protected:
  std::string MessageFor(const std::string& name) const {
    return MessageOf([&]() { YamlReader::FromFile((folder_ / name).string()); }, folder_);
  }

  const TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(BadFile, ThatIsMissingIsRefused) {
  EXPECT_EQ(MessageFor("none.yaml"), "none.yaml: no such file");
}

TEST_F(BadFile, ThatIsADirectoryIsRefused) {
  fs::create_directory(folder_ / "folder.yaml");
  EXPECT_EQ(MessageFor("folder.yaml"), "folder.yaml: is a directory, not a file");
}

TEST_F(BadFile, ThatIsADeviceIsRefused) {
  fs::create_symlink("/dev/zero", folder_ / "device.yaml");
  EXPECT_EQ(MessageFor("device.yaml"), "device.yaml: is not a regular file");
}

TEST_F(BadFile, ThatIsEmptyIsRefused) {
  std::ofstream(folder_ / "empty.yaml").flush();
  EXPECT_EQ(MessageFor("empty.yaml"), "empty.yaml:1: is empty");
}

// A hole costs no disk: the size alone must decide, before anything is read.
TEST_F(BadFile, ThatIsHugeIsRefusedUnread) {
  std::ofstream(folder_ / "huge.yaml") << "a: 1\n";
  fs::resize_file(folder_ / "huge.yaml", 100'000'000);
  EXPECT_EQ(MessageFor("huge.yaml"), "huge.yaml: is 100000000 bytes long, must be at most 1048576");
}

TEST(YamlReader, FailPointsAtTheKeyOrAtItsMap) {
  const YamlReader top = YamlReader::FromText("a: 1\nb:\n  c: 2\n", "f.yaml");
  EXPECT_EQ(MessageOf([&]() { top.GetMap("b").Fail("c", "is odd"); }, ""), "f.yaml:3: b.c: is odd");
  EXPECT_EQ(MessageOf([&]() { top.Fail("none", "is odd"); }, ""), "f.yaml:1: none: is odd");
}

TEST(YamlReader, FailBlamesWhatWasSetOfTwoThatDoNotAgree) {
  const YamlReader top = YamlReader::FromText("m: {a: 1, b: 2}\n", "f.yaml");
  const auto message = [](const YamlReader& reader) {
    return MessageOf([&]() { reader.GetMap("m").Fail("a", "must be above b", "b"); }, "");
  };
  EXPECT_EQ(message(top), "f.yaml:1: m.a: must be above b");
  EXPECT_EQ(message(top.With("m.b", "3", "--set")), "--set m.b: m.a: must be above b");
  EXPECT_EQ(message(top.With("m.a", "3", "--set")), "--set m.a: must be above b");
  EXPECT_EQ(message(top.With("m", "{a: 1, b: 3}", "--set")), "--set m.a: must be above b");
}

TEST(YamlReader, WithAValueChangesOnePlaceAndNoOther) {
  const YamlReader top = YamlReader::FromText("a: &x {n: 1, m: [2, 3]}\nb: *x\n", "f.yaml");
  const YamlReader changed = top.With("a.m[1]", "9", "--set").With("a.k", "new", "--set");
  EXPECT_EQ(changed.GetMap("a").GetDoubles("m"), (std::vector<double>{2, 9}));
  EXPECT_EQ(changed.GetMap("a").GetString("k"), "new");
  EXPECT_EQ(changed.GetMap("b").GetDoubles("m"), (std::vector<double>{2, 3}));
  EXPECT_EQ(top.GetMap("a").GetDoubles("m"), (std::vector<double>{2, 3}));
}

TEST(YamlReader, WithAPartHasItsKeysAtTheirOwnLines) {
  const YamlReader top = YamlReader::FromText("n: 1\npart:\n  n: 2\n  odd: 3\n", "f.yaml");
  const YamlReader changed = top.With(top.GetMap("part"));
  EXPECT_EQ(changed.GetInt("n"), 2);
  EXPECT_EQ(top.GetInt("n"), 1);
  EXPECT_TRUE(changed.Has("part"));
  EXPECT_EQ(MessageOf([&]() { changed.Fail("n", "is odd"); }, ""), "f.yaml:3: n: is odd");
  EXPECT_EQ(MessageOf([&]() { changed.CheckNoUnknownKeys(); }, ""),
            "f.yaml:4: odd: is not a known key (known here: n, part)");
}

TEST(YamlReader, KnowsTheLineOfEverythingInIt) {
  const YamlReader top = YamlReader::FromText("a:\n  - {n: 1}\n  - {n: [2, 3]}\nb: 1\n", "f.yaml");
  EXPECT_EQ(top.With("a[1].n[0]", "4", "--set").Lines(),
            (std::map<std::string, int>{{"a", 2},
                                        {"a[0]", 2},
                                        {"a[0].n", 2},
                                        {"a[1]", 3},
                                        {"a[1].n", 3},
                                        {"a[1].n[0]", 0},
                                        {"b", 4}}));
}

// Each line has ten times as many values as the one before.
TEST(YamlReader, RefusesAliasesThatAreWrittenOutToMoreThanFits) {
  std::string text = "a0: [0]\n";
  for (int n = 1; n < 12; ++n) {
    const std::string alias = "*x" + std::to_string(n - 1) + ", ";
    text += "a" + std::to_string(n) + ": &x" + std::to_string(n) + " [";
    for (int i = 0; i < 10; ++i) text += n == 1 ? "1, " : alias;
    text += "]\n";
  }
  EXPECT_THAT(MessageOf([&]() { YamlReader::FromText(text, "f.yaml"); }, ""),
              ::testing::HasSubstr("holds more than a million values, with its aliases"));
}

TEST(YamlReader, RefusesAnAliasOfWhatItIsAPartOf) {
  EXPECT_THAT(MessageOf([&]() { YamlReader::FromText("a: &x [1, *x]\n", "f.yaml"); }, ""),
              ::testing::StartsWith("f.yaml:1: a[1]"));
}

}  // namespace
}  // namespace sidestep::yaml_reader_test
