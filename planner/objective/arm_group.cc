#include "sidestep/planner/objective/arm_group.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "sidestep/planner/guarded_spheres.h"

namespace sidestep::planner {
namespace {

using obstacle_kernels::Arm;
using obstacle_kernels::kGroup;

// The row in whose frame a sphere stands; -1: the base.
int RowOf(const robot::RobotModel& robot, int sphere) {
  const int link = robot.spheres()[static_cast<std::size_t>(sphere)].link;
  return robot.kinematics().link(link).row;
}

// The robot's spheres, row by row.
std::vector<int> SpheresByRow(const robot::RobotModel& robot) {
  std::vector<int> order(static_cast<std::size_t>(robot.num_spheres()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return RowOf(robot, a) < RowOf(robot, b); });
  return order;
}

// The coordinates of rows, ascending, none twice.
std::vector<int> CoordinatesOf(const robot::RobotModel& robot, const std::vector<int>& rows) {
  std::set<int> coordinates;
  for (const int row : rows) {
    coordinates.insert(robot.kinematics().rows()[static_cast<std::size_t>(row)].coordinate);
  }
  return {coordinates.begin(), coordinates.end()};
}

Arm::Movers MakeMovers(const robot::RobotModel& robot, const std::vector<int>& rows,
                       const std::vector<int>& coordinates) {
  Arm::Movers movers;
  movers.coordinates = coordinates;
  for (const int row : rows) {
    const int coordinate = robot.kinematics().rows()[static_cast<std::size_t>(row)].coordinate;
    const auto at = std::lower_bound(coordinates.begin(), coordinates.end(), coordinate);
    movers.rows.push_back({row, static_cast<int>(at - coordinates.begin())});
  }
  return movers;
}

Arm::LinkHinge MakeLinkHinge(const robot::RobotModel& robot, const robot::LinkPair& links,
                             const std::vector<int>& place) {
  const auto movers_of = [&robot](int link) {
    return robot.kinematics().movers(robot.kinematics().link(link).row);
  };
  const std::vector<int> first = movers_of(links.first), second = movers_of(links.second);
  std::vector<int> of_first, of_second, of_both;  // rows ascend, as the base comes first
  std::set_difference(first.begin(), first.end(), second.begin(), second.end(),
                      std::back_inserter(of_first));
  std::set_difference(second.begin(), second.end(), first.begin(), first.end(),
                      std::back_inserter(of_second));
  std::set_union(of_first.begin(), of_first.end(), of_second.begin(), of_second.end(),
                 std::back_inserter(of_both));
  const std::vector<int> coordinates = CoordinatesOf(robot, of_both);

  Arm::LinkHinge hinge{
      MakeMovers(robot, of_first, coordinates), MakeMovers(robot, of_second, coordinates), {}};
  for (int a = 0; a < robot.num_spheres(); ++a) {
    for (int b = 0; b < robot.num_spheres(); ++b) {
      const robot::CollisionSphere& one = robot.spheres()[static_cast<std::size_t>(a)];
      const robot::CollisionSphere& other = robot.spheres()[static_cast<std::size_t>(b)];
      if (one.link != links.first || other.link != links.second) continue;
      hinge.pairs.push_back({place[static_cast<std::size_t>(a)], place[static_cast<std::size_t>(b)],
                             one.radius_m, other.radius_m});
    }
  }
  return hinge;
}

}  // namespace

std::shared_ptr<const Arm> MakeArm(const robot::RobotModel& robot, double epsilon_m, double sigma,
                                   std::optional<double> self_epsilon_m) {
  const robot::Kinematics& kinematics = robot.kinematics();
  auto made = std::make_shared<Arm>();
  Arm& arm = *made;
  arm.num_joints = robot.num_joints();
  const Eigen::Matrix3d R_WB = robot.X_WB().rotation().toRotationMatrix();
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(arm.R_WB.data()) = R_WB;
  Eigen::Map<Eigen::Vector3d>(arm.p_WB.data()) = robot.X_WB().translation();

  const std::vector<int> by_row = SpheresByRow(robot);
  std::vector<int> place(by_row.size());  // of the robot's sphere among the arm's
  for (std::size_t s = 0; s < by_row.size(); ++s) {
    const robot::CollisionSphere& sphere = robot.spheres()[static_cast<std::size_t>(by_row[s])];
    place[static_cast<std::size_t>(by_row[s])] = static_cast<int>(s);
    const Eigen::Vector3d p_KS = kinematics.link(sphere.link).OnRow(sphere.p_LS);
    arm.spheres.push_back({{p_KS.x(), p_KS.y(), p_KS.z()}});
  }
  std::size_t end_sphere = 0;
  const auto end_of = [&](int row) {
    while (end_sphere < by_row.size() && RowOf(robot, by_row[end_sphere]) == row) ++end_sphere;
    return static_cast<int>(end_sphere);
  };
  arm.end_base_sphere = end_of(-1);
  arm.movers.emplace_back();
  for (int i = 0; i < static_cast<int>(kinematics.rows().size()); ++i) {
    arm.rows.push_back({kinematics.rows()[static_cast<std::size_t>(i)], end_of(i)});
    const std::vector<int>& movers = kinematics.movers(i);
    arm.movers.push_back(MakeMovers(robot, movers, CoordinatesOf(robot, movers)));
  }
  for (const int s : GuardedSpheres(robot)) {
    const robot::CollisionSphere& sphere = robot.spheres()[static_cast<std::size_t>(s)];
    arm.hinges.push_back({place[static_cast<std::size_t>(s)], RowOf(robot, s) + 1, sphere.radius_m,
                          epsilon_m + sphere.radius_m});
  }
  arm.inverse_sigma = 1 / sigma;
  if (!self_epsilon_m) return made;
  arm.self_epsilon_m = *self_epsilon_m;
  for (const robot::LinkPair& links : robot.self_collision()) {
    arm.link_hinges.push_back(MakeLinkHinge(robot, links, place));
  }
  return made;
}

ArmGroup::ArmGroup(std::shared_ptr<const Arm> arm) : arm_(std::move(arm)) {
  const auto n = static_cast<std::size_t>(arm_->num_joints);
  q_8_.assign(kGroup * n, 0.0);
  axes_8_.assign(kGroup * arm_->rows.size() * obstacle_kernels::kNumbersPerAxis, 0.0);
  centers_8_.assign(kGroup * 3 * arm_->spheres.size(), 0.0);
  samples_8_.assign(kGroup * 4 * arm_->hinges.size(), 0.0);
  constexpr std::size_t kPoints = sdf::PointBlock::kSize;
  blocks_.resize(kGroup * ((arm_->hinges.size() + kPoints - 1) / kPoints));
}

void ArmGroup::Place(const Eigen::Ref<const Eigen::MatrixXd>& q, double* axes_8) {
  for (Eigen::Index c = 0; c < kSize; ++c) {
    // What is left of the group is filled with its last configuration.
    const auto q_c = q.col(std::min(c, q.cols() - 1));
    for (Eigen::Index j = 0; j < q.rows(); ++j) {
      q_8_[static_cast<std::size_t>(kSize * j + c)] = q_c(j);
    }
  }
  obstacle_kernels::ComputeCenters(*arm_, q_8_.data(), axes_8, centers_8_.data());

  // All at once: a vector that is read just after it was written number by number is waited for.
  sdf::PointBlock* blocks = blocks_.data();
  for (std::size_t begin = 0; begin < arm_->hinges.size(); begin += sdf::PointBlock::kSize) {
    const std::size_t count = std::min(sdf::PointBlock::kSize, arm_->hinges.size() - begin);
    for (std::size_t n = 0; n < count; ++n) {
      const double* const center =
          &centers_8_[3 * kGroup * static_cast<std::size_t>(arm_->hinges[begin + n].sphere)];
      for (std::size_t c = 0; c < kGroup; ++c) {
        blocks[c].x[n] = center[c];
        blocks[c].y[n] = center[kGroup + c];
        blocks[c].z[n] = center[2 * kGroup + c];
      }
    }
    for (std::size_t c = 0; c < kGroup; ++c, ++blocks) {
      blocks->count = count;
      blocks->Pad();
    }
  }
}

int ArmGroup::Ask(int c, const sdf::FieldSlice& slice, bool with_gradients) {
  int num_outside = 0;
  double* sample = samples_8_.data() + c;
  for (auto at = static_cast<std::size_t>(c); at < blocks_.size(); at += kGroup) {
    sdf::PointBlock& block = blocks_[at];
    block.with_gradients = with_gradients;
    num_outside += slice.SampleBlock(block);
    for (std::size_t n = 0; n < block.count; ++n, sample += 4 * kGroup) {
      sample[0] = block.distance_m[n];
      if (!with_gradients) continue;
      sample[kGroup] = block.gradient_x[n];
      sample[2 * kGroup] = block.gradient_y[n];
      sample[3 * kGroup] = block.gradient_z[n];
    }
  }
  return num_outside;
}

}  // namespace sidestep::planner
