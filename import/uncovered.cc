#include "sidestep/import/uncovered.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "sidestep/import/surface_points.h"

namespace sidestep::imports {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

// Of all spheres the one that a piece sticks out of least, and how far.
struct Nearest {
  std::size_t sphere = 0;
  double out_m = std::numeric_limits<double>::infinity();
};

double OutOf(const CoverSphere& sphere, const Corners& corners) {
  const double square = std::max({(corners[0] - sphere.center_m).squaredNorm(),
                                  (corners[1] - sphere.center_m).squaredNorm(),
                                  (corners[2] - sphere.center_m).squaredNorm()});
  return std::sqrt(square) - sphere.radius_m;
}

Nearest FindNearest(const std::vector<CoverSphere>& spheres, const Corners& corners) {
  Nearest nearest;
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double out_m = OutOf(spheres[i], corners);
    if (out_m < nearest.out_m) nearest = {i, out_m};
  }
  return nearest;
}

double OutAt(const std::vector<CoverSphere>& spheres, const Eigen::Vector3d& p) {
  double out_m = std::numeric_limits<double>::infinity();
  for (const CoverSphere& sphere : spheres) {
    out_m = std::min(out_m, (p - sphere.center_m).norm() - sphere.radius_m);
  }
  return out_m;
}

// The corner before the longest edge, and that edge's length.
std::pair<std::size_t, double> LongestEdge(const Corners& corners) {
  std::pair<std::size_t, double> longest = {0, -1};
  for (std::size_t k = 0; k < 3; ++k) {
    const double length = (corners[(k + 1) % 3] - corners[k]).norm();
    if (length > longest.second) longest = {k, length};
  }
  return longest;
}

std::pair<Corners, Corners> Halves(const Corners& corners, std::size_t edge) {
  const std::size_t next = (edge + 1) % 3;
  const Eigen::Vector3d middle = (corners[edge] + corners[next]) / 2;
  std::pair<Corners, Corners> halves = {corners, corners};
  halves.first[next] = middle;
  halves.second[edge] = middle;
  return halves;
}

template <class Use>
void ForEachTriangle(const std::vector<TriangleMesh>& meshes, const Use& use) {
  for (const TriangleMesh& mesh : meshes) {
    for (const auto& triangle : mesh.triangles.colwise()) {
      use(Corners{mesh.vertices.col(triangle[0]), mesh.vertices.col(triangle[1]),
                  mesh.vertices.col(triangle[2])});
    }
  }
}

// Calls visit(piece, the sphere that it sticks out of least) for the pieces of triangles that may
// stick out by more than `cover_m`, cut until no edge is longer than `longest_m`. It may change the
// spheres.
template <class Visit>
void ForEachPieceOutside(const std::vector<TriangleMesh>& meshes,
                         const std::vector<CoverSphere>& spheres, double cover_m, double longest_m,
                         const Visit& visit) {
  std::vector<Corners> pieces;
  ForEachTriangle(meshes, [&](const Corners& corners) {
    pieces.assign(1, corners);
    while (!pieces.empty()) {
      const Corners piece = pieces.back();
      pieces.pop_back();
      const Nearest nearest = FindNearest(spheres, piece);
      if (nearest.out_m <= cover_m) continue;
      const auto [edge, length] = LongestEdge(piece);
      if (length > longest_m) {
        const auto halves = Halves(piece, edge);
        pieces.push_back(halves.first);
        pieces.push_back(halves.second);
      } else {
        visit(piece, nearest);
      }
    }
  });
}

}  // namespace

Uncovered FindUncovered(const std::vector<TriangleMesh>& meshes,
                        const std::vector<CoverSphere>& spheres, double gap_m) {
  constexpr int kMostPieces = 2000000;
  Uncovered worst;
  worst.at_least_m = -std::numeric_limits<double>::infinity();
  const auto look_at = [&](const Eigen::Vector3d& p) {
    const double out_m = OutAt(spheres, p);
    if (out_m > worst.at_least_m) {
      worst.at_least_m = out_m;
      worst.p_m = p;
    }
  };
  for (const TriangleMesh& mesh : meshes) {
    for (const auto& p : mesh.vertices.colwise()) look_at(p);
  }
  // A heap, the piece that may stick out furthest on top.
  using Piece = std::pair<double, Corners>;
  const auto is_below = [](const Piece& a, const Piece& b) { return a.first < b.first; };
  std::vector<Piece> heap;
  const auto add = [&](const Corners& corners) {
    const double out_m = FindNearest(spheres, corners).out_m;
    if (out_m > worst.at_least_m + gap_m) heap.emplace_back(out_m, corners);
  };
  ForEachTriangle(meshes, add);
  std::make_heap(heap.begin(), heap.end(), is_below);
  for (int count = 0; count < kMostPieces; ++count) {
    if (heap.empty() || heap.front().first <= worst.at_least_m + gap_m) break;
    std::pop_heap(heap.begin(), heap.end(), is_below);
    const Corners corners = heap.back().second;
    heap.pop_back();
    const std::size_t edge = LongestEdge(corners).first;
    const auto halves = Halves(corners, edge);
    look_at(halves.second[edge]);
    for (const Corners& half : {halves.first, halves.second}) {
      const std::size_t before = heap.size();
      add(half);
      if (heap.size() > before) std::push_heap(heap.begin(), heap.end(), is_below);
    }
  }
  worst.at_most_m = worst.at_least_m + gap_m;
  if (!heap.empty()) worst.at_most_m = std::max(worst.at_most_m, heap.front().first);
  return worst;
}

Eigen::Matrix3Xd FindOutside(const std::vector<TriangleMesh>& meshes,
                             const std::vector<CoverSphere>& spheres, double cover_m,
                             double apart_m) {
  PointThinner thinner(apart_m);
  ForEachPieceOutside(meshes, spheres, cover_m, apart_m, [&](const Corners& piece, const Nearest&) {
    const auto worst = std::max_element(
        piece.begin(), piece.end(),
        [&](const auto& a, const auto& b) { return OutAt(spheres, a) < OutAt(spheres, b); });
    if (OutAt(spheres, *worst) > cover_m) thinner.Add(*worst);
  });
  return thinner.Points();
}

void GrowToCover(const std::vector<TriangleMesh>& meshes, double cover_m, double steps_per_m,
                 std::vector<CoverSphere>* spheres) {
  const auto grow = [&](const Corners& piece, const Nearest& nearest) {
    CoverSphere& sphere = (*spheres)[nearest.sphere];
    double steps = std::ceil((sphere.radius_m + nearest.out_m - cover_m) * steps_per_m);
    for (; OutOf(sphere, piece) > cover_m; steps += 1) sphere.radius_m = steps / steps_per_m;
  };
  ForEachPieceOutside(meshes, *spheres, cover_m, 1 / steps_per_m, grow);
}

}  // namespace sidestep::imports
