// Whatever fails, the arm comes to rest, and stays there unless the cause has gone.
#include "sidestep/bench/validation/faults.h"

#include <fmt/core.h>

#include "sidestep/bench/validation/support.h"

namespace sidestep::bench {
namespace {

bool HoldsAny(const std::string& text, std::string_view words) {
  while (!words.empty()) {
    const std::size_t end = words.find('|');
    if (text.find(words.substr(0, end)) != std::string::npos) return true;
    words = end == std::string_view::npos ? "" : words.substr(end + 1);
  }
  return false;
}

Facts MeasureFaults(const ValidationRun& run) {
  if (run.one.group != validation_group::kFault) return {};
  const ValidationFault& fault = ValidationFaultOf(run.one.fault);
  const record::Recording& recording = run.result.recording;
  std::string told = run.result.reason + "\n";
  for (const SafetyEvent& event : recording.safety) {
    told += event.check + " " + event.reaction + "\n";
  }
  const bool rests = recording.control.empty() || !IsToldToMove(recording.control.back());
  // What the robot itself has ended, by a reflex, moves no more: it says nothing of how it brakes.
  const bool is_ended = run.one.on_the_wire && run.result.outcome == Outcome::kAborted;
  return {{"fault_answered", HoldsAny(told, fault.expected) ? 1 : 0},
          {"fault_rests", rests || is_ended || fault.may_go_on ? 1 : 0}};
}

ItemFinding JudgeFaults(const Evidence& evidence) {
  const auto is_fault = [](const RunRow& row) { return IsOfGroup(row, validation_group::kFault); };
  const std::vector<Told> answered = LargestFirst(evidence, "fault_answered", is_fault);
  const std::vector<Told> rests = LargestFirst(evidence, "fault_rests", is_fault);
  if (answered.empty()) return NothingRun("no episode was run");
  ItemFinding finding{ItemVerdict::kPass, "", {}};
  for (const auto& [told, what] : {std::pair(&answered, "was not answered as it has to be"),
                                   std::pair(&rests, "did not come to rest")}) {
    for (const Told& one : *told) {
      if (one.value == 1) continue;
      finding.verdict = ItemVerdict::kFail;
      const std::string& how = one.row->error.empty() ? one.row->outcome : one.row->error;
      finding.worst.push_back({NameOf(*one.row), std::string(what) + ": " + how});
    }
  }
  finding.evidence = fmt::format(
      "{} of {} faults were answered as docs/safety.md says, and the arm came to rest in {}",
      SumOf(answered), answered.size(), SumOf(rests));
  return finding;
}

}  // namespace

ValidationItem FaultsItem() {
  return {
      14,
      "faults of sensor, network and robot",
      "each is answered as specified; the arm rests, and does not go on by itself after a fault",
      "the checks of docs/safety.md",
      MeasureFaults,
      JudgeFaults};
}

}  // namespace sidestep::bench
