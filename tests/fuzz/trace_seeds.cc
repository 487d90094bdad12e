// trace_seeds TRACE PAYLOAD: writes what is inside the seal of a trace.
#include <cstdio>
#include <fstream>

#include "core/input_error.h"
#include "core/recording.h"
#include "core/sealed_file.h"

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  try {
    const auto payload = sidestep::ReadSealedFile(argv[1], {"sidestep trace", 1});
    std::ofstream stream(argv[2], std::ios::binary);
    stream.write(reinterpret_cast<const char*>(payload.data()),
                 static_cast<std::streamsize>(payload.size()));
    return stream ? 0 : 1;
  } catch (const sidestep::InputError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
