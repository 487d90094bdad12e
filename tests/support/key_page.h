#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace sidestep {

/// A page of docs/ that explains the keys of one kind of YAML file: a file that has every key, in
/// the first block of ```yaml, and a row for each, in tables whose head begins with `| key |`:
///
///   | key | type | unit | default | bounds | meaning |
///
/// A key is its path in the file: `[]` for an item of a list, `<name>` for a name that is free, `*`
/// for any of several kinds that has no row of its own. In `default`, `required` and a value in
/// backquotes are checked, and any other text means that the key may be left out. In `bounds`, `>
/// 0`, `>= 0`, `< 1`, `<= 1` and `0 to 1` are checked, also as one of several parts with semicolons
/// between them; any other text is for readers.
class KeyPage {
 public:
  struct Row {
    std::string key, type, unit, default_value, bounds, meaning;
    int line = 0;
  };

  /// What a reader makes of a file's text: something to compare. Throws InputError.
  using Reader = std::function<std::string(const std::string& text)>;

  KeyPage(const std::string& path, Reader read);

  /// Everything in which the page and the reader differ, one line each; empty if nothing.
  std::vector<std::string> Differences() const;

 private:
  std::string path_;
  Reader read_;
  std::string example_;
  std::vector<Row> rows_;
};

}  // namespace sidestep
