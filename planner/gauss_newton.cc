#include "sidestep/planner/gauss_newton.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "sidestep/planner/gp_trajectory.h"

namespace sidestep::planner {
namespace {

void RequireOfGaussNewton(bool condition, const std::string& what) {
  if (!condition) throw std::invalid_argument("GaussNewton: " + what);
}

void Check(const robot::RobotModel& robot, const Trajectory& initial,
           const GaussNewtonOptions& options) {
  CheckTrajectory(initial);
  RequireOfGaussNewton(initial.num_joints() == robot.num_joints(),
                       "the trajectory must have the robot's joints");
  RequireOfGaussNewton(initial.num_states() >= 2, "needs at least 2 states");
  RequireOfGaussNewton(options.epsilon_m >= 0 && options.sigma_obs > 0 && options.qc > 0,
                       "epsilon must be >= 0, sigma and qc > 0");
  RequireOfGaussNewton(options.num_interpolated >= 0 && options.max_iterations >= 0,
                       "num_interpolated and max_iterations must be >= 0");
}

}  // namespace

GaussNewton::GaussNewton(const robot::RobotModel& robot, const Trajectory& initial,
                         const GaussNewtonOptions& options)
    : robot_(robot),
      options_(options),
      n_(robot.num_joints()),
      K_(initial.num_states()),
      t_s_(initial.t_s),
      obstacles_(static_cast<std::size_t>(initial.num_states())),
      hessian_(initial.num_states(), 2 * robot.num_joints()) {
  Check(robot, initial, options);
  step_s_ = (t_s_(K_ - 1) - t_s_(0)) / (K_ - 1);
  states_.resize(2 * n_, K_);
  states_ << initial.q, initial.v;
  for (int j = 1; j <= options.num_interpolated; ++j) {
    const GpInterpolation between =
        InterpolateGp(step_s_, step_s_ * j / (options.num_interpolated + 1));
    weights_.emplace_back(between.Lambda(0, 0), between.Lambda(0, 1), between.Psi(0, 0),
                          between.Psi(0, 1));
  }
  // The residual of an interval is Phi x0 - x1, its cost half of r^T Q^-1 r.
  Eigen::Matrix<double, 2, 4> dr_dx;
  dr_dx << GpTransition(step_s_), -Eigen::Matrix2d::Identity();
  gp_joint_ = dr_dx.transpose() * GpInformation(step_s_, options.qc) * dr_dx;
  gp_pair_.setZero(4 * n_, 4 * n_);
  for (int a = 0; a < 4; ++a) {
    for (int b = 0; b < 4; ++b) {
      gp_pair_.block(a * n_, b * n_, n_, n_).diagonal().setConstant(gp_joint_(a, b));
    }
  }
}

void GaussNewton::SetField(int k, const sdf::DistanceField& field, EpisodeTime start) {
  StepObstacles& step = obstacles_.at(static_cast<std::size_t>(k));
  step.hinge =
      std::make_unique<ObstacleHinge>(robot_, field, options_.epsilon_m, options_.sigma_obs);
  step.start = start;
  step.is_current = false;
}

void GaussNewton::AddPrior(int k, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                           double sigma) {
  RequireOfGaussNewton(k >= 0 && k < K_ && q.size() == n_ && v.size() == n_ && sigma > 0,
                       "a prior needs a state, n positions, n velocities and a sigma > 0");
  Eigen::VectorXd x(2 * n_);
  x << q, v;
  priors_.push_back({k, x, sigma});
}

void GaussNewton::Linearise(int k) {
  StepObstacles& step = obstacles_[static_cast<std::size_t>(k)];
  if (step.is_current || !step.hinge) return;
  step.error = 0;
  step.H.setZero(4 * n_, 4 * n_);
  step.gradient.setZero(4 * n_);
  if (k == 0) {
    AddHinges(step, 0, {1, 0, 0, 0}, 0);
  } else {
    const double parts = options_.num_interpolated + 1;
    for (int j = 0; j < options_.num_interpolated; ++j) {
      AddHinges(step, k - 1, weights_[static_cast<std::size_t>(j)], (j + 1) / parts);
    }
    AddHinges(step, k - 1, {0, 0, 1, 0}, 1);
  }
  step.is_current = true;
}

void GaussNewton::AddHinges(StepObstacles& step, int begin, const Eigen::Vector4d& weights,
                            double share) {
  const Eigen::Map<const Eigen::MatrixXd> pair(states_.col(begin).data(), n_, 4);
  const double t_s = t_s_(begin) + share * (t_s_(begin + 1) - t_s_(begin));
  step.hinge->Evaluate(pair * weights, step.start + HorizonOffset(t_s), /*with_jacobian=*/true);
  const Eigen::VectorXd& h = step.hinge->hinges();
  const double error = 0.5 * h.squaredNorm();
  if (error == 0) return;
  step.error += error;

  Eigen::MatrixXd JtJ = Eigen::MatrixXd::Zero(n_, n_);
  Eigen::VectorXd Jth = Eigen::VectorXd::Zero(n_);
  for (Eigen::Index s = 0; s < h.size(); ++s) {
    if (h(s) == 0) continue;
    const auto row = step.hinge->jacobian().row(s);
    Jth += h(s) * row.transpose();
    JtJ += row.transpose() * row;
  }
  for (int a = 0; a < 4; ++a) {
    if (weights(a) == 0) continue;
    step.gradient.segment(a * n_, n_) += weights(a) * Jth;
    for (int b = 0; b <= a; ++b) {
      if (weights(b) == 0) continue;
      step.H.block(a * n_, b * n_, n_, n_) += (weights(a) * weights(b)) * JtJ;
    }
  }
}

bool GaussNewton::Step() {
  const int D = 2 * n_;
  Eigen::VectorXd step = Eigen::VectorXd::Zero(K_ * D);  // minus the gradient, then the step
  hessian_.SetZero();
  for (int k = 0; k + 1 < K_; ++k) {
    hessian_.AddPair(k, gp_pair_);
    Eigen::Map<Eigen::MatrixXd>(step.data() + k * D, n_, 4) -=
        Eigen::Map<const Eigen::MatrixXd>(states_.col(k).data(), n_, 4) * gp_joint_;
  }
  for (int k = 0; k < K_; ++k) {
    const StepObstacles& obstacles = obstacles_[static_cast<std::size_t>(k)];
    if (!obstacles.hinge || obstacles.error == 0) continue;
    const int begin = std::max(k - 1, 0);
    hessian_.AddPair(begin, obstacles.H);
    step.segment(begin * D, 2 * D) -= obstacles.gradient;
  }
  for (const Prior& prior : priors_) {
    const double information = 1 / (prior.sigma * prior.sigma);
    hessian_.AddToDiagonal(prior.k, information);
    step.segment(prior.k * D, D) -= information * (states_.col(prior.k) - prior.x);
  }
  if (!hessian_.Solve(step) || !step.allFinite()) return false;
  states_ += step.reshaped(D, K_);
  for (StepObstacles& obstacles : obstacles_) obstacles.is_current = false;
  return true;
}

GaussNewtonSummary GaussNewton::Solve() {
  GaussNewtonSummary summary;
  summary.errors.push_back(ComputeCost().total());
  while (summary.iterations() < options_.max_iterations && !summary.converged &&
         !options_.budget.IsSpent(summary.iterations())) {
    if (!Step()) break;
    const double before = summary.errors.back(), after = ComputeCost().total();
    summary.errors.push_back(after);
    const double decrease = before - after;
    summary.converged =
        decrease <= options_.absolute_decrease || decrease <= options_.relative_decrease * before;
  }
  return summary;
}

Trajectory GaussNewton::GetTrajectory() const {
  return {t_s_, states_.topRows(n_), states_.bottomRows(n_)};
}

PlanCost GaussNewton::ComputeCost() {
  PlanCost cost;
  cost.gp = ComputeGpCost(GetTrajectory(), options_.qc);
  for (int k = 0; k < K_; ++k) {
    Linearise(k);
    cost.obstacle += obstacles_[static_cast<std::size_t>(k)].error;
  }
  for (const Prior& prior : priors_) {
    cost.goal += 0.5 * ((states_.col(prior.k) - prior.x) / prior.sigma).squaredNorm();
  }
  return cost;
}

}  // namespace sidestep::planner
