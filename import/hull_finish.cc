#include "sidestep/import/hull_finish.h"

#include <fmt/core.h>

#include "sidestep/core/input_error.h"
#include "sidestep/import/convex_hull.h"

namespace sidestep::imports {

std::optional<robot::HullSolid> FinishedHull(const robot::HullSolid& whole, int max_vertices,
                                             std::string* note) {
  const SimplerHull simpler = Simplify(whole, max_vertices);
  if (simpler.outside_m > 0) {
    *note =
        fmt::format("has a hull of {} corners, of which {} are taken: {:.2g} mm stick out",
                    whole.vertices.cols(), simpler.hull.vertices.cols(), 1000 * simpler.outside_m);
  }
  return ConvexHullOf((simpler.hull.vertices * 1e6).array().round().matrix() / 1e6);
}

void FinishHulls(const ArmChoices& choices, robot::RobotTree* tree) {
  for (robot::TreeLink& link : tree->links) {
    for (robot::LinkSolid& solid : link.link.solids) {
      auto* const hull = std::get_if<robot::HullSolid>(&solid.form);
      if (hull == nullptr) continue;
      std::string note;
      const std::optional<robot::HullSolid> whole = ConvexHullOf(hull->vertices);
      const auto finished =
          whole ? FinishedHull(*whole, choices.max_hull_vertices, &note) : std::nullopt;
      if (!finished) {
        throw InputError(tree->file, link.line, "body '" + link.link.name + "'",
                         "its mesh '" + solid.source + "' spans no solid: it is flat, to 0.1 mm");
      }
      if (!note.empty()) {
        tree->notes.push_back("body '" + link.link.name + "': " + solid.source + " " + note);
      }
      *hull = *finished;
    }
  }
}

}  // namespace sidestep::imports
