#pragma once

// Tags that are wrong at times.

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/core/rotation_vector.h"
#include "sidestep/sdf/prediction/kalman_cv.h"
#include "sidestep/sdf/prediction/registry.h"
#include "sidestep/sdf/tracking/named_objects.h"

namespace sidestep::sdf {

inline constexpr double kPeriod_s = 1.0 / 30, kLatency_s = 0.1;
inline constexpr int kNumScans = 90, kSettled = 20;
inline const Eigen::Vector3d kCamera(1.6, 1.4, 1.9);  // 1.8 m from where things begin

inline Eigen::Vector3d Normal3(RandomStream& random) {
  const double x = random.Normal(), y = random.Normal(), z = random.Normal();
  return {x, y, z};
}

inline NamedObjectsOptions Gated() {
  NamedObjectsOptions options;
  options.cell_m = 0.1;
  options.max_distance_m = 0.1;
  options.gates = GatesOfTags(4, options.coast);
  return options;
}

// Something that moves as the filter takes it to: white noise of acceleration.
class Wanderer {
 public:
  explicit Wanderer(RandomStream& random) : random_(random) {
    x_.segment<3>(kP) = Eigen::Vector3d(0.4, 1, 0.6);
    x_.segment<3>(kV) = 0.2 * Normal3(random);
    yaw_rad_ = random.Uniform(-3, 3);
  }
  void Go() {
    const MotionMatrix Q = kConstantVelocity.noise(kPeriod_s);
    const Eigen::Matrix2d q{{Q(kP, kP), Q(kP, kV)}, {Q(kV, kP), Q(kV, kV)}};
    const Eigen::Matrix2d L = q.llt().matrixL();
    x_ = kConstantVelocity.move(x_, kPeriod_s, nullptr);
    for (int a = 0; a < 3; ++a) {
      const double first = random_.Normal(), second = random_.Normal();
      x_(kP + a) += L(0, 0) * first;
      x_(kV + a) += L(1, 0) * first + L(1, 1) * second;
    }
  }
  Pose X_WO() const { return Pose::FromRollPitchYaw({0, 0, yaw_rad_}, x_.segment<3>(kP)); }

 private:
  RandomStream& random_;
  MotionVector x_ = MotionVector::Zero();
  double yaw_rad_ = 0;
};

// As the model of a camera that finds tags errs (sim/tag_camera.h).
inline ObjectObservation See(const std::string& id, EpisodeTime t, const Pose& X_WO,
                             RandomStream& random) {
  const Eigen::Vector3d sight = X_WO.translation() - kCamera;
  const double d = sight.norm();
  const Eigen::Vector3d u = sight / d, noise = Normal3(random);
  const double across = 0.001 * d, along = 0.002 * d * d;
  const Eigen::Vector3d e = across * (noise - u * u.dot(noise)) + along * u * u.dot(noise);
  ObjectObservation seen;
  seen.id = id;
  seen.t = t;
  seen.X_WO = Pose(X_WO.rotation() * RotationBy(0.02 * Normal3(random)), X_WO.translation() + e);
  seen.covariance.topLeftCorner<3, 3>() =
      across * across * (Eigen::Matrix3d::Identity() - u * u.transpose()) +
      along * along * u * u.transpose();
  seen.covariance.bottomRightCorner<3, 3>().diagonal().setConstant(0.02 * 0.02);
  seen.shape = Box{{0.48, 0.55, 1.2}};
  return seen;
}

// Turned about the middle of a face, 0.25 m from that of the body, by twice what it leans.
inline void Flip(ObjectObservation* seen, RandomStream& random) {
  const double lean = random.Uniform(0.1, 0.7);
  const Eigen::Vector3d n = (kCamera - seen->X_WO.translation()).normalized();
  const Eigen::Vector3d p_WFace = seen->X_WO.translation() + 0.25 * n;
  const Eigen::Quaterniond turn = RotationBy(2 * lean * n.unitOrthogonal());
  seen->X_WO = Pose(turn * seen->X_WO.rotation(), p_WFace - 0.25 * (turn * n));
}

inline void Misplace(ObjectObservation* seen, RandomStream& random) {
  const Eigen::Vector3d off = random.Uniform(0.03, 0.5) * Normal3(random).normalized();
  seen->X_WO = Pose(seen->X_WO.rotation(), seen->X_WO.translation() + off);
}

struct Means {
  double nees = 0, late = 0, nis = 0;  // each of 3 degrees of freedom
  int num_nees = 0, num_nis = 0;
};

inline double Squared(const Eigen::Vector3d& error, const Eigen::Matrix3d& covariance) {
  return error.dot(covariance.ldlt().solve(error));
}

/// How far wrong tags move the estimate, against one that is spared them, and whether it is as sure
/// of itself as it may be (NEES, NIS), at capture and when a late picture arrives.
/// 10 % of the sightings are anywhere, 5 % flipped, and in every tenth scan there is another one of
/// the same name elsewhere.
inline void ExpectLittleHarmOfWrongTags(int num_seeds) {
  const auto predictor = MakePredictor("kalman_cv");
  std::vector<double> moved_m;
  double farthest_rad = 0;
  Means means;
  for (int seed = 0; seed < num_seeds; ++seed) {
    RandomStream motion(static_cast<std::uint64_t>(seed), "motion");
    RandomStream faults(static_cast<std::uint64_t>(seed), "faults");
    Wanderer thing(motion);
    NamedObjects objects(Gated()), spared(Gated());
    for (int k = 0; k < kNumScans; ++k, thing.Go()) {
      const EpisodeTime t(k * kPeriod_s);
      const Pose X_WO = thing.X_WO();
      ObjectObservation seen = See("cart", t, X_WO, motion);
      const double what = faults.Uniform();
      const bool is_right = what >= 0.15;
      if (what < 0.1) {
        Misplace(&seen, faults);
      } else if (!is_right) {
        Flip(&seen, faults);
      }
      if (is_right && k > kSettled && k % 10 == 0) {
        const PredictedMotion before = predictor->Predict(*objects.Objects().at(0).object);
        const Eigen::Vector3d off = seen.X_WO.translation() - before.X_WO(t).translation();
        const Eigen::Matrix3d R = seen.covariance.topLeftCorner<3, 3>();
        means.nis += Squared(off, before.covariance_m2(t) + R);
        ++means.num_nis;
      }
      std::vector<ObjectObservation> scan = {seen};
      if (faults.Uniform() < 0.1) {
        scan.insert(scan.begin(), See("cart", t, Pose::Translation(2 * Normal3(faults)), faults));
      }
      objects.Update(scan, t);
      spared.Update(is_right ? std::vector{seen} : std::vector<ObjectObservation>(), t);
      if (k < kSettled) continue;
      ASSERT_EQ(objects.Objects().size(), 1u) << "seed " << seed << ", scan " << k;
      const NamedObject now = objects.Objects()[0], without = spared.Objects().at(0);
      const PredictedMotion estimate = predictor->Predict(*now.object);
      const Eigen::Vector3d p_W = estimate.X_WO(t).translation();
      moved_m.push_back((p_W - predictor->PredictPose(*without.object, t).translation()).norm());
      farthest_rad = std::max(farthest_rad, now.R_WO.angularDistance(X_WO.rotation()));
      if (k + 1 < kNumScans) continue;
      means.nees += Squared(p_W - X_WO.translation(), estimate.covariance_m2(t));
      ++means.num_nees;
      // The picture arrives late: where it is by then is predicted.
      for (double gone_s = 0; gone_s < kLatency_s - 1e-9; gone_s += kPeriod_s) thing.Go();
      const EpisodeTime arrival = t + HorizonOffset(kLatency_s);
      means.late += Squared(estimate.X_WO(arrival).translation() - thing.X_WO().translation(),
                            estimate.covariance_m2(arrival));
    }
  }
  std::sort(moved_m.begin(), moved_m.end());
  EXPECT_LT(moved_m[moved_m.size() * 99 / 100], 0.001);
  EXPECT_LT(moved_m[moved_m.size() * 999 / 1000], 0.02);
  // One that does fit, right after others that did not; what is right then agrees.
  EXPECT_LT(moved_m.back(), 0.1);
  EXPECT_LT(farthest_rad, 0.35) << "a flip of less is none";
  // The mean of chi^2 with 3 degrees of freedom is 3 and its variance 6.
  EXPECT_NEAR(means.nees / means.num_nees, 3, 4 * std::sqrt(6.0 / means.num_nees));
  EXPECT_NEAR(means.late / means.num_nees, 3, 4 * std::sqrt(6.0 / means.num_nees));
  EXPECT_NEAR(means.nis / means.num_nis, 3, 4 * std::sqrt(6.0 / means.num_nis));
}

}  // namespace sidestep::sdf
