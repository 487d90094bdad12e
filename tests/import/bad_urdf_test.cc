#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "sidestep/core/input_error.h"
#include "sidestep/import/arm_of_tree.h"
#include "sidestep/import/urdf_tree.h"
#include "tests/support/bytes_of.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::imports::bad_urdf_test {
namespace {

namespace fs = std::filesystem;

const std::string kBad = SIDESTEP_SOURCE_DIR "/tests/data/bad_urdf/";
const std::string kGood = SIDESTEP_SOURCE_DIR "/tests/data/urdf/";

std::vector<std::string> BadFiles() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(kBad)) {
    if (entry.path().extension() == ".urdf") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

ImportedArm ArmFromUrdf(const std::string& path, const ArmChoices& choices) {
  return ArmOfTree(ReadUrdfTree(path, choices), choices);
}

std::string MessageOf(const std::string& path, const ArmChoices& choices = {}) {
  try {
    ArmFromUrdf(path, choices);
  } catch (const InputError& error) {
    return error.what();
  }
  return "was accepted";
}

class BadUrdf : public ::testing::TestWithParam<std::string> {};

// Each file says in its first line what is to be said of it; FOLDER is its own.
TEST_P(BadUrdf, IsRefusedAsItsFirstLineExpects) {
  const std::string path = kBad + GetParam() + ".urdf";
  std::ifstream stream(path);
  std::string expected;
  ASSERT_TRUE(std::getline(stream, expected));
  const std::string begin = "<!-- expect: ", end = " -->";
  ASSERT_EQ(expected.rfind(begin, 0), 0u) << "the first line must say what is expected";
  expected = expected.substr(begin.size(), expected.size() - begin.size() - end.size());
  std::string message = MessageOf(path);
  for (std::size_t at; (at = message.find(kBad)) != std::string::npos;) {
    message.replace(at, kBad.size(), "FOLDER/");
  }
  EXPECT_EQ(message, expected);
}

INSTANTIATE_TEST_SUITE_P(Data, BadUrdf, ::testing::ValuesIn(BadFiles()),
                         [](const auto& test) { return test.param; });

TEST(UrdfText, MayHaveWindowsLineEndsAndAByteOrderMark) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "arm.urdf").string();
  std::ofstream(path) << "\xEF\xBB\xBF" << BytesOf(kGood + "xacro_output.urdf");
  EXPECT_NE(BytesOf(path).find("\r\n"), std::string::npos);
  EXPECT_EQ(ArmFromUrdf(path, {}).arm.limits.size(), 6u);
}

TEST(UrdfText, IsRefusedInAnyOtherEncoding) {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "arm.urdf").string();
  std::ofstream(path) << "<robot name=\"caf\xE9\"/>";
  EXPECT_THAT(MessageOf(path), testing::HasSubstr("UTF-8"));
  std::ofstream(path) << std::string("\xFF\xFE<\0r\0", 6);
  EXPECT_THAT(MessageOf(path), testing::HasSubstr("UTF-16"));
}

TEST(UrdfText, IsRefusedIfItIsAFolderOrMissing) {
  EXPECT_THAT(MessageOf(kGood), testing::HasSubstr("is a directory"));
  EXPECT_THAT(MessageOf(kGood + "none.urdf"), testing::StartsWith(kGood + "none.urdf: "));
}

struct WrongChoice {
  const char* name;
  const char* file;
  ArmChoices choices;
  const char* message;
};

ArmChoices With(void (*change)(ArmChoices*)) {
  ArmChoices choices;
  change(&choices);
  return choices;
}

class WrongChoices : public ::testing::TestWithParam<WrongChoice> {};

TEST_P(WrongChoices, AreToldByTheirFlag) {
  EXPECT_THAT(MessageOf(kGood + GetParam().file, GetParam().choices),
              testing::StartsWith(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    What, WrongChoices,
    ::testing::Values(
        WrongChoice{"Branches",
                    "branch.urdf",
                    {},
                    "--tip: must be given: 3 joints lead to each of left_hand, right_hand"},
        WrongChoice{"UnknownTip", "six_axis.urdf", With([](ArmChoices* c) { c->tip = "hand"; }),
                    "--tip: there is no link 'hand' (there are: base_link, forearm, "},
        WrongChoice{"UnknownBase", "six_axis.urdf", With([](ArmChoices* c) { c->base = "foot"; }),
                    "--base: there is no link 'foot'"},
        WrongChoice{"TipAboveTheBase", "six_axis.urdf", With([](ArmChoices* c) {
                      c->base = "forearm";
                      c->tip = "shoulder";
                    }),
                    "--tip: the link 'shoulder' is not below 'forearm'"},
        WrongChoice{"UnknownJoint", "six_axis.urdf",
                    With([](ArmChoices* c) { c->fix["knee"] = 0; }),
                    "--fix: there is no joint 'knee'"},
        WrongChoice{"FixedJoint", "fixed_chains.urdf",
                    With([](ArmChoices* c) { c->fix["tip_joint"] = 0; }),
                    "--fix: the joint 'tip_joint' is fixed anyway"},
        WrongChoice{"FixedBeyondItsLimits", "six_axis.urdf",
                    With([](ArmChoices* c) { c->fix["lift"] = 1; }),
                    "--fix: 'lift' must be from -3.1 to 0.2, is 1"}),
    [](const auto& test) { return test.param.name; });

std::ostream& operator<<(std::ostream& out, const WrongChoice& choice) {
  return out << choice.name;
}

// What cannot be an inertia is refused (tests/data/bad_urdf) unless it is to be repaired.
TEST(UrdfInertia, IsRepairedOnRequestAndThatIsSaid) {
  ArmChoices choices;
  choices.repair_inertia = true;
  const struct {
    const char* file;
    const char* note;
  } kCases[] = {{"inertia_not_positive", "link 'arm': its inertia must be positive definite"},
                {"inertia_of_no_solid", "link 'arm': its inertia is none of a solid"},
                {"zero_mass", "link 'arm' has no mass: given"},
                {"moves_nothing_heavy", "link 'arm' has no mass: given"}};
  for (const auto& [file, note] : kCases) {
    const ImportedArm imported = ArmFromUrdf(kBad + file + ".urdf", choices);
    EXPECT_THAT(imported.notes, testing::Contains(testing::StartsWith(note)));
    EXPECT_TRUE(imported.arm.LinkOf(0).inertia.has_value());
  }
}

}  // namespace
}  // namespace sidestep::imports::bad_urdf_test
