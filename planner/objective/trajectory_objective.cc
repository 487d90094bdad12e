#include "sidestep/planner/objective/trajectory_objective.h"

#include <algorithm>
#include <utility>

#include "sidestep/planner/gp_trajectory.h"

namespace sidestep::planner {

std::shared_ptr<const obstacle_kernels::Arm> TrajectoryObjective::MakeArm(
    const robot::RobotModel& robot, const GpProblemOptions& options) {
  return planner::MakeArm(robot, options.epsilon_m, options.sigma_obs, options.self_epsilon_m);
}

TrajectoryObjective::TrajectoryObjective(std::shared_ptr<const obstacle_kernels::Arm> arm,
                                         const PlanRequest& request, const Eigen::VectorXd& t_s,
                                         const GpProblemOptions& options)
    : options_(options),
      n_(arm->num_joints),
      t_s_(t_s),
      step_s_(request.step_s),
      num_fixed_(request.num_fixed),
      first_free_(options.sigma_fixed ? 0 : request.num_fixed),
      x_start_(2 * n_),
      x_goal_(Eigen::VectorXd::Zero(2 * n_)),
      gp_(request.step_s, options.qc),
      obstacles_(std::move(arm)),
      at_places_(n_, (num_states() - first_free_) * (options.num_interpolated + 1)) {
  x_start_ << request.q_start, request.v_start;
  x_goal_.head(n_) = request.q_goal;
  std::vector<std::array<double, 4>> weights;  // of the configurations in an interval
  for (int j = 1; j <= options.num_interpolated; ++j) {
    const double tau_s = step_s_ * j / (options.num_interpolated + 1);
    const GpInterpolation between = InterpolateGp(step_s_, tau_s);
    weights.push_back(
        {between.Lambda(0, 0), between.Lambda(0, 1), between.Psi(0, 0), between.Psi(0, 1)});
  }
  const auto add = [&](const Place& place, double t_place_s) {
    places_.push_back(place);
    slices_.push_back(request.field->At(request.start + HorizonOffset(t_place_s)));
    slice_of_.push_back(slices_.back().get());
  };
  for (int k = first_free_; k < num_states(); ++k) {
    for (int j = 1; k > 0 && j <= options.num_interpolated; ++j) {
      const double tau_s = step_s_ * j / (options.num_interpolated + 1);
      add({k - 1, true, weights[static_cast<std::size_t>(j - 1)]}, t_s_(k - 1) + tau_s);
    }
    add({k, false, {0, 0, 1, 0}}, t_s_(k));
    end_place_.push_back(places_.size());
  }
  q_.resize(n_, static_cast<Eigen::Index>(places_.size()));
}

void TrajectoryObjective::Restart(const Trajectory& initial) {
  limits_.reset();
  priors_.clear();
  for (int k = 0; options_.sigma_fixed && k < num_fixed_; ++k) {
    Eigen::VectorXd x(2 * n_);
    x << initial.q.col(k), initial.v.col(k);
    priors_.push_back({k, k == 0 ? x_start_ : x, *options_.sigma_fixed});
  }
  priors_.push_back({num_states() - 1, x_goal_, options_.sigma_goal});
  std::vector<double> information(static_cast<std::size_t>(num_states() - first_free_), 0.0);
  for (const Prior& prior : priors_) {
    information[static_cast<std::size_t>(prior.state - first_free_)] +=
        1 / (prior.sigma * prior.sigma);
  }
  bound_.emplace(step_s_, options_.qc, information, /*follows_fixed=*/first_free_ > 0);
}

void TrajectoryObjective::Evaluate(const Eigen::MatrixXd& states, ChainQuadratic& quadratic) {
  quadratic.SetZero();
  Look(states);
  for (int k = first_free_; k < num_states(); ++k) AddStep(states, k, k - first_free_, quadratic);
  const int height = 2 * quadratic.stride();
  for (const Prior& prior : priors_) {
    double* const gradient = quadratic.gradient(prior.state - first_free_);
    double* const panel = quadratic.panel(prior.state - first_free_);
    const double information = 1 / (prior.sigma * prior.sigma);
    double square = 0;
    for (int i = 0; i < 2 * n_; ++i) {
      const double off = states(i, prior.state) - prior.x(i);
      square += off * off;
      gradient[i] += information * off;
      panel[i * height + i] += information;
    }
    quadratic.cost.goal += 0.5 * information * square;
  }
}

void TrajectoryObjective::Look(const Eigen::MatrixXd& states) {
  for (std::size_t c = 0; c < places_.size(); ++c) {
    const Place& place = places_[c];
    double* const q = q_.col(static_cast<Eigen::Index>(c)).data();
    const double* const x = states.col(place.state).data();
    if (!place.is_between) {
      std::copy_n(x, n_, q);
      continue;
    }
    const auto& w = place.weights;
    for (int i = 0; i < n_; ++i) {
      q[i] = (w[0] * x[i] + w[1] * x[n_ + i]) + (w[2] * x[2 * n_ + i] + w[3] * x[3 * n_ + i]);
    }
  }
  obstacles_.Evaluate(q_, slice_of_, at_places_);
}

void TrajectoryObjective::AddStep(const Eigen::MatrixXd& states, int k, int block,
                                  ChainQuadratic& quadratic) {
  AddObstacles(k, block, quadratic);
  if (k > 0) AddInterval(states, k, block, quadratic);
  if (limits_) AddStateLimits(states, k, block, quadratic);
}

void TrajectoryObjective::AddObstacles(int k, int block, ChainQuadratic& quadratic) {
  const auto free = static_cast<std::size_t>(k - first_free_);
  between_.clear();
  for (std::size_t c = free == 0 ? 0 : end_place_[free - 1]; c < end_place_[free]; ++c) {
    const int index = static_cast<int>(c);
    if (at_places_.cost(index) == 0) continue;
    quadratic.cost.obstacle += at_places_.cost(index);
    between_.push_back({at_places_.gradient(index), at_places_.hessian(index), places_[c].weights,
                        !places_[c].is_between});
  }
  if (between_.empty()) return;
  chain_kernels::IntervalTarget target;
  target.far_panel = quadratic.panel(block);
  target.far_gradient = quadratic.gradient(block);
  if (block > 0) {
    target.near_panel = quadratic.panel(block - 1);
    target.near_gradient = quadratic.gradient(block - 1);
  }
  chain_kernels::AddBetween(n_, quadratic.stride(), between_, target);
}

// Of the interval that ends at state k: the GP prior, and the limits within.
void TrajectoryObjective::AddInterval(const Eigen::MatrixXd& states, int k, int block,
                                      ChainQuadratic& quadratic) const {
  const double* const near = states.col(k - 1).data();
  const double* const far = states.col(k).data();
  for (int i = 0; i < n_; ++i) {
    const std::array<double, 4> x = {near[i], near[n_ + i], far[i], far[n_ + i]};
    std::array<double, 4> gradient;
    quadratic.cost.gp += gp_.At(x, gradient);
    AddJoint(gradient, gp_.hessian(), i, block, quadratic);
    if (!limits_) continue;
    const LimitWeights& weights = limits_->weights;
    const auto add = [&](const LimitTerm& term) {
      if (term.residual == 0) return;
      quadratic.cost.limits += 0.5 * term.residual * term.residual;
      std::array<double, 4> slope_residual;
      Eigen::Matrix4d hessian;
      for (std::size_t a = 0; a < 4; ++a) {
        slope_residual[a] = term.residual * term.slope[a];
        for (std::size_t b = 0; b < 4; ++b) hessian(a, b) = term.slope[a] * term.slope[b];
      }
      AddJoint(slope_residual, hessian, i, block, quadratic);
    };
    if (weights.velocity > 0) {
      add(MidVelocityLimit(step_s_, limits_->upper(n_ + i), weights.velocity, x));
    }
    if (weights.acceleration > 0) {
      add(AccelerationLimitAtBegin(step_s_, limits_->a_max(i), weights.acceleration, x));
      add(AccelerationLimitAtEnd(step_s_, limits_->a_max(i), weights.acceleration, x));
    }
  }
}

// A quadratic in joint i's (q, v, q, v) at block - 1 and block; what concerns a fixed state is left
// out.
void TrajectoryObjective::AddJoint(const std::array<double, 4>& gradient,
                                   const Eigen::Matrix4d& hessian, int i, int block,
                                   ChainQuadratic& quadratic) const {
  const int height = 2 * quadratic.stride();
  double* const far_gradient = quadratic.gradient(block);
  far_gradient[i] += gradient[2];
  far_gradient[n_ + i] += gradient[3];
  double* const far_q = quadratic.panel(block) + i * height;
  double* const far_v = far_q + n_ * height;
  far_q[i] += hessian(2, 2);
  far_q[n_ + i] += hessian(3, 2);
  far_v[n_ + i] += hessian(3, 3);
  if (block == 0) return;
  double* const near_gradient = quadratic.gradient(block - 1);
  near_gradient[i] += gradient[0];
  near_gradient[n_ + i] += gradient[1];
  double* const near_q = quadratic.panel(block - 1) + i * height;
  double* const near_v = near_q + n_ * height;
  near_q[i] += hessian(0, 0);
  near_q[n_ + i] += hessian(1, 0);
  near_v[n_ + i] += hessian(1, 1);
  double* const below_q = near_q + quadratic.stride();
  double* const below_v = near_v + quadratic.stride();
  below_q[i] += hessian(2, 0);
  below_q[n_ + i] += hessian(3, 0);
  below_v[i] += hessian(2, 1);
  below_v[n_ + i] += hessian(3, 1);
}

void TrajectoryObjective::AddStateLimits(const Eigen::MatrixXd& states, int k, int block,
                                         ChainQuadratic& quadratic) const {
  const int height = 2 * quadratic.stride();
  double* const gradient = quadratic.gradient(block);
  double* const panel = quadratic.panel(block);
  for (int i = 0; i < 2 * n_; ++i) {
    const double weight = i < n_ ? limits_->weights.position : limits_->weights.velocity;
    const double x = states(i, k);
    const double over = x - limits_->upper(i), under = limits_->lower(i) - x;
    const double excess = std::max(over, under);
    if (!(excess > 0) || weight == 0) continue;
    quadratic.cost.limits += 0.5 * (weight * excess) * (weight * excess);
    gradient[i] += (over > under ? 1 : -1) * weight * weight * excess;
    panel[i * height + i] += weight * weight;
  }
}

}  // namespace sidestep::planner
