#include "sidestep/import/mesh_uri.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "sidestep/core/input_error.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::imports::mesh_uri_test {
namespace {

namespace fs = std::filesystem;

class MeshUri : public ::testing::Test {
 protected:
  MeshUri() {
    for (const char* const file : {"ws/arm_parts/meshes/a.stl", "ws/arm_parts/urdf/arm.urdf",
                                   "other/hand_parts/b.stl", "other/with space/c.stl"}) {
      fs::create_directories((root_ / file).parent_path());
      std::ofstream(root_ / file) << "x";
    }
  }
  std::string Found(const std::string& uri, const std::vector<std::string>& folders = {}) const {
    try {
      const std::string path =
          ResolveMeshUri(uri, (root_ / "ws/arm_parts/urdf/arm.urdf").string(), folders);
      return fs::weakly_canonical(path).lexically_relative(fs::weakly_canonical(root_)).string();
    } catch (const InputError& error) {
      return error.what();
    }
  }
  const TemporaryFolder folder_;
  const fs::path root_ = folder_.path();
};

TEST_F(MeshUri, IsFoundBesideTheUrdf) {
  EXPECT_EQ(Found("../meshes/a.stl"), "ws/arm_parts/meshes/a.stl");
  EXPECT_EQ(Found((root_ / "other/hand_parts/b.stl").string()), "other/hand_parts/b.stl");
}

TEST_F(MeshUri, OfAFileMayHaveEscapes) {
  EXPECT_EQ(Found("file://" + (root_ / "other").string() + "/with%20space/c.stl"),
            "other/with space/c.stl");
}

TEST_F(MeshUri, OfAPackageIsFoundAboveTheUrdfOrWhereItIsSaidToBe) {
  EXPECT_EQ(Found("package://arm_parts/meshes/a.stl"), "ws/arm_parts/meshes/a.stl");
  EXPECT_EQ(Found("model://arm_parts/meshes/a.stl"), "ws/arm_parts/meshes/a.stl");
  const std::string other = (root_ / "other").string();
  EXPECT_EQ(Found("package://hand_parts/b.stl", {other}), "other/hand_parts/b.stl");
  EXPECT_EQ(Found("package://hand_parts/b.stl", {other + "/hand_parts/"}),
            "other/hand_parts/b.stl");
}

// As of a shell's <(xacro FILE).
TEST_F(MeshUri, OfAUrdfThatComesThroughAPipeIsFoundWhereItIsSaidToBe) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const std::string urdf = "/proc/self/fd/" + std::to_string(ends[0]);
  const std::string other = (root_ / "other").string();
  EXPECT_EQ(ResolveMeshUri("package://hand_parts/b.stl", urdf, {other}),
            other + "/hand_parts/b.stl");
  EXPECT_THROW(ResolveMeshUri("package://hand_parts/b.stl", urdf, {}), InputError);
  close(ends[0]);
  close(ends[1]);
}

TEST_F(MeshUri, ThatLeadsNowhereSaysWhy) {
  EXPECT_THAT(Found("package://hand_parts/b.stl"),
              testing::HasSubstr("there is no package 'hand_parts' beside the URDF or above it; "
                                 "say where it is by --package-path"));
  EXPECT_THAT(Found("package://arm_parts/meshes/none.stl"), testing::HasSubstr("holds no such"));
  EXPECT_THAT(Found("package://arm_parts"), testing::HasSubstr("must be package://PACKAGE/FILE"));
  EXPECT_THAT(Found("http://example.org/a.stl"), testing::HasSubstr("only package://"));
  EXPECT_THAT(Found("none.stl"), testing::HasSubstr("there is no "));
}

}  // namespace
}  // namespace sidestep::imports::mesh_uri_test
