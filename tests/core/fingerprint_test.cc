#include "sidestep/core/fingerprint.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

namespace sidestep::fingerprint_test {
namespace {

std::string Of(std::initializer_list<std::string_view> parts) {
  Fingerprint fingerprint;
  for (const std::string_view part : parts) fingerprint.Add(part);
  return fingerprint.Text();
}

// The published value of FNV-1a for no bytes at all; and for "", whose length, eight zero bytes,
// counts as well: 0xcbf29ce484222325 * 0x100000001b3^8 modulo 2^64.
TEST(Fingerprint, IsThatOfFnv1a) {
  EXPECT_EQ(Of({}), "cbf29ce484222325");
  EXPECT_EQ(Of({""}), "a8c7f832281a39c5");
}

TEST(Fingerprint, TellsEveryChangeAndWhereAPartEnds) {
  EXPECT_EQ(Of({"ab", "c"}), Of({"ab", "c"}));
  EXPECT_NE(Of({"ab", "c"}), Of({"a", "bc"}));
  EXPECT_NE(Of({"ab"}), Of({"ba"}));
  EXPECT_NE(Of({"ab"}), Of({"ab", ""}));
}

}  // namespace
}  // namespace sidestep::fingerprint_test
