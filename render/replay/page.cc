#include "sidestep/render/replay/page.h"

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "sidestep/core/base64.h"
#include "sidestep/core/markup.h"
#include "sidestep/core/page_template.h"
#include "sidestep/core/utf8.h"
#include "sidestep/render/replay/web_files.h"
#include "sidestep/render/scene_painter.h"

namespace sidestep::render {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little);

std::string Bytes(const std::vector<std::uint8_t>& bytes) {
  return Base64({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

std::string Floats(const std::vector<float>& values) {
  return Base64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
}

std::string Floats(const std::vector<double>& values) {
  return Floats(std::vector<float>(values.begin(), values.end()));
}

void Append(const Eigen::Vector3d& p, std::vector<float>* values) {
  for (const double x : p) values->push_back(static_cast<float>(x));
}

std::string PointFloats(const Eigen::Matrix3Xd& points) {
  std::vector<float> values;
  for (Eigen::Index i = 0; i < points.cols(); ++i) Append(points.col(i), &values);
  return Floats(values);
}

// x, y, z and the quaternion as x, y, z, w, which is the browser's order.
void Append(const Pose& X, std::vector<float>* values) {
  Append(X.translation(), values);
  for (const double c : X.rotation().coeffs()) values->push_back(static_cast<float>(c));
}

std::string Poses(const std::vector<Pose>& poses) {
  std::vector<float> values;
  for (const Pose& pose : poses) Append(pose, &values);
  return Floats(values);
}

Json Numbers(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

std::string Text(const std::string& text) { return EscapeInvalidUtf8(text); }

const char* ToString(ReplayShape shape) {
  switch (shape) {
    case ReplayShape::kPlane:
      return "plane";
    case ReplayShape::kSphere:
      return "sphere";
    case ReplayShape::kCapsule:
      return "capsule";
    case ReplayShape::kEllipsoid:
      return "ellipsoid";
    case ReplayShape::kCylinder:
      return "cylinder";
    case ReplayShape::kBox:
      return "box";
    case ReplayShape::kMesh:
      return "mesh";
  }
  return "";
}

const char* ToString(ReplayRole role) {
  switch (role) {
    case ReplayRole::kScenery:
      return "scenery";
    case ReplayRole::kRobot:
      return "robot";
    case ReplayRole::kObstacle:
      return "obstacle";
    case ReplayRole::kContactBox:
      return "contact_box";
  }
  return "";
}

const char* ToString(Mood mood) {
  switch (mood) {
    case Mood::kNeutral:
      return "neutral";
    case Mood::kGood:
      return "good";
    case Mood::kNear:
      return "near";
    case Mood::kBad:
      return "bad";
  }
  return "";
}

Json GeomsJson(const Replay& replay) {
  Json geoms = Json::array();
  for (const ReplayGeom& geom : replay.geoms) {
    std::vector<float> pose;
    Append(geom.X_BG, &pose);
    geoms.push_back({{"shape", ToString(geom.shape)},
                     {"size", Numbers(geom.size_m)},
                     {"rgba", geom.rgba},
                     {"role", ToString(geom.role)},
                     {"mesh", geom.mesh},
                     {"body", geom.body},
                     {"pose", pose}});
  }
  return geoms;
}

Json MeshesJson(const Replay& replay) {
  Json meshes = Json::array();
  for (const ReplayMesh& mesh : replay.meshes) {
    const auto floats = mesh.vertices_m.reshaped();
    const auto corners = mesh.triangles.reshaped();
    meshes.push_back({{"vertices", Floats(std::vector<float>(floats.begin(), floats.end()))},
                      {"triangles", std::vector<int>(corners.begin(), corners.end())}});
  }
  return meshes;
}

Json FramesJson(const Replay& replay) {
  std::vector<float> poses;
  for (const std::vector<Pose>& frame : replay.X_WB) {
    for (const Pose& pose : frame) Append(pose, &poses);
  }
  return {{"step_s", replay.step_s},
          {"count", replay.X_WB.size()},
          {"bodies", replay.X_WB.front().size()},
          {"poses", Floats(poses)},
          {"obstacle_speed", Floats(replay.obstacle_speed_m_s)}};
}

Json SpheresJson(const Replay& replay) {
  std::vector<float> centres;
  for (const Eigen::Matrix3Xd& frame : replay.p_WS) {
    for (Eigen::Index s = 0; s < frame.cols(); ++s) Append(frame.col(s), &centres);
  }
  return {{"radii", replay.sphere_radii_m},
          {"centres", Floats(centres)},
          {"why_none", Text(replay.why_no_spheres)}};
}

Json MotionJson(const Replay& replay) {
  Json plans = Json::array(), predictions = Json::array();
  for (const ReplayPlan& plan : replay.plans) {
    plans.push_back(
        {{"effect_s", plan.effect_s}, {"step_s", plan.step_s}, {"path", PointFloats(plan.p_WTip)}});
  }
  for (const ReplayPrediction& prediction : replay.predictions) {
    predictions.push_back({{"effect_s", prediction.effect_s},
                           {"half", Numbers(prediction.half_extents_m)},
                           {"t", Floats(prediction.t_s)},
                           {"poses", Poses(prediction.X_WO)}});
  }
  return {{"trail", {{"step_s", replay.trail_step_s}, {"path", PointFloats(replay.p_WTrail)}}},
          {"plans", plans},
          {"predictions", predictions}};
}

Json TimelineJson(const Replay& replay) {
  Json statuses = Json::array(), marks = Json::array(), touches = Json::array();
  for (const ReplayStatus& status : replay.statuses) {
    statuses.push_back({status.t_s, Text(status.status.text), ToString(status.status.mood)});
  }
  for (const ReplayMark& mark : replay.marks) {
    marks.push_back({mark.t_s, Text(mark.what), mark.kind});
  }
  for (const auto& [t_s, p_W] : replay.touches) touches.push_back({t_s, Numbers(p_W)});
  Json json = {
      {"statuses", statuses},
      {"marks", marks},
      {"touches", touches},
      {"clearance", {{"t", Floats(replay.clearance_t_s)}, {"d", Floats(replay.clearance_m)}}}};
  json["margin_m"] = replay.margin_m ? Json(*replay.margin_m) : Json();
  return json;
}

// Each volume as what differs in it from the one before about the same time ahead, the first from
// one that is free throughout: most does not.
Json FieldJson(const FieldSamples& field) {
  Json json = {{"why_none", Text(field.why_none)}, {"volumes", Json::array()}};
  if (field.volumes.empty()) return json;
  json["size"] = field.grid.size;
  json["first"] = Numbers(field.grid.first_center_m);
  json["cell"] = field.grid.cell_m;
  json["reach"] = field.max_distance_m;
  json["ahead"] = field.ahead_s;
  const std::size_t num_ahead = field.ahead_s.size();
  const std::vector<std::uint8_t> free(field.grid.num_cells(), 255);
  for (std::size_t i = 0; i < field.volumes.size(); ++i) {
    const FieldVolume& volume = field.volumes[i];
    const auto& before = i < num_ahead ? free : field.volumes[i - num_ahead].distance;
    json["volumes"].push_back({{"seen_s", volume.t_seen.seconds()},
                               {"t", volume.t.seconds()},
                               {"changes", Bytes(PackChanges(before, volume.distance))}});
  }
  return json;
}

Json ToJson(const Replay& replay) {
  Json facts = Json::array();
  for (const auto& [name, value] : replay.facts) facts.push_back({name, Text(value)});
  return {{"name", Text(replay.name)},
          {"title", Text(replay.title.name)},
          {"explanation", Text(replay.title.explanation)},
          {"place", Text(replay.place)},
          {"facts", facts},
          {"end_s", replay.end_s},
          {"geoms", GeomsJson(replay)},
          {"meshes", MeshesJson(replay)},
          {"frames", FramesJson(replay)},
          {"spheres", SpheresJson(replay)},
          {"motion", MotionJson(replay)},
          {"timeline", TimelineJson(replay)},
          {"field", FieldJson(replay.field)}};
}

std::string CssColor(Color color) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text = "#";
  for (const std::uint8_t part : {color.r, color.g, color.b}) {
    text += kDigits[part >> 4];
    text += kDigits[part & 15];
  }
  return text;
}

}  // namespace

std::vector<std::uint8_t> PackChanges(const std::vector<std::uint8_t>& before,
                                      const std::vector<std::uint8_t>& now) {
  if (before.size() != now.size()) throw std::invalid_argument("PackChanges: two lengths");
  constexpr std::size_t kGap = 3;  // so few that stay are not worth a new piece
  std::vector<std::uint8_t> packed;
  const auto append_count = [&](std::size_t count) {
    for (; count >= 128; count >>= 7) packed.push_back(static_cast<std::uint8_t>(count | 128));
    packed.push_back(static_cast<std::uint8_t>(count));
  };
  std::size_t written = 0;
  for (std::size_t at = 0; at < now.size(); ++at) {
    if (now[at] == before[at]) continue;
    std::size_t end = at + 1;
    for (std::size_t next = end; next < now.size() && next < end + kGap; ++next) {
      if (now[next] != before[next]) end = next + 1;
    }
    append_count(at - written);
    append_count(end - at);
    packed.insert(packed.end(), now.begin() + static_cast<std::ptrdiff_t>(at),
                  now.begin() + static_cast<std::ptrdiff_t>(end));
    written = end;
    at = end;  // this one stays
  }
  return packed;
}

std::string ReplayJson(const ReplaySet& set) {
  Json traces = Json::array();
  for (const Replay& replay : set.replays) traces.push_back(ToJson(replay));
  const Json data = {{"colors",
                      {{"plan", CssColor(kPlanColor)},
                       {"trail", CssColor(kTrailColor)},
                       {"prediction", CssColor(kPredictionColor)},
                       {"contact", CssColor(kContactColor)}}},
                     {"view",
                      {{"eye", Numbers(set.view.position_m())},
                       {"target", Numbers(set.view.lookat_m)},
                       {"field_of_view_rad", kReplayFieldOfView_rad}}},
                     {"traces", traces}};
  return ScriptJson(data.dump());
}

std::string ReplayStyle() { return std::string(kReplayCss); }

std::string ReplayScripts() {
  std::string scripts;
  for (const std::string_view script : {kThreeNoticeJs, kThreeJs, kOrbitControlsJs, kReplayDataJs,
                                        kReplaySceneJs, kReplayChartJs, kReplayJs}) {
    scripts += "<script>\n" + std::string(script) + "\n</script>\n";
  }
  return scripts;
}

std::string ReplayPage(const std::string& title, const ReplaySet& set) {
  return FillTemplate(kReplayPageHtml, {{"title", EscapeMarkup(Text(title))},
                                        {"style", ReplayStyle()},
                                        {"scripts", ReplayScripts()},
                                        {"data", ReplayJson(set)}});
}

}  // namespace sidestep::render
