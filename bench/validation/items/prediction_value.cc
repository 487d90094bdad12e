// What the planner makes of a prediction, without a supervisor that helps it.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "sidestep/bench/statistics.h"
#include "sidestep/bench/validation/support.h"

namespace sidestep::bench {
namespace {

Facts MeasurePredictionValue(const ValidationRun& run) {
  if (run.one.group != validation_group::kPrediction) return {};
  const record::Recording& recording = run.result.recording;
  const std::map<std::string, double>& metrics = recording.metrics;
  return {{"alone_free", run.result.outcome == Outcome::kGoal ? 1 : 0},
          {"alone_jerk_rms", metrics.at("jerk_rms")},
          {"alone_clearance_m", metrics.at("min_clearance_m")}};
}

struct PredictionPair {
  const RunRow *with = nullptr, *without = nullptr;
};

std::map<std::string, PredictionPair> PredictionPairsOf(const Evidence& evidence) {
  std::map<std::string, PredictionPair> pairs;
  for (const RunRow& row : evidence.rows) {
    if (!IsOfGroup(row, validation_group::kPrediction) || row.metrics.empty()) continue;
    const std::string same = row.factors.at("behaviour") + " " + row.factors.at("speed_m_s") + " " +
                             row.factors.at("draw");
    const bool is_with = row.factors.at("knowledge") == "prediction";
    (is_with ? pairs[same].with : pairs[same].without) = &row;
  }
  return pairs;
}

ItemFinding JudgePredictionValue(const Evidence& evidence) {
  int num_pairs = 0, free_with = 0, free_without = 0;
  std::vector<double> jerk_ratios, clearance_gains_m;
  ItemFinding finding;
  for (const auto& [same, pair] : PredictionPairsOf(evidence)) {
    if (pair.with == nullptr || pair.without == nullptr) continue;
    ++num_pairs;
    const auto fact = [](const RunRow* row, const char* name) { return row->metrics.at(name); };
    const bool with = fact(pair.with, "alone_free") == 1;
    const bool without = fact(pair.without, "alone_free") == 1;
    free_with += with ? 1 : 0;
    free_without += without ? 1 : 0;
    clearance_gains_m.push_back(fact(pair.with, "alone_clearance_m") -
                                fact(pair.without, "alone_clearance_m"));
    if (with && without) {
      jerk_ratios.push_back(std::pow(fact(pair.with, "alone_jerk_rms"), 2) /
                            std::pow(fact(pair.without, "alone_jerk_rms"), 2));
    }
    if (!with && finding.worst.size() < 3) {
      finding.worst.push_back({NameOf(*pair.with), pair.with->outcome + " with prediction"});
    }
  }
  if (num_pairs == 0) return NothingRun("no pair of episodes was run");
  const double jerk = Quantile(jerk_ratios, 0.5), gain_m = Quantile(clearance_gains_m, 0.5);
  const bool is_smoother = jerk_ratios.empty() || jerk <= 1;
  // A planner that looks at nothing is as good without, and is not to pass for it.
  const bool is_used = std::any_of(clearance_gains_m.begin(), clearance_gains_m.end(),
                                   [](double gain) { return gain != 0; });
  const bool passes = is_used && free_with >= free_without && gain_m >= 0 && is_smoother;
  finding.verdict = passes ? ItemVerdict::kPass : ItemVerdict::kFail;
  finding.evidence = fmt::format(
      "{} pairs of episodes without a supervisor that acts: with prediction {} reach the goal and "
      "touch nothing, planning on the world as it is now {}; the median of the least clearance is "
      "{:+.0f} mm with prediction, that of the squared jerk {:.2f} times as much",
      num_pairs, free_with, free_without, 1e3 * gain_m, jerk_ratios.empty() ? NAN : jerk);
  if (!is_used) finding.evidence += "; it makes no difference at all to this planner";
  return finding;
}

}  // namespace

ValidationItem PredictionValueItem() {
  return {18,
          "what prediction is worth",
          "as many goals, as much clearance and no more squared jerk than planning on the world as "
          "it is now",
          "the claim of Finean, Merkt & Havoutis, ICAPS 2021",
          MeasurePredictionValue,
          JudgePredictionValue};
}

}  // namespace sidestep::bench
