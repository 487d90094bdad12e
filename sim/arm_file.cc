#include "sidestep/sim/arm_file.h"

#include <tinyxml2.h>

#include <set>
#include <string_view>

#include "sidestep/core/input_error.h"
#include "sidestep/sim/foreign_model.h"

namespace sidestep::sim {
namespace {

using tinyxml2::XMLElement;

const std::set<std::string_view> kTakenOver = {"compiler",  "default",  "asset",
                                               "worldbody", "contact",  "equality",
                                               "tendon",    "actuator", "sensor"};

[[noreturn]] void FailAtElement(const std::string& name, const XMLElement& element,
                                const std::string& why) {
  throw InputError(name, element.GetLineNum(), element.Name(), why);
}

// Joints that mimic others; robot.yaml is held to them (sim/robot_agreement.h).
void CheckTies(const XMLElement& equality, const std::string& name) {
  for (const XMLElement* tie = equality.FirstChildElement(); tie != nullptr;
       tie = tie->NextSiblingElement()) {
    if (std::string_view(tie->Name()) == "joint") continue;
    FailAtElement(name, *tie, "ties bodies together, which planning takes for free; leave it out");
  }
}

}  // namespace

void CheckArmFile(const XMLElement& root, const std::string& name) {
  for (const XMLElement* section = root.FirstChildElement(); section != nullptr;
       section = section->NextSiblingElement()) {
    const std::string_view tag = section->Name();
    if (tag == "equality") CheckTies(*section, name);
    if (kTakenOver.count(tag) > 0) continue;
    FailAtElement(name, *section,
                  "is not taken over from a robot, the world has its own; leave it out");
  }
  const XMLElement* first = nullptr;
  for (const XMLElement* world = root.FirstChildElement("worldbody"); world != nullptr;
       world = world->NextSiblingElement("worldbody")) {
    for (const XMLElement* child = world->FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      if (std::string_view(child->Name()) != "body") {
        FailAtElement(name, *child, "stands beside the root body, and only that is taken over");
      }
      if (first != nullptr) {
        FailAtElement(name, *child,
                      "is a second root body; a robot has one, which is at line " +
                          std::to_string(first->GetLineNum()));
      }
      first = child;
    }
  }
}

MujocoModelPtr LoadArmFile(const std::string& path) {
  return LoadArmText(ReadModelFile(path), path);
}

MujocoModelPtr LoadArmText(const std::string& xml, const std::string& name) {
  tinyxml2::XMLDocument document;
  CheckArmFile(ParseModel(xml, name, &document), name);
  return LoadMujocoModel(xml, name);
}

}  // namespace sidestep::sim
