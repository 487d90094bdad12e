#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <functional>
#include <iterator>
#include <optional>
#include <set>
#include <utility>

#include "sidestep/bench/sweep/sweep.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/number_text.h"
#include "sidestep/core/parse_number.h"
#include "sidestep/core/text_file.h"
#include "sidestep/core/yaml_reader.h"
#include "sidestep/core/yaml_tree.h"

namespace sidestep::bench {
namespace {

constexpr std::uintmax_t kMaxBytes = 1 << 20;
constexpr double kMostAxisValues = 100'000;  // of an axis
constexpr std::uint64_t kMostSeeds = 10'000'000;
constexpr std::uint64_t kLargestSeed = 2147483647;

// A scalar as it can stand in a list of YAML.
std::string ScalarText(const std::string& text) {
  const bool is_plain = !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '+' || c == '.';
  });
  if (is_plain) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

// A value as --set takes it.
std::string SettingText(const YamlValue& value, bool is_inner = false) {
  switch (value.kind) {
    case YamlValue::Kind::kNull:
      return "null";
    case YamlValue::Kind::kScalar:
      return is_inner ? ScalarText(value.text) : value.text;
    case YamlValue::Kind::kList:
      return "[" +
             Joined(value.children, ", ",
                    [](const YamlValue& child) { return SettingText(child, true); }) +
             "]";
    case YamlValue::Kind::kMap:
      break;
  }
  return "{" +
         Joined(value.children, ", ",
                [](const YamlValue& child) {
                  return ScalarText(child.key) + ": " + SettingText(child, true);
                }) +
         "}";
}

// A number in one form, whatever it is written as; anything else as it is.
std::string AsNumber(const std::string& text) {
  const std::optional<double> number = NumberIn<double>(text);
  return number ? ShortestText(*number) : text;
}

// Reads what the strict reader has no getter for: values of any kind.
class AxisReader {
 public:
  AxisReader(const YamlReader& map, const YamlValue& tree) : map_(map), tree_(tree) {}

  SweepAxis Read(const std::string& name) const {
    map_.Has(name);  // it is known
    const YamlValue& value = *tree_.Find(name);
    SweepAxis axis{name, {}};
    if (name == "seed") map_.Fail(name, "is what `seeds` varies");
    if (value.kind == YamlValue::Kind::kMap) {
      axis.values = RangeOf(name);
    } else {
      if (value.kind != YamlValue::Kind::kList || value.children.empty()) {
        map_.Fail(name, "must be a list of values, or a map {from: A, to: B, step: C}");
      }
      for (const YamlValue& one : value.children) axis.values.push_back(ValueOf(name, one));
    }
    std::set<std::string> seen;
    for (const std::string& one : axis.values) {
      if (!seen.insert(AsNumber(one)).second) map_.Fail(name, "'" + one + "' is given twice");
    }
    return axis;
  }

 private:
  std::string ValueOf(const std::string& name, const YamlValue& value) const {
    const auto num_keys = static_cast<std::size_t>(std::count(name.begin(), name.end(), '/') + 1);
    if (num_keys == 1) return SettingText(value);
    if (value.kind != YamlValue::Kind::kList || value.children.size() != num_keys) {
      map_.Fail(name, fmt::format("varies {} keys together: each value must be a list of {}",
                                  num_keys, num_keys));
    }
    return Joined(value.children, "/", [](const YamlValue& one) {
      const bool is_cut = one.text.find('/') != std::string::npos;
      return is_cut ? ScalarText(one.text) : SettingText(one);
    });
  }

  // Each is the double nearest to its decimal fraction, as if it had been written.
  std::vector<std::string> RangeOf(const std::string& name) const {
    const YamlReader range = map_.GetMap(name);
    const double from = range.GetDouble("from"), to = range.GetDouble("to"),
                 step = range.GetPositive("step");
    range.CheckNoUnknownKeys();
    const double count = std::floor((to - from) / step * (1 + 1e-12)) + 1;
    if (!(count >= 1)) range.Fail("to", "must not be below `from`");
    if (count > kMostAxisValues) range.Fail("step", "makes too many values");
    std::vector<std::string> values;
    for (int i = 0; i < static_cast<int>(count); ++i) {
      values.push_back(ShortestText(std::stod(fmt::format("{:.12g}", from + i * step))));
    }
    return values;
  }

  const YamlReader& map_;
  const YamlValue& tree_;
};

std::vector<std::uint64_t> SeedsFromTo(const YamlReader& top, std::uint64_t first,
                                       std::uint64_t last) {
  if (last - first >= kMostSeeds) {
    top.Fail("seeds", "must be at most " + std::to_string(kMostSeeds));
  }
  std::vector<std::uint64_t> seeds;
  for (std::uint64_t seed = first; seed <= last; ++seed) seeds.push_back(seed);
  return seeds;
}

std::vector<std::uint64_t> ReadSeeds(const YamlReader& top) {
  if (!top.Has("seeds")) return {1};
  const auto seed_of = [](const YamlReader& map, const std::string& key, double number) {
    if (number != std::floor(number) || number < 0 || number > kLargestSeed) {
      map.Fail(key, "seeds are whole numbers from 0 to 2147483647");
    }
    return static_cast<std::uint64_t>(number);
  };
  if (top.IsScalar("seeds")) {
    const int count = top.GetInt("seeds");
    if (count < 1) top.Fail("seeds", "must be at least 1: how many, from seed 1 on");
    return SeedsFromTo(top, 1, static_cast<std::uint64_t>(count));
  }
  if (top.IsMap("seeds")) {
    const YamlReader range = top.GetMap("seeds");
    const std::uint64_t first = seed_of(range, "from", range.GetDouble("from"));
    const std::uint64_t last = seed_of(range, "to", range.GetDouble("to"));
    range.CheckNoUnknownKeys();
    if (last < first) range.Fail("to", "must not be below `from`");
    return SeedsFromTo(top, first, last);
  }
  std::vector<std::uint64_t> seeds;
  std::set<std::uint64_t> seen;
  for (const double number : top.GetDoubles("seeds")) {
    seeds.push_back(seed_of(top, "seeds", number));
    if (!seen.insert(seeds.back()).second) top.Fail("seeds", "one is given twice");
  }
  if (seeds.empty()) top.Fail("seeds", "must name at least one");
  return seeds;
}

SweepQuestion ReadQuestion(const YamlReader& top, const std::vector<SweepAxis>& axes) {
  SweepQuestion question;
  if (!top.Has("compare")) return question;
  const YamlReader map = top.GetMap("compare");
  question = {map.GetString("factor"), map.GetString("of"), map.GetString("with")};
  map.CheckNoUnknownKeys();
  const auto axis = std::find_if(axes.begin(), axes.end(),
                                 [&](const SweepAxis& one) { return one.name == question.factor; });
  if (axis == axes.end()) map.Fail("factor", "'" + question.factor + "' is none of the axes");
  for (const char* const key : {"of", "with"}) {
    const std::string value = map.GetString(key);
    const auto& values = axis->values;
    if (std::find(values.begin(), values.end(), value) == values.end()) {
      map.Fail(key, "'" + value + "' is none of its values (" + Joined(values) + ")");
    }
  }
  if (question.of == question.with) map.Fail("with", "must be another value than `of`");
  return question;
}

void CheckScenarios(const YamlReader& top, const std::vector<std::string>& scenarios) {
  if (scenarios.empty()) top.Fail("scenarios", "must name at least one");
  std::set<std::string> seen;
  for (const std::string& scenario : scenarios) {
    if (!seen.insert(scenario).second) {
      top.Fail("scenarios", "'" + scenario + "' is given twice");
    }
  }
}

void CheckGivenOnce(const YamlReader& top, const Sweep& sweep) {
  std::set<std::string> keys;
  for (const auto& [key, value] : sweep.settings) keys.insert(key);
  if (keys.contains("seed")) top.Fail("set", "seed is what `seeds` varies");
  for (const SweepAxis& axis : sweep.axes) {
    std::string key;
    for (const char c : axis.name + "/") {
      if (c != '/') {
        key += c;
        continue;
      }
      if (!keys.insert(key).second) top.Fail("axes", "'" + key + "' is given twice");
      key.clear();
    }
  }
}

// Who searches has to know how long.
void CheckSearch(const YamlReader& top, const Sweep& sweep) {
  const auto fixed = sweep.settings.find("knowledge");
  bool is_search = fixed != sweep.settings.end() && fixed->second == "search";
  for (const SweepAxis& axis : sweep.axes) {
    if (axis.name != "knowledge") continue;
    is_search = is_search ||
                std::find(axis.values.begin(), axis.values.end(), "search") != axis.values.end();
  }
  if (is_search && sweep.search == 0) {
    top.Fail("search",
             "how many guesses are searched is to be said, since `knowledge` is `search`");
  }
}

}  // namespace

Sweep ParseSweep(const std::string& text, const std::string& path) {
  const YamlReader top = YamlReader::FromText(text, path);
  const YamlValue tree =
      ParseYaml(text, [&](int line, const std::string& key, const std::string& why) {
        return InputError(path, line, key, why);
      });
  Sweep sweep;
  sweep.name = std::filesystem::path(path).stem().string();
  sweep.file = path;
  for (const char* const key : {"scenarios", "seeds", "variations"}) {
    if (top.Has(key)) sweep.lines[key] = top.Line(key);
  }
  if (top.Has("description")) sweep.description = top.GetString("description");
  sweep.scenarios = top.GetStrings("scenarios");
  CheckScenarios(top, sweep.scenarios);
  if (top.Has("set")) {
    const YamlReader map = top.GetMap("set");
    for (const std::string& key : map.Keys()) {
      map.Has(key);
      sweep.lines["set." + key] = map.Line(key);
      sweep.settings[key] = SettingText(*tree.Find("set")->Find(key));
    }
  }
  if (top.Has("variations")) {
    sweep.settings["variations"] = SettingText(*tree.Find("variations"));
  }
  if (top.Has("axes")) {
    const YamlReader map = top.GetMap("axes");
    const AxisReader reader(map, *tree.Find("axes"));
    for (const std::string& name : map.Keys()) {
      sweep.lines["axes." + name] = map.Line(name);
      sweep.axes.push_back(reader.Read(name));
    }
  }
  CheckGivenOnce(top, sweep);
  sweep.seeds = ReadSeeds(top);
  if (top.Has("search")) {
    sweep.search = top.GetInt("search");
    if (sweep.search < 1 || sweep.search > 100'000) {
      top.Fail("search", "must be from 1 to 100000 guesses");
    }
  }
  CheckSearch(top, sweep);
  if (top.Has("traces")) {
    const std::string word =
        top.GetChoice("traces", {std::begin(kKeptTracesWords), std::end(kKeptTracesWords)});
    sweep.traces = static_cast<KeptTraces>(
        std::find(std::begin(kKeptTracesWords), std::end(kKeptTracesWords), word) -
        std::begin(kKeptTracesWords));
  }
  sweep.question = ReadQuestion(top, sweep.axes);
  top.CheckNoUnknownKeys();
  return sweep;
}

Sweep ReadSweep(const std::string& path) { return ParseSweep(ReadTextFile(path, kMaxBytes), path); }

}  // namespace sidestep::bench
