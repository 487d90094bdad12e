#pragma once

#include <string>

namespace sidestep::sim {

/// Where in an MJCF file something stands, for messages about what was compiled from it.
class MjcfLines {
 public:
  /// Reads nothing yet: Find does, for it is asked only when something is wrong.
  explicit MjcfLines(std::string path) : path_(std::move(path)) {}

  /// The line, from 1, of the first element in which `attribute` has this value, among those of one
  /// tag (any if it is empty), outside of `default`; 1 if there is none.
  int Find(const std::string& tag, const std::string& attribute, const std::string& value) const;

  /// The line of the child number `index`, from 0, among those of tag `child` of the element of
  /// tag `tag` and that name; the line of that element if it has not as many.
  int FindChild(const std::string& tag, const std::string& name, const std::string& child,
                int index) const;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace sidestep::sim
