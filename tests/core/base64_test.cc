#include "sidestep/core/base64.h"

#include <gtest/gtest.h>

namespace sidestep::base64_test {
namespace {

// The test vectors of RFC 4648, section 10.
TEST(Base64, WritesWhatTheStandardDoes) {
  const struct {
    const char *bytes, *text;
  } vectors[] = {{"", ""},
                 {"f", "Zg=="},
                 {"fo", "Zm8="},
                 {"foo", "Zm9v"},
                 {"foob", "Zm9vYg=="},
                 {"fooba", "Zm9vYmE="},
                 {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, text] : vectors) EXPECT_EQ(Base64(bytes), text);
}

TEST(Base64, TakesEveryByte) {
  EXPECT_EQ(Base64(std::string("\x00\xFF\xFB\xEF\x80", 5)), "AP/774A=");
}

}  // namespace
}  // namespace sidestep::base64_test
