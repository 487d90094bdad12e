#include "sidestep/import/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

#include "sidestep/core/input_error.h"
#include "tests/support/bytes_of.h"
#include "tests/support/temporary_folder.h"

namespace sidestep::imports::mesh_file_test {
namespace {

using Eigen::Vector3d;

const std::string kParts = SIDESTEP_SOURCE_DIR "/tests/data/urdf/arm_parts/meshes/";

Vector3d Low(const TriangleMesh& mesh) { return mesh.vertices.rowwise().minCoeff(); }
Vector3d High(const TriangleMesh& mesh) { return mesh.vertices.rowwise().maxCoeff(); }

class MeshFile : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& bytes) const {
    const std::string path = (folder_.path() / name).string();
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  std::string MessageOf(const std::string& path) const {
    try {
      LoadMesh(path, {});
    } catch (const InputError& error) {
      return error.what();
    }
    return "was accepted";
  }
  const TemporaryFolder folder_;
};

TEST_F(MeshFile, OfTextStlHasItsTrianglesAndJoinsTheirCorners) {
  const LoadedMesh loaded = LoadMesh(kParts + "tower.stl", {});
  EXPECT_EQ(loaded.mesh.vertices.cols(), 24);
  EXPECT_EQ(loaded.mesh.triangles.cols(), 44);
  EXPECT_NEAR(Low(loaded.mesh).z(), -20, 1e-5);
  EXPECT_NEAR(High(loaded.mesh).x(), 65, 1e-5);
  EXPECT_GT(SignedVolume_m3(loaded.mesh), 0);
  EXPECT_THAT(loaded.notes, testing::IsEmpty());
}

TEST_F(MeshFile, OfBinaryStlIsTheSameAsOfText) {
  const TriangleMesh text = LoadMesh(kParts + "tower.stl", {}).mesh;
  std::string bytes(80, ' ');
  const auto append = [&bytes](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  append(static_cast<std::uint32_t>(text.triangles.cols()));
  for (const auto& t : text.triangles.colwise()) {
    for (int i = 0; i < 3; ++i) append(0.0f);
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 3; ++i) append(static_cast<float>(text.vertices(i, t(k))));
    }
    append(std::uint16_t{0});
  }
  const TriangleMesh binary = LoadMesh(Write("tower.STL", bytes), {}).mesh;
  EXPECT_EQ(binary.triangles, text.triangles);
  EXPECT_LT((binary.vertices - text.vertices).cwiseAbs().maxCoeff(), 1e-5);
}

// A tube of 3 to 4 cm around z, from 0 to 7 cm, in a node that is 1 cm lower.
TEST_F(MeshFile, OfColladaIsInMetresAndWhereItsNodesPutIt) {
  const LoadedMesh loaded = LoadMesh(kParts + "wrist.dae", {});
  EXPECT_NEAR(Low(loaded.mesh).z(), -0.01, 1e-6);
  EXPECT_NEAR(High(loaded.mesh).z(), 0.06, 1e-6);
  EXPECT_NEAR(High(loaded.mesh).x(), 0.04, 1e-6);
  EXPECT_THAT(loaded.notes, testing::IsEmpty());
}

TEST_F(MeshFile, OfColladaIsTurnedSoThatItsUpAxisIsZ) {
  std::string text = BytesOf(kParts + "wrist.dae");
  const std::size_t at = text.find("Z_UP");
  ASSERT_NE(at, std::string::npos);
  const struct {
    const char* up;
    Vector3d low, high;  // where the tube along the file's z comes to lie
  } kCases[] = {{"Y_UP", {-0.04, -0.06, -0.04}, {0.04, 0.01, 0.04}},
                {"X_UP", {-0.04, -0.06, -0.04}, {0.04, 0.01, 0.04}}};
  for (const auto& [up, low, high] : kCases) {
    text.replace(at, 4, up);
    const std::string path = Write("wrist.dae", text);
    const LoadedMesh turned = LoadMesh(path, {});
    EXPECT_LT((Low(turned.mesh) - low).cwiseAbs().maxCoeff(), 1e-6) << up;
    EXPECT_LT((High(turned.mesh) - high).cwiseAbs().maxCoeff(), 1e-6) << up;
    EXPECT_GT(SignedVolume_m3(turned.mesh), 0) << up;
    EXPECT_THAT(turned.notes, testing::ElementsAre(testing::StartsWith("has its up axis along")));
    const LoadedMesh as_it_is = LoadMesh(path, {/*turn_up_axis=*/false});
    EXPECT_NEAR(High(as_it_is.mesh).z(), 0.06, 1e-6) << up;
  }
}

TEST_F(MeshFile, ThatIsInsideOutOrOpenIsTold) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const std::string inverted = corners + "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";
  EXPECT_THAT(LoadMesh(Write("a.obj", inverted), {}).notes, testing::ElementsAre("is inside out"));
  const std::string open = corners + "f 1 3 2\nf 1 2 4\nf 2 3 4\n";
  EXPECT_THAT(LoadMesh(Write("b.obj", open), {}).notes,
              testing::ElementsAre("is not closed: 3 of its edges lack a triangle on one side"));
}

// On which assimp 5.2 crashes: it believes the count.
TEST_F(MeshFile, IsRefusedIfReadingItCrashes) {
  std::string text = BytesOf(kParts + "wrist.dae");
  const std::string count = "count=\"48\"";
  text.replace(text.find(count), count.size(), "count=\"none\"");
  EXPECT_NE(MessageOf(Write("a.dae", text)), "was accepted");
}

TEST_F(MeshFile, IsRefusedIfItIsNone) {
  EXPECT_THAT(MessageOf(kParts + "none.stl"), testing::HasSubstr("is not there"));
  EXPECT_THAT(MessageOf(kParts), testing::HasSubstr("is no file"));
  EXPECT_THAT(MessageOf(Write("a.stp", "ISO")), testing::HasSubstr("must be an STL, OBJ or DAE"));
  EXPECT_THAT(MessageOf(Write("a.stl", "")), testing::HasSubstr("is no mesh"));
  EXPECT_THAT(MessageOf(Write("a.dae", "<COLLADA>")), testing::HasSubstr("is no well-formed XML"));
  EXPECT_THAT(MessageOf(Write("b.dae", "<!DOCTYPE a [<!ENTITY b \"c\">]><COLLADA/>")),
              testing::HasSubstr("is not taken in a mesh"));
  EXPECT_THAT(MessageOf(Write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n")),
              testing::HasSubstr("holds no"));
}

}  // namespace
}  // namespace sidestep::imports::mesh_file_test
