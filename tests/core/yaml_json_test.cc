#include "sidestep/core/yaml_json.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace sidestep::yaml_json_test {
namespace {

struct Pair {
  const char* yaml;
  const char* json;
};

class YamlAndJson : public ::testing::TestWithParam<Pair> {};

TEST_P(YamlAndJson, SayTheSame) { EXPECT_EQ(YamlToJson(GetParam().yaml), GetParam().json); }

INSTANTIATE_TEST_SUITE_P(Values, YamlAndJson,
                         ::testing::Values(Pair{"a: 1\nb: [2.5, -1e-05, 0]",
                                                R"({"a":1,"b":[2.5,-1e-05,0]})"},
                                           Pair{"z: 1\na: 2", R"({"z":1,"a":2})"},
                                           Pair{"a: {b: {c: []}}", R"({"a":{"b":{"c":[]}}})"},
                                           Pair{"a: true\nb: \"true\"", R"({"a":true,"b":"true"})"},
                                           Pair{"a: \"42\"\nb: word", R"({"a":"42","b":"word"})"},
                                           Pair{"a:\nb: ~", R"({"a":null,"b":null})"},
                                           // What JSON does not take for numbers.
                                           Pair{"[.5, 1., 007, +1, 0x10, .inf, nan]",
                                                R"([".5","1.","007","+1","0x10",".inf","nan"])"},
                                           Pair{R"(a: "quote \" backslash \\ line\nend")",
                                                R"({"a":"quote \" backslash \\ line\u000aend"})"}));

TEST(YamlToJson, RefusesWhatIsNotYaml) { EXPECT_THROW(YamlToJson("a: [1"), std::invalid_argument); }

}  // namespace
}  // namespace sidestep::yaml_json_test
