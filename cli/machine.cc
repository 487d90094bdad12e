#include "sidestep/cli/machine.h"

#include <unistd.h>

#include <array>
#include <fstream>

#include "sidestep/cli/versions.h"

namespace sidestep::cli {
namespace {

std::string CpuName() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  }
  return "";
}

}  // namespace

std::map<std::string, std::string> MachineIn(std::map<std::string, std::string> versions) {
  for (const char* const of_build : {"sidestep", "build_id", "build_type", "compiler"}) {
    versions.erase(of_build);
  }
  return versions;
}

std::map<std::string, std::string> Machine() {
  std::map<std::string, std::string> machine = MachineIn(Versions());
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  machine["hostname"] = name.data();
  machine["cpu"] = CpuName();
  return machine;
}

}  // namespace sidestep::cli
