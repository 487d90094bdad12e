#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

namespace sidestep::sim {

/// The physics failed: a diverged state, too many contacts for MuJoCo's buffers, an engine error.
/// The episode cannot be completed.
class SimulationError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct MujocoDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};
using MujocoModelPtr = std::unique_ptr<mjModel, MujocoDeleter>;
using MujocoDataPtr = std::unique_ptr<mjData, MujocoDeleter>;

/// "2.2.2".
std::string MujocoVersion();

/// Compiles an MJCF text that refers to no other file. Safe from many threads.
///
/// The first call also takes over MuJoCo's two process-wide handlers, for good: engine errors
/// become SimulationError (MuJoCo's own handler ends the process), and warnings are not written to
/// MUJOCO_LOG.TXT in the working directory any more; MujocoWarning reads them from the state they
/// belong to.
/// @param name stands for the file in messages.
/// @throws InputError with MuJoCo's own words if the text is not a model, at the line of the text
///   and with the element or the object's name where MuJoCo tells them.
MujocoModelPtr LoadMujocoModel(const std::string& xml, const std::string& name);

/// Compiles an MJCF file, with all that it refers to. @throws InputError likewise.
MujocoModelPtr LoadMujocoFile(const std::string& path);

/// A state of `model` at its reference pose, nothing computed yet.
MujocoDataPtr MakeMujocoData(const mjModel& model);

/// The first thing MuJoCo has warned about since this state was made, if any. It resets a state
/// that has diverged and goes on; what follows looks like a simulation and is none.
std::optional<std::string> MujocoWarning(const mjData& data);

}  // namespace sidestep::sim
