#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>

#include "tests/architecture_rules.h"

namespace sidestep {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(Architecture, OfThisRepositoryHoldsToTheRules) {
  const SourceTree tree = ReadSourceTree(SIDESTEP_SOURCE_DIR);
  ASSERT_EQ(tree.count("tests/architecture_test.cc"), 1u) << "the tree was not read";
  for (const std::string& violation : FindViolations(tree, ModuleRules())) {
    ADD_FAILURE() << violation;
  }
}

// The page for people must not say something else than the rules do.
TEST(Architecture, IsDescribedAsItIsChecked) {
  const SourceTree tree = ReadSourceTree(SIDESTEP_SOURCE_DIR);
  const std::string& page = tree.at("docs/architecture.md");
  for (const ModuleRule& rule : ModuleRules()) {
    const std::size_t begin = page.find("| `" + rule.name + "/` |");
    ASSERT_NE(begin, std::string::npos) << rule.name << " has no row";
    const std::string row = page.substr(begin, page.find('\n', begin) - begin);
    std::string arrows;
    for (const std::string& module : rule.modules) arrows += (arrows.empty() ? "" : ", ") + module;
    if (rule.name == "cli") arrows = "all";
    if (arrows.empty()) arrows = "–";
    EXPECT_NE(row.find("| " + arrows + " |"), std::string::npos) << row << "\nexpected: " << arrows;
  }
}

// The checker itself, on a tree of two modules that keeps every rule.
const std::vector<ModuleRule> kRules = {{"base", {}, {"lib/"}}, {"top", {"base"}, {}}};

SourceTree SoundTree() {
  return {
      {"base/CMakeLists.txt", "sidestep_module(base SOURCES a.cc DEPENDS Eigen3::Eigen)\n"},
      {"base/a.h",
       "#pragma once\n#include <Eigen/Core>\n#include <vector>\n"
       "namespace sidestep::base {\nstruct A {};\n}\n"},
      {"base/a.cc", "#include \"sidestep/base/a.h\"\n\n#include <lib/lib.h>\n"},
      {"top/CMakeLists.txt", "sidestep_module(top SOURCES b.cc DEPENDS sidestep::base)\n"},
      {"top/b.h", "#pragma once\n#include \"sidestep/base/a.h\"\n"},
      {"top/b.cc", "#include \"sidestep/top/b.h\"\n"},
      {"tests/b_test.cc", "#include <lib/lib.h>\n#include \"sidestep/top/b.h\"\n"},
      {"README.md", "Text.\n"},
  };
}

TEST(ArchitectureChecker, AcceptsASoundTree) {
  EXPECT_THAT(FindViolations(SoundTree(), kRules), IsEmpty());
}

struct Breach {
  std::string name;
  std::string path;
  std::string text;  ///< what stands in the file instead
  std::string expected;
};
std::ostream& operator<<(std::ostream& stream, const Breach& breach) {
  return stream << breach.name;
}

class ArchitectureBreach : public ::testing::TestWithParam<Breach> {};

TEST_P(ArchitectureBreach, IsFoundAndNothingElse) {
  SourceTree tree = SoundTree();
  tree[GetParam().path] = GetParam().text;
  EXPECT_THAT(FindViolations(tree, kRules), ElementsAre(GetParam().expected));
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, ArchitectureBreach,
    ::testing::Values(
        Breach{"WrongWayArrow", "top/b.cc",
               "#include \"sidestep/top/b.h\"\n#include \"tests/b_test.cc\"\n",
               "top/b.cc:2: top/ may not include tests/b_test.cc"},
        Breach{"ForbiddenLibrary", "top/b.cc", "// x\n  #  include <lib/lib.h>  // y\n",
               "top/b.cc:2: top/ may not include <lib/lib.h>"},
        Breach{"UnknownHeader", "base/a.cc", "#include <other.h>\n",
               "base/a.cc:1: base/ may not include <other.h>"},
        Breach{"NameNotFromTheRoot", "top/b.cc", "#include \"b.h\"\n",
               "top/b.cc:1: no file b.h (quoted names begin with sidestep/<module>/)"},
        Breach{"NameFromTheRoot", "top/b.cc",
               "#include \"sidestep/top/b.h\"\n#include \"base/a.h\"\n",
               "top/b.cc:2: no file base/a.h (quoted names begin with sidestep/<module>/)"},
        Breach{"TestThatNamesFromTheRoot", "tests/b_test.cc", "#include \"top/b.h\"\n",
               "tests/b_test.cc:1: no file top/b.h (quoted names begin with sidestep/<module>/)"},
        Breach{"TypeDefinedTwice", "base/c.h",
               "#pragma once\nnamespace sidestep::base {\nclass A : public X<int> {};\n}\n",
               "base/c.h:3: sidestep::base::A is defined in base/a.h too"},
        Breach{"TypeOutsideItsModule", "base/c.h",
               "#pragma once\nnamespace sidestep {\nenum class C { kOne };\n}\n",
               "base/c.h:3: sidestep::C lies outside sidestep::base::"},
        Breach{"NoPragmaOnce", "base/a.h", "#include <vector>\n",
               "base/a.h: a header without #pragma once"},
        Breach{"LinkWithoutInclude", "base/CMakeLists.txt",
               "sidestep_module(base SOURCES a.cc DEPENDS sidestep::top)\n",
               "base/CMakeLists.txt: links top, which no file includes"},
        Breach{"IncludeWithoutLink", "top/CMakeLists.txt", "sidestep_module(top SOURCES b.cc)\n",
               "top/CMakeLists.txt: does not link base, which is included"},
        Breach{"HeaderBehindAPrivateLink", "top/CMakeLists.txt",
               "sidestep_module(top SOURCES b.cc PRIVATE_DEPENDS sidestep::base)\n",
               "top/CMakeLists.txt: links base privately, but a header includes it"},
        Breach{"FileWrittenAnyhow", "base/a.cc",
               "#include \"sidestep/base/a.h\"\nstd::ofstream(\"x\");\n",
               "base/a.cc:2: writes a file by std::ofstream; core/atomic_file.h is there for it"},
        Breach{"UnknownFolder", "utils/x.txt", "",
               "utils: a folder at the top that is no module; see docs/architecture.md"},
        Breach{"DistributionOfALibrary", "base/a.cc",
               "\nstd::normal_distribution<double> normal;\n",
               "base/a.cc:2: random numbers come from core/random.h"},
        Breach{"GeneratorOfALibrary", "top/b.cc", "\n\nstd::mt19937_64 generator(1);\n",
               "top/b.cc:3: random numbers come from core/random.h"},
        Breach{"GeneratorThatAllShare", "tests/b_test.cc",
               "const auto p = Eigen::Vector3d::Random();\n",
               "tests/b_test.cc:1: random numbers come from core/random.h"},
        Breach{"MachinePath", "README.md",
               "a\nsee /ho"
               "me/someone/notes\n",
               "README.md:2: names a folder of one machine, /ho"
               "me/"}),
    [](const auto& test) { return test.param.name; });

TEST(ArchitectureChecker, FindsAnArrowThatPointsBack) {
  SourceTree tree = SoundTree();
  tree["base/a.cc"] = "#include \"sidestep/top/b.h\"\n";
  EXPECT_THAT(FindViolations(tree, kRules),
              ElementsAre("base/a.cc:1: base/ may not include sidestep/top/b.h",
                          "base/CMakeLists.txt: does not link top, which is included"));
}

}  // namespace
}  // namespace sidestep
