#include "sidestep/cli/look_around.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "sidestep/cli/camera_video.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/hardware_world.h"
#include "sidestep/cli/operator_log.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/provenance.h"
#include "sidestep/cli/run_folder.h"
#include "sidestep/cli/sensors.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/text_file.h"
#include "sidestep/hardware/look_log.h"
#include "sidestep/record/recording_file.h"

namespace sidestep::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kAfterTheLast_s = 0.1;  // picture that is recorded: it is planned around
constexpr std::uintmax_t kMostTable_bytes = 1 << 30;

std::string PathIn(const std::string& folder, const char* name) {
  return (fs::path(folder) / name).string();
}

Pose PlaceOfCamera(const scenarios::Scenario& scenario,
                   const std::optional<hardware::CameraCalibration>& calibration) {
  return calibration ? calibration->X_WC : TagSensorOptionsOf(scenario).X_WC;
}

// How many horizons it looks.
double HorizonsOf(const LookAroundOptions& options, const ReadyCamera& camera,
                  const scenarios::Scenario& scenario) {
  if (options.seconds > 0) return options.seconds / scenario.horizon_s;
  if (camera.ends_at) return (camera.ends_at->seconds() + kAfterTheLast_s) / scenario.horizon_s;
  return 2;
}

int CountAccepted(const record::Recording& recording) {
  return static_cast<int>(std::count_if(recording.cycles.begin(), recording.cycles.end(),
                                        [](const CycleRecord& cycle) { return cycle.accepted; }));
}

int CountScansWithObjects(const record::Recording& recording) {
  return static_cast<int>(std::count_if(recording.observations.begin(),
                                        recording.observations.end(),
                                        [](const auto& scan) { return !scan.objects.empty(); }));
}

}  // namespace

void LookAround(const Problem& problem, const DataPaths& paths, const LookAroundOptions& options,
                std::unique_ptr<hardware::FciDriver> driver) {
  const scenarios::Scenario& scenario = problem.scenario;
  if (options.camera.choice.kind == CameraKind::kServer) {
    throw InputError("--camera", "the server's world stands still as long as its robot does");
  }
  RunFolder folder(options.out, Identify(scenario, paths));
  const std::string camera_folder = PathIn(options.out, kCameraFolder);
  CheckCanWrite(PathIn(options.out, kDryRunVideo));
  hardware::LookLog log(MakeOutFolder(camera_folder, {}));
  CameraUse use = options.camera;
  use.on_look = [&](const hardware::Look& look) { log.Add(look); };
  const ReadyCamera camera = OpenTagCamera(scenario, use, TodayUtc());

  bench::EpisodeOptions episode;
  episode.clock = use.choice.kind == CameraKind::kRealSense ? bench::EpisodeClock::kWall
                                                            : bench::EpisodeClock::kVirtual;
  episode.why_stop = options.why_stop;
  episode.journal = &folder.journal();
  episode.horizons = HorizonsOf(options, camera, scenario);
  const HardwareSite site = {use.robot, camera.make_sensor, camera.description};
  bench::EpisodeResult result = bench::RunEpisode(
      scenario, problem.robot, StandingWorlds(paths, site, std::move(driver)), episode);
  log.Finish();
  const record::Recording& recording = result.recording;
  Print("pictures         {}, something that is followed in {}\n", log.num_frames(),
        CountScansWithObjects(recording));
  Print("plans            {} of {} accepted; none was followed\n", CountAccepted(recording),
        recording.cycles.size());
  if (use.calibration) {
    WriteFile(PathIn(options.out, kCalibrationFile), ToYaml(*use.calibration));
  }
  if (log.num_frames() > 0) {
    WriteCameraVideo(camera_folder, PlaceOfCamera(scenario, use.calibration), recording,
                     problem.robot, PathIn(options.out, kDryRunVideo));
    Print("written          {0}/{1}, {0}/{2}/\n", options.out, kDryRunVideo, kCameraFolder);
  }
  folder.KeepAndTell(result, scenario, false);
}

bool LookAgain(const DataPaths& paths, const std::string& folder, const std::string& out) {
  const record::Recording recording = record::ReadRecording(PathIn(folder, "trace.h5"));
  const std::string camera_folder = PathIn(folder, kCameraFolder);
  const auto scenario =
      scenarios::ParseScenario(recording.scenario_yaml, folder + ": its scenario");
  if (!scenario.sensor.tag_images) throw InputError(folder, "is of no run with a camera");
  std::optional<hardware::CameraCalibration> calibration;
  if (fs::exists(PathIn(folder, kCalibrationFile))) {
    calibration = hardware::ReadCalibration(PathIn(folder, kCalibrationFile));
  }
  const Pose X_WC = PlaceOfCamera(scenario, calibration);
  const std::string table_file = PathIn(camera_folder, hardware::LookLog::kTableFile);
  const std::string recorded = ReadTextFile(table_file, kMostTable_bytes);

  hardware::LookTable table;
  int num_frames = 0;
  hardware::TagSensorOptions options = TagSensorOptionsOf(scenario);
  options.X_WC = X_WC;
  options.on_look = [&](const hardware::Look& look) {
    table.Add(look);
    ++num_frames;
  };
  hardware::TagSensor sensor(std::make_unique<hardware::RecordedFrames>(camera_folder),
                             std::move(options));
  while (std::isfinite(sensor.NextDue().seconds())) sensor.Read(sensor.NextDue());

  const bool is_same = table.text() == recorded;
  const auto differ =
      std::mismatch(recorded.begin(), recorded.end(), table.text().begin(), table.text().end());
  const auto line = 1 + std::count(recorded.begin(), differ.first, '\n');
  Print("pictures         {}\n", num_frames);
  Print("found            {}\n", is_same ? "the same as when they were taken, to the bit"
                                         : "something else than when they were taken, from line " +
                                               std::to_string(line) + " of " + table_file + " on");
  if (!out.empty()) {
    const std::string video = MakeOutFolder(out, {kDryRunVideo}) + "/" + kDryRunVideo;
    const robot::RobotModel robot = RobotOf(scenario, paths.all_models());
    WriteCameraVideo(camera_folder, X_WC, recording, robot, video);
    Print("written          {}\n", video);
  }
  return is_same;
}

}  // namespace sidestep::cli
