// How fast the tool is.
#include <fmt/core.h>

#include <algorithm>

#include "sidestep/bench/validation/support.h"

namespace sidestep::bench {
namespace {

constexpr double kMost_m_s = 0.5, kMostAtFirst_m_s = 0.25;

Facts MeasureToolSpeed(const ValidationRun& run) {
  const record::Recording& recording = run.result.recording;
  double most_m_s = 0;
  for (std::size_t i = 1; i < recording.p_WTool.size(); ++i) {
    const double dt_s = (recording.control[i].t - recording.control[i - 1].t).seconds();
    most_m_s = std::max(most_m_s, (recording.p_WTool[i] - recording.p_WTool[i - 1]).norm() / dt_s);
  }
  return {{"tool_speed_m_s", most_m_s}};
}

ItemFinding JudgeToolSpeed(const Evidence& evidence) {
  const std::vector<Told> told = LargestFirst(evidence, "tool_speed_m_s", IsWithinEnvelope);
  if (told.empty()) return NothingRun("no episode was run");
  const double most_m_s = told.front().value;
  const double gate_m_s = std::min(kMost_m_s, evidence.scenario.safety.tool_speed_m_s);
  ItemFinding finding;
  finding.verdict = most_m_s <= gate_m_s ? ItemVerdict::kPass : ItemVerdict::kFail;
  finding.evidence = fmt::format("at most {:.3f} m/s", most_m_s);
  if (most_m_s > kMostAtFirst_m_s && most_m_s <= kMost_m_s) {
    finding.evidence += ": not for the first sessions";
  }
  finding.worst = WorstOf(told, gate_m_s, "{:.3f} m/s");
  return finding;
}

}  // namespace

ValidationItem ToolSpeedItem() {
  return {6,
          "speed of the tool",
          "at most 0.5 m/s, and safety.tool_speed_m_s; 0.25 m/s in the first sessions",
          "reduced speed of ISO 10218-1: 250 mm/s",
          MeasureToolSpeed,
          JudgeToolSpeed};
}

}  // namespace sidestep::bench
