#include "sidestep/bench/result_file.h"

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "sidestep/bench/json_text.h"
#include "sidestep/bench/metrics/registry.h"
#include "sidestep/bench/metrics/robot_limit_metrics.h"
#include "sidestep/bench/statistics.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/text_file.h"
#include "sidestep/core/yaml_json.h"
#include "sidestep/record/questions.h"

namespace sidestep::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uintmax_t kMaxResultBytes = 1 << 24;

Json TextOrNull(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

std::string TextIn(const Json& value) { return value.is_null() ? "" : value.get<std::string>(); }

// What results of earlier programs do not tell.
double IfThere(const Json& map, const std::string& key) {
  return NumberOrNaN(map.contains(key) ? map[key] : Json(nullptr));
}

const Json& EntryOf(const Json& map, const std::string& key, const std::string& path) {
  if (!map.is_object() || !map.contains(key)) {
    throw InputError(path, "is not a whole result: '" + key + "' is missing");
  }
  return map[key];
}

Json JsonValueOf(const Metric& metric, double value) {
  if (std::string(metric.unit) == "count") return Json(std::llround(value));
  return NumberOrNull(value);
}

Json StageTable(const StageTimes& times) {
  Json table = Json::object();
  for (const auto& [stage, seconds] : times) {
    table[stage] = {{"p50_ms", NumberOrNull(1e3 * Quantile(seconds, 0.50))},
                    {"p95_ms", NumberOrNull(1e3 * Quantile(seconds, 0.95))},
                    {"p99_ms", NumberOrNull(1e3 * Quantile(seconds, 0.99))},
                    {"max_ms", NumberOrNull(1e3 * Quantile(seconds, 1))}};
  }
  return table;
}

// What a robot waited for its commands; null where none did.
Json AnswerTable(const std::vector<double>& seconds) {
  if (seconds.empty()) return nullptr;
  return {{"count", seconds.size()},
          {"p50_us", 1e6 * Quantile(seconds, 0.5)},
          {"p99_9_us", 1e6 * Quantile(seconds, 0.999)},
          {"max_us", 1e6 * Quantile(seconds, 1)}};
}

RunClock ClockIn(const Json& wall_clock, const std::string& path) {
  const auto number = [&](const Json& map, const char* key) {
    return NumberOrNaN(EntryOf(map, key, path));
  };
  const Json& cycle = EntryOf(EntryOf(wall_clock, "cycle_cpu", path), "cycle", path);
  RunClock clock;
  clock.episode_s = number(wall_clock, "episode_s");
  clock.cycle_p50_ms = number(cycle, "p50_ms");
  clock.cycle_p95_ms = number(cycle, "p95_ms");
  clock.cycle_p99_ms = number(cycle, "p99_ms");
  clock.cycle_max_ms = IfThere(cycle, "max_ms");
  EntryOf(wall_clock, "cycles_over_charge", path).get_to(clock.cycles_over_charge);
  EntryOf(wall_clock, "late_plans", path).get_to(clock.late_plans);
  return clock;
}

// The leaves of a tree by their paths; lists of plain values are leaves.
void Flatten(const Json& value, const std::string& path,
             std::map<std::string, std::string>& leaves) {
  const bool is_list_of_maps = value.is_array() && !value.empty() && value.front().is_object();
  if (!value.is_object() && !is_list_of_maps) {
    leaves[path] = value.is_string() ? value.get<std::string>() : value.dump();
    return;
  }
  for (std::size_t i = 0; is_list_of_maps && i < value.size(); ++i) {
    Flatten(value[i], path + "[" + std::to_string(i) + "]", leaves);
  }
  for (auto item = value.begin(); value.is_object() && item != value.end(); ++item) {
    Flatten(item.value(), path.empty() ? item.key() : path + "." + item.key(), leaves);
  }
}

}  // namespace

std::string TouchedBy(const record::Recording& recording) {
  const std::optional<record::Touch> touch = record::FirstTouch(recording);
  return touch ? touch->object : "";
}

std::map<std::string, int> TrackEventCounts(const record::Recording& recording) {
  std::map<std::string, int> counts;
  for (const TrackEvent& event : recording.events) ++counts[event.what];
  return counts;
}

std::string ResultJson(const EpisodeResult& result, const scenarios::Scenario& scenario,
                       const RunIdentity& identity,
                       const std::map<std::string, std::string>& versions) {
  const RunRow row = RowOf(result, scenario);
  Json json;
  json["format"] = "sidestep-result-1";
  json["scenario"] = scenario.name;
  json["robot"] = row.subject.robot;
  const auto robot_at = result.recording.header.find("robot_at");
  json["robot_at"] =
      robot_at == result.recording.header.end() ? Json(nullptr) : Json(robot_at->second);
  json["planner"] = row.subject.planner;
  json["knowledge"] = row.subject.knowledge;
  json["predictor"] = row.subject.predictor;
  json["seed"] = scenario.seed;
  json["choices"] = scenario.choices;
  json["drawn"] = row.drawn;
  json["charged_latency_s"] = NumberOrNull(row.subject.charged_latency_s);
  json["outcome"] = row.outcome;
  const bool is_whole = result.outcome != Outcome::kAborted;
  json["ended"] = is_whole ? Json(ToString(Ending(row.metrics))) : Json(nullptr);
  json["reason"] = TextOrNull(row.error);
  json["touched"] = TextOrNull(row.touched);
  json["would_trip"] = Json::array();
  for (const TripMetric& metric : TrippedBy(row.metrics)) {
    json["would_trip"].push_back(metric.name);
  }
  for (const Metric& metric : Metrics()) {
    json[metric.name] = JsonValueOf(metric, row.metrics.at(metric.name));
  }
  json["parameters"] = Json::parse(YamlToJson(scenarios::ToYaml(scenario)));
  json["identity"] = {
      {"run", RunId(identity)}, {"scenario", identity.scenario}, {"models", identity.models}};
  json["versions"] = versions;
  json["scans_left_out"] = result.scans_left_out;
  json["track_events"] = TrackEventCounts(result.recording);
  json["safety_events"] = Json::array();
  for (const SafetyEvent& event : result.recording.safety) {
    json["safety_events"].push_back({{"t_s", event.t.seconds()},
                                     {"check", event.check},
                                     {"reaction", event.reaction},
                                     {"value", NumberOrNull(event.value)},
                                     {"limit", NumberOrNull(event.limit)}});
  }
  json["wall_clock"] = {{"episode_s", row.clock.episode_s},
                        {"cycle_cpu", StageTable(result.times)},
                        {"cycles_over_charge", row.clock.cycles_over_charge},
                        {"late_plans", row.clock.late_plans},
                        {"answers", AnswerTable(result.answers_s)}};
  return JsonText(json);
}

StoredResult ReadResult(const std::string& path) {
  const std::string text = ReadTextFile(path, kMaxResultBytes);
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("format") || json["format"] != "sidestep-result-1") {
    throw InputError(path, "is not a result.json of sidestep");
  }
  const auto at = [&](const std::string& key) -> const Json& { return EntryOf(json, key, path); };
  StoredResult stored;
  RunRow& row = stored.row;
  try {
    at("scenario").get_to(stored.scenario);
    at("seed").get_to(stored.seed);
    at("outcome").get_to(row.outcome);
    if (!OutcomeFromString(row.outcome)) {
      throw InputError(path, "is not a whole result: no outcome is '" + row.outcome + "'");
    }
    row.error = TextIn(at("reason"));
    row.touched = TextIn(at("touched"));
    at("drawn").get_to(row.drawn);
    row.subject = {at("robot"), at("planner"), at("knowledge"), at("predictor"),
                   IfThere(json, "charged_latency_s")};
    Flatten(at("parameters"), "", stored.parameters);
    at("versions").get_to(stored.versions);
    for (const Metric& metric : Metrics()) {
      row.metrics[metric.name] = NumberOrNaN(at(metric.name));
    }
    row.identity.scenario = EntryOf(at("identity"), "scenario", path);
    row.identity.models = EntryOf(at("identity"), "models", path);
    const auto build = stored.versions.find("build_id");
    if (build != stored.versions.end()) row.identity.build = build->second;
    row.clock = ClockIn(at("wall_clock"), path);
  } catch (const Json::exception&) {  // whose text is of no use to who wrote the file
    throw InputError(path, "is not a whole result: a value is of the wrong kind");
  }
  return stored;
}

}  // namespace sidestep::bench
