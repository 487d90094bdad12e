#include "sidestep/render/captions.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sidestep/core/number_text.h"
#include "sidestep/record/questions.h"
#include "sidestep/render/timeline.h"

namespace sidestep::render {
namespace {

constexpr double kNear_m = 0.05;
constexpr double kShowFinding_s = 1;

struct Wording {
  const char* knowledge;
  Title title;
};

std::string Millimetres(double metres) {
  return FiniteText("{:.0f} mm", std::round(1000 * metres) + 0.0);  // never -0
}
std::string Seconds(double seconds) { return FiniteText("{:.2f} s", seconds); }

}  // namespace

Title TitleOf(const record::Recording& recording, const std::string& fallback) {
  const Wording wordings[] = {
      {"static", {"Static", "saw the world once, at the start"}},
      {"execute_and_update", {"Execute and update", "re-plans around where things are now"}},
      {"prediction", {"Prediction", "re-plans around where things will be"}},
      {"full_knowledge", {"Full knowledge", "is told the true future"}},
  };
  const auto knowledge = recording.header.find("knowledge");
  if (knowledge == recording.header.end()) return {fallback, ""};
  for (const Wording& wording : wordings) {
    if (knowledge->second == wording.knowledge) return wording.title;
  }
  return {knowledge->second, ""};
}

Color ColorOf(Mood mood) {
  switch (mood) {
    case Mood::kNeutral:
      return {52, 60, 72};
    case Mood::kGood:
      return {28, 122, 68};
    case Mood::kNear:
      return {166, 104, 10};
    case Mood::kBad:
      return {196, 30, 34};
  }
  return {};
}

namespace {

// "supervisor BRAKES: stop path": what it did in the last second.
std::string Supervision(const SafetyEvent& event) {
  const struct {
    const char *reaction, *words;
  } wordings[] = {{"refuse", "refuses a plan"}, {"hold", "HOLDS"}, {"brake", "BRAKES"}};
  std::string text = "supervisor notes";
  for (const auto& [reaction, words] : wordings) {
    if (event.reaction == reaction) text = std::string("supervisor ") + words;
  }
  std::string check = event.check;
  std::replace(check.begin(), check.end(), '_', ' ');
  return text + ": " + check;
}

Status EpisodeStatusAt(const record::Recording& recording, EpisodeTime t) {
  const bool is_cut_off = record::WhyAborted(recording) && t >= record::EndOf(recording);
  const std::string cut_off =
      is_cut_off ? "ABORTED at " + Seconds(record::EndOf(recording).seconds()) : "";
  const std::optional<record::Touch> touch = record::FirstTouch(recording, t);
  if (touch) {
    return {"CONTACT at " + Seconds(touch->t.seconds()) +
                (touch->object.empty() ? "" : " with " + touch->object) +
                (is_cut_off ? ", " + cut_off : ""),
            Mood::kBad};
  }
  if (is_cut_off) return {cut_off, Mood::kBad};
  const std::optional<record::Clearance> least = record::LeastClearance(recording, t);
  const std::string least_text = least ? "least clearance " + Millimetres(least->clearance_m) : "";
  const auto goal = recording.metrics.find("time_to_goal_s");
  const bool knows_goal = goal != recording.metrics.end();
  if (knows_goal && goal->second <= t.seconds() && recording.truth.empty()) {
    return {"goal reached at " + Seconds(goal->second) + ", contact unjudged", Mood::kNeutral};
  }
  if (knows_goal && goal->second <= t.seconds()) {
    return {"goal reached at " + Seconds(goal->second) + (least ? ", " + least_text : ""),
            Mood::kGood};
  }
  if (knows_goal && t >= record::EndOf(recording)) {
    return {"goal not reached, " + (least ? least_text : "contact unjudged"), Mood::kNear};
  }
  const std::optional<record::Clearance> now = record::ClearanceAt(recording, t);
  if (!now) {
    const auto outcome = recording.header.find("outcome");
    const bool is_unjudged = outcome != recording.header.end() && outcome->second == "unjudged";
    return {is_unjudged ? "contact unjudged" : "", Mood::kNeutral};
  }
  return {"clearance " + Millimetres(now->clearance_m) +
              (least ? ", least so far " + Millimetres(least->clearance_m) : ""),
          now->clearance_m < kNear_m ? Mood::kNear : Mood::kNeutral};
}

}  // namespace

Status StatusAt(const record::Recording& recording, EpisodeTime t) {
  Status status = EpisodeStatusAt(recording, t);
  const auto found = record::FindingWithin(recording, t, HorizonOffset(kShowFinding_s));
  if (!found) return status;
  status.text = Supervision(*found) + (status.text.empty() ? "" : "; " + status.text);
  const bool stops = found->reaction == "hold" || found->reaction == "brake";
  if (stops && status.mood != Mood::kBad) status.mood = Mood::kNear;
  return status;
}

std::string PlaceOf(const record::Recording& recording) {
  const auto robot_at = recording.header.find("robot_at");
  if (robot_at == recording.header.end()) return "";
  const auto camera = recording.header.find("camera");
  const std::string obstacles = camera == recording.header.end()
                                    ? ", obstacles virtual"
                                    : ", obstacles seen by a camera (" + camera->second + ")";
  return "robot at " + robot_at->second + (recording.obstacles.empty() ? "" : obstacles);
}

}  // namespace sidestep::render
