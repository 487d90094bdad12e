#include "sidestep/import/link_spheres.h"

#include <algorithm>

#include "sidestep/core/input_error.h"
#include "sidestep/import/sphere_cover.h"

namespace sidestep::imports {
namespace {

LinkSolids LinkSolidsOf(const robot::ArmLink& link) {
  LinkSolids solids;
  for (const robot::LinkSolid& solid : link.solids) {
    if (const auto* const shape = std::get_if<Shape>(&solid.form)) {
      solids.shapes.push_back({*shape, solid.X_LS});
      continue;
    }
    const robot::HullSolid& hull = std::get<robot::HullSolid>(solid.form);
    TriangleMesh mesh{hull.vertices, hull.triangles};
    for (auto vertex : mesh.vertices.colwise()) vertex = solid.X_LS * Eigen::Vector3d(vertex);
    solids.meshes.push_back({link.name + ": " + solid.source, std::move(mesh)});
  }
  return solids;
}

}  // namespace

std::vector<robot::CollisionSphere> CoverArm(const robot::ArmDescription& arm,
                                             const SphereRequest& request) {
  std::vector<LinkSolids> links;
  for (const robot::ArmLink& link : arm.links) links.push_back(LinkSolidsOf(link));
  CoverRequest covers;
  covers.cover_m = request.cover_m;
  covers.num_spheres = request.num_spheres;
  const auto num_solid = std::count_if(arm.links.begin(), arm.links.end(),
                                       [](const auto& link) { return !link.solids.empty(); });
  if (request.num_spheres > 0 && request.num_spheres < num_solid) {
    throw InputError("--spheres",
                     "must be at least one a link with solids: " + std::to_string(num_solid));
  }
  const RobotCover cover = CoverLinks(links, covers);
  std::vector<robot::CollisionSphere> spheres;
  for (std::size_t link = 0; link < links.size(); ++link) {
    for (const CoverSphere& sphere : cover.links[link].spheres) {
      spheres.push_back({static_cast<int>(link) - 1, sphere.center_m, sphere.radius_m});
    }
  }
  return spheres;
}

}  // namespace sidestep::imports
