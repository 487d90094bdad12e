// Runs one short episode from the installed libraries and data, and reads its trace back.
#include <cstdio>
#include <exception>
#include <memory>
#include <string>

#include "bench/episode.h"
#include "bench/resolve.h"
#include "core/recording.h"
#include "render/trace_model.h"
#include "sim/simulation.h"

namespace {

int Run() {
  const std::string data = SIDESTEP_DATA_DIR;
  sidestep::Scenario scenario = sidestep::LoadScenario(data + "/scenarios/hsr_walkway.yaml");
  scenario.max_iterations = 5;
  const auto robot = sidestep::RobotModel::Load(data + "/models", scenario.robot, scenario.X_WB);
  sidestep::ResolveTask(scenario, robot);
  const auto make_world = [&](const sidestep::Scenario& of, const sidestep::RobotModel& arm) {
    return sidestep::MakeEpisodeWorld(
        std::make_shared<sidestep::Simulation>(of, arm, data + "/models"));
  };
  const sidestep::EpisodeResult result = sidestep::RunEpisode(scenario, robot, make_world);
  sidestep::WriteRecording(result.recording, "outside.h5");
  const sidestep::Recording read = sidestep::ReadRecording("outside.h5");
  std::printf("%s, %zu planning cycles\n", sidestep::ToString(result.outcome).c_str(),
              read.cycles.size());
  return read.cycles.empty() ? 1 : 0;
}

}  // namespace

int main() {
  try {
    return Run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
