#include "tests/support/key_page.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "sidestep/core/input_error.h"

namespace sidestep {
namespace {

using Row = KeyPage::Row;

std::string Trim(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" `");
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(" `") - first + 1);
}

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(Trim(part));
  return parts;
}

// A place in a file: keys, and numbers of items.
using Place = std::vector<std::string>;

std::string Joined(const Place& place) {
  std::string path;
  for (const std::string& key : place) path += (path.empty() || key[0] == '[' ? "" : ".") + key;
  return path;
}

YAML::Node NodeAt(const YAML::Node& root, const Place& place) {
  YAML::Node node = root;
  for (const std::string& key : place) {
    const YAML::Node next = key[0] == '[' ? node[std::stoul(key.substr(1))] : node[key];
    node.reset(next);
  }
  return node;
}

// What the reader knows of keys, found out by asking it: a key that it does not know is put into
// every map of an example, one after another, and it answers with those that it knows there.
class KnownKeys {
 public:
  KnownKeys(const std::string& example, const KeyPage::Reader& read)
      : root_(YAML::Load(example)), read_(read) {
    Visit({}, {});
  }

  /// Each known key, as a row writes it, and where the example has it.
  const std::map<std::string, std::vector<Place>>& places() const { return places_; }

  /// The message of the reader for the example with a value in this place, or without it.
  std::string MessageWith(const Place& place, const std::optional<YAML::Node>& value) const {
    try {
      ReadWith(place, value);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  std::string ReadWith(const Place& place, const std::optional<YAML::Node>& value) const {
    const YAML::Node root = YAML::Clone(root_);
    YAML::Node parent = NodeAt(root, Place(place.begin(), place.end() - 1));
    const std::string& key = place.back();
    if (!value) {
      parent.remove(key);
    } else if (key[0] == '[') {
      parent[std::stoul(key.substr(1))] = *value;
    } else {
      parent[key] = *value;
    }
    return read_(YAML::Dump(root));
  }

  YAML::Node At(const Place& place) const { return NodeAt(root_, place); }

 private:
  void Visit(const Place& place, const Place& pattern) {
    Place probe = place;
    probe.push_back("unheard_of");
    const std::string message = MessageWith(probe, YAML::Node(1));
    std::smatch found;
    const std::string path = Joined(place);
    const bool is_here = message.find(path.empty() ? "unheard_of" : path) != std::string::npos;
    if (is_here && std::regex_search(message, found, std::regex("\\(known here: (.*)\\)$"))) {
      for (const std::string& key : Split(found[1], ',')) {
        if (key != "unheard_of") Add(place, pattern, key, key);
      }
    } else if (is_here && std::regex_search(message, found, std::regex("exactly one of (.*)$"))) {
      for (const std::string& key : Split(found[1], ',')) Add(place, pattern, key, key);
    } else if (message.empty()) {  // anything goes, so what is in there belongs elsewhere
      for (const auto& entry : At(place))
        Add(place, pattern, entry.first.Scalar(), "<name>", false);
    } else if (message.find(Joined(probe) + ":") != std::string::npos) {
      for (const auto& entry : At(place)) Add(place, pattern, entry.first.Scalar(), "<name>");
    }
  }

  void Add(Place place, Place pattern, const std::string& key, const std::string& name,
           bool visit = true) {
    const YAML::Node parent = At(place);
    place.push_back(key);
    pattern.push_back(name);
    std::vector<Place>& where = places_[Joined(pattern)];
    const YAML::Node node = parent[key];
    if (!node.IsDefined()) return;
    where.push_back(place);
    if (!visit) return;
    if (node.IsMap()) Visit(place, pattern);
    if (!node.IsSequence()) return;
    pattern.push_back("[]");
    for (std::size_t i = 0; i < node.size(); ++i) {
      if (!node[i].IsMap()) continue;
      place.push_back("[" + std::to_string(i) + "]");
      Visit(place, pattern);
      place.pop_back();
    }
  }

  YAML::Node root_;
  const KeyPage::Reader& read_;
  std::map<std::string, std::vector<Place>> places_;
};

bool Covers(const std::string& row_key, const std::string& key) {
  const std::vector<std::string> a = Split(row_key, '.'), b = Split(key, '.');
  return std::equal(
      a.begin(), a.end(), b.begin(), b.end(),
      [](const std::string& part, const std::string& is) { return part == "*" || part == is; });
}

std::string Short(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

// A value at a bound and one just beyond.
struct Edge {
  double at;
  bool included;
  double beyond;
};

std::vector<Edge> EdgesOf(const Row& row) {
  std::vector<Edge> edges;
  const bool whole = row.type.find("whole") != std::string::npos;
  const auto add = [&](double at, bool included, int direction) {
    const double step = whole ? 1 : 1e-6 * std::max(1.0, std::abs(at));
    edges.push_back({at, included, included ? at + direction * step : at});
  };
  for (const std::string& part : Split(row.bounds, ';')) {
    std::smatch found;
    const std::string number = "(-?[0-9][0-9.e+-]*)";
    if (std::regex_match(part, found, std::regex("(<|>)(=?) " + number))) {
      add(std::stod(found[3]), found[2] == "=", found[1] == ">" ? -1 : 1);
    } else if (std::regex_match(part, found, std::regex(number + " to " + number))) {
      add(std::stod(found[1]), true, -1);
      add(std::stod(found[2]), true, 1);
    }
  }
  return edges;
}

class Checker {
 public:
  Checker(const std::string& page, const KnownKeys& known) : page_(page), known_(known) {}

  void Check(const Row& row, const std::string& key, const Place& place) {
    CheckDefault(row, key, place);
    for (const Edge& edge : EdgesOf(row)) {
      if (MessageAbout(place, edge.beyond).empty()) {
        Tell(row, "the reader takes " + Short(edge.beyond) + " for " + key +
                      ", which is beyond the page's bounds");
      }
      const std::string message = edge.included ? MessageAbout(place, edge.at) : "";
      if (!message.empty()) {
        Tell(row, "the reader refuses " + Short(edge.at) +
                      ", which is within the page's bounds: " + message);
      }
    }
  }

  void Tell(const Row& row, const std::string& what) {
    differences.push_back(page_ + ":" + std::to_string(row.line) + ": " + what);
  }

  std::vector<std::string> differences;

 private:
  // What the reader says against a number in this place (the first of a list); empty if nothing.
  std::string MessageAbout(Place place, double number) const {
    const std::string path = Joined(place);
    if (known_.At(place).IsSequence()) place.push_back("[0]");
    const std::string message = known_.MessageWith(place, YAML::Node(Short(number)));
    return message.find(path) == std::string::npos ? "" : message;
  }

  void CheckDefault(const Row& row, const std::string& key, const Place& place) {
    const std::string without = known_.MessageWith(place, std::nullopt);
    const bool is_missing = without.find(Joined(place) + ": is missing") != std::string::npos;
    if (row.default_value == "required") {
      if (!is_missing) Tell(row, key + " need not be given, the page says that it is required");
      return;
    }
    if (is_missing) {
      Tell(row, key + " must be given, the page has the default '" + row.default_value + "'");
    }
    if (row.default_value.front() != '`' || !without.empty()) return;
    const std::string value = Trim(row.default_value);
    const std::string with = known_.ReadWith(place, YAML::Load(value));
    if (with != known_.ReadWith(place, std::nullopt)) {
      Tell(row, "the default of " + key + " is not " + value);
    }
  }

  std::string page_;
  const KnownKeys& known_;
};

}  // namespace

KeyPage::KeyPage(const std::string& path, Reader read) : path_(path), read_(std::move(read)) {
  std::ifstream stream(path);
  if (!stream) throw std::runtime_error("cannot read " + path);
  bool in_example = false, in_table = false, had_example = false;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (line == "```yaml" && !had_example) {
      in_example = had_example = true;
    } else if (line == "```") {
      in_example = false;
    } else if (in_example) {
      example_ += line + "\n";
    }
    const bool is_row = !line.empty() && line[0] == '|';
    if (is_row && line.rfind("| key |", 0) == 0) in_table = true;
    if (!is_row) in_table = false;
    if (!in_table || line.rfind("| `", 0) != 0) continue;
    std::vector<std::string> cells;
    std::istringstream row(line.substr(1));
    for (std::string cell; std::getline(row, cell, '|');) {
      const std::size_t first = cell.find_first_not_of(' ');
      cells.push_back(first == std::string::npos
                          ? ""
                          : cell.substr(first, cell.find_last_not_of(' ') - first + 1));
    }
    if (cells.size() != 6 || std::count(cells.begin(), cells.end(), "") > 0) {
      throw std::runtime_error(path + ":" + std::to_string(number) +
                               ": a row needs six cells, none of them empty");
    }
    rows_.push_back({Trim(cells[0]), cells[1], cells[2], cells[3], cells[4], cells[5], number});
  }
}

std::vector<std::string> KeyPage::Differences() const {
  try {
    read_(example_);
  } catch (const InputError& error) {
    return {path_ + ": its example is refused: " + error.what()};
  }
  const KnownKeys known(example_, read_);
  Checker checker(path_, known);
  std::set<int> used;  // lines of rows
  for (const auto& [key, places] : known.places()) {
    // A row of its own stands before one of several kinds.
    const bool has_own = std::any_of(rows_.begin(), rows_.end(),
                                     [&key = key](const Row& row) { return row.key == key; });
    const auto covers = [&key = key, has_own](const Row& row) {
      return has_own ? row.key == key : Covers(row.key, key);
    };
    const auto row = std::find_if(rows_.begin(), rows_.end(), covers);
    if (row == rows_.end()) {
      checker.differences.push_back(path_ + ": has no row for `" + key +
                                    "`, which the reader knows");
      continue;
    }
    used.insert(row->line);
    const auto other = std::find_if(row + 1, rows_.end(), covers);
    if (other != rows_.end()) checker.Tell(*other, "is a second row for " + key);
    if (places.empty()) {
      checker.Tell(*row, "the example at the top of the page lacks " + key);
      continue;
    }
    checker.Check(*row, key, places.front());
  }
  for (const Row& row : rows_) {
    if (used.count(row.line) == 0) checker.Tell(row, "the reader knows no key " + row.key);
  }
  return checker.differences;
}

}  // namespace sidestep
