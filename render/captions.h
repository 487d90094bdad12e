#pragma once

#include <string>

#include "sidestep/core/time.h"
#include "sidestep/record/recording.h"
#include "sidestep/render/image.h"

namespace sidestep::render {

/// A trace's name and, in plain words, what its planner was told about the moving world.
struct Title {
  std::string name;
  std::string explanation;  ///< may be empty
};
/// From the header's `knowledge`; without one, `fallback` is the name.
Title TitleOf(const record::Recording& recording, const std::string& fallback);

enum class Mood { kNeutral, kGood, kNear, kBad };
Color ColorOf(Mood mood);  ///< for a bar under white text

/// How an episode stands at one moment.
struct Status {
  std::string text;
  Mood mood = Mood::kNeutral;
};
/// A contact stays in the status for good. The goal counts as reached at the metric
/// `time_to_goal_s`; without a truth nobody judged contact, and it says so. What was aborted says
/// so at its end. What the robot's supervisor found stands before it for a second.
Status StatusAt(const record::Recording& recording, EpisodeTime t);

/// Where the robot was, on hardware, and what its obstacles were: "robot at 172.16.0.2, obstacles
/// virtual". Empty for a simulation.
std::string PlaceOf(const record::Recording& recording);

}  // namespace sidestep::render
