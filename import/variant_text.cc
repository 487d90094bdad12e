#include "sidestep/import/variant_text.h"

#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"

namespace sidestep::import {

std::string VariantText(const Variant& variant) {
  std::string text;
  for (const std::string& line : variant.comment) text += "# " + line + "\n";
  text += "extends: \"" + variant.extends + "\"\nspheres:\n";
  std::vector<std::string> mount;
  int number = 0;
  for (const Variant::LinkSpheres& link : variant.links) {
    for (const CoverSphere& sphere : link.spheres) {
      const Eigen::Vector3d& p = sphere.center_m;
      // 0.0 makes a zero of -0.
      text += "  - {link: " + link.link + ", center_m: [" + ShortestText(p.x() + 0.0) + ", " +
              ShortestText(p.y() + 0.0) + ", " + ShortestText(p.z() + 0.0) +
              "], radius_m: " + ShortestText(sphere.radius_m) + "}\n";
      if (link.is_mount) mount.push_back(std::to_string(number));
      ++number;
    }
  }
  text += "mount: {spheres: [" + Joined(mount) + "]}\n";
  if (!variant.self_collision) return text;
  text += variant.self_collision->empty() ? "self_collision: []\n" : "self_collision:\n";
  for (const auto& [first, second] : *variant.self_collision) {
    text += "  - {links: [" + first + ", " + second + "]}\n";
  }
  return text;
}

}  // namespace sidestep::import
