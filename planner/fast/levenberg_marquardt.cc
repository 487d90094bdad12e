#include "sidestep/planner/fast/levenberg_marquardt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sidestep::planner {
namespace {

// Defaults of ceres::Solver::Options.
constexpr double kFirstRadius = 1e4, kMaxRadius = 1e16, kMinRadius = 1e-32;
constexpr double kMinDiagonal = 1e-6, kMaxDiagonal = 1e32;
constexpr double kLeastQuality = 1e-3;
constexpr double kGradientTolerance = 1e-10, kParameterTolerance = 1e-8;
constexpr int kMaxInvalidSteps = 5, kMaxNonmonotonicSteps = 5;

// How good a step was, where some may raise the cost: ceres::internal::TrustRegionStepEvaluator,
// after Conn, Gould & Toint, Trust-Region Methods, algorithm 10.1.2.
class StepJudge {
 public:
  explicit StepJudge(double cost)
      : minimum_(cost), present_(cost), reference_(cost), candidate_(cost) {}

  double Quality(double cost, double predicted) const {
    if (!(cost < std::numeric_limits<double>::max())) {
      return std::numeric_limits<double>::lowest();
    }
    return std::max((present_ - cost) / predicted,
                    (reference_ - cost) / (since_reference_ + predicted));
  }

  void Accept(double cost, double predicted) {
    present_ = cost;
    since_candidate_ += predicted;
    since_reference_ += predicted;
    if (cost < minimum_) {
      minimum_ = candidate_ = cost;
      num_nonmonotonic_ = 0;
      since_candidate_ = 0;
    } else {
      ++num_nonmonotonic_;
      if (cost > candidate_) {
        candidate_ = cost;
        since_candidate_ = 0;
      }
    }
    if (num_nonmonotonic_ == kMaxNonmonotonicSteps) {
      reference_ = candidate_;
      since_reference_ = since_candidate_;
    }
  }

 private:
  double minimum_, present_, reference_, candidate_;
  double since_reference_ = 0, since_candidate_ = 0;  // predicted decreases
  int num_nonmonotonic_ = 0;
};

}  // namespace

LevenbergMarquardt::LevenbergMarquardt(TrajectoryObjective& objective, Ending ending)
    : objective_(objective), ending_(ending), present_(objective.MakeQuadratic()) {
  const std::size_t size = present_.vector_size();
  scale_.assign(size, 0.0);
  damping_.assign(size, 0.0);
  step_.assign(size, 0.0);
}

double LevenbergMarquardt::LargestGradient() const {
  const double* const gradient = present_.gradient(0);
  double largest = 0;
  for (std::size_t i = 0; i < present_.vector_size(); ++i) {
    largest = std::max(largest, std::abs(gradient[i]));
  }
  return largest;
}

void LevenbergMarquardt::ChooseScales() {
  for (int k = 0; k < present_.num_blocks(); ++k) {
    for (int i = 0; i < present_.block_size(); ++i) {
      scale_[present_.Place(k) + static_cast<std::size_t>(i)] =
          1 / (1 + std::sqrt(present_.diagonal(k, i)));
    }
  }
}

void LevenbergMarquardt::ChooseDamping(double radius) {
  for (int k = 0; k < present_.num_blocks(); ++k) {
    for (int i = 0; i < present_.block_size(); ++i) {
      const auto at = present_.Place(k) + static_cast<std::size_t>(i);
      const double square = scale_[at] * scale_[at];
      damping_[at] = std::clamp(square * present_.diagonal(k, i), kMinDiagonal, kMaxDiagonal) /
                     (radius * square);
    }
  }
}

SolveOutcome LevenbergMarquardt::Solve(int max_iterations, double function_tolerance,
                                       Eigen::MatrixXd& states, const PlanBudget& budget) {
  const int first = objective_.first_free(), D = present_.block_size(),
            num_free = present_.num_blocks();
  objective_.Evaluate(states, present_);
  double cost = present_.cost.total(), least = cost;
  cost_ = present_.cost;
  ChooseScales();
  StepJudge judge(cost);
  Eigen::MatrixXd x = states, x_next = states;
  double radius = kFirstRadius, shrink = 2;
  int num_invalid = 0;
  bool is_new = true;  // whether `present_` has come by the last iteration

  SolveOutcome outcome;
  for (;; ++outcome.iterations) {
    if (outcome.iterations >= max_iterations || budget.IsTimeUp()) return outcome;
    if ((is_new && LargestGradient() <= kGradientTolerance) || radius < kMinRadius) break;
    if (ending_ == Ending::kSooner && is_new &&
        objective_.MostDecrease(present_) <= function_tolerance * cost) {
      break;
    }
    is_new = false;

    ChooseDamping(radius);
    double predicted = 0;
    if (solver_.Solve(present_, damping_, step_)) {
      // -(g dx + dx H dx / 2), where (H + damping) dx = -g.
      const double* const gradient = present_.gradient(0);
      for (std::size_t i = 0; i < step_.size(); ++i) {
        predicted += 0.5 * step_[i] * (damping_[i] * step_[i] - gradient[i]);
      }
    }
    if (!(predicted > 0)) {
      if (++num_invalid >= kMaxInvalidSteps) return outcome;
      radius /= shrink;
      shrink *= 2;
      continue;
    }
    num_invalid = 0;
    if (ending_ == Ending::kSooner && predicted <= function_tolerance * cost) break;

    for (int k = 0; k < num_free; ++k) {
      for (int i = 0; i < D; ++i) {
        x_next(i, first + k) =
            x(i, first + k) + step_[present_.Place(k) + static_cast<std::size_t>(i)];
      }
    }
    if (!candidate_) candidate_.emplace(objective_.MakeQuadratic());
    objective_.Evaluate(x_next, *candidate_);
    const double cost_next = candidate_->cost.total();
    const auto free_part = [&](const Eigen::MatrixXd& of) { return of.rightCols(num_free); };
    const double moved = (free_part(x_next) - free_part(x)).norm();
    if (moved <= kParameterTolerance * (free_part(x).norm() + kParameterTolerance) ||
        std::abs(cost - cost_next) <= function_tolerance * cost) {
      if (ending_ == Ending::kSooner && cost_next < least) {
        states = x_next;
        cost_ = candidate_->cost;
      }
      break;
    }

    const double quality = judge.Quality(cost_next, predicted);
    if (quality > kLeastQuality) {
      std::swap(present_, *candidate_);
      x.swap(x_next);
      cost = cost_next;
      is_new = true;
      radius = std::min(kMaxRadius, radius / std::max(1.0 / 3, 1 - std::pow(2 * quality - 1, 3)));
      shrink = 2;
      judge.Accept(cost, predicted);
      if (cost < least) {
        least = cost;
        states = x;
        cost_ = present_.cost;
      }
    } else {
      radius /= shrink;
      shrink *= 2;
    }
  }
  outcome.converged = true;
  return outcome;
}

}  // namespace sidestep::planner
