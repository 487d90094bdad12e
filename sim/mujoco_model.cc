#include "sidestep/sim/mujoco_model.h"

#include <array>
#include <cstring>
#include <regex>

#include "sidestep/core/input_error.h"
#include "sidestep/core/markup.h"

namespace sidestep::sim {
namespace {

// MuJoCo is C and ends the process when its error handler returns. It is built with unwind tables
// (the x86-64 ABI asks for them), so an exception passes through; the state it leaves behind is
// only good for deletion.
void ThrowError(const char* message) { throw SimulationError(std::string("MuJoCo: ") + message); }

void IgnoreWarning(const char*) {}

// What MuJoCo says of a text, as an InputError at its line. The message is one of
//   XML Error: WHY / Element 'TAG', line 4
//   Error: WHY / Object name = NAME, id = 0, line = 4, column = -1
//   XML parse error 14: / Error=WHY ErrorID=14 (0xe) Line number=4: ...
// where / is a line break or two; anything else is passed on as it is.
InputError ErrorOf(const std::string& file, const std::string& message) {
  static const std::regex kElement("(?:XML )?Error: ([^\\n]*)\\n+Element '([^']*)', line (\\d+)");
  static const std::regex kObject(
      "Error: ([^\\n]*)\\n+Object name = (.*), id = \\d+, line = (\\d+)");
  static const std::regex kSyntax("XML parse error [^\\n]*\\n+Error=(\\w+)().*Line number=(\\d+)");
  for (const std::regex* const form : {&kElement, &kObject, &kSyntax}) {
    std::smatch parts;
    if (!std::regex_search(message, parts, *form)) continue;
    const int line = std::stoi(parts[3].str().substr(0, 9));
    if (form == &kSyntax) return XmlFault(file, line, parts[1].str());
    return InputError(file, line, parts[2], parts[1]);
  }
  return InputError(file, message);
}

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
  if (xml.empty()) throw InputError(name, "is empty");
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
  if (!model) throw ErrorOf(name, message.data());
  return model;
}

MujocoModelPtr LoadMujocoFile(const std::string& path) {
  InstallHandlers();
  std::array<char, 1000> message = {};
  MujocoModelPtr model;
  try {
    model.reset(
        mj_loadXML(path.c_str(), nullptr, message.data(), static_cast<int>(message.size())));
  } catch (const SimulationError& error) {
    throw InputError(path, error.what());
  }
  if (!model) throw ErrorOf(path, message.data());
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
