#include "sidestep/core/utf8.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace sidestep::utf8_test {
namespace {

// By the definition, without any care for which code points there are.
std::string Encode(unsigned code_point, int length) {
  if (length == 1) return {static_cast<char>(code_point)};
  std::string text;
  for (int i = 1; i < length; ++i) {
    text.insert(text.begin(), static_cast<char>(0x80 | (code_point & 0x3F)));
    code_point >>= 6;
  }
  const unsigned mark = 0xF00u >> length;
  text.insert(text.begin(), static_cast<char>((mark & 0xFF) | code_point));
  return text;
}

int LengthOf(unsigned code_point) {
  return code_point < 0x80 ? 1 : code_point < 0x800 ? 2 : code_point < 0x10000 ? 3 : 4;
}

TEST(Utf8, TakesEveryCodePointInItsShortestForm) {
  for (unsigned c = 0; c <= 0x10FFFF; ++c) {
    const int length = LengthOf(c);
    const bool is_surrogate = c >= 0xD800 && c <= 0xDFFF;
    ASSERT_EQ(Utf8Length(Encode(c, length)), is_surrogate ? 0u : static_cast<unsigned>(length))
        << std::hex << c;
  }
}

TEST(Utf8, RefusesLongerFormsAndWhatLiesAboveAllCodePoints) {
  for (const unsigned c : {0u, 0x7Fu, 0x80u, 0x7FFu, 0x800u, 0xFFFFu}) {
    for (int length = LengthOf(c) + 1; length <= 4; ++length) {
      EXPECT_EQ(Utf8Length(Encode(c, length)), 0u) << std::hex << c << " in " << length;
    }
  }
  EXPECT_EQ(Utf8Length(Encode(0x110000, 4)), 0u);
  EXPECT_EQ(Utf8Length(Encode(0x1FFFFF, 4)), 0u);
}

TEST(Utf8, RefusesWhatIsCutOffOrBeginsInTheMiddle) {
  for (const unsigned c : {0xE9u, 0x20ACu, 0x1F916u}) {
    const std::string whole = Encode(c, LengthOf(c));
    for (std::size_t size = 0; size < whole.size(); ++size) {
      EXPECT_EQ(Utf8Length(whole.substr(0, size)), 0u);
      EXPECT_EQ(Utf8Length(whole.substr(0, size) + "a"), size == 0 ? 1u : 0u);
      EXPECT_EQ(Utf8Length(whole.substr(std::max<std::size_t>(size, 1))), 0u);
    }
  }
}

TEST(EscapeInvalidUtf8, KeepsTextAndWritesOtherBytesOut) {
  const struct {
    std::string bytes, text;
  } cases[] = {
      {"", ""},
      {"plain", "plain"},
      {"caf\xC3\xA9 \xE2\x82\xAC", "caf\xC3\xA9 \xE2\x82\xAC"},
      {"caf\xE9", "caf\\xE9"},
      {"\xE9t\xE9", "\\xE9t\\xE9"},
      {"\xC3", "\\xC3"},
      {"\xE2\x82z", "\\xE2\\x82z"},
      {"\xFF\xFE", "\\xFF\\xFE"},
  };
  for (const auto& c : cases) {
    EXPECT_EQ(EscapeInvalidUtf8(c.bytes), c.text);
    EXPECT_EQ(FindInvalidUtf8(EscapeInvalidUtf8(c.bytes)), c.text.size());
    EXPECT_EQ(FindInvalidUtf8(c.bytes) == c.bytes.size(), c.bytes == c.text);
  }
}

TEST(Utf8Prefix, CutsNoCharacter) {
  const std::string text = "a\xC3\xA9\xE2\x82\xACz";
  const char* const expected[] = {"",
                                  "a",
                                  "a",
                                  "a\xC3\xA9",
                                  "a\xC3\xA9",
                                  "a\xC3\xA9",
                                  "a\xC3\xA9\xE2\x82\xAC",
                                  "a\xC3\xA9\xE2\x82\xACz"};
  for (std::size_t n = 0; n < 8; ++n) EXPECT_EQ(Utf8Prefix(text, n), expected[n]) << n;
  EXPECT_EQ(Utf8Prefix("\xE9\xE9\xE9", 2), "\xE9\xE9");
}

TEST(EscapeControls, WritesOutWhatATerminalWouldObey) {
  EXPECT_EQ(EscapeControls("a\x1b[31m\x07\x7f\0z"), "a\\x1B[31m\\x07\\x7F");
  EXPECT_EQ(EscapeControls("\xC2\x9B"
                           "1m \xC2\x80"),
            "\\xC2\\x9B1m \\xC2\\x80");
  EXPECT_EQ(EscapeControls("caf\xE9"), "caf\\xE9");
  EXPECT_EQ(EscapeControls("line\n\tcaf\xC3\xA9\xC2\xA0\r"), "line\n\tcaf\xC3\xA9\xC2\xA0\r");
}

}  // namespace
}  // namespace sidestep::utf8_test
