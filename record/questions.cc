#include "sidestep/record/questions.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>
#include <vector>

namespace sidestep::record {
namespace {

const EpisodeTime kEver(std::numeric_limits<double>::infinity());

// A sample says that something was touched since the sample before; which step it was, if known.
Touch TouchOf(const TruthSample& sample) {
  const bool timed = std::isfinite(sample.contact_s);
  return {timed ? EpisodeTime(sample.contact_s) : sample.t, sample.contact_object,
          sample.p_WContact};
}

constexpr std::string_view kHold = "hold", kBrake = "brake";  // words of control/safety.h

int GravityOf(const SafetyEvent& event) {
  return event.reaction == kBrake ? 3 : event.reaction == kHold ? 2 : event.reaction == "refuse";
}

}  // namespace

EpisodeTime EndOf(const Recording& recording) {
  EpisodeTime end;
  if (!recording.control.empty()) end = std::max(end, recording.control.back().t);
  if (!recording.truth.empty()) end = std::max(end, recording.truth.back().t);
  return end;
}

std::optional<std::string> WhyAborted(const Recording& recording) {
  const auto outcome = recording.header.find("outcome");
  if (outcome == recording.header.end() || outcome->second != "aborted") return std::nullopt;
  const auto reason = recording.header.find("reason");
  return reason == recording.header.end() ? "the trace does not say why" : reason->second;
}

const ControlSample* TickAt(const Recording& recording, EpisodeTime t) {
  const std::vector<ControlSample>& ticks = recording.control;
  if (ticks.empty()) return nullptr;
  const auto next =
      std::upper_bound(ticks.begin(), ticks.end(), t,
                       [](EpisodeTime at, const ControlSample& tick) { return at < tick.t; });
  return next == ticks.begin() ? &*next : &*std::prev(next);
}

std::optional<Touch> FirstTouch(const Recording& recording) { return FirstTouch(recording, kEver); }

std::optional<Touch> FirstTouch(const Recording& recording, EpisodeTime t) {
  const auto first = std::find_if(recording.truth.begin(), recording.truth.end(),
                                  [](const TruthSample& sample) { return sample.in_contact; });
  if (first == recording.truth.end()) return std::nullopt;
  const Touch touch = TouchOf(*first);
  return touch.t <= t ? std::optional<Touch>(touch) : std::nullopt;
}

std::optional<Touch> TouchWithin(const Recording& recording, EpisodeTime t, HorizonOffset window) {
  std::optional<Touch> latest;
  for (const TruthSample& sample : recording.truth) {
    if (!sample.in_contact) continue;
    const Touch touch = TouchOf(sample);
    if (touch.t <= t && sample.t >= t - window) latest = touch;
  }
  return latest;
}

std::optional<Clearance> ClearanceAt(const Recording& recording, EpisodeTime t) {
  if (recording.truth.empty()) return std::nullopt;
  const auto next =
      std::upper_bound(recording.truth.begin(), recording.truth.end(), t,
                       [](EpisodeTime at, const TruthSample& sample) { return at < sample.t; });
  const TruthSample& sample = next == recording.truth.begin() ? *next : *std::prev(next);
  return Clearance{sample.t, sample.clearance_m};
}

std::optional<Clearance> LeastClearance(const Recording& recording) {
  return LeastClearance(recording, kEver);
}

std::optional<Clearance> LeastClearance(const Recording& recording, EpisodeTime t) {
  std::optional<Clearance> least;
  for (const TruthSample& sample : recording.truth) {
    if (sample.t > t) break;
    if (!least || sample.clearance_m < least->clearance_m) least = {sample.t, sample.clearance_m};
  }
  return least;
}

std::optional<SafetyEvent> FindingWithin(const Recording& recording, EpisodeTime t,
                                         HorizonOffset window) {
  std::optional<SafetyEvent> gravest;
  for (const SafetyEvent& event : recording.safety) {
    if (event.t > t || event.t < t - window) continue;
    if (!gravest || GravityOf(event) >= GravityOf(*gravest)) gravest = event;
  }
  return gravest;
}

std::optional<EpisodeTime> FirstStop(const Recording& recording) {
  for (const SafetyEvent& event : recording.safety) {
    if (event.reaction == kHold || event.reaction == kBrake) return event.t;
  }
  return std::nullopt;
}

}  // namespace sidestep::record
