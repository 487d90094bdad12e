#include "sidestep/cli/trace_replay.h"

#include <fmt/core.h>

#include <cmath>
#include <exception>
#include <list>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>

#include "sidestep/bench/recorded_fields.h"
#include "sidestep/bench/run_identity.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"
#include "sidestep/record/recording.h"
#include "sidestep/render/replay/replay.h"
#include "sidestep/render/trace_model.h"
#include "sidestep/render/view_choice.h"

namespace sidestep::cli {
namespace {

// What a trace does not hold, found where it came from.
struct Origin {
  std::optional<scenarios::Scenario> scenario;
  std::optional<robot::RobotModel> robot;  // the same as then
  std::string why_no_robot;
};

Origin FindOrigin(const record::Recording& recording, const DataPaths& paths) {
  Origin origin;
  try {
    origin.scenario = scenarios::ParseScenario(recording.scenario_yaml, "its scenario");
    robot::RobotModel robot = RobotOf(*origin.scenario, paths.all_models());
    const auto then = recording.header.find("identity.models");
    const std::string now =
        bench::IdentifyRun(*origin.scenario, paths.all_models(), /*build=*/"").models;
    if (then == recording.header.end() || then->second != now ||
        robot.joint_names() != recording.joints) {
      origin.why_no_robot = "the files of the robot are not those of the run";
    } else {
      origin.robot = std::move(robot);
    }
  } catch (const InputError& error) {
    origin.why_no_robot = error.what();
  }
  return origin;
}

// Of everything that moves, each once: "1.4 m/s".
std::string SpeedsOf(const scenarios::Scenario& scenario) {
  std::set<double> speeds;
  for (const scenarios::MovingObstacle& obstacle : scenario.moving_obstacles) {
    speeds.insert(std::visit([](const auto& motion) { return motion.speed_m_s; }, obstacle.motion));
  }
  const auto text = [](double speed_m_s) { return fmt::format("{:.3g}", speed_m_s); };
  return speeds.empty() ? "" : Joined(speeds, ", ", text) + " m/s";
}

FieldSamples SampleField(const record::Recording& recording, const Origin& origin,
                         int most_points) {
  FieldSamples none;
  if (!origin.robot) {
    none.why_none = origin.why_no_robot;
    return none;
  }
  if (most_points == 0) {
    none.why_none = "it was not asked for";
    return none;
  }
  const double reach_m = origin.scenario->epsilon_m + origin.robot->largest_sphere_radius_m();
  try {
    return bench::SampleRecordedFields(recording, *origin.scenario, reach_m, {0, 0.5, 1},
                                       most_points);
  } catch (const std::exception& error) {  // whatever a trace from elsewhere is unfit for
    none.why_none = error.what();
    return none;
  }
}

render::Frustum ReplayFrustum() {
  constexpr double kMargin = 0.06;
  const double up = (1 - 2 * kMargin) * std::tan(render::kReplayFieldOfView_rad / 2);
  const double right = up * 4 / 3;
  return {-right, right, -up, up};
}

}  // namespace

render::ReplaySet MakeReplaySet(const std::vector<render::NamedRecording>& traces,
                                const DataPaths& paths, const ReplayOptions& options) {
  if (!options.titles.empty() && options.titles.size() != traces.size()) {
    throw InputError("--title", "needs one for each of the " + std::to_string(traces.size()) +
                                    " traces, there are " + std::to_string(options.titles.size()));
  }
  render::ReplaySet set;
  std::list<render::TraceModel> models;
  for (const auto& [name, recording] : traces) {
    render::TraceModel& model = models.emplace_back(recording, name);
    const Origin origin = FindOrigin(recording, paths);
    render::ReplayExtras extras;
    extras.robot = origin.robot ? &*origin.robot : nullptr;
    extras.why_no_robot = origin.why_no_robot;
    if (origin.scenario) {
      extras.margin_m = origin.scenario->epsilon_m;
      // What a camera sees goes its own way.
      const bool is_seen = recording.header.contains("camera");
      extras.speeds = is_seen ? "" : SpeedsOf(*origin.scenario);
    }
    extras.field = SampleField(recording, origin, options.field_points);
    set.replays.push_back(render::MakeReplay(model, std::move(extras)));
    if (!options.titles.empty()) {
      set.replays.back().title = {options.titles[set.replays.size() - 1], ""};
    }
  }
  std::vector<render::TraceModel*> all;
  for (render::TraceModel& model : models) all.push_back(&model);
  set.view = render::ChooseView(all, ReplayFrustum());
  return set;
}

}  // namespace sidestep::cli
