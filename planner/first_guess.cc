#include "sidestep/planner/first_guess.h"

#include <stdexcept>
#include <vector>

namespace sidestep::planner {
namespace {

constexpr double kLateBegin = 0.4;  // share of the free time
constexpr double kEarlyEnd = 0.6;
constexpr double kDetour_rad = 0.7;
constexpr double kLeastShare = 0.2;  // of the free time, and of the way

struct Knot {
  double t_s;
  Eigen::VectorXd q, v;
};

Trajectory FromKnots(const std::vector<Knot>& knots) {
  const Eigen::Index n = knots.front().q.size(), K = static_cast<Eigen::Index>(knots.size());
  Trajectory trajectory{Eigen::VectorXd(K), Eigen::MatrixXd(n, K), Eigen::MatrixXd(n, K)};
  for (Eigen::Index k = 0; k < K; ++k) {
    trajectory.t_s(k) = knots[k].t_s;
    trajectory.q.col(k) = knots[k].q;
    trajectory.v.col(k) = knots[k].v;
  }
  return trajectory;
}

// From (q, v) to rest at `q_goal` within `duration_s`.
Trajectory MakeFreePart(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                        const Eigen::VectorXd& q_goal, double duration_s, Timing timing) {
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(q.size());
  switch (timing) {
    case Timing::kWholeTime:
      return FromKnots({{0, q, v}, {duration_s, q_goal, rest}});
    case Timing::kLeaveLate: {
      const double begin_s = kLateBegin * duration_s;
      // A third of v t: the cubic that brakes to rest without acceleration at its end.
      return FromKnots(
          {{0, q, v}, {begin_s, q + v * begin_s / 3, rest}, {duration_s, q_goal, rest}});
    }
    case Timing::kArriveEarly:
      return FromKnots(
          {{0, q, v}, {kEarlyEnd * duration_s, q_goal, rest}, {duration_s, q_goal, rest}});
  }
  throw std::invalid_argument("unknown Timing");
}

// The request's grid, with what is fixed there. What is free has yet to be filled in.
Trajectory FixedPart(const PlanRequest& request) {
  if (request.initial) return MakeWarmStart(request);
  const int K = request.num_states;
  return {Eigen::VectorXd::LinSpaced(K, 0, K - 1) * request.step_s, request.q_start.replicate(1, K),
          request.v_start.replicate(1, K)};
}

// The request's fixed states, then the motion that `make_free_part` gives from the last of them,
// (q, v), in a given time.
template <class MakeFreePartFn>
Trajectory WithFreePart(const PlanRequest& request, const MakeFreePartFn& make_free_part) {
  const int K = request.num_states, last_fixed = request.num_fixed - 1;
  Trajectory motion = FixedPart(request);
  const Trajectory free_part = make_free_part(motion.q.col(last_fixed), motion.v.col(last_fixed),
                                              motion.t_s(K - 1) - motion.t_s(last_fixed));
  for (int k = request.num_fixed; k < K; ++k) {
    const TrajectoryPoint point =
        Sample(free_part, HorizonOffset(motion.t_s(k) - motion.t_s(last_fixed)));
    motion.q.col(k) = point.q;
    motion.v.col(k) = point.v;
  }
  return motion;
}

}  // namespace

Trajectory MakeDirectMotion(const PlanRequest& request, Timing timing) {
  return WithFreePart(request, [&](const auto& q, const auto& v, double duration_s) {
    return MakeFreePart(q, v, request.q_goal, duration_s, timing);
  });
}

Trajectory MakeDetour(const PlanRequest& request, const Eigen::VectorXd& scale,
                      RandomStream& random) {
  const auto share = [&random] { return kLeastShare + (1 - 2 * kLeastShare) * random.Uniform(); };
  return WithFreePart(request, [&](const auto& q, const auto& v, double duration_s) {
    const Eigen::VectorXd way = request.q_goal - q, rest = Eigen::VectorXd::Zero(q.size());
    const double via_s = share() * duration_s;
    Eigen::VectorXd q_via = q + share() * way;
    for (Eigen::Index i = 0; i < q_via.size(); ++i) {
      q_via(i) += kDetour_rad * scale(i) * random.Normal();
    }
    return FromKnots(
        {{0, q, v}, {via_s, q_via, way / duration_s}, {duration_s, request.q_goal, rest}});
  });
}

Trajectory MakeContinuation(const PlanRequest& request, const TimedPlan& plan) {
  Trajectory motion = FixedPart(request);
  for (int k = request.num_fixed; k < request.num_states; ++k) {
    const EpisodeTime t = request.start + HorizonOffset(motion.t_s(k));
    const TrajectoryPoint point = Sample(plan.trajectory, t - plan.start);
    motion.q.col(k) = point.q;
    motion.v.col(k) = point.v;
  }
  return motion;
}

Trajectory MakeWarmStart(const PlanRequest& request) {
  Trajectory motion = request.initial.value();
  motion.q.col(0) = request.q_start;
  motion.v.col(0) = request.v_start;
  return motion;
}

}  // namespace sidestep::planner
