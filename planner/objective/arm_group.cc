#include "sidestep/planner/objective/arm_group.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sidestep/planner/guarded_spheres.h"
#include "sidestep/sdf/point_block.h"

namespace sidestep::planner {
namespace {

using obstacle_kernels::Arm;
using obstacle_kernels::kGroup;

// The robot's spheres, link by link.
std::vector<int> SpheresByLink(const robot::RobotModel& robot) {
  std::vector<int> order(static_cast<std::size_t>(robot.num_spheres()));
  for (std::size_t s = 0; s < order.size(); ++s) order[s] = static_cast<int>(s);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return robot.spheres()[static_cast<std::size_t>(a)].link <
           robot.spheres()[static_cast<std::size_t>(b)].link;
  });
  return order;
}

Arm MakeArm(const robot::RobotModel& robot, double epsilon_m, double sigma,
            std::optional<double> self_epsilon_m) {
  Arm arm;
  arm.num_joints = robot.num_joints();
  const Eigen::Matrix3d R_WB = robot.X_WB().rotation().toRotationMatrix();
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(arm.R_WB.data()) = R_WB;
  Eigen::Map<Eigen::Vector3d>(arm.p_WB.data()) = robot.X_WB().translation();

  const std::vector<int> by_link = SpheresByLink(robot);
  std::vector<int> place(by_link.size());  // of the robot's sphere among the arm's
  for (std::size_t s = 0; s < by_link.size(); ++s) {
    const robot::CollisionSphere& sphere = robot.spheres()[static_cast<std::size_t>(by_link[s])];
    place[static_cast<std::size_t>(by_link[s])] = static_cast<int>(s);
    arm.spheres.push_back({{sphere.p_LS.x(), sphere.p_LS.y(), sphere.p_LS.z()}});
  }
  int end_sphere = 0;
  for (int i = 0; i < arm.num_joints; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const robot::DhRow& row = robot.dh()[k];
    while (end_sphere < robot.num_spheres() &&
           robot.spheres()[static_cast<std::size_t>(by_link[static_cast<std::size_t>(end_sphere)])]
                   .link == i) {
      ++end_sphere;
    }
    arm.joints[k] = {row.theta_rad,           row.d_m,   row.a_m, std::cos(row.alpha_rad),
                     std::sin(row.alpha_rad), end_sphere};
  }
  for (const int s : GuardedSpheres(robot)) {
    const robot::CollisionSphere& sphere = robot.spheres()[static_cast<std::size_t>(s)];
    arm.hinges.push_back({place[static_cast<std::size_t>(s)], sphere.link, sphere.radius_m,
                          epsilon_m + sphere.radius_m});
  }
  arm.inverse_sigma = 1 / sigma;
  if (!self_epsilon_m) return arm;
  arm.self_epsilon_m = *self_epsilon_m;
  for (const robot::LinkPair& links : robot.self_collision()) {
    Arm::LinkHinge& hinge = arm.link_hinges.emplace_back();
    hinge.first = links.first;
    hinge.second = links.second;
    for (int a = 0; a < robot.num_spheres(); ++a) {
      for (int b = 0; b < robot.num_spheres(); ++b) {
        const robot::CollisionSphere& first = robot.spheres()[static_cast<std::size_t>(a)];
        const robot::CollisionSphere& second = robot.spheres()[static_cast<std::size_t>(b)];
        if (first.link != links.first || second.link != links.second) continue;
        hinge.pairs.push_back({place[static_cast<std::size_t>(a)],
                               place[static_cast<std::size_t>(b)], first.radius_m,
                               second.radius_m});
      }
    }
  }
  return arm;
}

}  // namespace

ArmGroup::ArmGroup(const robot::RobotModel& robot, double epsilon_m, double sigma,
                   std::optional<double> self_epsilon_m)
    : arm_(MakeArm(robot, epsilon_m, sigma, self_epsilon_m)) {
  const auto n = static_cast<std::size_t>(arm_.num_joints);
  q_8_.assign(kGroup * n, 0.0);
  axes_8_.assign(kGroup * n * obstacle_kernels::kNumbersPerAxis, 0.0);
  centers_8_.assign(kGroup * 3 * arm_.spheres.size(), 0.0);
  samples_8_.assign(kGroup * 4 * arm_.hinges.size(), 0.0);
}

void ArmGroup::Place(const Eigen::Ref<const Eigen::MatrixXd>& q) {
  for (Eigen::Index c = 0; c < kSize; ++c) {
    // What is left of the group is filled with its last configuration.
    const auto q_c = q.col(std::min(c, q.cols() - 1));
    for (Eigen::Index j = 0; j < q.rows(); ++j) {
      q_8_[static_cast<std::size_t>(kSize * j + c)] = q_c(j);
    }
  }
  obstacle_kernels::ComputeCenters(arm_, q_8_.data(), axes_8_.data(), centers_8_.data());
}

int ArmGroup::Sample(int c, const sdf::FieldSlice& slice) {
  int num_outside = 0;
  sdf::PointBlock block;
  for (std::size_t begin = 0; begin < arm_.hinges.size(); begin += sdf::PointBlock::kSize) {
    block.count = std::min(sdf::PointBlock::kSize, arm_.hinges.size() - begin);
    for (std::size_t n = 0; n < block.count; ++n) {
      const double* const center =
          &centers_8_[3 * kGroup * static_cast<std::size_t>(arm_.hinges[begin + n].sphere)] + c;
      block.x[n] = center[0];
      block.y[n] = center[kGroup];
      block.z[n] = center[2 * kGroup];
    }
    block.Pad();
    num_outside += slice.SampleBlock(block);
    double* sample = &samples_8_[4 * kGroup * begin] + c;
    for (std::size_t n = 0; n < block.count; ++n, sample += 4 * kGroup) {
      sample[0] = block.distance_m[n];
      sample[kGroup] = block.gradient_x[n];
      sample[2 * kGroup] = block.gradient_y[n];
      sample[3 * kGroup] = block.gradient_z[n];
    }
  }
  return num_outside;
}

}  // namespace sidestep::planner
