#include "sidestep/cli/versions.h"

#include <gnu/libc-version.h>

#include "sidestep/cli/build_id.h"
#include "sidestep/cli/build_info.h"  // made by CMake
#include "sidestep/planner/registry.h"
#include "sidestep/record/recording_file.h"
#include "sidestep/sim/mujoco_model.h"

namespace sidestep::cli {
namespace {

// glibc chooses among variants of sin, cos and exp by these, and they differ in the last bit.
std::string CpuFeatures() {
  std::string features = "x86-64";
  if (__builtin_cpu_supports("avx2")) features += " avx2";
  if (__builtin_cpu_supports("fma")) features += " fma";
  if (__builtin_cpu_supports("avx512f")) features += " avx512f";
  return features;
}

}  // namespace

std::string VersionNumber() { return std::string("sidestep ") + kVersion; }
std::string VersionText() { return VersionNumber() + " (build " + BuildId().substr(0, 12) + ")"; }

std::map<std::string, std::string> Versions() {
  return {
      {"sidestep", kVersion},
      {"build_id", BuildId()},
      {"build_type", kBuildType},
      {"compiler", kCompiler},
      {"mujoco", sim::MujocoVersion()},
      {"ceres", planner::CeresVersion()},
      {"hdf5", record::Hdf5Version()},
      {"c_library", std::string("glibc ") + gnu_get_libc_version()},
      {"cpu_features", CpuFeatures()},
  };
}

}  // namespace sidestep::cli
