#include "sidestep/sdf/map/nrrd_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "sidestep/core/input_error.h"

namespace sidestep::sdf::nrrd_file_test {
namespace {

using ::testing::HasSubstr;

class NrrdFile : public ::testing::Test {
 protected:
  NrrdFile() {
    folder_ = (std::filesystem::temp_directory_path() / "sidestep_nrrd_XXXXXX").string();
    EXPECT_NE(mkdtemp(folder_.data()), nullptr);
  }
  ~NrrdFile() override { std::filesystem::remove_all(folder_); }

  std::string path() const { return folder_ + "/grid.nrrd"; }
  // As a reader takes the file apart: its header ends with the first empty line.
  void Read() {
    std::ifstream file(path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const std::size_t end = bytes.find("\n\n");
    ASSERT_NE(end, std::string::npos);
    header_ = bytes.substr(0, end);
    data_ = bytes.substr(end + 2);
  }

  std::string folder_, header_, data_;
};

TEST_F(NrrdFile, OfAFieldSaysWhereItsCellsAreAndHoldsItsValues) {
  const GridSpec spec{{-1, 0.1, 1e-7}, 0.04, {2, 3, 4}};
  AlignedVector<float> distance_m(24);
  for (std::size_t n = 0; n < 24; ++n) distance_m[n] = 0.1F * static_cast<float>(n) - 1;
  WriteNrrd(SdfGrid(spec, distance_m), path());
  Read();
  EXPECT_EQ(header_,
            "NRRD0004\n"
            "type: float\n"
            "dimension: 3\n"
            "space dimension: 3\n"
            "sizes: 2 3 4\n"
            "space directions: (0.04,0,0) (0,0.04,0) (0,0,0.04)\n"
            "space origin: (-1,0.1,1e-07)\n"
            "space units: \"m\" \"m\" \"m\"\n"
            "kinds: domain domain domain\n"
            "endian: little\n"
            "encoding: raw");
  ASSERT_EQ(data_.size(), 24 * sizeof(float));
  EXPECT_EQ(std::memcmp(data_.data(), distance_m.data(), data_.size()), 0);
}

TEST_F(NrrdFile, OfOccupancyHoldsAByteACellWithXFastest) {
  OccupancyGrid grid({{0, 0, 0}, 0.5, {3, 2, 1}});
  grid.cells[grid.spec.Index(2, 0, 0)] = 1;
  grid.cells[grid.spec.Index(0, 1, 0)] = 1;
  WriteNrrd(grid, path());
  Read();
  EXPECT_THAT(header_, HasSubstr("\ntype: uint8\n"));
  EXPECT_THAT(header_, HasSubstr("\nsizes: 3 2 1\n"));
  EXPECT_EQ(data_, std::string({0, 0, 1, 1, 0, 0}));
}

TEST_F(NrrdFile, ThatCannotBeWrittenIsNamed) {
  try {
    WriteNrrd(OccupancyGrid({{0, 0, 0}, 1, {1, 1, 1}}), folder_);
    FAIL() << "was written";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), folder_ + ": cannot be written: Is a directory");
  }
}

}  // namespace
}  // namespace sidestep::sdf::nrrd_file_test
