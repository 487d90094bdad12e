#include "sidestep/sim/tied_joints.h"

namespace sidestep::sim {

void FollowLeaders(const mjModel& model, mjData* data) {
  for (int tie = 0; tie < model.neq; ++tie) {
    if (model.eq_type[tie] != mjEQ_JOINT || model.eq_active[tie] == 0) continue;
    const int follower = model.jnt_qposadr[model.eq_obj1id[tie]];
    const int leader_joint = model.eq_obj2id[tie];
    double lead = 0;
    if (leader_joint >= 0) {
      const int leader = model.jnt_qposadr[leader_joint];
      lead = data->qpos[leader] - model.qpos0[leader];
    }
    // position - its reference = a polynomial of the other's
    double offset = 0;
    for (int power = 4; power >= 0; --power) {
      offset = offset * lead + model.eq_data[mjNEQDATA * tie + power];
    }
    data->qpos[follower] = model.qpos0[follower] + offset;
  }
}

}  // namespace sidestep::sim
