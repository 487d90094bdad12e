#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/import/sphere_cover.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/sim/mujoco_model.h"
#include "sidestep/sim/robot_solids.h"
#include "sidestep/sim/robot_survey.h"

namespace sidestep::cli {

/// A robot and its body.
struct CheckedRobot {
  std::string file;  ///< robot.yaml, or that of a variant
  std::string mjcf;
  robot::RobotModel robot;
  sim::MujocoModelPtr model;
};

/// @param name a robot of `models_dir`, with a variant or not (`panda:covered`); or a path, with a
///   / or ending in .yaml: a folder, or a robot.yaml or variant in it.
/// @throws InputError, also where robot.yaml and MJCF disagree.
CheckedRobot LoadRobot(const std::string& name, const ModelFolders& models);

/// How well the spheres of one link cover its solids.
struct LinkReport {
  sim::RigidLink link;
  std::string name;
  imports::CoverCheck cover;  ///< of a link with solids
  std::string body;           ///< of the MJCF, that sticks out furthest
};

struct TouchingPose {
  std::string configuration;
  std::vector<sim::SelfContact> contacts;
};

struct RobotReport {
  int num_frames = 0;  ///< configurations at which frames were compared
  sim::FrameDifference frames;
  /// The limits that are not given, and of which joints.
  std::vector<std::pair<std::string, std::vector<std::string>>> missing_limits;
  std::vector<TouchingPose> touching;  ///< named configurations, where something touches
  std::vector<LinkReport> links;
  double uncovered_m = 0;  ///< the worst of all links
  double excess = 0;       ///< of volume, all links together
  std::uint64_t seed = 0;
  sim::SelfContactSurvey self_contacts;
};

/// @param configurations how many random ones are searched for contacts.
RobotReport ReportOn(const CheckedRobot& checked, int configurations, std::uint64_t seed);

/// The report for people, and as JSON.
std::string ReportText(const CheckedRobot& checked, const RobotReport& report);
std::string ReportJson(const CheckedRobot& checked, const RobotReport& report);

/// The solids of a link as covers want them.
imports::LinkSolids SolidsToCover(const sim::RigidLink& link);

}  // namespace sidestep::cli
