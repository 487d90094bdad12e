#include "sidestep/import/solid_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "sidestep/core/input_error.h"
#include "sidestep/import/convex_hull.h"
#include "sidestep/import/hull_finish.h"
#include "sidestep/import/mesh_file.h"
#include "sidestep/import/mesh_uri.h"
#include "sidestep/import/triangle_mesh.h"
#include "sidestep/import/urdf_pose.h"

namespace sidestep::imports {
namespace {

constexpr double kLargest_m = 10;  // of a link's solid

class SolidReader {
 public:
  SolidReader(const UrdfFile& file, const urdf::Link& link, const ArmChoices& choices,
              std::vector<std::string>* notes)
      : file_(file), link_(link), choices_(choices), notes_(*notes) {}

  robot::LinkSolid Read(const urdf::Geometry& geometry, const urdf::Pose& origin, int line) {
    line_ = line;
    robot::LinkSolid solid;
    solid.X_LS = PoseOf(origin);
    switch (geometry.type) {
      case urdf::Geometry::BOX: {
        const urdf::Vector3& size = static_cast<const urdf::Box&>(geometry).dim;
        solid.form = Box{{size.x, size.y, size.z}};
        break;
      }
      case urdf::Geometry::SPHERE:
        solid.form = Sphere{static_cast<const urdf::Sphere&>(geometry).radius};
        break;
      case urdf::Geometry::CYLINDER: {
        const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
        if (choices_.cylinders_as_capsules) {
          solid.form = Capsule{cylinder.radius, cylinder.length};
        } else {
          solid.form = Cylinder{cylinder.radius, cylinder.length};
        }
        break;
      }
      default:
        ReadMesh(static_cast<const urdf::Mesh&>(geometry), &solid);
        return solid;
    }
    const Eigen::Vector3d extents_m = 2 * HalfExtents(std::get<Shape>(solid.form));
    CheckSize(extents_m.maxCoeff(), ShapeName(std::get<Shape>(solid.form)));
    if (extents_m.minCoeff() < 1e-5) Fail("is thinner than 0.01 mm");
    return solid;
  }

 private:
  [[noreturn]] void Fail(const std::string& why) const {
    throw InputError(file_.path, line_, "link '" + link_.name + "'", why);
  }

  void CheckSize(double largest_m, const std::string& what) const {
    if (largest_m <= kLargest_m) return;
    Fail(
        fmt::format("its {} is {:.4g} m across, must be at most {:.0f} m: is its scale right? "
                    "(scale=\"0.001 0.001 0.001\" for a mesh in millimetres)",
                    what, largest_m, kLargest_m));
  }

  void ReadMesh(const urdf::Mesh& mesh, robot::LinkSolid* solid) {
    const Eigen::Vector3d scale(mesh.scale.x, mesh.scale.y, mesh.scale.z);
    if (scale.cwiseAbs().minCoeff() == 0) Fail("the scale of its mesh must not be 0");
    LoadedMesh loaded;
    try {
      const std::string path = ResolveMeshUri(mesh.filename, file_.path, choices_.package_paths);
      loaded = LoadMesh(path, {choices_.turn_up_axis});
    } catch (const InputError& error) {
      Fail(error.what());
    }
    const std::string name = std::filesystem::path(mesh.filename).filename().string();
    solid->source = name;
    const auto note = [&](const std::string& text) {
      notes_.push_back("link '" + link_.name + "': " + name + " " + text);
    };
    for (const std::string& text : loaded.notes) note(text);
    Eigen::Matrix3Xd points = scale.asDiagonal() * loaded.mesh.vertices;
    CheckSize((points.rowwise().maxCoeff() - points.rowwise().minCoeff()).maxCoeff(), name);
    const std::optional<robot::HullSolid> whole = ConvexHullOf(points);
    if (!whole) Fail(name + " spans no solid: it is flat, to 0.1 mm");
    const double inside_m3 = std::abs(SignedVolume_m3(loaded.mesh) * scale.prod());
    const double more = SignedVolume_m3({whole->vertices, whole->triangles}) / inside_m3 - 1;
    if (more > 0.1 && loaded.notes.empty()) {
      note(fmt::format("is not convex: its hull holds {:.0f} % more than it does", 100 * more));
    }
    std::string hull_note;
    const auto hull = FinishedHull(*whole, choices_.max_hull_vertices, &hull_note);
    if (!hull) Fail(name + " spans no solid: it is flat, to 0.1 mm");
    if (!hull_note.empty()) note(hull_note);
    solid->form = *hull;
  }

  const UrdfFile& file_;
  const urdf::Link& link_;
  const ArmChoices& choices_;
  std::vector<std::string>& notes_;
  int line_ = 1;
};

}  // namespace

std::vector<robot::LinkSolid> ReadSolids(const UrdfFile& file, const urdf::Link& link,
                                         const ArmChoices& choices,
                                         std::vector<std::string>* notes) {
  SolidReader reader(file, link, choices, notes);
  std::vector<robot::LinkSolid> solids;
  const auto line = [&](const char* kind, std::size_t i) {
    return file.LineOf(std::string(kind) + " " + link.name + " " + std::to_string(i));
  };
  for (std::size_t i = 0; i < link.collision_array.size(); ++i) {
    const urdf::Collision& one = *link.collision_array[i];
    solids.push_back(reader.Read(*one.geometry, one.origin, line("collision", i)));
  }
  if (!solids.empty() || !choices.visuals_as_collisions) return solids;
  for (std::size_t i = 0; i < link.visual_array.size(); ++i) {
    const urdf::Visual& one = *link.visual_array[i];
    solids.push_back(reader.Read(*one.geometry, one.origin, line("visual", i)));
  }
  return solids;
}

}  // namespace sidestep::imports
