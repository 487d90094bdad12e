// The same seed gives the same bits.
#include <fmt/core.h>

#include <cstring>
#include <map>

#include "sidestep/bench/validation/support.h"
#include "sidestep/core/fnv1a.h"

namespace sidestep::bench {
namespace {

// Of every command that was sent, in 52 bits, which a double holds.
double HashOf(const record::Recording& recording) {
  std::uint64_t hash = kFnv1aBasis;
  for (const ControlSample& tick : recording.control) {
    for (const double q : tick.q_command) {
      unsigned char bytes[sizeof(q)];
      std::memcpy(bytes, &q, sizeof(q));
      for (const unsigned char byte : bytes) hash = Fnv1a(hash, byte);
    }
  }
  return static_cast<double>(hash >> 12);
}

Facts MeasureDeterminism(const ValidationRun& run) {
  return {{"commands_hash", HashOf(run.result.recording)}};
}

// What a repetition repeats.
std::string Same(const RunRow& row) {
  Factors factors = row.factors;
  factors.erase("group");
  factors.erase("case");
  std::string text;
  for (const auto& [factor, value] : factors) text += value + " ";
  return text;
}

ItemFinding JudgeDeterminism(const Evidence& evidence) {
  std::map<std::string, double> hashes;
  for (const RunRow& row : evidence.rows) {
    if (!IsOfGroup(row, validation_group::kEnvelope)) continue;
    const auto hash = row.metrics.find("commands_hash");
    if (hash != row.metrics.end()) hashes[Same(row)] = hash->second;
  }
  ItemFinding finding{ItemVerdict::kPass, "", {}};
  int repeated = 0, equal = 0;
  for (const RunRow& row : evidence.rows) {
    const auto hash = row.metrics.find("commands_hash");
    if (!IsOfGroup(row, validation_group::kRepeat) || hash == row.metrics.end()) continue;
    const auto first = hashes.find(Same(row));
    if (first == hashes.end()) continue;
    ++repeated;
    if (first->second == hash->second) {
      ++equal;
      continue;
    }
    finding.verdict = ItemVerdict::kFail;
    finding.worst.push_back({NameOf(row), "sent other commands the second time"});
  }
  if (repeated == 0) return NothingRun("no episode was run twice");
  finding.evidence = fmt::format("{} of {} episodes sent the same bits again", equal, repeated);
  return finding;
}

}  // namespace

ValidationItem DeterminismItem() {
  return {15,
          "determinism",
          "the same commands again, to the bit, in lock-step too",
          "what cannot be repeated cannot be understood",
          MeasureDeterminism,
          JudgeDeterminism};
}

}  // namespace sidestep::bench
