#include "sidestep/import/triangle_mesh.h"

#include <gtest/gtest.h>

namespace sidestep::imports::triangle_mesh_test {
namespace {

TriangleMesh Tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 4);
  mesh.vertices << 0, 1, 0, 0,  //
      0, 0, 2, 0,               //
      0, 0, 0, 3;
  mesh.triangles.resize(3, 4);
  mesh.triangles << 0, 0, 0, 1,  //
      2, 1, 3, 2,                //
      1, 3, 2, 3;
  return mesh;
}

TEST(TriangleMesh, HasTheVolumeOfATetrahedronWhereverItStands) {
  TriangleMesh mesh = Tetrahedron();
  EXPECT_NEAR(SignedVolume_m3(mesh), 1, 1e-14);
  mesh.vertices.colwise() += Eigen::Vector3d(3, -2, 5);
  EXPECT_NEAR(SignedVolume_m3(mesh), 1, 1e-12);
}

TEST(TriangleMesh, ThatIsInsideOutHasANegativeVolume) {
  TriangleMesh mesh = Tetrahedron();
  mesh.triangles.row(1).swap(mesh.triangles.row(2));
  EXPECT_NEAR(SignedVolume_m3(mesh), -1, 1e-14);
}

}  // namespace
}  // namespace sidestep::imports::triangle_mesh_test
