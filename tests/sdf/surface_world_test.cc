// What a model of the world makes of depth images: what moves, and what only seems to.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::sdf::surface_world_test {
namespace {

constexpr double kPeriod_s = 1.0 / 30;

WorldModelOptions Options(double noise_per_m) {
  WorldModelOptions options;
  options.predictor = "kalman_cv";
  options.grid = {{0, -1.5, -1.5}, 0.05, {60, 60, 60}};
  options.max_distance_m = 0.3;
  options.evidence = {0.7, 1.4, -2.8, 2.8, 10, 30, 4, 1, 6};
  options.views["camera"].noise_per_m = noise_per_m;
  return options;
}

// What a ray through (x, y, 1) x m meets at time t: how far along x, and nothing where its way is
// free to the end; `measured` is false for what is known to be the robot.
struct Met {
  double x_m;
  bool measured = true;
};
using Scene = std::function<Met(double y, double z, double t_s)>;

// A camera at the origin that looks along x.
Scan Look(const Scene& scene, double t_s, double noise_per_m, RandomStream& random) {
  std::vector<Eigen::Vector3d> hits, ends;
  for (double y = -0.5; y < 0.5; y += 0.02) {
    for (double z = -0.4; z < 0.4; z += 0.02) {
      const Met met = scene(y, z, t_s);
      const double noise = met.measured ? noise_per_m * met.x_m * random.Normal() : 0;
      const Eigen::Vector3d p_W = met.x_m * (1 + noise) * Eigen::Vector3d(1, y, z);
      (met.measured ? hits : ends).push_back(p_W);
    }
  }
  Scan scan;
  scan.t = EpisodeTime(t_s);
  scan.sensor = "camera";
  scan.kind = ScanKind::kSurface;
  const Pose X_WC(Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY())),
                  Eigen::Vector3d::Zero());
  scan.X_WC = X_WC;
  for (auto* const part : {&hits, &ends}) {
    Eigen::Matrix3Xd& points = part == &hits ? scan.p_CP : scan.p_CFree;
    points.resize(3, static_cast<Eigen::Index>(part->size()));
    for (std::size_t n = 0; n < part->size(); ++n) {
      points.col(static_cast<Eigen::Index>(n)) = X_WC.Inverse() * (*part)[n];
    }
  }
  return scan;
}

// When something is first said to move, if ever.
std::optional<double> FirstMotion(const Scene& scene, double until_s, double noise_per_m) {
  const auto world = MakeWorldModel(Options(noise_per_m));
  RandomStream random(5, "noise");
  for (int frame = 0; frame * kPeriod_s < until_s; ++frame) {
    world->Observe(Look(scene, frame * kPeriod_s, noise_per_m, random));
    if (!world->MovingNow().empty()) return frame * kPeriod_s;
  }
  return std::nullopt;
}

// A wall with a step in it, and an arm before it that swings aside.
Met WallBehindAnArm(double y, double, double t_s) {
  if (std::abs(y - 0.3 * t_s) < 0.1) return {1.0, false};
  return {y > 0.2 ? 2.02 : 2.37};
}

TEST(SurfaceWorld, HoldsNothingThatMovesWhereAnArmUncoversWhatItHid) {
  for (const double noise_per_m : {0.0, 0.002, 0.005, 0.01}) {
    EXPECT_FALSE(FirstMotion(WallBehindAnArm, 3, noise_per_m).has_value()) << noise_per_m;
  }
}

TEST(SurfaceWorld, SeesWhatComesInWithinAFifthOfASecond) {
  for (const double noise_per_m : {0.0, 0.002, 0.005, 0.01}) {
    for (const double speed_m_s : {0.4, 1.2, 2.5}) {
      const double begin_s = 1;
      // A box 0.3 m wide, 1.2 m away, that comes from the left.
      const Scene scene = [&](double y, double z, double t_s) {
        const double edge_m = -0.8 + speed_m_s * std::max(0.0, t_s - begin_s);
        const bool is_box = 1.2 * y > edge_m - 0.3 && 1.2 * y < edge_m && std::abs(1.2 * z) < 0.2;
        return is_box ? Met{1.2} : WallBehindAnArm(y, z, t_s);
      };
      // It is half in the picture.
      const double in_view_s = begin_s + (0.8 - 0.6 + 0.15) / speed_m_s;
      const auto moved_s = FirstMotion(scene, 6, noise_per_m);
      ASSERT_TRUE(moved_s.has_value()) << noise_per_m << ", " << speed_m_s << " m/s";
      EXPECT_GT(*moved_s, begin_s);
      EXPECT_LT(*moved_s, in_view_s + 0.2) << noise_per_m << ", " << speed_m_s << " m/s";
    }
  }
}

TEST(SurfaceWorld, SeesWhatComesStraightAtTheCamera) {
  for (const double noise_per_m : {0.0, 0.002}) {
    for (const double speed_m_s : {0.5, 1.5, 3.0}) {
      const Scene scene = [&](double y, double z, double t_s) {
        const double x_m = 2.3 - speed_m_s * std::max(0.0, t_s - 0.5);
        const bool is_ball = x_m > 0.4 && std::hypot(y, z) * x_m < 0.15;
        return is_ball ? Met{x_m} : Met{2.9};
      };
      const auto moved_s = FirstMotion(scene, 3, noise_per_m);
      ASSERT_TRUE(moved_s.has_value()) << noise_per_m << ", " << speed_m_s << " m/s";
      EXPECT_LT(*moved_s, 0.5 + 0.2 + 0.1 / speed_m_s) << noise_per_m << ", " << speed_m_s;
    }
  }
}

}  // namespace
}  // namespace sidestep::sdf::surface_world_test
