#include "sidestep/import/variant_text.h"

#include <algorithm>

#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"
#include "sidestep/scenarios/yaml_text.h"

namespace sidestep::imports {
namespace {

// A name as YAML takes it for one.
std::string Word(const std::string& name) {
  const auto is_plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  const bool begins_plain = !name.empty() && is_plain(name[0]) && !(name[0] <= '9');
  return begins_plain && std::all_of(name.begin(), name.end(), is_plain) ? name
                                                                         : scenarios::Quoted(name);
}

}  // namespace

std::string VariantText(const Variant& variant) {
  std::string text;
  for (const std::string& line : variant.comment) text += "# " + line + "\n";
  text += "extends: " + scenarios::Quoted(variant.extends) + "\nspheres:\n";
  std::vector<std::string> mount;
  int number = 0;
  for (const Variant::LinkSpheres& link : variant.links) {
    for (const CoverSphere& sphere : link.spheres) {
      const Eigen::Vector3d& p = sphere.center_m;
      text += "  - {link: " + Word(link.link) + ", center_m: [" + ShortestNumber(p.x()) + ", " +
              ShortestNumber(p.y()) + ", " + ShortestNumber(p.z()) +
              "], radius_m: " + ShortestText(sphere.radius_m) + "}\n";
      if (link.is_mount) mount.push_back(std::to_string(number));
      ++number;
    }
  }
  text += "mount: {spheres: [" + Joined(mount) + "]}\n";
  if (!variant.self_collision) return text;
  text += variant.self_collision->empty() ? "self_collision: []\n" : "self_collision:\n";
  for (const auto& [first, second] : *variant.self_collision) {
    text += "  - {links: [" + Word(first) + ", " + Word(second) + "]}\n";
  }
  return text;
}

}  // namespace sidestep::imports
