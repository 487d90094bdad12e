#include "sidestep/planner/objective/obstacle_objective.h"

#include <algorithm>
#include <utility>

#include "sidestep/planner/costs/obstacle_hinge.h"

namespace sidestep::planner {
ObstacleQuadratics::ObstacleQuadratics(int num_joints, int count)
    : n_(num_joints),
      rows_(PaddedRows(num_joints)),
      costs_(static_cast<std::size_t>(count), 0.0),
      gradients_(static_cast<std::size_t>(count * rows_), 0.0),
      hessians_(static_cast<std::size_t>(count * n_ * rows_), 0.0) {}

ObstacleQuadratic ObstacleQuadratics::Get(int c) const {
  return {cost(c), Eigen::Map<const Eigen::VectorXd>(gradient(c), n_),
          Eigen::Map<const Eigen::MatrixXd>(hessian(c), rows_, n_).topRows(n_)};
}

ObstacleObjective::ObstacleObjective(std::shared_ptr<const obstacle_kernels::Arm> arm)
    : group_(std::move(arm)) {
  terms_8_.assign(ArmGroup::kSize * static_cast<std::size_t>(group_.arm().num_terms()), 0.0);
}

void ObstacleObjective::Evaluate(const Eigen::MatrixXd& q,
                                 const std::vector<const sdf::FieldSlice*>& slices,
                                 ObstacleQuadratics& quadratics) {
  const int n = group_.arm().num_joints, rows = ObstacleQuadratics::PaddedRows(n);
  const int count = static_cast<int>(q.cols());
  for (int begin = 0; begin < count; begin += ArmGroup::kSize) {
    const int size = std::min(ArmGroup::kSize, count - begin);
    group_.Place(q.middleCols(begin, size));
    for (int lane = 0; lane < size; ++lane) {
      group_.Sample(lane,
                    *slices[static_cast<std::size_t>(begin) + static_cast<std::size_t>(lane)]);
    }
    obstacle_kernels::ComputeTerms(group_.arm(), group_.axes_8(), group_.centers_8(),
                                   group_.samples_8(), terms_8_.data());
    for (int lane = 0; lane < size; ++lane) {
      const double* term = terms_8_.data() + lane;
      const int c = begin + lane;
      quadratics.cost(c) = *term;
      if (*term == 0) continue;  // nobody looks at the rest
      double* const gradient = quadratics.gradient(c);
      double* const hessian = quadratics.hessian(c);
      for (int j = 0; j < n; ++j) gradient[j] = *(term += ArmGroup::kSize);
      for (int a = 0; a < n; ++a) {
        for (int b = 0; b <= a; ++b) {
          hessian[b * rows + a] = hessian[a * rows + b] = *(term += ArmGroup::kSize);
        }
      }
    }
  }
}

ObstacleQuadratic ReferenceQuadratic(const robot::RobotModel& robot,
                                     const sdf::DistanceField& field, double epsilon_m,
                                     double sigma, std::optional<double> self_epsilon_m,
                                     const Eigen::VectorXd& q, EpisodeTime t) {
  ObstacleHinge hinge(robot, field, epsilon_m, sigma, self_epsilon_m);
  hinge.Evaluate(q, t, /*with_jacobian=*/true);
  const Eigen::VectorXd& h = hinge.hinges();
  const RowMajorMatrix& J = hinge.jacobian();
  return {0.5 * h.squaredNorm(), J.transpose() * h, J.transpose() * J};
}

}  // namespace sidestep::planner
