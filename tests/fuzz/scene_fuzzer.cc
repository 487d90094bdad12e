// Any text is refused with an InputError, or is a planning scene or request whose scenario is one.
#include <string>

#include "sidestep/core/input_error.h"
#include "sidestep/import/moveit_files.h"

namespace {

// What stands in the scene, as a scenario would say it.
void WriteAndRead(const sidestep::imports::ImportedScene& scene) {
  sidestep::scenarios::Scenario scenario;
  scenario.name = "scene";
  scenario.description = "A scene";
  scenario.grid = {{0, 0, 0}, 0.1, {2, 2, 2}};
  scenario.knowledge = "static";
  scenario.predictor = "stationary";
  scenario.sensor.name = "occupancy";
  scenario.sensor.rate_hz = 30;
  scenario.static_obstacles = scene.obstacles;
  const std::string text = ToYaml(scenario);
  sidestep::scenarios::ParseScenario(text, "written.yaml");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  try {
    sidestep::imports::ParseMoveItRequest(text, "fuzz.yaml");
  } catch (const sidestep::InputError&) {
  }
  sidestep::imports::ImportedScene scene;
  try {
    scene = sidestep::imports::ParseMoveItScene(text, "fuzz.yaml");
  } catch (const sidestep::InputError&) {
    return 0;
  }
  WriteAndRead(scene);  // Not caught: must be accepted.
  return 0;
}
