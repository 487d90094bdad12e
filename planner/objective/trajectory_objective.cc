#include "sidestep/planner/objective/trajectory_objective.h"

#include <algorithm>

#include "sidestep/planner/gp_trajectory.h"

namespace sidestep::planner {

TrajectoryObjective::TrajectoryObjective(const robot::RobotModel& robot, const PlanRequest& request,
                                         const Eigen::VectorXd& t_s,
                                         const GpProblemOptions& options)
    : options_(options),
      n_(robot.num_joints()),
      t_s_(t_s),
      step_s_(request.step_s),
      num_fixed_(request.num_fixed),
      first_free_(options.sigma_fixed ? 0 : request.num_fixed),
      x_start_(2 * n_),
      x_goal_(Eigen::VectorXd::Zero(2 * n_)),
      gp_(request.step_s, options.qc),
      obstacles_(robot, options.epsilon_m, options.sigma_obs, options.self_epsilon_m),
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
    between_.push_back({at_places_.gradient(index), at_places_.hessian(index), places_[c].weights});
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
  const int height = 2 * quadratic.stride();
  double* const far_panel = quadratic.panel(block);
  double* const far_gradient = quadratic.gradient(block);
  for (int i = 0; i < n_; ++i) {
    const Eigen::Vector4d x(states(i, k - 1), states(n_ + i, k - 1), states(i, k),
                            states(n_ + i, k));
    JointQuadratic joint = gp_.At(x);
    quadratic.cost.gp += joint.cost;
    if (limits_) {
      joint.cost = 0;
      const LimitWeights& weights = limits_->weights;
      if (weights.velocity > 0) {
        AddMidVelocityLimit(step_s_, limits_->upper(n_ + i), weights.velocity, x, joint);
      }
      if (weights.acceleration > 0) {
        AddAccelerationLimit(step_s_, limits_->a_max(i), weights.acceleration, x, joint);
      }
      quadratic.cost.limits += joint.cost;
    }
    for (int a = 2; a < 4; ++a) {
      far_gradient[(a - 2) * n_ + i] += joint.gradient(a);
      for (int b = 2; b <= a; ++b) {
        far_panel[((b - 2) * n_ + i) * height + (a - 2) * n_ + i] += joint.hessian(a, b);
      }
    }
    if (block == 0) continue;
    for (int b = 0; b < 2; ++b) {
      quadratic.gradient(block - 1)[b * n_ + i] += joint.gradient(b);
      double* const column = quadratic.panel(block - 1) + (b * n_ + i) * height;
      for (int a = b; a < 2; ++a) column[a * n_ + i] += joint.hessian(a, b);
      for (int a = 2; a < 4; ++a) {
        column[quadratic.stride() + (a - 2) * n_ + i] += joint.hessian(a, b);
      }
    }
  }
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
