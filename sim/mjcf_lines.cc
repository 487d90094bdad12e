#include "sidestep/sim/mjcf_lines.h"

#include <tinyxml2.h>

namespace sidestep::sim {
namespace {

using tinyxml2::XMLElement;

const XMLElement* FindBelow(const XMLElement& element, const std::string& tag,
                            const std::string& attribute, const std::string& value) {
  if (std::string(element.Name()) == "default") return nullptr;
  const char* const found = element.Attribute(attribute.c_str());
  if (found != nullptr && value == found && (tag.empty() || tag == element.Name())) return &element;
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    if (const XMLElement* const below = FindBelow(*child, tag, attribute, value)) return below;
  }
  return nullptr;
}

}  // namespace

int MjcfLines::Find(const std::string& tag, const std::string& attribute,
                    const std::string& value) const {
  tinyxml2::XMLDocument document;
  if (document.LoadFile(path_.c_str()) != tinyxml2::XML_SUCCESS) return 1;
  const XMLElement* const root = document.RootElement();
  const XMLElement* const found = root ? FindBelow(*root, tag, attribute, value) : nullptr;
  return found != nullptr ? found->GetLineNum() : 1;
}

int MjcfLines::FindChild(const std::string& tag, const std::string& name, const std::string& child,
                         int index) const {
  tinyxml2::XMLDocument document;
  if (document.LoadFile(path_.c_str()) != tinyxml2::XML_SUCCESS) return 1;
  const XMLElement* const root = document.RootElement();
  const XMLElement* const parent = root ? FindBelow(*root, tag, "name", name) : nullptr;
  if (parent == nullptr) return 1;
  const XMLElement* found = parent->FirstChildElement(child.c_str());
  for (; found != nullptr && index > 0; --index) found = found->NextSiblingElement(child.c_str());
  return (found != nullptr ? found : parent)->GetLineNum();
}

}  // namespace sidestep::sim
