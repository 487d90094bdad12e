// Runs one short episode from the installed libraries and data, reads its trace back, and loads a
// plug-in that is linked with them too.
#include <dlfcn.h>

#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>

#include "core/time.h"
#include "plug_in.h"
#include "sidestep/bench/episode.h"
#include "sidestep/bench/resolve.h"
#include "sidestep/record/recording_file.h"
#include "sidestep/render/trace_model.h"
#include "sidestep/sim/simulation.h"

namespace {

void Run() {
  const std::string data = SIDESTEP_DATA_DIR;
  sidestep::scenarios::Scenario scenario =
      sidestep::scenarios::LoadScenario(data + "/scenarios/hsr_walkway.yaml");
  if (scenario.horizon_s > kOutsideSeconds) throw std::runtime_error("takes too long");
  scenario.planner_parameters["max_iterations"] = "5";
  const auto robot =
      sidestep::robot::RobotModel::Load(data + "/models", scenario.robot, scenario.X_WB);
  sidestep::bench::ResolveTask(scenario, robot);
  const auto make_world = [&](const sidestep::scenarios::Scenario& of,
                              const sidestep::robot::RobotModel& arm) {
    return sidestep::bench::MakeEpisodeWorld(
        std::make_shared<sidestep::sim::Simulation>(of, arm, data + "/models"));
  };
  const sidestep::bench::EpisodeResult result =
      sidestep::bench::RunEpisode(scenario, robot, make_world);
  sidestep::record::WriteRecording(result.recording, "outside.h5");
  const sidestep::record::Recording read = sidestep::record::ReadRecording("outside.h5");
  if (read.cycles.empty()) throw std::runtime_error("planned nothing");
  std::printf("%s, %zu planning cycles\n", sidestep::bench::ToString(result.outcome).c_str(),
              read.cycles.size());
}

void LoadPlugIn(const char* path) {
  void* const library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) throw std::runtime_error(dlerror());
  const auto count = reinterpret_cast<decltype(&CountPlannersAndPredictors)>(
      dlsym(library, "CountPlannersAndPredictors"));
  if (count == nullptr) throw std::runtime_error(dlerror());
  std::printf("%d planners and predictors in the plug-in\n", count());
}

}  // namespace

int main(int num_arguments, char** arguments) {
  try {
    Run();
    if (num_arguments > 1) LoadPlugIn(arguments[1]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
