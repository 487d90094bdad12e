#include "sidestep/sim/link_frame.h"

#include <Eigen/Geometry>

namespace sidestep::sim {

LinkFrame FindLinkFrame(const robot::RobotModel& robot, const mjModel& model, std::size_t joint) {
  std::string name = robot.joints()[joint].link;
  if (robot.joints()[joint].dh) {
    std::size_t row = 0;
    for (std::size_t k = 0; k <= joint; ++k) row += robot.joints()[k].dh.has_value();
    name = "dh" + std::to_string(row);
  } else if (const int body = mj_name2id(&model, mjOBJ_BODY, name.c_str()); body >= 0) {
    return {false, body, name};
  }
  return {true, mj_name2id(&model, mjOBJ_SITE, name.c_str()), name};
}

Pose PoseOf(const mjData& data, const LinkFrame& frame) {
  if (!frame.is_site) {
    const mjtNum* const R = data.xquat + 4 * frame.id;
    return Pose(Eigen::Quaterniond(R[0], R[1], R[2], R[3]),
                Eigen::Map<const Eigen::Vector3d>(data.xpos + 3 * frame.id));
  }
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(data.site_xmat +
                                                                         9 * frame.id);
  return Pose(Eigen::Quaterniond(Eigen::Matrix3d(R)),
              Eigen::Map<const Eigen::Vector3d>(data.site_xpos + 3 * frame.id));
}

}  // namespace sidestep::sim
