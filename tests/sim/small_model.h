#pragma once

#include <Eigen/Geometry>
#include <string>

#include "sidestep/core/pose.h"
#include "sidestep/sim/mujoco_model.h"

namespace sidestep::sim {

/// A model from the inside of <worldbody> (and what else belongs to the top), at its first pose.
struct SmallModel {
  MujocoModelPtr model;
  MujocoDataPtr data;

  explicit SmallModel(const std::string& worldbody, const std::string& top = "")
      : model(LoadMujocoModel("<mujoco><compiler angle='radian'/>" + top + "<worldbody>" +
                                  worldbody + "</worldbody></mujoco>",
                              "small model")),
        data(MakeMujocoData(*model)) {
    mj_kinematics(model.get(), data.get());
  }

  /// Puts mocap body `index` somewhere.
  void Place(int index, const Pose& X_WO) {
    const Eigen::Quaterniond& R = X_WO.rotation();
    Eigen::Map<Eigen::Vector3d>(data->mocap_pos + 3 * index) = X_WO.translation();
    Eigen::Map<Eigen::Vector4d>(data->mocap_quat + 4 * index) << R.w(), R.x(), R.y(), R.z();
    mj_kinematics(model.get(), data.get());
  }

  int Geom(const std::string& name) const {
    return mj_name2id(model.get(), mjOBJ_GEOM, name.c_str());
  }
};

}  // namespace sidestep::sim
