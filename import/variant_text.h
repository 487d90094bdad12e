#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/import/cover_sphere.h"

namespace sidestep::imports {

/// Other spheres for a robot (docs/robots.md, "Variants").
struct Variant {
  std::vector<std::string> comment;  ///< lines at the top
  std::string extends;               ///< the robot.yaml, as seen from the variant's folder
  struct LinkSpheres {
    std::string link;
    std::vector<CoverSphere> spheres;  ///< in the link's frame
    bool is_mount = false;             ///< they may overlap what the robot stands on
  };
  std::vector<LinkSpheres> links;
  /// Pairs of links that planners keep apart; none: those of the robot.
  std::optional<std::vector<std::pair<std::string, std::string>>> self_collision;
};

/// The text of its file.
std::string VariantText(const Variant& variant);

}  // namespace sidestep::imports
