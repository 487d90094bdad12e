#include "sidestep/planner/clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sidestep/planner/guarded_spheres.h"
#include "sidestep/planner/objective/obstacle_kernels.h"
#include "sidestep/sdf/aligned_vector.h"

namespace sidestep::planner {
namespace {

constexpr double kSameContact_s = 0.02;  // contacts this close are at one time

// What the fast look at a moment may be off by, as long as joints turn less than this: far more
// than rounding, far less than matters.
constexpr double kRounding_m = 1e-9, kMostTurn_rad = 1e4;

// The motion at the moments at which it is judged.
class Moments {
 public:
  Moments(const Trajectory& trajectory, EpisodeTime start, EpisodeTime from, EpisodeTime to,
          double step_s)
      : trajectory_(trajectory),
        start_(start),
        from_(from),
        step_s_(step_s),
        duration_s_(std::max(0.0, (to - from).seconds())),
        count_(1 + static_cast<int>(std::ceil(duration_s_ / step_s))),
        v_(trajectory.num_joints()),
        a_(trajectory.num_joints()) {}

  int count() const { return count_; }
  EpisodeTime Time(int i) const {
    return from_ + HorizonOffset(std::min(duration_s_, i * step_s_));
  }
  void Configuration(int i, Eigen::VectorXd& q) {
    SampleInto(trajectory_, Time(i) - start_, q, v_, a_);
  }
  /// The same to rounding and sooner, for i that do not fall.
  void NearlyConfiguration(int i, Eigen::Ref<Eigen::VectorXd> q) {
    const double t = (Time(i) - start_).seconds();
    const Eigen::VectorXd& t_s = trajectory_.t_s;
    const Eigen::Index last = t_s.size() - 1;
    while (interval_ < last && t >= t_s(interval_ + 1)) ++interval_;
    if (t < t_s(0) || interval_ == last) {
      q = trajectory_.q.col(interval_);
      return;
    }
    const double h = t_s(interval_ + 1) - t_s(interval_);
    const double s = (t - t_s(interval_)) / h, s2 = s * s, s3 = s2 * s;
    q = (1 - 3 * s2 + 2 * s3) * trajectory_.q.col(interval_) +
        h * (s - 2 * s2 + s3) * trajectory_.v.col(interval_) +
        (3 * s2 - 2 * s3) * trajectory_.q.col(interval_ + 1) +
        h * (s3 - s2) * trajectory_.v.col(interval_ + 1);
  }

 private:
  const Trajectory& trajectory_;
  EpisodeTime start_, from_;
  double step_s_, duration_s_;
  int count_;
  Eigen::VectorXd v_, a_;      // of no interest
  Eigen::Index interval_ = 0;  // of the last NearlyConfiguration
};

// The least clearance at one moment, as it is told.
class ExactClearance {
 public:
  ExactClearance(const robot::RobotModel& robot, const std::vector<int>& spheres,
                 const SelfClearance& links, const sdf::DistanceField& field)
      : robot_(robot),
        field_(field),
        spheres_(spheres),
        links_(links),
        p_WS_(3, static_cast<Eigen::Index>(spheres_.size())) {}

  double At(const Eigen::VectorXd& q, EpisodeTime t) {
    const robot::SphereCenters centers = robot_.ComputeSphereCenters(q, /*with_jacobian=*/false);
    for (std::size_t s = 0; s < spheres_.size(); ++s) p_WS_.col(s) = centers.p_WS.col(spheres_[s]);
    double least_m = links_.Least(centers.p_WS);
    field_.SampleMany(p_WS_, t, samples_);
    for (std::size_t s = 0; s < spheres_.size(); ++s) {
      least_m = std::min(least_m, samples_.distance_m(s) - robot_.sphere_radii_m()(spheres_[s]));
    }
    return least_m;
  }

 private:
  const robot::RobotModel& robot_;
  const sdf::DistanceField& field_;
  const std::vector<int>& spheres_;
  const SelfClearance& links_;
  Eigen::Matrix3Xd p_WS_;
  sdf::DistanceSamples samples_;
};

}  // namespace

bool IsSafer(const Clearance& a, const Clearance& b) {
  if (a.first_contact.has_value() != b.first_contact.has_value()) return !a.first_contact;
  if (a.first_contact) {
    const double later_s = (*a.first_contact - *b.first_contact).seconds();
    if (std::abs(later_s) > kSameContact_s) return later_s > 0;
  }
  return a.least_m > b.least_m;
}

ClearanceMeter::ClearanceMeter(const robot::RobotModel& robot)
    : robot_(robot),
      arm_(MakeArm(robot, /*epsilon_m=*/0, /*sigma=*/1, /*self_epsilon_m=*/0)),
      spheres_(GuardedSpheres(robot)),
      links_(robot) {}

Clearance ClearanceMeter::Measure(const sdf::DistanceField& field, const Trajectory& trajectory,
                                  EpisodeTime start, EpisodeTime from, EpisodeTime to,
                                  double step_s) const {
  Moments moments(trajectory, start, from, to, step_s);
  const int n = trajectory.num_joints();

  // All moments, several at a time, to rounding.
  Clearance clearance;
  ArmGroup group(arm_);
  sdf::AlignedVector<double> nearly_m(static_cast<std::size_t>(moments.count() + ArmGroup::kSize));
  Eigen::MatrixXd q(n, ArmGroup::kSize);
  double least_m = std::numeric_limits<double>::infinity();
  bool is_sure = true;
  for (int begin = 0; begin < moments.count(); begin += ArmGroup::kSize) {
    const int size = std::min(ArmGroup::kSize, moments.count() - begin);
    for (int c = 0; c < size; ++c) moments.NearlyConfiguration(begin + c, q.col(c));
    is_sure = is_sure && q.leftCols(size).cwiseAbs().maxCoeff() < kMostTurn_rad;
    group.PlaceSpheres(q.leftCols(size));
    for (int c = 0; c < size; ++c) {
      clearance.samples_outside_grid += group.Measure(c, *field.At(moments.Time(begin + c)));
    }
    double* const nearly = &nearly_m[static_cast<std::size_t>(begin)];
    obstacle_kernels::ComputeClearance(group.arm(), group.centers_8(), group.samples_8(), nearly);
    least_m = std::min(least_m, *std::min_element(nearly, nearly + size));
  }

  // Those that can be the least or the first contact, exactly.
  ExactClearance exact(robot_, spheres_, links_, field);
  Eigen::VectorXd q_i(n);
  for (int i = 0; i < moments.count(); ++i) {
    const double nearly = nearly_m[static_cast<std::size_t>(i)];
    const bool can_be_first = !clearance.first_contact && nearly <= kRounding_m;
    if (is_sure && nearly > least_m + kRounding_m && !can_be_first) continue;
    moments.Configuration(i, q_i);
    clearance.least_m = std::min(clearance.least_m, exact.At(q_i, moments.Time(i)));
    if (clearance.least_m <= 0 && !clearance.first_contact)
      clearance.first_contact = moments.Time(i);
  }
  return clearance;
}

Clearance MeasureClearance(const robot::RobotModel& robot, const sdf::DistanceField& field,
                           const Trajectory& trajectory, EpisodeTime start, EpisodeTime from,
                           EpisodeTime to, double step_s) {
  return ClearanceMeter(robot).Measure(field, trajectory, start, from, to, step_s);
}

}  // namespace sidestep::planner
