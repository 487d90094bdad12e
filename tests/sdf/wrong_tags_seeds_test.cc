#include <gtest/gtest.h>

#include "tests/sdf/wrong_tags.h"

namespace sidestep::sdf {
namespace {

TEST(TagsThatMisbehave, DoLittleHarmOverFourHundredSeeds) { ExpectLittleHarmOfWrongTags(400); }

}  // namespace
}  // namespace sidestep::sdf
