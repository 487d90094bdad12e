// Long and at random.
#include <fmt/core.h>

#include <cmath>

#include "sidestep/bench/validation/support.h"

namespace sidestep::bench {
namespace {

constexpr double kMostGrowth = 0.01;
constexpr std::size_t kLeastEpisodes = 2000;

ItemFinding JudgeSoak(const Evidence& evidence) {
  const auto is_soak = [](const RunRow& row) { return IsOfGroup(row, validation_group::kSoak); };
  const std::vector<Told> touched = LargestFirst(evidence, "contact_in_motion", is_soak);
  if (touched.empty()) return NothingRun("--soak runs it, for an hour or so");
  int failed = 0;
  for (const RunRow& row : evidence.rows) failed += is_soak(row) && row.outcome == kFailed;
  ItemFinding finding;
  const double growth = evidence.memory_growth.value_or(0);
  const bool passes = SumOf(touched) == 0 && failed == 0 && growth <= kMostGrowth;
  const bool is_long = touched.size() >= kLeastEpisodes;
  finding.verdict =
      !passes ? ItemVerdict::kFail : (is_long ? ItemVerdict::kPass : ItemVerdict::kNotRun);
  finding.evidence = fmt::format(
      "{} episodes at random within the envelope: a moving arm touched something in {}, {} could "
      "not be run",
      touched.size(), SumOf(touched), failed);
  if (!is_long) finding.evidence += fmt::format("; that is short of {}", kLeastEpisodes);
  if (growth > kMostGrowth) finding.evidence += "; the program grew by more than 1 %";
  if (SumOf(touched) > 0) finding.worst = WorstOf(touched, 0, "touched in motion");
  return finding;
}

}  // namespace

ValidationItem SoakItem() {
  return {19,
          "soak",
          "no contact of a moving arm in 2000 random episodes; no growth of memory",
          "what is rare shows in numbers alone",
          nullptr,
          JudgeSoak};
}

}  // namespace sidestep::bench
