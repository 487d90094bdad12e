#include "sidestep/core/yaml_reader.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>

#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/text_file.h"
#include "sidestep/core/utf8.h"

namespace sidestep {
namespace {

// Far above any file a person writes, far below what would make the parser slow.
constexpr std::uintmax_t kMaxFileBytes = 1 << 20;
// yaml-cpp recurses once for each level; a hostile file must not exhaust the stack.
constexpr int kMaxDepth = 64;

// Refuses what yaml-cpp would recurse into too deeply. Only flow brackets and indentation nest.
void CheckText(const std::string& text, const std::string& name) {
  int line = 1, depth = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte == 0 || (byte < 32 && c != '\n' && c != '\t' && c != '\r')) {
      throw InputError(name, line, "", "is not a text file (byte " + std::to_string(byte) + ")");
    }
    if (c == '\n') ++line;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kMaxDepth) throw InputError(name, line, "", "is nested too deeply");
  }
  std::istringstream lines(text);
  std::string row;
  for (line = 1; std::getline(lines, row); ++line) {
    int markers = 0;
    for (std::size_t i = 0; i + 1 < row.size(); ++i) {
      markers += (row[i] == '-' || row[i] == '?') && row[i + 1] == ' ';
    }
    const std::size_t indent = std::min(row.find_first_not_of(' '), row.size());
    if (markers > kMaxDepth || indent > 4 * kMaxDepth) {
      throw InputError(name, line, "", "is nested too deeply");
    }
  }
}

// Hears what yaml-cpp reads and keeps only where documents begin.
class DocumentStarts : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& mark) override { lines.push_back(mark.line + 1); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

  std::vector<int> lines;
};

// Asks for two documents and no more: yaml-cpp 0.7 takes a stray comma for an endless row of empty
// ones (its issue 1040), so YAML::LoadAll may never return.
void CheckOneDocument(const std::string& text, const std::string& name) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentStarts starts;
  parser.HandleNextDocument(starts);
  if (parser.HandleNextDocument(starts)) {
    throw InputError(name, starts.lines.back(), "", "must hold one document; something follows it");
  }
}

// `text` in quotes, cut where it would make a message unreadable.
std::string Quote(const std::string& text) {
  constexpr std::size_t kLongest = 60;
  return "'" + (text.size() <= kLongest ? text : Utf8Prefix(text, kLongest) + "...") + "'";
}

std::string Describe(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Null:
      return "empty";
    case YAML::NodeType::Scalar:
      return Quote(node.Scalar());
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Map:
      return "a map";
    default:
      return "missing";
  }
}

// The keys and list places of a path: `a[0].b` leads over a and 0 to b.
std::vector<std::string> KeysOf(const std::string& path) {
  std::vector<std::string> keys = {""};
  for (const char c : path) {
    if (c == '.' || c == '[' || c == ']') {
      keys.emplace_back();
    } else {
      keys.back() += c;
    }
  }
  std::erase(keys, "");
  return keys;
}

// What a map holds under a key or a list at a place; undefined if there is nothing.
YAML::Node ChildOf(const YAML::Node& node, const std::string& key) {
  if (node.IsMap()) {
    for (const auto& entry : node) {
      if (entry.first.IsScalar() && entry.first.Scalar() == key) return entry.second;
    }
  }
  if (node.IsSequence()) {
    std::size_t index = 0;
    const auto parsed = std::from_chars(key.data(), key.data() + key.size(), index);
    const bool is_number = parsed.ec == std::errc() && parsed.ptr == key.data() + key.size();
    if (is_number && index < node.size()) return node[index];
  }
  return YAML::Node(YAML::NodeType::Undefined);
}

}  // namespace

struct YamlReader::Node {
  YAML::Node yaml;
  std::string file;
  std::string path;  // of this map, empty at the top
  int line = 1;
  mutable std::set<std::string> known;
  // Paths that were set from elsewhere, and from where. Shared by all views of one file.
  std::shared_ptr<std::map<std::string, std::string>> set =
      std::make_shared<std::map<std::string, std::string>>();

  std::string PathOf(const std::string& key) const {
    if (path.empty()) return key;
    return key.empty() ? path : path + "." + key;
  }
  static int LineOf(const YAML::Node& node, int otherwise) {
    return node.Mark().line >= 0 ? node.Mark().line + 1 : otherwise;  // marks count from 0
  }
  YAML::Node Find(const std::string& key) const {
    known.insert(key);
    return ChildOf(yaml, key);
  }
  // What `key` leads to, or "key[3]" to an item of its list.
  YAML::Node FindItem(const std::string& key) const {
    const YAML::Node found = Find(key);
    const std::size_t bracket = key.find('[');
    if (found.IsDefined() || bracket == std::string::npos) return found;
    const std::size_t length = key.find(']') - bracket - 1;
    return ChildOf(ChildOf(yaml, key.substr(0, bracket)), key.substr(bracket + 1, length));
  }
  // The line of `key`, or of the list in which `key`, "list[3]", is an item; else of this map.
  int LineOfKey(const std::string& key) const {
    const std::string name = key.substr(0, key.find('['));
    for (const auto& entry : yaml) {
      if (entry.first.Scalar() == name) return LineOf(entry.first, line);
    }
    return line;
  }
  // Throws if what is wrong at `full_path` was set from elsewhere: there or in what holds it.
  void BlameSetting(const std::string& full_path, const std::string& why) const {
    for (const auto& [set_path, origin] : *set) {
      const bool is_inside =
          full_path.rfind(set_path, 0) == 0 &&
          (full_path.size() == set_path.size() || full_path[set_path.size()] == '.' ||
           full_path[set_path.size()] == '[');
      if (is_inside) throw InputError(origin + " " + full_path, why);
    }
  }
  [[noreturn]] void FailAt(const YAML::Node& at, const std::string& key,
                           const std::string& why) const {
    BlameSetting(PathOf(key), why);
    // The mark of an empty value is where the next thing begins: often a line too far down.
    const bool marked = at.IsDefined() && !at.IsNull();
    throw InputError(file, marked ? LineOf(at, line) : LineOfKey(key), PathOf(key), why);
  }
  YAML::Node Require(const std::string& key) const {
    const YAML::Node node = Find(key);
    if (!node.IsDefined()) throw InputError(file, line, PathOf(key), "is missing");
    return node;
  }
  YAML::Node RequireSequence(const std::string& key) const {
    const YAML::Node node = Require(key);
    if (!node.IsSequence()) FailAt(node, key, "must be a list, is " + Describe(node));
    return node;
  }
  double Number(const YAML::Node& node, const std::string& key) const {
    if (!node.IsScalar()) FailAt(node, key, "must be a number, is " + Describe(node));
    double value = 0;
    const std::string& text = node.Scalar();
    if (!YAML::convert<double>::decode(node, value)) {
      double ignored = 0;
      const char* const end = text.data() + text.size();
      const auto parsed = std::from_chars(text.data(), end, ignored);
      if (parsed.ec == std::errc::result_out_of_range && parsed.ptr == end) {
        FailAt(node, key, "is out of range: " + text);
      }
      FailAt(node, key, "must be a number, is " + Quote(text));
    }
    if (!std::isfinite(value)) FailAt(node, key, "must be finite, is " + text);
    if (std::abs(value) > kLargestNumber) {
      FailAt(node, key, "must be from -1e12 to 1e12, is " + text);
    }
    return value;
  }
  void CheckPositive(double value, const YAML::Node& node, const std::string& key) const {
    if (!(value > 0)) FailAt(node, key, "must be > 0, is " + node.Scalar());
    if (value < 1 / kLargestNumber) {
      FailAt(node, key, "must be at least 1e-12, is " + node.Scalar());
    }
  }
  std::unique_ptr<Node> Child(const YAML::Node& node, const std::string& key) const {
    if (!node.IsMap()) FailAt(node, key, "must be a map, is " + Describe(node));
    auto child = std::make_unique<Node>();
    child->yaml = node;
    child->file = file;
    child->path = PathOf(key);
    child->set = set;
    child->line = LineOf(node, line);  // of its first key
    child->CheckKeys();
    return child;
  }
  // yaml-cpp keeps both of two equal keys and answers with the first.
  void CheckKeys() const {
    std::set<std::string> seen;
    for (const auto& entry : yaml) {
      if (!entry.first.IsScalar()) {
        throw InputError(file, LineOf(entry.first, line), path, "keys must be plain words");
      }
      if (!seen.insert(entry.first.Scalar()).second) {
        throw InputError(file, LineOf(entry.first, line), PathOf(entry.first.Scalar()),
                         "is given twice");
      }
    }
  }
};

YamlReader::YamlReader(std::unique_ptr<Node> node) : node_(std::move(node)) {}
YamlReader::~YamlReader() = default;
YamlReader::YamlReader(YamlReader&&) noexcept = default;
YamlReader& YamlReader::operator=(YamlReader&&) noexcept = default;

YamlReader YamlReader::FromFile(const std::string& path) {
  return FromText(ReadTextFile(path, kMaxFileBytes), path);
}

YamlReader YamlReader::FromText(const std::string& bytes, const std::string& name) {
  const std::string text = DecodeText(bytes, name);
  CheckText(text, name);
  auto node = std::make_unique<Node>();
  node->file = name;
  try {
    // The mark that ends a document turns a quote that nobody closed into an error. Without it
    // yaml-cpp takes the rest of the file for the quoted word.
    const std::string closed_text = text + "\n...\n";
    CheckOneDocument(closed_text, name);
    node->yaml = YAML::Load(closed_text);
    if (node->yaml.IsNull()) throw InputError(name, 1, "", "is empty");
  } catch (const YAML::Exception& error) {
    const bool open_quote = error.msg == YAML::ErrorMsg::DOC_IN_SCALAR;
    throw InputError(name, error.mark.line + 1, "",
                     open_quote ? "a quote is not closed" : "is not valid YAML: " + error.msg);
  }
  if (!node->yaml.IsMap()) {
    throw InputError(name, 1, "", "must be a map of keys, is " + Describe(node->yaml));
  }
  node->CheckKeys();
  return YamlReader(std::move(node));
}

bool YamlReader::Has(const std::string& key) const { return node_->Find(key).IsDefined(); }

std::string YamlReader::GetString(const std::string& key) const {
  const YAML::Node node = node_->Require(key);
  if (!node.IsScalar()) node_->FailAt(node, key, "must be a word, is " + Describe(node));
  if (node.Scalar().empty()) node_->FailAt(node, key, "must not be empty");
  return node.Scalar();
}

bool YamlReader::GetBool(const std::string& key) const {
  const YAML::Node node = node_->Require(key);
  if (node.IsScalar() && node.Scalar() == "true") return true;
  if (node.IsScalar() && node.Scalar() == "false") return false;
  node_->FailAt(node, key, "must be true or false, is " + Describe(node));
}

int YamlReader::GetInt(const std::string& key) const {
  const YAML::Node node = node_->Require(key);
  const std::string text = node.IsScalar() ? node.Scalar() : "";
  char* end = nullptr;
  const long long value = std::strtoll(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0') {
    node_->FailAt(node, key, "must be a whole number, is " + Describe(node));
  }
  if (value > INT32_MAX || value < INT32_MIN) node_->FailAt(node, key, "is out of range: " + text);
  return static_cast<int>(value);
}

double YamlReader::GetDouble(const std::string& key) const {
  return node_->Number(node_->Require(key), key);
}

double YamlReader::GetPositive(const std::string& key) const {
  const double value = GetDouble(key);
  node_->CheckPositive(value, node_->Find(key), key);
  return value;
}

double YamlReader::GetNonNegative(const std::string& key) const {
  const double value = GetDouble(key);
  if (!(value >= 0)) Fail(key, "must be >= 0, is " + node_->Find(key).Scalar());
  return value;
}

std::vector<double> YamlReader::GetDoubles(const std::string& key) const {
  std::vector<double> values;
  for (const YAML::Node& item : node_->RequireSequence(key)) {
    values.push_back(node_->Number(item, key + "[" + std::to_string(values.size()) + "]"));
  }
  return values;
}

std::vector<std::vector<double>> YamlReader::GetRows(const std::string& key) const {
  std::vector<std::vector<double>> rows;
  for (const YAML::Node& row : node_->RequireSequence(key)) {
    const std::string row_key = key + "[" + std::to_string(rows.size()) + "]";
    if (!row.IsSequence()) node_->FailAt(row, row_key, "must be a list, is " + Describe(row));
    std::vector<double>& numbers = rows.emplace_back();
    for (const YAML::Node& item : row) {
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
    node_->CheckPositive(value(i), node_->Find(key)[i], key + "[" + std::to_string(i) + "]");
  }
  return value;
}

std::vector<std::string> YamlReader::GetStrings(const std::string& key) const {
  std::vector<std::string> values;
  for (const YAML::Node& item : node_->RequireSequence(key)) {
    if (!item.IsScalar()) {
      node_->FailAt(item, key + "[" + std::to_string(values.size()) + "]",
                    "must be a word, is " + Describe(item));
    }
    values.push_back(item.Scalar());
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

void YamlReader::Set(const std::string& path, const std::string& value, const std::string& origin) {
  const auto fail = [&](const std::string& why) { throw InputError(origin + " " + path, why); };
  if (FindInvalidUtf8(value) < value.size()) fail("must be UTF-8, is " + Quote(value));
  CheckText(value, origin + " " + path);
  const std::vector<std::string> keys = KeysOf(path);
  if (keys.empty()) fail("is no key");
  YAML::Node node = node_->yaml;
  for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
    const YAML::Node next = ChildOf(node, keys[i]);
    if (!next.IsDefined()) fail("leads nowhere: there is no " + Quote(keys[i]));
    node.reset(next);
  }
  if (node.IsSequence() && !ChildOf(node, keys.back()).IsDefined()) {
    fail("leads nowhere: there is no item " + Quote(keys.back()));
  }
  if (!node.IsSequence() && !node.IsMap()) fail("leads nowhere: what is there holds no keys");
  try {
    const YAML::Node leaf = YAML::Load(value + "\n...\n");
    if (node.IsSequence()) {
      node[std::stoul(keys.back())] = leaf;
    } else {
      node[keys.back()] = leaf;
    }
  } catch (const YAML::Exception& error) {
    fail("is not valid YAML: " + error.msg);
  }
  (*node_->set)[path] = origin;
}

void YamlReader::Replace(const YamlReader& other) {
  for (const auto& entry : other.node_->yaml) node_->yaml[entry.first.Scalar()] = entry.second;
}

bool YamlReader::IsScalar(const std::string& key) const { return node_->Find(key).IsScalar(); }

YamlReader YamlReader::GetMap(const std::string& key) const {
  return YamlReader(node_->Child(node_->Require(key), key));
}

std::vector<YamlReader> YamlReader::GetMaps(const std::string& key) const {
  std::vector<YamlReader> maps;
  for (const YAML::Node& item : node_->RequireSequence(key)) {
    maps.push_back(YamlReader(node_->Child(item, key + "[" + std::to_string(maps.size()) + "]")));
  }
  return maps;
}

std::vector<std::string> YamlReader::Keys() const {
  std::vector<std::string> keys;
  for (const auto& entry : node_->yaml) keys.push_back(entry.first.Scalar());
  return keys;
}

void YamlReader::CheckNoUnknownKeys() const {
  for (const auto& entry : node_->yaml) {
    const std::string& key = entry.first.Scalar();
    if (node_->known.count(key) == 0) {
      const std::string why = "is not a known key (known here: " + Joined(node_->known) + ")";
      node_->BlameSetting(node_->PathOf(key), why);
      throw InputError(node_->file, Node::LineOf(entry.first, node_->line), node_->PathOf(key),
                       why);
    }
  }
}

int YamlReader::Line(const std::string& key) const {
  const YAML::Node node = node_->Find(key);
  return node.IsDefined() ? Node::LineOf(node, node_->line) : node_->line;
}

void YamlReader::Fail(const std::string& key, const std::string& why) const {
  node_->FailAt(node_->FindItem(key), key, why);
}

}  // namespace sidestep
