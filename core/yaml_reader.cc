#include "sidestep/core/yaml_reader.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <set>

#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/parse_number.h"
#include "sidestep/core/text_file.h"
#include "sidestep/core/utf8.h"
#include "sidestep/core/yaml_tree.h"

namespace sidestep {
namespace {

using Kind = YamlValue::Kind;

// Far above any file a person writes, far below what would make the parser slow.
constexpr std::uintmax_t kMaxYamlBytes = 1 << 20;

// `text` in quotes, cut where it would make a message unreadable.
std::string Quote(const std::string& text) {
  constexpr std::size_t kLongest = 60;
  return "'" + (text.size() <= kLongest ? text : Utf8Prefix(text, kLongest) + "...") + "'";
}

std::string Describe(const YamlValue& value) {
  switch (value.kind) {
    case Kind::kNull:
      return "empty";
    case Kind::kScalar:
      return Quote(value.text);
    case Kind::kList:
      return "a list";
    case Kind::kMap:
      return "a map";
  }
  return "";
}

std::string PathOfChild(const YamlValue& parent, const std::string& path, std::size_t n) {
  if (parent.kind == Kind::kList) return path + "[" + std::to_string(n) + "]";
  return (path.empty() ? "" : path + ".") + parent.children[n].key;
}

struct SetPlace {
  std::string by, path;
};

// The first value that was set, of those within `value`, which is at `path`.
std::optional<SetPlace> FindSet(const YamlValue& value, const std::string& path) {
  if (!value.setting.empty()) return SetPlace{value.setting, path};
  for (std::size_t n = 0; n < value.children.size(); ++n) {
    const auto found = FindSet(value.children[n], PathOfChild(value, path, n));
    if (found) return found;
  }
  return std::nullopt;
}

void MarkAsSet(YamlValue& value, const std::string& by) {
  value.setting = by;
  for (YamlValue& child : value.children) MarkAsSet(child, by);
}

void AddLines(const YamlValue& value, const std::string& path, std::map<std::string, int>& lines) {
  const bool is_set = !value.setting.empty();
  if (!path.empty()) lines[path] = is_set ? 0 : value.line;
  for (std::size_t n = 0; n < value.children.size(); ++n) {
    const YamlValue& child = value.children[n];
    // Who complains of a number in a list complains of the list.
    if (value.kind == Kind::kList && child.kind != Kind::kMap && child.setting.empty()) continue;
    AddLines(child, PathOfChild(value, path, n), lines);
  }
}

}  // namespace

struct YamlReader::Node {
  std::shared_ptr<const YamlValue> value;  // a map; keeps the whole tree
  std::string file;
  std::string path;  // of this map, empty at the top
  mutable std::set<std::string> known;

  std::string PathOf(const std::string& key) const {
    if (path.empty()) return key;
    return key.empty() ? path : path + "." + key;
  }
  const YamlValue* Find(const std::string& key) const {
    known.insert(key);
    return value->Find(key);
  }
  // What `key` leads to, or "key[3]" to an item of its list.
  const YamlValue* FindItem(const std::string& key) const {
    const YamlValue* found = Find(key);
    if (found != nullptr || key.find('[') == std::string::npos) return found;
    found = value.get();
    for (const YamlStep& step : ParseYamlPath(key)) {
      if (found == nullptr) return nullptr;
      found = step.key.empty() ? found->FindItem(step.index) : found->Find(step.key);
    }
    return found;
  }
  // Throws for `key` at what it leads to or, if it is not there, at this map. Who set a value, or
  // some of it, is told so.
  [[noreturn]] void FailAt(const YamlValue* at, const std::string& key,
                           const std::string& why) const {
    const YamlValue& place = at == nullptr ? *value : *at;
    if (!place.setting.empty()) throw InputError(place.setting + " " + PathOf(key), why);
    const auto set = at == nullptr ? std::nullopt : FindSet(*at, PathOf(key));
    if (set) throw InputError(set->by + " " + set->path, why);
    throw InputError(file, place.line, PathOf(key), why);
  }
  const YamlValue& Require(const std::string& key) const {
    const YamlValue* const found = Find(key);
    if (found == nullptr) FailAt(nullptr, key, "is missing");
    return *found;
  }
  const YamlValue& RequireList(const std::string& key) const {
    const YamlValue& found = Require(key);
    if (found.kind != Kind::kList) FailAt(&found, key, "must be a list, is " + Describe(found));
    return found;
  }
  double Number(const YamlValue& at, const std::string& key) const {
    if (at.kind != Kind::kScalar) FailAt(&at, key, "must be a number, is " + Describe(at));
    double number = 0;
    if (!YAML::convert<double>::decode(YAML::Node(at.text), number)) {
      double ignored = 0;
      const char* const end = at.text.data() + at.text.size();
      const auto parsed = std::from_chars(at.text.data(), end, ignored);
      if (parsed.ec == std::errc::result_out_of_range && parsed.ptr == end) {
        FailAt(&at, key, "is out of range: " + at.text);
      }
      FailAt(&at, key, "must be a number, is " + Quote(at.text));
    }
    if (HasLeadingZeros(at.text)) {
      FailAt(&at, key, "must be a number without leading zeros, is " + Quote(at.text));
    }
    if (!std::isfinite(number)) FailAt(&at, key, "must be finite, is " + at.text);
    if (std::abs(number) > kLargestNumber) {
      FailAt(&at, key, "must be from -1e12 to 1e12, is " + at.text);
    }
    return number;
  }
  void CheckPositive(double number, const YamlValue& at, const std::string& key) const {
    if (!(number > 0)) FailAt(&at, key, "must be > 0, is " + at.text);
    if (number < 1 / kLargestNumber) FailAt(&at, key, "must be at least 1e-12, is " + at.text);
  }
  std::unique_ptr<Node> Child(const YamlValue& at, const std::string& key) const {
    if (at.kind != Kind::kMap) FailAt(&at, key, "must be a map, is " + Describe(at));
    auto child = std::make_unique<Node>();
    child->value = std::shared_ptr<const YamlValue>(value, &at);
    child->file = file;
    child->path = PathOf(key);
    return child;
  }
};

YamlReader::YamlReader(std::unique_ptr<Node> node) : node_(std::move(node)) {}
YamlReader::~YamlReader() = default;
YamlReader::YamlReader(YamlReader&&) noexcept = default;
YamlReader& YamlReader::operator=(YamlReader&&) noexcept = default;

YamlReader YamlReader::FromFile(const std::string& path) {
  return FromText(ReadTextFile(path, kMaxYamlBytes), path);
}

YamlReader YamlReader::FromText(const std::string& bytes, const std::string& name) {
  YamlValue top = ParseYaml(DecodeText(bytes, name),
                            [&](int line, const std::string& key, const std::string& why) {
                              return InputError(name, line, key, why);
                            });
  if (top.kind == Kind::kNull) throw InputError(name, 1, "", "is empty");
  if (top.kind != Kind::kMap) {
    throw InputError(name, 1, "", "must be a map of keys, is " + Describe(top));
  }
  top.line = 1;
  auto node = std::make_unique<Node>();
  node->file = name;
  node->value = std::make_shared<const YamlValue>(std::move(top));
  return YamlReader(std::move(node));
}

bool YamlReader::Has(const std::string& key) const { return node_->Find(key) != nullptr; }

std::string YamlReader::GetString(const std::string& key) const {
  const YamlValue& at = node_->Require(key);
  if (at.kind != Kind::kScalar) node_->FailAt(&at, key, "must be a word, is " + Describe(at));
  if (at.text.empty()) node_->FailAt(&at, key, "must not be empty");
  return at.text;
}

bool YamlReader::GetBool(const std::string& key) const {
  const YamlValue& at = node_->Require(key);
  if (at.kind == Kind::kScalar && at.text == "true") return true;
  if (at.kind == Kind::kScalar && at.text == "false") return false;
  node_->FailAt(&at, key, "must be true or false, is " + Describe(at));
}

int YamlReader::GetInt(const std::string& key) const {
  const YamlValue& at = node_->Require(key);
  char* end = nullptr;
  const long long value = std::strtoll(at.text.c_str(), &end, 10);
  if (at.text.empty() || *end != '\0') {
    node_->FailAt(&at, key, "must be a whole number, is " + Describe(at));
  }
  if (HasLeadingZeros(at.text)) {
    node_->FailAt(&at, key, "must be a whole number without leading zeros, is " + Quote(at.text));
  }
  if (value > INT32_MAX || value < INT32_MIN) {
    node_->FailAt(&at, key, "is out of range: " + at.text);
  }
  return static_cast<int>(value);
}

double YamlReader::GetDouble(const std::string& key) const {
  return node_->Number(node_->Require(key), key);
}

double YamlReader::GetPositive(const std::string& key) const {
  const double value = GetDouble(key);
  node_->CheckPositive(value, node_->Require(key), key);
  return value;
}

double YamlReader::GetNonNegative(const std::string& key) const {
  const double value = GetDouble(key);
  if (!(value >= 0)) Fail(key, "must be >= 0, is " + node_->Require(key).text);
  return value;
}

std::vector<double> YamlReader::GetDoubles(const std::string& key) const {
  std::vector<double> values;
  for (const YamlValue& item : node_->RequireList(key).children) {
    values.push_back(node_->Number(item, key + "[" + std::to_string(values.size()) + "]"));
  }
  return values;
}

std::vector<std::vector<double>> YamlReader::GetRows(const std::string& key) const {
  std::vector<std::vector<double>> rows;
  for (const YamlValue& row : node_->RequireList(key).children) {
    const std::string row_key = key + "[" + std::to_string(rows.size()) + "]";
    if (row.kind != Kind::kList) {
      node_->FailAt(&row, row_key, "must be a list, is " + Describe(row));
    }
    std::vector<double>& numbers = rows.emplace_back();
    for (const YamlValue& item : row.children) {
      numbers.push_back(node_->Number(item, row_key + "[" + std::to_string(numbers.size()) + "]"));
    }
  }
  return rows;
}

Eigen::VectorXd YamlReader::GetVector(const std::string& key, int length) const {
  const std::vector<double> values = GetDoubles(key);
  if (static_cast<int>(values.size()) != length) {
    Fail(key,
         "must have " + std::to_string(length) + " numbers, has " + std::to_string(values.size()));
  }
  return Eigen::Map<const Eigen::VectorXd>(values.data(), length);
}

Eigen::Vector3d YamlReader::GetVector3(const std::string& key) const { return GetVector(key, 3); }

Eigen::Vector3d YamlReader::GetPositiveVector3(const std::string& key) const {
  const Eigen::Vector3d value = GetVector3(key);
  for (int i = 0; i < 3; ++i) {
    node_->CheckPositive(value(i), node_->Require(key).children[static_cast<std::size_t>(i)],
                         key + "[" + std::to_string(i) + "]");
  }
  return value;
}

std::vector<std::string> YamlReader::GetStrings(const std::string& key) const {
  std::vector<std::string> values;
  for (const YamlValue& item : node_->RequireList(key).children) {
    if (item.kind != Kind::kScalar) {
      node_->FailAt(&item, key + "[" + std::to_string(values.size()) + "]",
                    "must be a word, is " + Describe(item));
    }
    values.push_back(item.text);
  }
  return values;
}

std::string YamlReader::GetChoice(const std::string& key,
                                  const std::vector<std::string>& choices) const {
  const std::string value = GetString(key);
  if (std::find(choices.begin(), choices.end(), value) == choices.end()) {
    Fail(key, "must be one of " + Joined(choices) + ", is " + Quote(value));
  }
  return value;
}

Pose YamlReader::GetPose(const std::string& key) const {
  const YamlReader map = GetMap(key);
  const Eigen::Vector3d p = map.GetVector3("position_m");
  const Eigen::Vector3d rpy =
      map.Has("rpy_rad") ? map.GetVector3("rpy_rad") : Eigen::Vector3d(0, 0, 0);
  map.CheckNoUnknownKeys();
  return Pose::FromRollPitchYaw(rpy, p);
}

YamlReader YamlReader::With(const std::string& path, const std::string& value,
                            const std::string& by) const {
  const auto fail = [&](const std::string& why) { throw InputError(by + " " + path, why); };
  if (FindInvalidUtf8(value) < value.size()) fail("must be UTF-8, is " + Quote(value));
  const std::vector<YamlStep> steps = ParseYamlPath(path);
  if (steps.empty()) fail("is no path: it must be written as a.b or a[0].b");
  auto top = std::make_shared<YamlValue>(*node_->value);
  YamlValue* at = top.get();
  for (const YamlStep& step : steps) {
    const bool is_last = &step == &steps.back();
    if (step.key.empty()) {
      if (at->kind != Kind::kList) fail("leads nowhere: what is there is no list");
      if (step.index >= at->children.size()) {
        fail("leads nowhere: there is no " + Quote(std::to_string(step.index)));
      }
      at = &at->children[step.index];
      continue;
    }
    if (at->kind == Kind::kList) fail("leads nowhere: items of a list are written [0], [1], ...");
    if (at->kind != Kind::kMap) fail("leads nowhere: what is there holds no keys");
    if (is_last && at->Find(step.key) == nullptr) at->children.emplace_back().key = step.key;
    YamlValue* const next = at->Find(step.key);
    if (next == nullptr) fail("leads nowhere: there is no " + Quote(step.key));
    at = next;
  }
  YamlValue set = ParseYaml(value, [&](int, const std::string& key, const std::string& why) {
    return InputError(by + " " + path + (key.empty() ? "" : ": " + key), why);
  });
  MarkAsSet(set, by);
  set.key = at->key;
  *at = std::move(set);
  return WithValue(std::move(top));
}

YamlReader YamlReader::With(const YamlReader& part) const {
  auto top = std::make_shared<YamlValue>(*node_->value);
  for (const YamlValue& child : part.node_->value->children) {
    if (YamlValue* const own = top->Find(child.key)) {
      *own = child;
    } else {
      top->children.push_back(child);
    }
  }
  return WithValue(std::move(top));
}

YamlReader YamlReader::Without(const std::string& key) const {
  auto top = std::make_shared<YamlValue>(*node_->value);
  std::erase_if(top->children, [&](const YamlValue& child) { return child.key == key; });
  return WithValue(std::move(top));
}

YamlReader YamlReader::WithValue(std::shared_ptr<const YamlValue> value) const {
  auto node = std::make_unique<Node>();
  node->value = std::move(value);
  node->file = node_->file;
  node->path = node_->path;
  return YamlReader(std::move(node));
}

bool YamlReader::IsScalar(const std::string& key) const {
  const YamlValue* const found = node_->Find(key);
  return found != nullptr && found->kind == Kind::kScalar;
}

bool YamlReader::IsMap(const std::string& key) const {
  const YamlValue* const found = node_->Find(key);
  return found != nullptr && found->kind == Kind::kMap;
}

bool YamlReader::IsListOfMaps(const std::string& key) const {
  const YamlValue* const found = node_->Find(key);
  return found != nullptr && found->kind == Kind::kList && !found->children.empty() &&
         found->children.front().kind == Kind::kMap;
}

YamlReader YamlReader::GetMap(const std::string& key) const {
  return YamlReader(node_->Child(node_->Require(key), key));
}

std::vector<YamlReader> YamlReader::GetMaps(const std::string& key) const {
  std::vector<YamlReader> maps;
  for (const YamlValue& item : node_->RequireList(key).children) {
    maps.push_back(YamlReader(node_->Child(item, key + "[" + std::to_string(maps.size()) + "]")));
  }
  return maps;
}

std::vector<std::string> YamlReader::Keys() const {
  std::vector<std::string> keys;
  for (const YamlValue& child : node_->value->children) keys.push_back(child.key);
  return keys;
}

void YamlReader::CheckNoUnknownKeys() const {
  for (const YamlValue& child : node_->value->children) {
    if (node_->known.count(child.key) != 0) continue;
    const std::string path = node_->PathOf(child.key);
    const std::string why = "is not a known key (known here: " + Joined(node_->known) + ")";
    if (!child.setting.empty()) throw InputError(child.setting + " " + path, why);
    throw InputError(node_->file, child.key_line, path, why);
  }
}

int YamlReader::Line(const std::string& key) const {
  const YamlValue* const found = node_->Find(key);
  return (found == nullptr ? *node_->value : *found).line;
}

std::map<std::string, int> YamlReader::Lines() const {
  std::map<std::string, int> lines;
  AddLines(*node_->value, node_->path, lines);
  return lines;
}

void YamlReader::Fail(const std::string& key, const std::string& why,
                      const std::string& against) const {
  const YamlValue* const at = node_->FindItem(key);
  const YamlValue* const other = against.empty() ? nullptr : node_->FindItem(against);
  const bool is_set = at != nullptr && FindSet(*at, key);
  const auto other_set = other == nullptr ? std::nullopt : FindSet(*other, node_->PathOf(against));
  if (!is_set && other_set) {
    throw InputError(other_set->by + " " + other_set->path, node_->PathOf(key) + ": " + why);
  }
  node_->FailAt(at, key, why);
}

}  // namespace sidestep
