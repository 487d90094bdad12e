#include "sidestep/bench/reproduce/open_loop_statistics_text.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "sidestep/bench/json_text.h"

namespace sidestep::bench {
namespace {

using Json = nlohmann::ordered_json;

Json Bounds(const Interval& interval) {
  return {NumberOrNull(interval.low), NumberOrNull(interval.high)};
}

Json ToJson(const FreeRate& rate) {
  return {{"knowledge", ToString(rate.knowledge)},
          {"rows", rate.num_rows},
          {"free", rate.num_free},
          {"free_rate_wilson_95", Bounds(rate.wilson)},
          {"mean_gp_cost", NumberOrNull(rate.mean_gp_cost)}};
}

Json ToJson(const CostComparison& costs) {
  return {{"rows", costs.num_rows},
          {"rows_without_finite_cost", costs.num_not_finite},
          {"hodges_lehmann_shift", NumberOrNull(costs.shift)},
          {"wilcoxon_p", costs.p},
          {"wilcoxon_p_holm", costs.p_holm}};
}

Json ToJson(const LevelComparison& speed) {
  return {{"speed_m_per_s", speed.level},
          {"rows", speed.num_rows},
          {"only_first_free", speed.only_first},
          {"only_second_free", speed.only_second},
          {"mcnemar_p", speed.mcnemar_p},
          {"mcnemar_p_holm", speed.mcnemar_p_holm},
          {"gp_cost", ToJson(speed.all)},
          {"gp_cost_where_both_free", ToJson(speed.both_succeed)}};
}

Json ToJson(const KnowledgeComparison& comparison) {
  Json json = {{"first", ToString(comparison.first)},
               {"second", ToString(comparison.second)},
               {"rows", comparison.num_rows},
               {"only_first_free", comparison.only_first},
               {"only_second_free", comparison.only_second},
               {"free_rate_difference", comparison.rate_difference},
               {"free_rate_difference_bootstrap_95", Bounds(comparison.rate_interval)},
               {"median_gp_cost_difference", NumberOrNull(comparison.median_cost_difference)},
               {"median_gp_cost_difference_bootstrap_95", Bounds(comparison.cost_interval)},
               {"by_speed", Json::array()}};
  for (const LevelComparison& speed : comparison.levels) json["by_speed"].push_back(ToJson(speed));
  return json;
}

Json ToJson(const OpenLoopStatistics& statistics) {
  Json json = {{"filter", ToString(statistics.filter)},
               {"rows", statistics.num_rows},
               {"rows_excluded_by_speed", statistics.excluded_by_speed},
               {"rows_excluded_none_free", statistics.excluded_none_free},
               {"all_speeds", Json::array()},
               {"by_speed", Json::array()},
               {"comparisons", Json::array()}};
  for (const FreeRate& rate : statistics.pooled) json["all_speeds"].push_back(ToJson(rate));
  for (const FreeRate& rate : statistics.by_speed) {
    json["by_speed"].push_back(ToJson(rate));
    json["by_speed"].back()["speed_m_per_s"] = rate.speed_m_s;
  }
  for (const KnowledgeComparison& comparison : statistics.comparisons) {
    json["comparisons"].push_back(ToJson(comparison));
  }
  return json;
}

}  // namespace

std::string ToJson(const std::vector<OpenLoopStatistics>& statistics) {
  Json json = Json::array();
  for (const OpenLoopStatistics& filtered : statistics) json.push_back(ToJson(filtered));
  return JsonText(json);
}

std::string Describe(const OpenLoopStatistics& statistics) {
  std::string text = fmt::format("{}: {} rows", ToString(statistics.filter), statistics.num_rows);
  if (statistics.excluded_by_speed + statistics.excluded_none_free > 0) {
    text += fmt::format(" (excluded: {} by speed, {} in which none is free)",
                        statistics.excluded_by_speed, statistics.excluded_none_free);
  }
  text += '\n';
  for (const FreeRate& rate : statistics.pooled) {
    text += fmt::format("  {:<20} free {:4} of {:4}, {:5.1f} % [{:.1f}, {:.1f}]\n",
                        ToString(rate.knowledge), rate.num_free, rate.num_rows,
                        100.0 * rate.num_free / rate.num_rows, 100 * rate.wilson.low,
                        100 * rate.wilson.high);
  }
  for (const KnowledgeComparison& c : statistics.comparisons) {
    const int num_speeds = static_cast<int>(c.levels.size());
    text += fmt::format("  {} - {}\n", ToString(c.first), ToString(c.second));
    text += fmt::format(
        "    free    {:+8.1f} points [{:+.1f}, {:+.1f}]; McNemar p < 0.05 at {} of {} speeds\n",
        100 * c.rate_difference, 100 * c.rate_interval.low, 100 * c.rate_interval.high,
        c.CountSignificantOutcomes(), num_speeds);
    text += fmt::format(
        "    GP cost {:+8.2f} median [{:+.2f}, {:+.2f}]; Wilcoxon p < 0.05 at {} of {}\n",
        c.median_cost_difference, c.cost_interval.low, c.cost_interval.high,
        c.CountSignificantCosts(&LevelComparison::all), num_speeds);
  }
  return text;
}

}  // namespace sidestep::bench
