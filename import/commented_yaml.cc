#include "sidestep/import/commented_yaml.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <sstream>

#include "sidestep/core/utf8.h"

namespace sidestep::imports {
namespace {

// By the key's path; lists' items have the path of the list.
const std::map<std::string, std::vector<std::string>>& Comments() {
  static const std::map<std::string, std::vector<std::string>> comments = {
      {"robot", {"Which robot, and where its base stands in the world (z is up, lengths in m)."}},
      {"robot.base", {"Turn it by rpy_rad: [roll, pitch, yaw] beside position_m."}},
      {"robot.mount", {"What it stands on, and may touch with its foot; without it, the floor."}},
      {"task",
       {"From where to where: a named configuration of the robot, or one number a joint, in rad",
        "(in m of one that slides)."}},
      {"task.dwell_s", {"How long to stay at the goal for it to be reached [s]."}},
      {"horizon",
       {"How far ahead plans reach, and from one support state to the next. An episode takes at",
        "most twice as long."}},
      {"workspace",
       {"The grid in which things are seen: the centre of its first cell, the edge of a cell, and",
        "how many along x, y and z. Let it hold all that the arm can reach."}},
      {"floor_m", {"The height of the floor: solid, and known exactly."}},
      {"static_world",
       {"How what stands still is known to the planner: exact (by its shapes) or occupancy (as the",
        "sensor sees it, by cells)."}},
      {"static_boxes", {"What stands still: boxes with full edges."}},
      {"static_obstacles",
       {"What stands still, of any shape: box, sphere, capsule, cylinder, ellipsoid, "
        "convex_mesh."}},
      {"moving_obstacles",
       {"What moves, as prescribed. Other motions: waypoints, accelerated, circle, random_walk,",
        "walk, recorded."}},
      {"planner", {"One of `sidestep list planners`, which tells what each can be set to."}},
      {"planner.epsilon_m", {"Obstacles cost from this clearance on [m]."}},
      {"planner.velocity_scale", {"How much of the robot's limits plans may use."}},
      {"planner.growth_sigmas",
       {"Moving things are taken to be thicker by so many standard deviations of where they are",
        "predicted to be, but by no more than the limit."}},
      {"planner.position_limits", {"Which limits plans keep to."}},
      {"replanning",
       {"How often plans are made, and what a cycle takes of the episode's time: charged (always",
        "latency_s), measured or none. iterations: work that a cycle may cost; 0: no end."}},
      {"safety",
       {"The supervisor of the robot: off, observe or lab, and what obstacles are declared to "
        "do."}},
      {"knowledge",
       {"What the planner is told of moving things: static (they stay where they were first seen),",
        "execute_and_update (they stay where they are), prediction, full_knowledge."}},
      {"predictor", {"How they are predicted: one of `sidestep list predictors`."}},
      {"sensor", {"One of `sidestep list sensors`, and what is wrong with it."}},
      {"seed", {"Everything random follows from it."}}};
  return comments;
}

// The key that a line of ToYaml begins with, and how far in; empty where a list's item begins.
std::string KeyOf(const std::string& line, std::size_t& indent) {
  indent = line.find_first_not_of(' ');
  if (indent == std::string::npos || line[indent] == '-') return "";
  std::size_t end = indent;
  while (end < line.size() &&
         (std::isalnum(static_cast<unsigned char>(line[end])) != 0 || line[end] == '_')) {
    ++end;
  }
  return end < line.size() && line[end] == ':' ? line.substr(indent, end - indent) : "";
}

}  // namespace

std::string CommentedYaml(const scenarios::Scenario& scenario,
                          const std::vector<std::string>& head) {
  std::string text;
  for (const std::string& one : head) {
    std::istringstream parts(EscapeInvalidUtf8(one.empty() ? "\n" : one));
    for (std::string part; std::getline(parts, part);) {
      text += part.empty() ? "#\n" : "# " + part + "\n";
    }
  }
  std::istringstream lines(ToYaml(scenario));
  std::string top;
  for (std::string line; std::getline(lines, line);) {
    std::size_t indent = 0;
    const std::string key = KeyOf(line, indent);
    if (indent == 0) top = key;
    const bool is_known_place = !key.empty() && (indent == 0 || indent == 2);
    const auto found = Comments().find(indent == 0 ? key : top + "." + key);
    if (is_known_place && found != Comments().end()) {
      if (indent == 0) text += "\n";
      for (const std::string& comment : found->second) {
        text += std::string(indent, ' ') + "# " + comment + "\n";
      }
    }
    text += line + "\n";
  }
  return text;
}

}  // namespace sidestep::imports
