#include "sidestep/import/closed_mesh.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"

namespace sidestep::imports {
namespace {

std::string PointText(const Eigen::Vector3d& p) {
  return "(" + ShortestText(p.x()) + ", " + ShortestText(p.y()) + ", " + ShortestText(p.z()) + ")";
}

}  // namespace

std::vector<int> FirstOfEachPlace(const TriangleMesh& mesh) {
  const auto place = [&mesh](int i) {
    const Eigen::Vector3d p = mesh.vertices.col(i);
    return std::array<double, 3>{p.x() + 0.0, p.y() + 0.0, p.z() + 0.0};  // no -0
  };
  std::vector<int> order(static_cast<std::size_t>(mesh.vertices.cols()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::pair(place(a), a) < std::pair(place(b), b); });
  std::vector<int> first(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_same = i > 0 && place(order[i]) == place(order[i - 1]);
    first[static_cast<std::size_t>(order[i])] =
        is_same ? first[static_cast<std::size_t>(order[i - 1])] : order[i];
  }
  return first;
}

void CheckClosed(const NamedMesh& solid) {
  const TriangleMesh& mesh = solid.mesh;
  const Eigen::Index num_vertices = mesh.vertices.cols();
  if (mesh.triangles.cols() == 0) throw InputError(solid.name, "has no triangles");
  if (!mesh.vertices.allFinite()) throw InputError(solid.name, "has a vertex that is not finite");
  if (mesh.triangles.minCoeff() < 0 || mesh.triangles.maxCoeff() >= num_vertices) {
    throw InputError(solid.name, "has a triangle with a corner that is no vertex");
  }
  const std::vector<int> first = FirstOfEachPlace(mesh);
  // The ends of each edge, the lower one first, and which way a triangle runs along it.
  std::vector<std::array<int, 3>> edges;
  for (const auto& triangle : mesh.triangles.colwise()) {
    std::array<int, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = first[static_cast<std::size_t>(triangle[static_cast<Eigen::Index>(k)])];
    }
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = corners[k], b = corners[(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
    }
  }
  std::sort(edges.begin(), edges.end());
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    int sum = 0;
    for (;
         end < edges.size() && edges[end][0] == edges[begin][0] && edges[end][1] == edges[begin][1];
         ++end) {
      sum += edges[end][2];
    }
    if (sum == 0) continue;
    throw InputError(solid.name,
                     "is not closed: the edge from " +
                         PointText(mesh.vertices.col(edges[begin][0])) + " to " +
                         PointText(mesh.vertices.col(edges[begin][1])) + " has " +
                         (end - begin == 1 ? "a triangle on one side only"
                                           : "triangles that do not face the same way"));
  }
  if (!(SignedVolume_m3(mesh) > 0)) {
    throw InputError(solid.name, "is inside out, or holds no volume");
  }
}

}  // namespace sidestep::imports
