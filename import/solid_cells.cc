#include "sidestep/import/solid_cells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sidestep::imports {
namespace {

constexpr int kFreeRim = 2;
// Where the lines run between whole cells, so that none meets an edge of a solid made of round
// numbers.
constexpr double kOffX = 0.4142135, kOffY = 0.5857864, kOffZ = 0.4495897;

// Which side of the edge from a to b the line (y, z) is on: 1 or -1, never 0, and exactly opposite
// for the edge from b to a, so that lines slip through no crack between triangles.
int SideOf(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double y, double z) {
  const bool is_forward =
      std::pair(a.y(), std::pair(a.z(), a.x())) < std::pair(b.y(), std::pair(b.z(), b.x()));
  const Eigen::Vector3d& p = is_forward ? a : b;
  const Eigen::Vector3d& q = is_forward ? b : a;
  const double cross = (q.y() - p.y()) * (z - p.z()) - (q.z() - p.z()) * (y - p.y());
  const int side = cross >= 0 ? 1 : -1;
  return is_forward ? side : -side;
}

struct Crossing {
  double x = 0;
  int winding = 0;  ///< 1 into a solid, -1 out of it
};

}  // namespace

SolidCells FillCells(const std::vector<TriangleMesh>& meshes, int cells_along) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (const TriangleMesh& mesh : meshes) {
    low = low.cwiseMin(mesh.vertices.rowwise().minCoeff());
    high = high.cwiseMax(mesh.vertices.rowwise().maxCoeff());
  }
  GridSpec spec;
  spec.cell_m = (high - low).maxCoeff() / cells_along;
  spec.first_center_m =
      low + spec.cell_m * (Eigen::Vector3d(kOffX, kOffY, kOffZ) - Eigen::Vector3d::Constant(1.0) -
                           Eigen::Vector3d::Constant(kFreeRim - 1.0));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto along = static_cast<Eigen::Index>(axis);
    spec.size[axis] =
        static_cast<int>(std::ceil((high[along] - low[along]) / spec.cell_m)) + 2 * kFreeRim;
  }
  const auto ny = static_cast<std::size_t>(spec.size[1]),
             nz = static_cast<std::size_t>(spec.size[2]);
  std::vector<std::vector<Crossing>> lines(ny * nz);
  const auto first_line = [&](double p, Eigen::Index axis) {
    return std::max(
        0, static_cast<int>(std::ceil((p - spec.first_center_m[axis]) / spec.cell_m - 1e-9)));
  };
  for (const TriangleMesh& mesh : meshes) {
    for (const auto& triangle : mesh.triangles.colwise()) {
      const Eigen::Vector3d a = mesh.vertices.col(triangle[0]), b = mesh.vertices.col(triangle[1]),
                            c = mesh.vertices.col(triangle[2]);
      const Eigen::Vector3d least = a.cwiseMin(b).cwiseMin(c), most = a.cwiseMax(b).cwiseMax(c);
      const Eigen::Vector3d normal = (b - a).cross(c - a);
      for (int k = first_line(least.z(), 2); k < spec.size[2]; ++k) {
        const double z = spec.first_center_m.z() + spec.cell_m * k;
        if (z > most.z()) break;
        for (int j = first_line(least.y(), 1); j < spec.size[1]; ++j) {
          const double y = spec.first_center_m.y() + spec.cell_m * j;
          if (y > most.y()) break;
          const int side = SideOf(a, b, y, z);
          if (SideOf(b, c, y, z) != side || SideOf(c, a, y, z) != side) continue;
          // Seen along x, a triangle that runs round to the left is one that is left behind.
          double x = a.x();
          if (normal.x() != 0) {
            x -= (normal.y() * (y - a.y()) + normal.z() * (z - a.z())) / normal.x();
          }
          lines[static_cast<std::size_t>(k) * ny + static_cast<std::size_t>(j)].push_back(
              {std::clamp(x, least.x(), most.x()), -side});
        }
      }
    }
  }
  SolidCells cells{OccupancyGrid(spec), 0};
  for (std::size_t line = 0; line < lines.size(); ++line) {
    std::vector<Crossing>& crossings = lines[line];
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
      return std::pair(a.x, -a.winding) < std::pair(b.x, -b.winding);
    });
    int winding = 0;
    for (std::size_t n = 0; n + 1 < crossings.size(); ++n) {
      winding += crossings[n].winding;
      if (winding <= 0) continue;
      const double from = crossings[n].x, to = crossings[n + 1].x;
      cells.volume_m3 += (to - from) * spec.cell_m * spec.cell_m;
      for (int i = first_line(from, 0);
           i < spec.size[0] && spec.first_center_m.x() + spec.cell_m * i < to; ++i) {
        cells.grid.cells[spec.Index(i, static_cast<int>(line % ny), static_cast<int>(line / ny))] =
            1;
      }
    }
  }
  return cells;
}

}  // namespace sidestep::imports
