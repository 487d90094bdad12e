#include "sidestep/bench/result_file.h"

#include <cmath>
#include <cstdint>
#include <limits>
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

Json NumberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

double NumberOrNaN(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

const Json& At(const Json& map, const std::string& key, const std::string& path) {
  if (!map.is_object() || !map.contains(key)) {
    throw InputError(path, "is not a whole result: '" + key + "' is missing");
  }
  return map[key];
}

Json ValueOf(const Metric& metric, double value) {
  if (std::string(metric.unit) == "count") return Json(std::llround(value));
  return NumberOrNull(value);
}

Json StageTable(const StageTimes& times) {
  Json table = Json::object();
  for (const auto& [stage, seconds] : times) {
    table[stage] = {{"p50_ms", NumberOrNull(1e3 * Quantile(seconds, 0.50))},
                    {"p95_ms", NumberOrNull(1e3 * Quantile(seconds, 0.95))},
                    {"p99_ms", NumberOrNull(1e3 * Quantile(seconds, 0.99))}};
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
  Json json;
  json["format"] = "sidestep-result-1";
  json["scenario"] = scenario.name;
  json["robot"] = scenario.robot;
  const auto robot_at = result.recording.header.find("robot_at");
  json["robot_at"] =
      robot_at == result.recording.header.end() ? Json(nullptr) : Json(robot_at->second);
  json["planner"] = scenario.planner;
  json["knowledge"] = scenario.knowledge;
  json["predictor"] = scenario.predictor;
  json["seed"] = scenario.seed;
  json["choices"] = scenario.choices;
  json["drawn"] = scenario.drawn;
  json["outcome"] = ToString(result.outcome);
  const bool is_whole = result.outcome != Outcome::kAborted;
  json["ended"] = is_whole ? Json(ToString(Ending(result.recording.metrics))) : Json(nullptr);
  json["reason"] = result.reason.empty() ? Json(nullptr) : Json(result.reason);
  const std::string touched = TouchedBy(result.recording);
  json["touched"] = touched.empty() ? Json(nullptr) : Json(touched);
  json["would_trip"] = Json::array();
  for (const TripMetric& metric : TrippedBy(result.recording.metrics)) {
    json["would_trip"].push_back(metric.name);
  }
  for (const Metric& metric : Metrics()) {
    json[metric.name] = ValueOf(metric, result.recording.metrics.at(metric.name));
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
  json["wall_clock"] = {{"episode_s", result.wall_s},
                        {"cycle_cpu", StageTable(result.times)},
                        {"cycles_over_charge", result.cycles_over_charge},
                        {"late_plans", result.late_plans},
                        {"answers", AnswerTable(result.answers_s)}};
  return JsonText(json);
}

ResultSummary ReadResult(const std::string& path) {
  const std::string text = ReadTextFile(path, kMaxResultBytes);
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("format") || json["format"] != "sidestep-result-1") {
    throw InputError(path, "is not a result.json of sidestep");
  }
  ResultSummary summary;
  try {
    summary.scenario = At(json, "scenario", path).get<std::string>();
    summary.knowledge = At(json, "knowledge", path).get<std::string>();
    const auto word = At(json, "outcome", path).get<std::string>();
    const std::optional<Outcome> outcome = OutcomeFromString(word);
    if (!outcome) throw InputError(path, "is not a whole result: no outcome is '" + word + "'");
    summary.outcome = *outcome;
    const Json& touched = At(json, "touched", path);
    if (!touched.is_null()) summary.touched = touched.get<std::string>();
    Flatten(At(json, "parameters", path), "", summary.parameters);
    for (const Metric& metric : Metrics()) {
      summary.metrics[metric.name] = NumberOrNaN(At(json, metric.name, path));
    }
    const Json* cycle = &json;
    for (const char* const key : {"wall_clock", "cycle_cpu", "cycle", "p50_ms"}) {
      cycle = &At(*cycle, key, path);
    }
    summary.cycle_p50_ms = NumberOrNaN(*cycle);
  } catch (const Json::exception&) {  // whose text is of no use to who wrote the file
    throw InputError(path, "is not a whole result: a value is of the wrong kind");
  }
  return summary;
}

}  // namespace sidestep::bench
