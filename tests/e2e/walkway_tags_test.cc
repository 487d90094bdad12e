// The walkway, seen by the tag on what drives through it, run as a person would run it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "tests/support/bytes_of.h"
#include "tests/support/subprocess.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::walkway_tags_test {
namespace {

using Json = nlohmann::json;

struct Seeing {
  std::string tags;
  int seed;
};
std::ostream& operator<<(std::ostream& stream, const Seeing& seeing) {
  return stream << seeing.tags << " with seed " << seeing.seed;
}

class WalkwayByTags : public ::testing::TestWithParam<Seeing> {};

TEST_P(WalkwayByTags, IsCrossedWithoutTouchingAnything) {
  const TemporaryFolder temporary;
  const auto out = temporary.path() / "out";
  const Finished finished =
      RunProgram({SIDESTEP_PROGRAM, "run", "walkway_tags", "--set", "tags=" + GetParam().tags,
                  "--seed", std::to_string(GetParam().seed), "--out", out.string()},
                 {}, temporary.path().string());
  ASSERT_EQ(finished.exit_code, 0) << finished.err;
  const Json result = Json::parse(BytesOf(out / "result.json"), nullptr, false);
  EXPECT_EQ(result["outcome"], "goal");
  const int refused = result["track_events"].value("refused", 0);
  if (GetParam().tags == "misbehaving") {
    EXPECT_GE(refused, 5) << "what is wrong is left out, and told";
  } else if (GetParam().tags == "exact") {
    EXPECT_EQ(refused, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Tags, WalkwayByTags,
                         ::testing::Values(Seeing{"exact", 1}, Seeing{"noisy", 1},
                                           Seeing{"misbehaving", 1}, Seeing{"misbehaving", 2},
                                           Seeing{"misbehaving", 3}));

}  // namespace
}  // namespace sidestep::walkway_tags_test
