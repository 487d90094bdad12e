#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "sidestep/core/pose.h"
#include "sidestep/sim/model_store.h"

namespace sidestep::sim {

/// One primitive of a picture: something to look at, of no other effect.
struct PictureGeom {
  std::string type;      ///< MJCF's word for it
  Eigen::Vector3d size;  ///< as MJCF has it
  Pose X_AG;             ///< in the model's own frame
  Eigen::Vector4f rgba;
};

/// What MuJoCo draws by default of a model (geoms of groups 0 to 2) at its reference pose, planes
/// left out.
/// @param path of an MJCF file that refers to no other.
/// @param store of models that were compiled before, to which its own is added; may be null.
/// @throws InputError if it is not a model, or draws a mesh or a height field.
std::vector<PictureGeom> PictureOf(const std::string& path, ModelStore* store = nullptr);

}  // namespace sidestep::sim
