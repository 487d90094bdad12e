#include "sidestep/control/arm_capsules.h"

namespace sidestep::control {

ArmCapsules::ArmCapsules(const robot::RobotModel& robot)
    : num_joints_(robot.num_joints()),
      size_(static_cast<int>(robot.capsules().size())),
      rows_(robot.kinematics().rows()),
      R_WB_(robot.X_WB().rotation().toRotationMatrix()),
      p_WB_(robot.X_WB().translation()) {
  for (std::size_t k = 0; k < robot.capsules().size(); ++k) {
    const robot::CollisionCapsule& capsule = robot.capsules()[k];
    const robot::LinkOnRow& link = robot.kinematics().link(capsule.link);
    capsules_[k] = {link.row, link.OnRow(capsule.p_LA), link.OnRow(capsule.p_LB), capsule.radius_m};
  }
}

void ArmCapsules::Place(const JointVector& q, All& placed) const noexcept {
  robot::RowPlaces places;
  places.of[0].R_WK = R_WB_;
  places.of[0].p_WK = p_WB_;
  PlaceRows(rows_, q, places);
  for (std::size_t k = 0; k < static_cast<std::size_t>(size_); ++k) {
    const OnRow& capsule = capsules_[k];
    const robot::RowPlace& place = places[capsule.row];
    placed[k] = {place.p_WK + place.R_WK * capsule.p_KA, place.p_WK + place.R_WK * capsule.p_KB,
                 capsule.radius_m, capsule.row >= 0};
  }
}

}  // namespace sidestep::control
