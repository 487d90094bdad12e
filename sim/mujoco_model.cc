#include "sidestep/sim/mujoco_model.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "sidestep/core/input_error.h"

namespace sidestep::sim {
namespace {

// MuJoCo is C and ends the process when its error handler returns. It is built with unwind tables
// (the x86-64 ABI asks for them), so an exception passes through; the state it leaves behind is
// only good for deletion.
void ThrowError(const char* message) { throw SimulationError(std::string("MuJoCo: ") + message); }

void IgnoreWarning(const char*) {}

void InstallHandlers() {
  static const bool kInstalled = [] {
    mju_user_error = ThrowError;
    mju_user_warning = IgnoreWarning;
    return true;
  }();
  static_cast<void>(kInstalled);
}

}  // namespace

MujocoModelPtr LoadMujocoModel(const std::string& xml, const std::string& name) {
  InstallHandlers();
  const auto vfs = std::make_unique<mjVFS>();  // 2 MB: not for the stack
  mj_defaultVFS(vfs.get());
  constexpr const char* kFile = "model.xml";
  mj_makeEmptyFileVFS(vfs.get(), kFile, static_cast<int>(xml.size()));
  std::memcpy(vfs->filedata[0], xml.data(), xml.size());
  std::array<char, 1000> message = {};
  MujocoModelPtr model(
      mj_loadXML(kFile, vfs.get(), message.data(), static_cast<int>(message.size())));
  mj_deleteVFS(vfs.get());
  if (!model) {
    std::string line(message.data());
    std::replace(line.begin(), line.end(), '\n', ' ');
    throw InputError(name, line);
  }
  return model;
}

MujocoDataPtr MakeMujocoData(const mjModel& model) { return MujocoDataPtr(mj_makeData(&model)); }

std::optional<std::string> MujocoWarning(const mjData& data) {
  for (int i = 0; i < mjNWARNING; ++i) {
    const mjWarningStat& warning = data.warning[i];
    if (warning.number > 0) return mju_warningText(i, warning.lastinfo);
  }
  return std::nullopt;
}

std::string MujocoVersion() { return mj_versionString(); }

}  // namespace sidestep::sim
