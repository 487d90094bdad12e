#include "sidestep/cli/camera_video.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "sidestep/core/csv.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"
#include "sidestep/hardware/look_log.h"
#include "sidestep/render/camera_view.h"
#include "sidestep/render/timeline.h"
#include "sidestep/render/video_writer.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {
namespace {

constexpr render::Color kSeenColor = {40, 140, 255}, kExpectedColor = {255, 60, 60};
constexpr double kAhead_s[] = {0.5, 1, 1.5};

struct SeenBody {
  std::string name;
  Pose X_WO;
};

// What was found in one picture.
struct Found {
  std::vector<Eigen::Matrix<double, 2, 4>> tags_px;
  std::vector<SeenBody> bodies;
};

std::vector<double> Numbers(const CsvRow& row, const std::string& file) {
  std::vector<double> values;
  std::string word;
  for (const char c : row.fields[3] + " ") {
    if (c != ' ') {
      word += c;
    } else if (!word.empty()) {
      values.push_back(ParseCsvNumber(word, file, row.line, "values"));
      word.clear();
    }
  }
  return values;
}

std::map<std::string, Found> ReadLooks(const std::string& folder) {
  constexpr std::size_t kOfTag = 10, kOfBody = 28;
  const std::string file = (std::filesystem::path(folder) / hardware::LookLog::kTableFile).string();
  const CsvFile table = ReadCsv(file);
  if (table.columns != std::vector<std::string>{"number", "what", "name", "values"}) {
    throw InputError(file, 1, "header", "must be number,what,name,values");
  }
  std::map<std::string, Found> looks;
  for (const CsvRow& row : table.rows) {
    const std::vector<double> values = Numbers(row, file);
    Found& found = looks[row.fields[0]];
    if (row.fields[1] == "tag" && values.size() == kOfTag) {
      found.tags_px.emplace_back(Eigen::Map<const Eigen::Matrix<double, 2, 4>>(&values[2]));
    } else if (row.fields[1] == "body" && values.size() == kOfBody) {
      const Eigen::Quaterniond q(values[3], values[4], values[5], values[6]);
      found.bodies.push_back({row.fields[2], Pose(q, {values[0], values[1], values[2]})});
    } else {
      throw InputError(file, row.line, "what", "is neither a tag nor a body with its values");
    }
  }
  return looks;
}

const CycleRecord* CycleBefore(const record::Recording& recording, EpisodeTime t) {
  const CycleRecord* latest = nullptr;
  for (const CycleRecord& cycle : recording.cycles) {
    if (cycle.t > t) break;
    latest = &cycle;
  }
  return latest;
}

// Where one who knew this cycle expects things later on, the later the paler.
void AddExpected(const CycleRecord& cycle, EpisodeTime t, std::vector<render::ViewedBox>* boxes) {
  double opacity = 0.9;
  for (const double ahead_s : kAhead_s) {
    for (const PredictedObject& object : cycle.objects) {
      if (object.t.empty()) continue;
      const Pose X_WO = render::PoseAt(object.t, object.X_WO, t + HorizonOffset(ahead_s));
      boxes->push_back({X_WO, object.half_extents_m, kExpectedColor, opacity});
    }
    opacity *= 0.6;
  }
}

Eigen::Matrix3Xd ToolPath(const CycleRecord& cycle, const robot::RobotModel& robot) {
  Eigen::Matrix3Xd path_W(3, cycle.plan.num_states());
  for (int k = 0; k < cycle.plan.num_states(); ++k) {
    path_W.col(k) = robot.ComputeToolPose(cycle.plan.q.col(k)).translation();
  }
  return path_W;
}

class Viewer {
 public:
  Viewer(const std::string& folder, const Pose& X_WC, const record::Recording& recording,
         const robot::RobotModel& robot)
      : looks_(ReadLooks(folder)),
        X_WC_(X_WC),
        recording_(recording),
        robot_(robot),
        scenario_(scenarios::ParseScenario(recording.scenario_yaml, "the recorded scenario")) {}

  render::Image Draw(const robot::Frame& frame) const {
    render::CameraNotes view;
    view.camera = frame.camera;
    view.X_WC = X_WC_;
    const CycleRecord* const cycle = CycleBefore(recording_, frame.t);
    if (cycle != nullptr) {
      AddExpected(*cycle, frame.t, &view.boxes);
      view.path_W = ToolPath(*cycle, robot_);
    }
    const auto found = looks_.find(std::to_string(frame.number));
    const Found nothing, &look = found == looks_.end() ? nothing : found->second;
    view.tags_px = look.tags_px;
    std::string sees;
    for (const SeenBody& body : look.bodies) {
      for (const scenarios::MovingObstacle& obstacle : scenario_.moving_obstacles) {
        if (obstacle.name != body.name) continue;
        view.boxes.push_back({body.X_WO, HalfExtents(obstacle.shape), kSeenColor, 1});
      }
      sees += (sees.empty() ? "sees " : ", ") + body.name;
    }
    view.lines = {FiniteText("{:.2f} s", frame.t.seconds()) + ", picture " +
                      std::to_string(frame.number) + " of camera " + frame.serial,
                  std::to_string(look.tags_px.size()) + " tags, " +
                      (sees.empty() ? "sees nothing that it follows" : sees),
                  PlanOf(cycle)};
    return render::DrawCameraNotes(frame.image, view, font_);
  }

 private:
  static std::string PlanOf(const CycleRecord* cycle) {
    if (cycle == nullptr) return "nothing is planned yet";
    if (!cycle->accepted) {
      return "no plan: " + (cycle->reason.empty() ? cycle->status : cycle->reason);
    }
    return "a plan with " + FiniteText("{:.0f} mm", 1e3 * cycle->predicted_clearance_m) +
           " of clearance, as expected; red: 0.5, 1 and 1.5 s later";
  }

  std::map<std::string, Found> looks_;
  Pose X_WC_;
  const record::Recording& recording_;
  const robot::RobotModel& robot_;
  const scenarios::Scenario scenario_;
  render::GlContext gl_;
  render::Font font_{gl_};
};

}  // namespace

void WriteCameraVideo(const std::string& folder, const Pose& X_WC,
                      const record::Recording& recording, const robot::RobotModel& robot,
                      const std::string& path) {
  const hardware::RecordedFrames frames(folder);
  const robot::CameraIntrinsics& lens = frames.camera().intrinsics;
  const Viewer viewer(folder, X_WC, recording, robot);
  const double seconds = (frames.end() - frames.At(0).t).seconds();
  const double rate_hz = seconds > 0 ? static_cast<double>(frames.size() - 1) / seconds : 1;
  const int rate = std::clamp(static_cast<int>(std::lround(rate_hz)), 1, 240);
  render::VideoWriter video(path, lens.width, lens.height, rate);
  for (std::size_t i = 0; i < frames.size(); ++i) video.Add(viewer.Draw(frames.At(i)));
  video.Finish();
}

}  // namespace sidestep::cli
