#include "tests/defined_types.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>

namespace sidestep {
namespace {

using ::testing::ElementsAreArray;

struct Case {
  std::string name;
  std::string text;
  std::vector<std::string> types;  // with their lines, e.g. "a::B:3"
};
std::ostream& operator<<(std::ostream& stream, const Case& one) { return stream << one.name; }

class DefinedTypes : public ::testing::TestWithParam<Case> {};

TEST_P(DefinedTypes, AreThoseWithABodyAtTheLevelOfANamespace) {
  std::vector<std::string> found;
  for (const DefinedType& type : FindDefinedTypes(GetParam().text)) {
    found.push_back(type.name + ":" + std::to_string(type.line));
  }
  EXPECT_THAT(found, ElementsAreArray(GetParam().types));
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, DefinedTypes,
    ::testing::Values(
        Case{"Plain",
             "namespace a {\nstruct B { int c; };\nclass D final : public B {};\n}\n",
             {"a::B:2", "a::D:3"}},
        Case{"Enumerations", "enum class E : int { kA };\nenum F { kB };\n", {"E:1", "F:2"}},
        Case{"Templates", "template <class T, template <class> class U>\nclass V {};\n", {"V:2"}},
        Case{"NotSpecialisations", "template <>\nstruct std::hash<B> {};\n", {}},
        Case{"NestedNamespaces",
             "namespace a::b { namespace c { struct D {}; } struct E {}; }",
             {"a::b::c::D:1", "a::b::E:1"}},
        Case{"WithAlignment", "struct alignas(64) [[nodiscard]] Wide {};", {"Wide:1"}},
        Case{"NotDeclarations", "class A;\nstruct B* f(struct C c);\nenum class D : int;\n", {}},
        Case{"NotAliases", "namespace x = y;\nusing A = struct B;\nusing namespace z;\n", {}},
        Case{"NotInside", "namespace a { struct B { struct C {}; enum D { kE }; }; }", {"a::B:1"}},
        Case{"InsideOfOthersByTheirWholeName",
             "struct A { struct B; };\nstruct A::B {};\n",
             {"A:1", "A::B:2"}},
        Case{"NotInFunctions", "int f(int a) {\n  struct Local {};\n  return a;\n}\n", {}},
        Case{"NotUnnamedNamespaces",
             "namespace a { namespace { struct B {}; } struct C {}; }",
             {"a::C:1"}},
        Case{"NotText",
             "// struct A {};\n/* class\nB {} */ const char* s = \"struct C {}\";\n"
             "#define STRUCT struct D {}\nchar c = '{';\nstruct E {};\n",
             {"E:6"}},
        Case{"AfterVariables",
             "struct A {} a;\nconst int b[] = {1, 2};\nstruct C {};\n",
             {"A:1", "C:3"}}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace sidestep
