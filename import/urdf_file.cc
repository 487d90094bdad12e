#include "sidestep/import/urdf_file.h"

#include <tinyxml2.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>
#include <string_view>

#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/markup.h"
#include "sidestep/core/text_file.h"
#include "sidestep/import/urdfdom_messages.h"

namespace sidestep::imports {
namespace {

using tinyxml2::XMLElement;

constexpr std::uintmax_t kMaxUrdfBytes = 64u << 20;
constexpr int kMaxElements = 200000;

// The numbers of an element: how many an attribute holds, and what they must be.
struct NumberRule {
  std::string_view tag, attribute;
  int count;
  bool is_required, must_be_positive;
};
constexpr NumberRule kNumbers[] = {
    {"origin", "xyz", 3, false, false},        {"origin", "rpy", 3, false, false},
    {"mass", "value", 1, true, false},         {"inertia", "ixx", 1, true, false},
    {"inertia", "ixy", 1, true, false},        {"inertia", "ixz", 1, true, false},
    {"inertia", "iyy", 1, true, false},        {"inertia", "iyz", 1, true, false},
    {"inertia", "izz", 1, true, false},        {"box", "size", 3, true, true},
    {"sphere", "radius", 1, true, true},       {"cylinder", "radius", 1, true, true},
    {"cylinder", "length", 1, true, true},     {"mesh", "scale", 3, false, false},
    {"axis", "xyz", 3, true, false},           {"limit", "lower", 1, false, false},
    {"limit", "upper", 1, false, false},       {"limit", "effort", 1, true, false},
    {"limit", "velocity", 1, true, false},     {"dynamics", "damping", 1, false, false},
    {"dynamics", "friction", 1, false, false}, {"mimic", "multiplier", 1, false, false},
    {"mimic", "offset", 1, false, false},
};

const std::set<std::string_view> kJointKinds = {"revolute", "continuous", "prismatic", "fixed"};
const std::set<std::string_view> kForms = {"box", "sphere", "cylinder", "mesh"};

bool IsXacro(std::string_view text) {
  return text.starts_with("xacro:") || text.find("${") != std::string_view::npos ||
         text.find("$(") != std::string_view::npos;
}

class UrdfCheck {
 public:
  explicit UrdfCheck(UrdfFile* file) : file_(*file) {}

  void Run(const tinyxml2::XMLDocument& document) {
    CheckNodes(document, 0);
    const XMLElement* const root = document.RootElement();
    if (root == nullptr || std::string_view(root->Name()) != "robot") {
      throw InputError(file_.path, root == nullptr ? 1 : root->GetLineNum(), "",
                       "must be a URDF file, whose root is <robot>");
    }
    for (const XMLElement* element = root->FirstChildElement(); element != nullptr;
         element = element->NextSiblingElement()) {
      const std::string_view tag = element->Name();
      if (tag == "link") {
        CheckLink(*element);
      } else if (tag == "joint") {
        CheckJoint(*element);
      } else if (tag != "material") {
        left_out_.insert(std::string(tag));
      }
    }
    if (links_.empty()) Fail(*root, "robot", "has no link");
    CheckTree();
    if (!left_out_.empty()) {
      file_.notes.push_back("left out, for they are no part of the arm: <" +
                            Joined(left_out_, ">, <") + ">");
    }
  }

 private:
  struct JointEnds {
    std::string name, parent, child, mimics;
    const XMLElement* element;
  };

  [[noreturn]] void Fail(const XMLElement& element, const std::string& key,
                         const std::string& why) const {
    throw InputError(file_.path, element.GetLineNum(), key, why);
  }

  // Of the document as a whole: what no URDF has, and what xacro would have to make a URDF of.
  void CheckNodes(const tinyxml2::XMLNode& parent, int depth) {
    for (const tinyxml2::XMLNode* node = parent.FirstChild(); node != nullptr;
         node = node->NextSibling()) {
      if (node->ToUnknown() != nullptr) {
        throw InputError(file_.path, node->GetLineNum(), "<!",
                         "document types and entities are not taken");
      }
      const XMLElement* const element = node->ToElement();
      if (element == nullptr) continue;
      if (++num_elements_ > kMaxElements) {
        Fail(*element, element->Name(),
             "is one element too many, of at most " + std::to_string(kMaxElements));
      }
      const bool is_extension =
          depth == 1 && !std::set<std::string_view>{"link", "joint"}.count(element->Name());
      if (std::string_view(element->Name()).starts_with("xacro:")) FailXacro(*element);
      for (const tinyxml2::XMLAttribute* attribute = element->FirstAttribute();
           attribute != nullptr && !is_extension; attribute = attribute->Next()) {
        if (IsXacro(attribute->Value())) FailXacro(*element);
      }
      if (!is_extension) CheckNodes(*element, depth + 1);
    }
  }

  [[noreturn]] void FailXacro(const XMLElement& element) const {
    Fail(element, element.Name(),
         "is xacro, from which a URDF is yet to be made: xacro FILE > robot.urdf");
  }

  std::string NameOf(const XMLElement& element) const {
    const char* const name = element.Attribute("name");
    if (name == nullptr || *name == '\0') {
      Fail(element, element.Name(), "must have a name");
    }
    return name;
  }

  void CheckNumbers(const XMLElement& element, const std::string& of) const {
    for (const NumberRule& numbers : kNumbers) {
      if (numbers.tag != element.Name()) continue;
      const std::string key =
          of + ": " + std::string(numbers.tag) + " " + std::string(numbers.attribute);
      const char* const text = element.Attribute(std::string(numbers.attribute).c_str());
      if (text == nullptr) {
        if (numbers.is_required) Fail(element, key, "is missing");
        continue;
      }
      std::istringstream words(text);
      int count = 0;
      for (std::string word; words >> word; ++count) {
        char* end = nullptr;
        const double value = std::strtod(word.c_str(), &end);
        if (*end != '\0') Fail(element, key, "must be a number, is '" + word + "'");
        if (!std::isfinite(value)) Fail(element, key, "must be finite, is " + word);
        if (std::abs(value) > 1e12) Fail(element, key, "must be at most 1e12, is " + word);
        if (numbers.must_be_positive && !(value > 0)) {
          Fail(element, key, "must be > 0, is " + word);
        }
      }
      if (count != numbers.count) {
        Fail(element, key,
             "must be " + std::to_string(numbers.count) + " number" +
                 (numbers.count == 1 ? "" : "s") + ", is '" + text + "'");
      }
    }
    for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      CheckNumbers(*child, of);
    }
  }

  void CheckLink(const XMLElement& link) {
    const std::string name = NameOf(link);
    const std::string of = "link '" + name + "'";
    if (const auto [other, is_new] = links_.emplace(name, &link); !is_new) {
      Fail(link, of, "is there already, at line " + std::to_string(other->second->GetLineNum()));
    }
    file_.lines["link " + name] = link.GetLineNum();
    int collisions = 0, visuals = 0;
    for (const XMLElement* child = link.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      const std::string_view tag = child->Name();
      if (tag == "inertial") {
        for (const char* const part : {"mass", "inertia"}) {
          if (child->FirstChildElement(part) == nullptr) {
            Fail(*child, of, std::string("its inertial has no <") + part + ">");
          }
        }
        file_.lines["inertial " + name] = child->GetLineNum();
      } else if (tag == "collision") {
        CheckForm(*child, of);
        file_.lines["collision " + name + " " + std::to_string(collisions++)] = child->GetLineNum();
      } else if (tag == "visual") {
        CheckForm(*child, of);
        file_.lines["visual " + name + " " + std::to_string(visuals++)] = child->GetLineNum();
      } else {
        left_out_.insert(std::string(tag));
        continue;
      }
      CheckNumbers(*child, of);
    }
  }

  void CheckForm(const XMLElement& solid, const std::string& of) const {
    const XMLElement* const geometry = solid.FirstChildElement("geometry");
    const XMLElement* const form = geometry == nullptr ? nullptr : geometry->FirstChildElement();
    if (form == nullptr) Fail(solid, of, std::string("its ") + solid.Name() + " has no geometry");
    if (kForms.count(form->Name()) == 0) {
      Fail(*form, of,
           "its " + std::string(solid.Name()) + " must be a box, sphere, cylinder or mesh, is a " +
               form->Name());
    }
    if (std::string_view(form->Name()) == "mesh") {
      const char* const file = form->Attribute("filename");
      if (file == nullptr || *file == '\0') Fail(*form, of, "its mesh has no filename");
    }
  }

  std::string EndOf(const XMLElement& joint, const char* tag, const std::string& of) const {
    const XMLElement* const end = joint.FirstChildElement(tag);
    const char* const link = end == nullptr ? nullptr : end->Attribute("link");
    if (link == nullptr) Fail(joint, of, std::string("has no <") + tag + " link=\"...\"/>");
    return link;
  }

  void CheckJoint(const XMLElement& joint) {
    const std::string name = NameOf(joint);
    const std::string of = "joint '" + name + "'";
    if (file_.lines.count("joint " + name) > 0) {
      Fail(joint, of, "is there already, at line " + std::to_string(file_.lines["joint " + name]));
    }
    file_.lines["joint " + name] = joint.GetLineNum();
    file_.joint_order.push_back(name);
    const char* const kind = joint.Attribute("type");
    if (kind == nullptr || kJointKinds.count(kind) == 0) {
      Fail(joint, of + ": type",
           std::string("must be revolute, continuous, prismatic or fixed, is ") +
               (kind == nullptr ? "missing" : kind));
    }
    CheckNumbers(joint, of);
    if (const XMLElement* axis = joint.FirstChildElement("axis")) {
      std::istringstream words(axis->Attribute("xyz"));
      double x = 0, y = 0, z = 0;
      words >> x >> y >> z;
      if (!(std::hypot(x, y, z) > 1e-6) && std::string_view(kind) != "fixed") {
        Fail(*axis, of + ": axis", "must not be zero");
      }
    }
    const bool wants_limit =
        std::string_view(kind) == "revolute" || std::string_view(kind) == "prismatic";
    if (wants_limit && joint.FirstChildElement("limit") == nullptr) {
      Fail(joint, of, std::string("must have a <limit>, for it is ") + kind);
    }
    const XMLElement* const mimic = joint.FirstChildElement("mimic");
    const char* const mimics = mimic == nullptr ? "" : mimic->Attribute("joint");
    if (mimics == nullptr) Fail(*mimic, of + ": mimic", "names no joint");
    ends_.push_back({name, EndOf(joint, "parent", of), EndOf(joint, "child", of), mimics, &joint});
  }

  void CheckTree() const {
    std::map<std::string, const JointEnds*> parent_joint;
    for (const JointEnds& joint : ends_) {
      const std::string of = "joint '" + joint.name + "'";
      for (const std::string& link : {joint.parent, joint.child}) {
        if (links_.count(link) == 0) {
          Fail(*joint.element, of, "there is no link '" + link + "'");
        }
      }
      if (const auto [other, is_new] = parent_joint.emplace(joint.child, &joint); !is_new) {
        Fail(*joint.element, of,
             "carries the link '" + joint.child + "', which joint '" + other->second->name +
                 "' carries already, at line " +
                 std::to_string(other->second->element->GetLineNum()));
      }
      if (!joint.mimics.empty()) CheckMimic(joint);
    }
    std::vector<std::string> roots;
    for (const auto& [link, element] : links_) {
      if (parent_joint.count(link) == 0) roots.push_back(link);
    }
    if (roots.size() > 1) {
      const XMLElement& second = *links_.at(roots[1]);
      Fail(second, "link '" + roots[1] + "'",
           "hangs on no joint, nor does '" + roots[0] + "': the links must be one tree (" +
               std::to_string(roots.size()) + " roots: " + Joined(roots) + ")");
    }
    // From each link up: who does not come to the root goes round.
    for (const auto& [name, element] : links_) {
      std::string link = name;
      for (std::size_t steps = 0; parent_joint.count(link) > 0; ++steps) {
        if (steps > links_.size()) {
          Fail(*element, "link '" + name + "'", "its joints lead round in a circle");
        }
        link = parent_joint.at(link)->parent;
      }
    }
  }

  void CheckMimic(const JointEnds& joint) const {
    std::set<std::string> seen;
    const JointEnds* at = &joint;
    while (!at->mimics.empty()) {
      if (!seen.insert(at->name).second) {
        Fail(*joint.element, "joint '" + joint.name + "': mimic", "leads round in a circle");
      }
      const auto leader = std::find_if(ends_.begin(), ends_.end(), [at](const JointEnds& other) {
        return other.name == at->mimics;
      });
      if (leader == ends_.end()) {
        Fail(*at->element, "joint '" + at->name + "': mimic",
             "there is no joint '" + at->mimics + "'");
      }
      at = &*leader;
    }
  }

  UrdfFile& file_;
  int num_elements_ = 0;
  std::map<std::string, const XMLElement*> links_;
  std::vector<JointEnds> ends_;
  std::set<std::string> left_out_;
};

}  // namespace

int UrdfFile::LineOf(const std::string& what) const {
  const auto found = lines.find(what);
  return found == lines.end() ? 1 : found->second;
}

UrdfFile ReadUrdf(const std::string& path) {
  return ParseUrdf(ReadTextFile(path, kMaxUrdfBytes), path);
}

UrdfFile ParseUrdf(const std::string& text, const std::string& path) {
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw XmlFault(path, document.ErrorLineNum(), document.ErrorName());
  }
  UrdfFile file;
  file.path = path;
  UrdfCheck(&file).Run(document);
  const UrdfdomMessages messages;
  file.model = urdf::parseURDF(text);
  if (file.model == nullptr || file.model->getRoot() == nullptr) {
    throw InputError(
        path, "urdfdom cannot read it" + (messages.text().empty() ? "" : ": " + messages.text()));
  }
  return file;
}

}  // namespace sidestep::imports
