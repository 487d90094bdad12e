// Any text is refused with an InputError, or is a scenario whose own text is one, too.
#include <string>

#include "sidestep/core/input_error.h"
#include "sidestep/scenarios/scenario.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(bytes), size);
  std::string written;
  try {
    written = sidestep::scenarios::ToYaml(sidestep::scenarios::ParseScenario(text, "fuzz.yaml"));
  } catch (const sidestep::InputError&) {
    return 0;
  }
  sidestep::scenarios::ParseScenario(written, "written.yaml");  // Not caught: must be accepted.
  return 0;
}
