#include <cstdlib>
#include <exception>
#include <string>

#include "sidestep/bench/report/gnuplot.h"
#include "sidestep/bench/task_pool.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/cli/versions.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/render/gl_context.h"
#include "sidestep/render/video_writer.h"
#include "sidestep/robot/robot_model.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::cli {
namespace {

// Prints one finding a line; a remedy belongs on the same line, so that it can be grepped.
class Report {
 public:
  void Good(const std::string& what, const std::string& detail) { Tell("ok", what, detail); }
  void Bad(const std::string& what, const std::string& detail, const std::string& remedy) {
    Tell("MISSING", what, detail + "; remedy: " + remedy);
    ++num_bad_;
  }
  /// Something that can be done without.
  void Absent(const std::string& what, const std::string& detail, const std::string& remedy) {
    Tell("absent", what, detail + "; remedy: " + remedy);
  }
  int num_bad() const { return num_bad_; }

 private:
  static void Tell(const char* verdict, const std::string& what, const std::string& detail) {
    Print("{:<8} {:<12} {}\n", verdict, what, detail);
  }
  int num_bad_ = 0;
};

void CheckData(Report& report) {
  try {
    const DataPaths paths = FindDataPaths();
    std::size_t num_scenarios = 0;
    for (const std::string& name : scenarios::ScenarioNames(paths.scenarios)) {
      const scenarios::Scenario scenario =
          scenarios::LoadScenario(paths.scenarios + "/" + name + ".yaml");
      if (!scenario.robot.empty()) {
        RobotOf(scenario, paths.models);
      }
      ++num_scenarios;
    }
    report.Good("data", std::to_string(num_scenarios) + " scenarios and their robots, in " +
                            paths.scenarios);
  } catch (const std::exception& error) {
    report.Bad("data", error.what(), "set SIDESTEP_DATA_DIR to a folder with models/, scenarios/");
  }
}

void CheckGl(Report& report) {
  const char* const choice = std::getenv("MUJOCO_GL");
  const std::string detail =
      "MUJOCO_GL=" + std::string(choice == nullptr ? "(not set: osmesa)" : choice);
  try {
    const render::GlContext gl;
    report.Good("rendering", gl.renderer() + ", OpenGL " + gl.version() + ", " + detail);
  } catch (const std::exception& error) {
    report.Bad("rendering", error.what(),
               "unset MUJOCO_GL (only osmesa is built in; no display or GPU is needed)");
  }
}

void CheckVideo(Report& report) {
  const std::string encoder = render::VideoEncoder();
  if (encoder.empty()) {
    report.Bad("video", "libavcodec has no H.264 encoder", "install Debian's libavcodec59");
  } else {
    report.Good("video", encoder);
  }
}

void CheckGnuplot(Report& report) {
  const std::string version = bench::GnuplotVersion();
  if (version.empty()) {
    report.Absent("figures", "no gnuplot: sidestep reproduce draws none", bench::kGnuplotRemedy);
  } else {
    report.Good("figures", version);
  }
}

int Diagnose() {
  Report report;
  for (const auto& [part, version] : Versions()) report.Good(part, version);
  report.Good("processors", std::to_string(bench::NumProcessors()));
  CheckData(report);
  CheckGl(report);
  CheckVideo(report);
  CheckGnuplot(report);
  return report.num_bad() == 0 ? 0 : 1;
}

}  // namespace

void AddDoctorCommand(CommandLine& line) {
  CLI::App* const doctor = line.app.add_subcommand(
      "doctor", "Say what is installed, which GL draws, and what to do about what is missing");
  doctor->callback([&line] { line.exit_code = Diagnose(); });
}

}  // namespace sidestep::cli
