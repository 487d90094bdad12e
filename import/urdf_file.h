#pragma once

#include <urdf_model/model.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace sidestep::imports {

/// A URDF that has been read and is sound in form: a tree of links with one root, joints of known
/// kinds, numbers that are numbers.
struct UrdfFile {
  std::string path;
  std::shared_ptr<const urdf::ModelInterface> model;
  /// The lines of `link NAME`, `inertial NAME` (of a link), `collision NAME K` (the K-th of a link,
  /// from 0; `visual` as well) and `joint NAME`.
  std::map<std::string, int> lines;
  std::vector<std::string> joint_order;  ///< names, as they stand in the file
  std::vector<std::string> notes;        ///< what was left out

  int LineOf(const std::string& what) const;  ///< 1 if it is not there
};

/// Reads a URDF by the library urdfdom, after it has been checked: urdfdom takes much without a
/// word (several parents, a number that is none), and tells no lines.
/// @throws InputError FILE:LINE: KEY: WHY.
UrdfFile ReadUrdf(const std::string& path);

/// The same for a text. @param path stands for it in messages.
UrdfFile ParseUrdf(const std::string& text, const std::string& path);

}  // namespace sidestep::imports
