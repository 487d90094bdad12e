#include "sidestep/cli/calibrate.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <numbers>
#include <string>

#include "sidestep/cli/console.h"
#include "sidestep/cli/operator_log.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/csv.h"
#include "sidestep/core/input_error.h"
#include "sidestep/hardware/camera_calibration.h"
#include "sidestep/hardware/recorded_frames.h"

namespace sidestep::cli {
namespace {

struct CalibrateOptions {
  ScenarioOptions scenario;
  std::string views, out;
  int tag_id = -1;
  double tag_size_m = 0;
};

// joints.csv: where the robot rested at each frame.
std::map<std::int64_t, Eigen::VectorXd> ReadJoints(const std::string& path, int num_joints) {
  std::vector<std::string> columns = {"number"};
  for (int j = 1; j <= num_joints; ++j) columns.push_back("q" + std::to_string(j));
  const CsvFile file = ReadCsv(path);
  if (file.columns != columns) throw InputError(path, 1, "header", "must be number,q1,...");
  std::map<std::int64_t, Eigen::VectorXd> joints;
  for (const CsvRow& row : file.rows) {
    const auto number =
        static_cast<std::int64_t>(ParseCsvNumber(row.fields[0], path, row.line, "number"));
    Eigen::VectorXd q(num_joints);
    for (int j = 0; j < num_joints; ++j) {
      const auto field = static_cast<std::size_t>(j) + 1;
      q(j) = ParseCsvNumber(row.fields[field], path, row.line, columns[field]);
    }
    if (!joints.emplace(number, q).second) {
      throw InputError(path, row.line, "number", "is there twice");
    }
  }
  return joints;
}

std::vector<hardware::HandView> FindViews(const hardware::RecordedFrames& frames,
                                          const std::map<std::int64_t, Eigen::VectorXd>& joints,
                                          const robot::RobotModel& robot, int tag_id) {
  hardware::TagDetector detector;
  std::vector<hardware::HandView> views;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const robot::Frame frame = frames.At(i);
    const auto q = joints.find(frame.number);
    if (q == joints.end()) continue;
    for (const hardware::TagDetection& tag : detector.Detect(frame.image)) {
      if (tag.id == tag_id) views.push_back({robot.ComputeLinkPoses(q->second).back(), tag});
    }
  }
  return views;
}

int Calibrate(const CalibrateOptions& options) {
  const Problem problem = LoadProblem(options.scenario.scenario, ParseOverrides(options.scenario),
                                      FindDataPaths(options.scenario.models));
  CheckCanWrite(options.out);
  const hardware::RecordedFrames frames(options.views);
  const std::string joints_file = (std::filesystem::path(options.views) / "joints.csv").string();
  const auto joints = ReadJoints(joints_file, problem.robot.num_joints());
  const auto views = FindViews(frames, joints, problem.robot, options.tag_id);
  hardware::CameraCalibration calibration =
      hardware::CalibrateCamera(frames.camera().intrinsics, options.tag_size_m, views);
  calibration.serial = frames.camera().serial;
  calibration.robot = problem.robot.name();
  calibration.date = TodayUtc();

  constexpr double kDegree = std::numbers::pi / 180;
  const Eigen::Vector3d& p = calibration.X_WC.translation();
  Print("camera           {}, at ({:.4f}, {:.4f}, {:.4f}) m\n", calibration.serial, p.x(), p.y(),
        p.z());
  Print("views            {} of {} frames; {} of them held out\n", views.size(), frames.size(),
        calibration.num_held_out);
  Print("reprojection     {:.3f} px\n", calibration.reprojection_px);
  Print("held out         {:.2f} mm and {:.3f} degrees root mean square, {:.2f} mm at most\n",
        1e3 * calibration.held_out_rms_m, calibration.held_out_rms_rad / kDegree,
        1e3 * calibration.held_out_max_m);
  const auto why_not = hardware::WhyNotAccepted(calibration);
  if (!why_not) {
    WriteFile(options.out, ToYaml(calibration));
    Print("written to       {}\n", options.out);
  }
  FinishOutput();
  if (why_not) PrintError("hardware calibrate: not accepted: {}\n", *why_not);
  return why_not ? 1 : 0;
}

}  // namespace

void AddCalibrate(CLI::App& hardware, CommandLine& line) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* const calibrate = hardware.add_subcommand(
      "calibrate",
      "Find out where a camera stands, from recorded pictures of a tag on the robot's hand");
  AddScenario(*calibrate, options->scenario)->description("Whose robot it is, and its base");
  calibrate
      ->add_option("--views", options->views,
                   "Folder of recorded frames, with joints.csv: number,q1,... of each at which the "
                   "robot rested")
      ->required();
  calibrate->add_option("--tag-id", options->tag_id, "Of the tag, tag36h11")
      ->required()
      ->check(CLI::Range(0, 586));
  calibrate->add_option("--tag-size", options->tag_size_m, "Edge of its black square [m]")
      ->required()
      ->check(CLI::Range(0.001, 10.0));
  calibrate->add_option("--out", options->out, "The file of the calibration, YAML")->required();
  calibrate->callback([&line, options] { line.exit_code = Calibrate(*options); });
}

}  // namespace sidestep::cli
