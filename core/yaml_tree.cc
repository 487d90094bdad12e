#include "sidestep/core/yaml_tree.h"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <sstream>

namespace sidestep {
namespace {

// yaml-cpp recurses once for each level; a hostile file must not exhaust the stack.
constexpr int kMaxDepth = 64;
// Aliases of aliases double with each line; no file of a person has so many values.
constexpr int kMaxValues = 1'000'000;

// Refuses what yaml-cpp would recurse into too deeply. Only flow brackets and indentation nest.
void CheckText(const std::string& text, const YamlComplaint& complain) {
  int line = 1, depth = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte == 0 || (byte < 32 && c != '\n' && c != '\t' && c != '\r')) {
      throw complain(line, "", "is not a text file (byte " + std::to_string(byte) + ")");
    }
    if (c == '\n') ++line;
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kMaxDepth) throw complain(line, "", "is nested too deeply");
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
      throw complain(line, "", "is nested too deeply");
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
void CheckOneDocument(const std::string& text, const YamlComplaint& complain) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentStarts starts;
  parser.HandleNextDocument(starts);
  if (parser.HandleNextDocument(starts)) {
    throw complain(starts.lines.back(), "", "must hold one document; something follows it");
  }
}

class Copier {
 public:
  explicit Copier(const YamlComplaint& complain) : complain_(complain) {}

  // @param line where to look for it if it has no place of its own.
  YamlValue Copy(const YAML::Node& node, const std::string& path, int line, int depth = 0) {
    YamlValue value;
    // The mark of an empty value is where the next thing begins: often a line too far down.
    value.line = node.IsNull() ? line : LineOf(node, line);
    if (depth > kMaxDepth) throw complain_(value.line, path, "is nested too deeply");
    if (++num_values_ > kMaxValues) {
      throw complain_(value.line, path, "holds more than a million values, with its aliases");
    }
    if (node.IsScalar()) {
      value.kind = YamlValue::Kind::kScalar;
      value.text = node.Scalar();
    } else if (node.IsSequence()) {
      value.kind = YamlValue::Kind::kList;
      for (const YAML::Node& item : node) {
        const std::string place = path + "[" + std::to_string(value.children.size()) + "]";
        value.children.push_back(Copy(item, place, line, depth + 1));
      }
    } else if (node.IsMap()) {
      value.kind = YamlValue::Kind::kMap;
      CopyEntries(node, path, depth, value);
    }
    return value;
  }

 private:
  static int LineOf(const YAML::Node& node, int otherwise) {
    return node.Mark().line >= 0 ? node.Mark().line + 1 : otherwise;  // marks count from 0
  }

  void CopyEntries(const YAML::Node& map, const std::string& path, int depth, YamlValue& value) {
    std::set<std::string> seen;
    for (const auto& entry : map) {
      const int line = LineOf(entry.first, value.line);
      if (!entry.first.IsScalar()) throw complain_(line, path, "keys must be plain words");
      const std::string& key = entry.first.Scalar();
      const std::string place = path.empty() ? key : path + "." + key;
      // yaml-cpp keeps both of two equal keys and answers with the first.
      if (!seen.insert(key).second) throw complain_(line, place, "is given twice");
      value.children.push_back(Copy(entry.second, place, line, depth + 1));
      value.children.back().key = key;
      value.children.back().key_line = line;
    }
  }

  const YamlComplaint& complain_;
  int num_values_ = 0;
};

}  // namespace

const YamlValue* YamlValue::Find(const std::string& child_key) const {
  if (kind != Kind::kMap) return nullptr;
  const auto found = std::find_if(children.begin(), children.end(),
                                  [&](const YamlValue& child) { return child.key == child_key; });
  return found == children.end() ? nullptr : &*found;
}

YamlValue* YamlValue::Find(const std::string& child_key) {
  return const_cast<YamlValue*>(static_cast<const YamlValue*>(this)->Find(child_key));
}

const YamlValue* YamlValue::FindItem(std::size_t index) const {
  return kind == Kind::kList && index < children.size() ? &children[index] : nullptr;
}

YamlValue ParseYaml(const std::string& text, const YamlComplaint& complain) {
  CheckText(text, complain);
  // The mark that ends a document turns a quote that nobody closed into an error. Without it
  // yaml-cpp takes the rest of the file for the quoted word.
  const std::string closed_text = text + "\n...\n";
  try {
    CheckOneDocument(closed_text, complain);
    return Copier(complain).Copy(YAML::Load(closed_text), "", 1);
  } catch (const YAML::Exception& error) {
    const bool open_quote = error.msg == YAML::ErrorMsg::DOC_IN_SCALAR;
    throw complain(error.mark.line + 1, "",
                   open_quote ? "a quote is not closed" : "is not valid YAML: " + error.msg);
  }
}

std::vector<YamlStep> ParseYamlPath(const std::string& path) {
  std::vector<YamlStep> steps;
  std::size_t at = 0;
  while (at < path.size()) {
    if (path[at] == '[') {
      YamlStep item;
      const char* const begin = path.data() + at + 1;
      const auto parsed = std::from_chars(begin, path.data() + path.size(), item.index);
      const auto end = static_cast<std::size_t>(parsed.ptr - path.data());
      const bool is_number =
          parsed.ec == std::errc() &&
          std::to_string(item.index).size() == static_cast<std::size_t>(parsed.ptr - begin);
      if (steps.empty() || !is_number || end >= path.size() || path[end] != ']') return {};
      steps.push_back(item);
      at = end + 1;
    } else {
      if (!steps.empty() && path[at++] != '.') return {};
      const std::size_t end = std::min(path.find_first_of(".[]", at), path.size());
      if (end == at) return {};
      steps.push_back({path.substr(at, end - at)});
      at = end;
    }
  }
  return steps;
}

}  // namespace sidestep
