#include "sidestep/sim/contact_room.h"

#include <algorithm>
#include <utility>

namespace sidestep::sim {
namespace {

constexpr int kMaxConstraints = 6400;  // of which each pair takes 12 bytes

void CopyState(const mjModel& model, const mjData& from, mjData* to) {
  const auto copy = [](const mjtNum* values, int count, mjtNum* target) {
    std::copy_n(values, count, target);
  };
  to->time = from.time;
  copy(from.qpos, model.nq, to->qpos);
  copy(from.qvel, model.nv, to->qvel);
  copy(from.act, model.na, to->act);
  copy(from.ctrl, model.nu, to->ctrl);
  copy(from.qfrc_applied, model.nv, to->qfrc_applied);
  copy(from.xfrc_applied, 6 * model.nbody, to->xfrc_applied);
  copy(from.mocap_pos, 3 * model.nmocap, to->mocap_pos);
  copy(from.mocap_quat, 4 * model.nmocap, to->mocap_quat);
  copy(from.userdata, model.nuserdata, to->userdata);
  copy(from.qacc_warmstart, model.nv, to->qacc_warmstart);  // where the next solution begins
  copy(from.qfrc_actuator, model.nv, to->qfrc_actuator);    // of the step that led here
}

}  // namespace

bool LacksContactRoom(const mjData& data) {
  return data.warning[mjWARN_CONTACTFULL].number > 0 || data.warning[mjWARN_CNSTRFULL].number > 0;
}

bool DoubleContactRoom(mjModel* model, MujocoDataPtr* data) {
  if (2 * model->njmax > kMaxConstraints) return false;
  model->nconmax *= 2;
  model->njmax *= 2;
  model->nstack *= 4;  // as MuJoCo reckons it: by the square of the constraints
  MujocoDataPtr roomy = MakeMujocoData(*model);
  CopyState(*model, **data, roomy.get());
  *data = std::move(roomy);
  return true;
}

}  // namespace sidestep::sim
