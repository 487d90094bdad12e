// A moving arm touches nothing. An arm at rest may be run into, and its base: that is no motion of
// ours.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "sidestep/bench/validation/support.h"
#include "sidestep/record/questions.h"

namespace sidestep::bench {
namespace {

constexpr double kSameMoment_s = 2e-3;

Facts MeasureContactInMotion(const ValidationRun& run) {
  const record::Recording& recording = run.result.recording;
  if (recording.truth.empty()) return {};
  bool in_motion = false, at_rest = false;
  double speed_m_s = 0;
  for (const TruthSample& sample : recording.truth) {
    if (!sample.in_contact) continue;
    const EpisodeTime t =
        std::isfinite(sample.contact_s) ? EpisodeTime(sample.contact_s) : sample.t;
    if (IsBase(run.robot, sample)) {
      at_rest = true;
      continue;
    }
    bool moves = false;
    for (const double aside_s : {-kSameMoment_s, 0.0, kSameMoment_s}) {
      const ControlSample* const tick = record::TickAt(recording, t + HorizonOffset(aside_s));
      if (tick == nullptr || !IsToldToMove(*tick)) continue;
      moves = true;
      speed_m_s = std::max(speed_m_s, FastestSphere_m_s(run.robot, *tick));
    }
    (moves ? in_motion : at_rest) = true;
  }
  Facts facts = {{"contact_in_motion", in_motion ? 1 : 0},
                 {"contact_at_rest_only", at_rest && !in_motion ? 1 : 0}};
  if (in_motion) facts["contact_speed_m_s"] = speed_m_s;
  return facts;
}

ItemFinding JudgeContactInMotion(const Evidence& evidence) {
  const auto is_beyond = [](const RunRow& row) {
    return IsOfGroup(row, validation_group::kSudden) || IsOfGroup(row, validation_group::kFast);
  };
  const std::vector<Told> within = LargestFirst(evidence, "contact_in_motion", IsWithinEnvelope);
  const std::vector<Told> at_rest =
      LargestFirst(evidence, "contact_at_rest_only", IsWithinEnvelope);
  const std::vector<Told> beyond = LargestFirst(evidence, "contact_in_motion", is_beyond);
  const std::vector<Told> speeds = LargestFirst(evidence, "contact_speed_m_s", is_beyond);
  if (within.empty()) return NothingRun("no episode was run in which contacts are known");
  ItemFinding finding;
  finding.verdict = SumOf(within) == 0 ? ItemVerdict::kPass : ItemVerdict::kFail;
  finding.evidence = fmt::format(
      "a moving arm touched something in {} of {} episodes within the envelope (an arm "
      "at rest was run into in {})",
      SumOf(within), within.size(), SumOf(at_rest));
  if (!beyond.empty()) {
    finding.evidence += fmt::format("; beyond it in {} of {}", SumOf(beyond), beyond.size());
    if (!speeds.empty()) {
      finding.evidence +=
          fmt::format(", its fastest part then at most {:.2f} m/s", speeds.front().value);
    }
    finding.evidence += ", where nothing is promised";
  }
  for (const std::vector<Told>* const told : {&within, &beyond}) {
    for (const Told& one : *told) {
      if (one.value == 0 || finding.worst.size() == 3) break;
      finding.worst.push_back({NameOf(*one.row), "touched in motion"});
    }
  }
  return finding;
}

}  // namespace

ValidationItem ContactInMotionItem() {
  return {8,
          "contact of a moving arm",
          "none within the declared envelope; beyond it, told",
          "speed and separation monitoring: at rest before contact",
          MeasureContactInMotion,
          JudgeContactInMotion};
}

}  // namespace sidestep::bench
