#include "sidestep/cli/build_id.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

namespace sidestep::cli {
namespace {

// This program's own file holds the note: the owner "GNU", and the bytes of the id behind it.
TEST(BuildId, IsThatOfTheNoteInTheProgramsFile) {
  const std::string id = BuildId();
  ASSERT_EQ(id.size(), 40u);  // of SHA-1
  std::string bytes;
  for (std::size_t i = 0; i < id.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(id.substr(i, 2), nullptr, 16));
  }
  std::ifstream program("/proc/self/exe", std::ios::binary);
  const std::string file(std::istreambuf_iterator<char>(program), {});
  EXPECT_NE(file.find(std::string("GNU\0", 4) + bytes), std::string::npos);
}

}  // namespace
}  // namespace sidestep::cli
