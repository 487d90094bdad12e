#include "sidestep/cli/robot_check.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "sidestep/bench/json_text.h"
#include "sidestep/core/joined.h"
#include "sidestep/core/model_name.h"
#include "sidestep/core/number_text.h"
#include "sidestep/robot/limit_keys.h"
#include "sidestep/sim/arm_file.h"
#include "sidestep/sim/robot_agreement.h"
#include "sidestep/sim/robot_configuration.h"

namespace sidestep::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kFrames = 1000;
constexpr double kPrecision_m = 1e-5;

imports::TriangleMesh MeshOf(const sim::ConvexHull& hull) {
  imports::TriangleMesh mesh;
  mesh.vertices.resize(3, std::ssize(hull.vertices));
  mesh.triangles.resize(3, std::ssize(hull.faces));
  for (std::size_t i = 0; i < hull.vertices.size(); ++i) {
    mesh.vertices.col(static_cast<Eigen::Index>(i)) = hull.vertices[i];
  }
  for (std::size_t i = 0; i < hull.faces.size(); ++i) {
    mesh.triangles.col(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::Vector3i>(hull.faces[i].data());
  }
  return mesh;
}

std::vector<imports::CoverSphere> SpheresOf(const sim::RigidLink& link) {
  std::vector<imports::CoverSphere> spheres;
  for (const robot::CollisionSphere& sphere : link.spheres) {
    spheres.push_back({sphere.p_LS, sphere.radius_m});
  }
  return spheres;
}

std::vector<std::pair<std::string, std::vector<std::string>>> MissingLimits(
    const robot::RobotModel& robot) {
  std::vector<std::pair<std::string, std::vector<std::string>>> missing;
  for (int i = 0; i < robot.num_joints(); ++i) {
    const auto number = static_cast<std::size_t>(i);
    const robot::JointLimits& limits = robot.limits()[number];
    const robot::Joint& joint =
        robot.joints()[static_cast<std::size_t>(robot.moving_joints()[number])];
    const robot::LimitKeys keys = robot::LimitKeysOf(joint.kind);
    const std::pair<const char*, double> all[] = {
        {keys.q_min, limits.q_min},       {keys.q_max, limits.q_max},
        {keys.v_max, limits.v_max},       {keys.a_max, limits.a_max},
        {keys.jerk_max, limits.jerk_max}, {keys.torque_max, limits.torque_max}};
    for (const auto& [key, value] : all) {
      if (!std::isinf(value)) continue;
      const std::string name = key;
      auto found = std::find_if(missing.begin(), missing.end(),
                                [&name](const auto& one) { return one.first == name; });
      if (found == missing.end()) found = missing.insert(missing.end(), {name, {}});
      found->second.push_back(joint.name);
    }
  }
  return missing;
}

std::string LimitsText(const RobotReport& report, int num_joints) {
  if (report.missing_limits.empty()) {
    return "all there are: position, velocity, acceleration, jerk, torque";
  }
  return "not given: " + Joined(report.missing_limits, "; ", [num_joints](const auto& limit) {
           const bool is_of_all = std::ssize(limit.second) == num_joints;
           return limit.first + " of " + (is_of_all ? "all joints" : Joined(limit.second));
         });
}

// How a pair of links stands.
enum class Standing { kForeseen, kMissed, kNeverTouched, kApart };

struct JudgedPair {
  std::string first, second;
  int touched = 0, false_alarms = 0;
  Standing standing = Standing::kApart;
};

std::vector<JudgedPair> JudgePairs(const robot::RobotModel& robot, const RobotReport& report) {
  std::vector<JudgedPair> judged;
  for (const sim::PairCount& pair : report.self_contacts.pairs) {
    const bool is_listed =
        std::any_of(robot.self_collision().begin(), robot.self_collision().end(),
                    [&](const robot::LinkPair& listed) {
                      return std::minmax({sim::CarrierOf(robot, listed.first),
                                          sim::CarrierOf(robot, listed.second)}) ==
                             std::pair(pair.first, pair.second);
                    });
    const Standing standing = pair.touched > 0
                                  ? (is_listed ? Standing::kForeseen : Standing::kMissed)
                                  : (is_listed ? Standing::kNeverTouched : Standing::kApart);
    judged.push_back({sim::LinkName(robot, pair.first), sim::LinkName(robot, pair.second),
                      pair.touched, pair.false_alarms, standing});
  }
  return judged;
}

std::string PairsText(const std::vector<JudgedPair>& pairs, Standing standing) {
  std::string text;
  for (const JudgedPair& pair : pairs) {
    if (pair.standing != standing) continue;
    const bool is_listed = standing == Standing::kForeseen || standing == Standing::kNeverTouched;
    text += fmt::format("{}{}-{}", text.empty() ? "" : ", ", pair.first, pair.second);
    if (pair.touched > 0) text += fmt::format(" {}", pair.touched);
    if (is_listed) text += fmt::format(" (+{})", pair.false_alarms);
  }
  return text.empty() ? "none" : text;
}

std::string Percent(double share) { return FiniteText("{:.1f}", 100 * share); }
std::string Millimetres(double length_m) { return FiniteText("{:.2f}", 1e3 * length_m, "all"); }

double ExcessOf(const imports::CoverCheck& cover) { return cover.sphere_m3 / cover.solid_m3 - 1; }

Json JsonNumber(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

imports::LinkSolids SolidsToCover(const sim::RigidLink& link) {
  imports::LinkSolids solids{link.shapes, {}};
  for (std::size_t i = 0; i < link.hulls.size(); ++i) {
    solids.meshes.push_back({"a mesh of body '" + link.hull_body[i] + "'", MeshOf(link.hulls[i])});
  }
  return solids;
}

CheckedRobot LoadRobot(const std::string& name, const ModelFolders& models) {
  const bool is_path = name.find('/') != std::string::npos || name.ends_with(".yaml");
  std::string file = name;
  if (!name.ends_with(".yaml")) {
    const std::string own = ModelFolder(name);
    file = (is_path ? own : models.Find(own).value_or(own)) + "/" +
           DescriptionFile(ModelVariant(name));
  }
  robot::RobotModel robot = is_path ? robot::RobotModel::FromFile(file, Pose())
                                    : robot::RobotModel::Load(models, name, Pose());
  const fs::path folder = fs::path(robot.file()).parent_path();
  std::string mjcf = (folder / (robot.name() + ".xml")).string();
  sim::MujocoModelPtr model = sim::LoadArmFile(mjcf);
  sim::CheckAgreement(robot, *model, mjcf);
  return {std::move(file), std::move(mjcf), std::move(robot), std::move(model)};
}

RobotReport ReportOn(const CheckedRobot& checked, int configurations, std::uint64_t seed) {
  const robot::RobotModel& robot = checked.robot;
  RobotReport report;
  report.seed = seed;
  report.num_frames = kFrames;
  report.frames = sim::FindWorstFrame(robot, *checked.model, kFrames, seed);
  report.missing_limits = MissingLimits(robot);
  for (const auto& [name, q] : robot.configurations()) {
    std::vector<sim::SelfContact> contacts = sim::FindSelfContacts(robot, *checked.model, q);
    if (!contacts.empty()) report.touching.push_back({name, std::move(contacts)});
  }
  report.uncovered_m = -std::numeric_limits<double>::infinity();
  double solid_m3 = 0, sphere_m3 = 0;
  for (sim::RigidLink& link : sim::FindRigidLinks(robot, *checked.model)) {
    if (!link.has_solids()) continue;
    LinkReport one;
    one.name = sim::LinkName(robot, link.link);
    one.cover = CheckCover(SolidsToCover(link), SpheresOf(link), kPrecision_m);
    one.body = (one.cover.on_shape ? link.shape_body : link.hull_body)[one.cover.solid];
    one.link = std::move(link);
    report.uncovered_m = std::max(report.uncovered_m, one.cover.uncovered_m);
    solid_m3 += one.cover.solid_m3;
    sphere_m3 += one.cover.sphere_m3;
    report.links.push_back(std::move(one));
  }
  report.excess = sphere_m3 / solid_m3 - 1;
  report.self_contacts = sim::SurveySelfContacts(robot, *checked.model, configurations, seed);
  return report;
}

std::string ReportText(const CheckedRobot& checked, const RobotReport& report) {
  const robot::RobotModel& robot = checked.robot;
  std::string text = fmt::format("robot            {}, {}\n", checked.file, checked.mjcf);
  text += fmt::format(
      "frames           at most {:.1e} m and {:.1e} rad from the MJCF's, at {} random "
      "configurations\n",
      report.frames.apart_m, report.frames.turned_rad, report.num_frames);
  text += fmt::format("limits           {}\n", LimitsText(report, robot.num_joints()));
  text += fmt::format("configurations   {} named, {}\n", robot.configurations().size(),
                      report.touching.empty() ? "none of them touches itself" : "of them touch:");
  for (const TouchingPose& pose : report.touching) {
    for (const sim::SelfContact& contact : pose.contacts) {
      text += fmt::format("  {}: {} touches {}\n", pose.configuration, contact.first_body,
                          contact.second_body);
    }
  }
  text +=
      "\nlink          spheres  sticks out [mm]  at [m]                     body            "
      "excess [%]\n";
  for (const LinkReport& link : report.links) {
    const Eigen::Vector3d& p = link.cover.p_m;
    const bool has_spheres = !link.link.spheres.empty();
    text += fmt::format(
        "{:<13} {:>7}  {:>15}  {:<25}  {:<14}  {:>10}\n", link.name, link.link.spheres.size(),
        Millimetres(link.cover.uncovered_m),
        has_spheres ? fmt::format("{:.3f}, {:.3f}, {:.3f}", p.x(), p.y(), p.z()) : "-",
        has_spheres ? link.body : "-", has_spheres ? Percent(ExcessOf(link.cover)) : "-");
  }
  text +=
      fmt::format("{:<13} {:>7}  {:>15}  {:<25}  {:<14}  {:>10}\n\n", "all", robot.num_spheres(),
                  Millimetres(report.uncovered_m), "", "", Percent(report.excess));
  const std::vector<JudgedPair> pairs = JudgePairs(robot, report);
  const auto apart = std::count_if(pairs.begin(), pairs.end(), [](const JudgedPair& pair) {
    return pair.standing == Standing::kApart;
  });
  text += fmt::format(
      "self-contact     at {} of {} random configurations (seed {}); pairs of links, at "
      "how many they touch (+ at how many only their spheres do)\n",
      report.self_contacts.num_touching, report.self_contacts.num_configurations, report.seed);
  text +=
      fmt::format("  touch, in self_collision       {}\n", PairsText(pairs, Standing::kForeseen));
  text += fmt::format("  touch, not in self_collision   {}\n", PairsText(pairs, Standing::kMissed));
  text += fmt::format("  in self_collision, never touch {}\n",
                      PairsText(pairs, Standing::kNeverTouched));
  text += fmt::format("  never touch                    the other {}\n", apart);
  return text;
}

std::string ReportJson(const CheckedRobot& checked, const RobotReport& report) {
  const robot::RobotModel& robot = checked.robot;
  Json json;
  json["format"] = "sidestep-robot-check-1";
  json["robot"] = robot.name();
  json["file"] = checked.file;
  json["mjcf"] = checked.mjcf;
  json["seed"] = report.seed;
  json["frames"] = {{"configurations", report.num_frames},
                    {"apart_m", report.frames.apart_m},
                    {"turned_rad", report.frames.turned_rad}};
  json["missing_limits"] = Json::object();
  for (const auto& [key, joints] : report.missing_limits) json["missing_limits"][key] = joints;
  json["configurations"] = robot.configurations().size();
  json["touching_configurations"] = Json::array();
  for (const TouchingPose& pose : report.touching) {
    for (const sim::SelfContact& contact : pose.contacts) {
      json["touching_configurations"].push_back({{"name", pose.configuration},
                                                 {"first_body", contact.first_body},
                                                 {"second_body", contact.second_body}});
    }
  }
  json["spheres"] = robot.num_spheres();
  json["uncovered_m"] = JsonNumber(report.uncovered_m);
  json["excess"] = report.excess;
  json["links"] = Json::array();
  for (const LinkReport& link : report.links) {
    const Eigen::Vector3d& p = link.cover.p_m;
    const bool has_spheres = !link.link.spheres.empty();
    json["links"].push_back({{"link", link.name},
                             {"spheres", link.link.spheres.size()},
                             {"uncovered_m", JsonNumber(link.cover.uncovered_m)},
                             {"at_m", has_spheres ? Json({p.x(), p.y(), p.z()}) : Json(nullptr)},
                             {"body", has_spheres ? Json(link.body) : Json(nullptr)},
                             {"solid_m3", link.cover.solid_m3},
                             {"sphere_m3", link.cover.sphere_m3},
                             {"excess", ExcessOf(link.cover)}});
  }
  Json& contacts = json["self_contact"];
  contacts["configurations"] = report.self_contacts.num_configurations;
  contacts["touching"] = report.self_contacts.num_touching;
  contacts["pairs"] = Json::array();
  for (const JudgedPair& pair : JudgePairs(robot, report)) {
    const bool is_listed =
        pair.standing == Standing::kForeseen || pair.standing == Standing::kNeverTouched;
    contacts["pairs"].push_back({{"first", pair.first},
                                 {"second", pair.second},
                                 {"touched", pair.touched},
                                 {"false_alarms", pair.false_alarms},
                                 {"in_self_collision", is_listed}});
  }
  return bench::JsonText(json);
}

}  // namespace sidestep::cli
