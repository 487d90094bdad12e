#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sidestep/core/input_error.h"

namespace sidestep {

/// What a YAML text says, as plain values that can be copied and changed: aliases are written out,
/// so that a change of one place is none of another.
struct YamlValue {
  enum class Kind { kNull, kScalar, kList, kMap };

  Kind kind = Kind::kNull;
  std::string text;  ///< of a scalar
  int line = 1;      ///< of a value that is empty: that of its key
  std::string key;   ///< under which a map holds it; no two of a map are equal
  int key_line = 1;
  /// Who gave it in place of the file, e.g. "--set"; empty: the file.
  std::string setting;
  std::vector<YamlValue> children;  ///< of a list or a map, in their order

  const YamlValue* Find(const std::string& child_key) const;  ///< of a map; null if not there
  YamlValue* Find(const std::string& child_key);
  const YamlValue* FindItem(std::size_t index) const;  ///< of a list; null if not there
};

/// What to throw where `key`, a path in the text, is wrong; empty: the text as a whole.
using YamlComplaint =
    std::function<InputError(int line, const std::string& key, const std::string& why)>;

/// Reads one document. @throws what `complain` makes if it is not YAML, nests too deeply, gives a
/// key twice, or writes out to more values than any file needs.
YamlValue ParseYaml(const std::string& text, const YamlComplaint& complain);

/// One step of a path: into a map or into a list.
struct YamlStep {
  std::string key;  ///< of a map; empty: an item of a list
  std::size_t index = 0;
};

/// The steps of a path such as `moving_obstacles[0].shape`: keys with a dot between two, items of
/// lists as [0], [1], ... Each place has one spelling. Empty if it is no path.
std::vector<YamlStep> ParseYamlPath(const std::string& path);

}  // namespace sidestep
