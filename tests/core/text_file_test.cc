#include "sidestep/core/text_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "sidestep/core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::text_file_test {
namespace {

struct Encoding {
  const char* name;
  std::string bytes;
  std::string result;  // the text, or what is wrong with it
};
std::ostream& operator<<(std::ostream& stream, const Encoding& e) { return stream << e.name; }

class TextFile : public ::testing::TestWithParam<Encoding> {};

TEST_P(TextFile, IsReadOrRefusedWithItsLine) {
  const TemporaryFolder folder;
  const std::string path = folder.path() / "text";
  std::ofstream(path, std::ios::binary) << GetParam().bytes;
  std::string result;
  try {
    result = ReadTextFile(path, 1000);
  } catch (const InputError& error) {
    result = std::string(error.what()).substr(path.size());
  }
  EXPECT_EQ(result, GetParam().result);
}

using namespace std::string_literals;
const std::string kWide = ":1: is UTF-16 or UTF-32, must be UTF-8";

INSTANTIATE_TEST_SUITE_P(
    Encodings, TextFile,
    ::testing::Values(
        Encoding{"Ascii", "a\nb\n", "a\nb\n"}, Encoding{"Utf8", "caf\xC3\xA9\n", "caf\xC3\xA9\n"},
        Encoding{"ByteOrderMark",
                 "\xEF\xBB\xBF"
                 "a\n",
                 "a\n"},
        Encoding{"OnlyAByteOrderMark", "\xEF\xBB\xBF", ""},
        Encoding{"WindowsLineEnds", "a\r\n\r\nb", "a\n\nb"},
        Encoding{"LoneCarriageReturn", "a\rb\r", "a\rb\r"},
        Encoding{"Latin1", "a\nb\ncaf\xE9\n", ":3: must be UTF-8, has the byte \\xE9 (Latin-1?)"},
        Encoding{"Latin1BehindWindowsLineEnds", "a\r\n\xE9",
                 ":2: must be UTF-8, has the byte \\xE9 (Latin-1?)"},
        Encoding{"CutOff", "a\xE2\x82", ":1: must be UTF-8, has the byte \\xE2 (Latin-1?)"},
        Encoding{"Utf16LittleEndian",
                 "\xFF\xFE"
                 "a\0\n\0"s,
                 kWide},
        Encoding{"Utf16BigEndian", "\xFE\xFF\0a\0\n"s, kWide},
        Encoding{"Utf16WithoutAMark", "a\0\n\0"s, kWide},
        Encoding{"Utf16BigEndianWithoutAMark", "\0a\0\n"s, kWide},
        Encoding{"Utf32", "\xFF\xFE\0\0a\0\0\0"s, kWide}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace sidestep::text_file_test
