#include "sidestep/sim/geom_solids.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

namespace sidestep::sim {
namespace {

// Turns each triangle so that its normal looks away from the centre.
void TurnOutwards(ConvexHull* hull) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& vertex : hull->vertices) centre += vertex;
  centre /= static_cast<double>(hull->vertices.size());
  for (std::array<int, 3>& face : hull->faces) {
    const auto vertex = [&](int i) {
      return hull->vertices[static_cast<std::size_t>(face[static_cast<std::size_t>(i)])];
    };
    const Eigen::Vector3d normal = (vertex(1) - vertex(0)).cross(vertex(2) - vertex(0));
    if (normal.dot(vertex(0) - centre) < 0) std::swap(face[1], face[2]);
  }
}

}  // namespace

std::optional<Shape> ShapeOfGeom(const mjModel& model, int geom) {
  const Eigen::Map<const Eigen::Vector3d> size(model.geom_size + 3 * geom);
  switch (model.geom_type[geom]) {
    case mjGEOM_SPHERE:
      return Sphere{size(0)};
    case mjGEOM_CAPSULE:
      return Capsule{size(0), 2 * size(1)};
    case mjGEOM_CYLINDER:
      return Cylinder{size(0), 2 * size(1)};
    case mjGEOM_ELLIPSOID:
      return Ellipsoid{size};
    case mjGEOM_BOX:
      return Box{2 * size};
    default:
      return std::nullopt;
  }
}

ConvexHull HullOfMesh(const mjModel& model, int mesh) {
  if (model.mesh_graphadr[mesh] < 0) {
    throw std::invalid_argument("HullOfMesh: the model holds no convex hull of this mesh");
  }
  // Layout: vertex count nv, face count nf, nv edge addresses, nv indices into the mesh's vertices,
  // nv + 3 nf edges, 3 nf face corners as indices into the mesh's vertices (mjmodel.h, mesh_graph).
  const int* graph = model.mesh_graph + model.mesh_graphadr[mesh];
  const int num_vertices = graph[0], num_faces = graph[1];
  const int* mesh_vertex = graph + 2 + num_vertices;
  const int* corners = mesh_vertex + num_vertices + num_vertices + 3 * num_faces;
  const float* positions = model.mesh_vert + 3 * model.mesh_vertadr[mesh];

  ConvexHull hull;
  std::vector<int> hull_index(static_cast<std::size_t>(model.mesh_vertnum[mesh]), -1);
  for (int i = 0; i < num_vertices; ++i) {
    hull_index[static_cast<std::size_t>(mesh_vertex[i])] = i;
    hull.vertices.push_back(
        Eigen::Map<const Eigen::Vector3f>(positions + 3 * mesh_vertex[i]).cast<double>());
  }
  for (int i = 0; i < num_faces; ++i) {
    std::array<int, 3> face;
    for (std::size_t k = 0; k < 3; ++k) {
      face[k] = hull_index[static_cast<std::size_t>(corners[3 * i + static_cast<int>(k)])];
    }
    hull.faces.push_back(face);
  }
  TurnOutwards(&hull);
  return hull;
}

HeightField::HeightField(const mjModel& model, int hfield)
    : rows_(model.hfield_nrow[hfield]),
      columns_(model.hfield_ncol[hfield]),
      elevations_(model.hfield_data + model.hfield_adr[hfield]) {
  const mjtNum* size = model.hfield_size + 4 * hfield;  // half x, half y, top, base
  half_size_m_ = {size[0], size[1]};
  top_m_ = size[2];
  base_m_ = -size[3];
}

double HeightField::Height(int row, int column) const {
  return top_m_ * static_cast<double>(elevations_[row * columns_ + column]);
}

Eigen::Vector3d HeightField::Vertex(int row, int column) const {
  return {half_size_m_.x() * (2.0 * column / (columns_ - 1) - 1),
          half_size_m_.y() * (2.0 * row / (rows_ - 1) - 1), Height(row, column)};
}

double HeightField::HeightAt(double x, double y) const {
  const double along = (x / half_size_m_.x() + 1) / 2 * (columns_ - 1);
  const double across = (y / half_size_m_.y() + 1) / 2 * (rows_ - 1);
  const int column = std::clamp(static_cast<int>(along), 0, columns_ - 2);
  const int row = std::clamp(static_cast<int>(across), 0, rows_ - 2);
  const double u = std::clamp(along - column, 0.0, 1.0);
  const double w = std::clamp(across - row, 0.0, 1.0);
  const double near = Height(row, column), far = Height(row + 1, column + 1);
  if (u >= w) {
    const double corner = Height(row, column + 1);
    return near + u * (corner - near) + w * (far - corner);
  }
  const double corner = Height(row + 1, column);
  return near + w * (corner - near) + u * (far - corner);
}

std::vector<ConvexHull> HeightField::Prisms() const {
  std::vector<ConvexHull> prisms;
  const auto add = [&](const std::array<Eigen::Vector3d, 3>& surface) {
    ConvexHull prism;
    prism.vertices.assign(surface.begin(), surface.end());
    for (Eigen::Vector3d below : surface) {
      below.z() = base_m_;
      prism.vertices.push_back(below);
    }
    prism.faces = {{0, 1, 2}, {3, 4, 5}, {0, 1, 4}, {0, 4, 3},
                   {1, 2, 5}, {1, 5, 4}, {2, 0, 3}, {2, 3, 5}};
    TurnOutwards(&prism);
    prisms.push_back(std::move(prism));
  };
  for (int row = 0; row + 1 < rows_; ++row) {
    for (int column = 0; column + 1 < columns_; ++column) {
      const Eigen::Vector3d near = Vertex(row, column), far = Vertex(row + 1, column + 1);
      add({near, Vertex(row, column + 1), far});
      add({near, far, Vertex(row + 1, column)});
    }
  }
  return prisms;
}

}  // namespace sidestep::sim
