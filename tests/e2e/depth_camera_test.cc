// Rooms as depth cameras see them, closed loop: what must not move does not, who comes in is seen,
// and the arm is no obstacle to itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/resolve.h"
#include "sidestep/bench/scenario_planner.h"
#include "sidestep/core/shape.h"
#include "sidestep/record/recording_file.h"
#include "sidestep/sdf/tracking/object_tracker.h"
#include "sidestep/sim/simulation.h"
#include "tests/support/temporary_folder.h"

namespace sidestep {
namespace {

const ModelFolders kModels = std::vector<std::string>{SIDESTEP_SOURCE_DIR "/models"};

struct Episode {
  scenarios::Scenario scenario;
  bench::EpisodeResult result;
};

Episode RunRoom(const std::string& name, scenarios::Settings settings) {
  settings.emplace("seed", "3");
  Episode episode{
      scenarios::LoadScenario(SIDESTEP_SOURCE_DIR "/scenarios/" + name + ".yaml", settings), {}};
  bench::ResolvePlanner(episode.scenario);
  const auto robot =
      robot::RobotModel::Load(kModels, episode.scenario.robot, episode.scenario.X_WB);
  bench::ResolveTask(episode.scenario, robot);
  const auto make_world = [](const scenarios::Scenario& of, const robot::RobotModel& its) {
    return bench::MakeEpisodeWorld(std::make_shared<sim::Simulation>(of, its, kModels));
  };
  episode.result = bench::RunEpisode(episode.scenario, robot, make_world);
  bench::RequireWhole(episode.result);
  return episode;
}

class StillRoom : public ::testing::TestWithParam<const char*> {};

TEST_P(StillRoom, HasNothingThatMovesAndLetsTheArmThrough) {
  const Episode episode = RunRoom("still_room", {{"sensor.camera.noise_per_m", GetParam()}});
  EXPECT_EQ(episode.result.outcome, bench::Outcome::kGoal);
  EXPECT_EQ(episode.result.recording.metrics.at("things_moved"), 0);
}

INSTANTIATE_TEST_SUITE_P(NoisePerM, StillRoom, ::testing::Values("0", "0.002", "0.005", "0.01"),
                         [](const auto& test) {
                           std::string name = test.param;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

// When the visitor's middle has come into the picture and into the grid.
double InViewAt(const scenarios::Scenario& scenario) {
  const scenarios::CameraSettings& camera = scenario.sensor.camera.value();
  const Pose X_CW = scenarios::PoseOfCamera(camera.position_m, camera.look_at_m).Inverse();
  const double across = std::tan(camera.field_of_view_rad / 2);
  for (double t_s = 0;; t_s += 1e-3) {
    const Eigen::Vector3d p_W =
        PoseAt(scenario.moving_obstacles.at(0), EpisodeTime(t_s)).translation();
    const Eigen::Vector3d p_C = X_CW * p_W;
    const auto [i, j, k] = scenario.grid.CellOf(p_W);
    const bool in_picture = std::abs(p_C.x()) < across * p_C.z() &&
                            std::abs(p_C.y()) < across * p_C.z() * camera.height / camera.width;
    if (in_picture && scenario.grid.Contains(i, j, k)) return t_s;
  }
}

struct Visit {
  const char* who;
  const char* noise_per_m;
};
std::ostream& operator<<(std::ostream& stream, const Visit& visit) {
  return stream << visit.who << " " << visit.noise_per_m;
}

TEST(TwoCameras, ThatCaptureAtOneMomentAreOneObservationAndLetTheArmThrough) {
  const Episode episode = RunRoom("walkway_depth", {});
  EXPECT_EQ(episode.result.outcome, bench::Outcome::kGoal);
  const record::Recording& recording = episode.result.recording;
  const TemporaryFolder folder;
  record::WriteRecording(recording, folder.path() / "trace.h5");
  const record::Recording read = record::ReadRecording(folder.path() / "trace.h5");
  ASSERT_EQ(read.observations.size(), recording.observations.size());
  for (std::size_t i = 0; i < read.observations.size(); ++i) {
    EXPECT_NEAR(read.observations[i].t.seconds(), static_cast<double>(i) / 30, 1e-3);
  }
}

class Visitor : public ::testing::TestWithParam<Visit> {};

TEST_P(Visitor, IsSeenToMoveWithinAFifthOfASecond) {
  const auto [who, noise_per_m] = GetParam();
  const Episode episode =
      RunRoom("still_room", {{"visitor", who}, {"sensor.camera.noise_per_m", noise_per_m}});
  const std::vector<TrackEvent>& events = episode.result.recording.events;
  const auto moved = std::find_if(events.begin(), events.end(), [](const TrackEvent& event) {
    return event.what == sdf::track_event::kMoved;
  });
  ASSERT_NE(moved, events.end());
  EXPECT_LT(moved->t.seconds(), InViewAt(episode.scenario) + 0.2);
  const Eigen::Vector3d p_W = PoseAt(episode.scenario.moving_obstacles[0], moved->t).translation();
  EXPECT_LT((moved->p_W - p_W).norm(), 0.9) << "and it is the visitor";
}

INSTANTIATE_TEST_SUITE_P(Who, Visitor,
                         ::testing::Values(Visit{"person", "0.002"}, Visit{"robot", "0.005"},
                                           Visit{"person", "0.01"}),
                         [](const auto& test) {
                           std::string name = std::string(test.param.who) + test.param.noise_per_m;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

// How many cells are filled, at the worst moment, that nothing of the room explains: by so much.
int MostUnexplained(const Episode& episode, double within_m) {
  const scenarios::Scenario& scenario = episode.scenario;
  std::vector<bool> is_explained(scenario.grid.num_cells(), false);
  for (std::size_t cell = 0; cell < is_explained.size(); ++cell) {
    const Eigen::Vector3d p_W = scenario.grid.CenterOf(cell);
    for (const scenarios::StaticObstacle& fixed : scenario.static_obstacles) {
      const double distance_m = SignedDistance(fixed.shape, fixed.X_WO.Inverse() * p_W);
      if (distance_m <= within_m) is_explained[cell] = true;
    }
  }
  std::vector<bool> filled(is_explained.size(), false);
  int count = 0, most = 0;
  for (const record::ObservationRecord& observation : episode.result.recording.observations) {
    for (const std::int64_t changed : observation.changed_cells) {
      const auto cell = static_cast<std::size_t>(changed);
      filled[cell] = !filled[cell];
      if (!is_explained[cell]) count += filled[cell] ? 1 : -1;
    }
    most = std::max(most, count);
  }
  return most;
}

TEST(CameraThatSeesTheArm, DoesNotTakeItForAnObstacleThoughItStandsACentimetreAside) {
  const scenarios::Settings sees = {{"sensor.camera.sees_robot", "true"},
                                    {"sensor.camera.misplaced_m", "[0.007, -0.005, 0.005]"},
                                    {"sensor.camera.noise_per_m", "0.002"}};
  // A cell's diagonal, the centimetre, and what noise moves a surface at first.
  const double within_m = 0.035 + 0.01 + 0.06;
  const Episode filtered = RunRoom("still_room", sees);
  EXPECT_EQ(filtered.result.outcome, bench::Outcome::kGoal);
  EXPECT_EQ(filtered.result.recording.metrics.at("things_moved"), 0);
  EXPECT_LE(MostUnexplained(filtered, within_m), 0);

  scenarios::Settings no_margin = sees;
  no_margin["sensor.camera.robot_margin_m"] = "0";
  no_margin["sensor.camera.noise_per_m"] = "0";
  EXPECT_GT(MostUnexplained(RunRoom("still_room", no_margin), within_m), 0)
      << "the test sees an arm";
}

}  // namespace
}  // namespace sidestep
