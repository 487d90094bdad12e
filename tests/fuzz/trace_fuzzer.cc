// Any file is refused with an InputError, or is a recording. The seal would stop nearly everything
// at once, so the bytes are sealed anew: what is fuzzed is what a faulty writer could leave.
#include <cstdint>
#include <span>
#include <string>

#include "core/input_error.h"
#include "core/recording.h"
#include "core/sealed_file.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string sealed = sidestep::SealedBytes({"sidestep trace", 1}, std::span(bytes, size));
  const sidestep::MemoryFile file(reinterpret_cast<const std::uint8_t*>(sealed.data()),
                                  sealed.size());
  try {
    sidestep::ReadRecording(file.path());
  } catch (const sidestep::InputError&) {
  }
  return 0;
}
