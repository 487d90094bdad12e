#include "sidestep/import/convex_hull.h"

#include <libqhull_r/qhull_ra.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

namespace sidestep::imports {
namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using robot::HullSolid;

// The least extent of points over the directions of their principal axes.
double LeastExtent_m(const Matrix3Xd& points) {
  const Vector3d mean = points.rowwise().mean();
  const Matrix3Xd about = points.colwise() - mean;
  const Eigen::Matrix3d scatter = about * about.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
  const Matrix3Xd along = axes.eigenvectors().transpose() * about;
  return (along.rowwise().maxCoeff() - along.rowwise().minCoeff()).minCoeff();
}

// Qhull's state, whose memory is given back on every way out.
class Qhull {
 public:
  Qhull() { qh_zero(&state_, nullptr); }
  ~Qhull() {
    qh_freeqhull(&state_, !qh_ALL);
    int long_bytes = 0, total_bytes = 0;
    qh_memfreeshort(&state_, &long_bytes, &total_bytes);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;
  qhT* get() { return &state_; }

 private:
  qhT state_;
};

// How far each point stands outside of the farthest plane of a hull.
Eigen::VectorXd HeightsOver(const HullSolid& hull, const Matrix3Xd& points) {
  Eigen::VectorXd heights =
      Eigen::VectorXd::Constant(points.cols(), -std::numeric_limits<double>::infinity());
  for (const auto& corners : hull.triangles.colwise()) {
    const Vector3d a = hull.vertices.col(corners(0));
    const Vector3d across =
        (hull.vertices.col(corners(1)) - a).cross(hull.vertices.col(corners(2)) - a);
    const double length = across.norm();
    if (!(length > 0)) continue;
    const Vector3d normal = across / length;
    const Eigen::VectorXd over = (normal.transpose() * (points.colwise() - a)).transpose();
    heights = heights.cwiseMax(over);
  }
  return heights;
}

Matrix3Xd ColumnsOf(const Matrix3Xd& points, const std::vector<Index>& which) {
  Matrix3Xd chosen(3, static_cast<Index>(which.size()));
  for (std::size_t i = 0; i < which.size(); ++i) {
    chosen.col(static_cast<Index>(i)) = points.col(which[i]);
  }
  return chosen;
}

}  // namespace

std::optional<HullSolid> ConvexHullOf(const Matrix3Xd& points) {
  if (points.cols() < 4 || !(LeastExtent_m(points) > kFlat_m)) return std::nullopt;
  // About their middle, for precision.
  const Vector3d middle = (points.rowwise().maxCoeff() + points.rowwise().minCoeff()) / 2;
  Matrix3Xd centred = points.colwise() - middle;
  const auto qhull = std::make_unique<Qhull>();
  qhT* const qh = qhull->get();
  char options[] = "qhull Qt Pp";
  const int failed = qh_new_qhull(qh, 3, static_cast<int>(centred.cols()), centred.data(),
                                  /*ismalloc=*/0, options, nullptr, /*errfile=*/nullptr);
  if (failed != 0) return std::nullopt;

  HullSolid hull;
  std::vector<int> index(static_cast<std::size_t>(points.cols()), -1);
  std::vector<Index> corners;
  std::vector<Eigen::Vector3i> triangles;
  facetT* facet;
  FORALLfacet_(qh->facet_list) {
    Eigen::Vector3i triangle;
    int k = 0;
    vertexT *vertex, **vertexp;
    FOREACHvertex_(facet->vertices) {
      const int point = qh_pointid(qh, vertex->point);
      int& number = index[static_cast<std::size_t>(point)];
      if (number < 0) {
        number = static_cast<int>(corners.size());
        corners.push_back(point);
      }
      if (k < 3) triangle(k) = number;
      ++k;
    }
    if (k == 3) triangles.push_back(triangle);
  }
  hull.vertices = ColumnsOf(points, corners);
  hull.triangles.resize(3, static_cast<Index>(triangles.size()));
  const Vector3d inside = hull.vertices.rowwise().mean();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    Eigen::Vector3i& t = triangles[i];
    const Vector3d a = hull.vertices.col(t(0));
    const Vector3d normal = (hull.vertices.col(t(1)) - a).cross(hull.vertices.col(t(2)) - a);
    if (normal.dot(a - inside) < 0) std::swap(t(1), t(2));
    hull.triangles.col(static_cast<Index>(i)) = t;
  }
  return hull;
}

SimplerHull Simplify(const HullSolid& hull, int max_vertices) {
  if (hull.vertices.cols() <= max_vertices) return {hull, 0};
  std::vector<Index> chosen;
  const auto choose = [&chosen](Index vertex) {
    if (std::find(chosen.begin(), chosen.end(), vertex) == chosen.end()) chosen.push_back(vertex);
  };
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(
      (hull.vertices.colwise() - hull.vertices.rowwise().mean()) *
      (hull.vertices.colwise() - hull.vertices.rowwise().mean()).transpose());
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::VectorXd along = hull.vertices.transpose() * axes.eigenvectors().col(axis);
    Index least = 0, most = 0;
    along.minCoeff(&least);
    along.maxCoeff(&most);
    choose(least);
    choose(most);
  }
  SimplerHull simpler;
  while (true) {
    const std::optional<HullSolid> inner = ConvexHullOf(ColumnsOf(hull.vertices, chosen));
    if (!inner) return {hull, 0};  // hardly a solid: better whole
    const Eigen::VectorXd heights = HeightsOver(*inner, hull.vertices);
    Index farthest = 0;
    simpler = {*inner, std::max(0.0, heights.maxCoeff(&farthest))};
    const std::size_t before = chosen.size();
    if (static_cast<int>(before) < max_vertices) choose(farthest);
    if (chosen.size() == before) return simpler;
  }
}

}  // namespace sidestep::imports
