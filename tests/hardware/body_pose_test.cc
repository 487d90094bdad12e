// Poses from corners that are computed, not seen: what is found is compared with what they were
// computed from.
#include "sidestep/hardware/body_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "sidestep/core/random.h"
#include "sidestep/scenarios/tag.h"
#include "tests/support/random_points.h"

namespace sidestep::hardware::body_pose_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

robot::CameraIntrinsics Camera() {
  robot::CameraIntrinsics camera = robot::PinholeOf(1280, 720, 1.211);
  camera.distortion = {0.1, -0.2, 0.001, -0.001, 0.05};
  return camera;
}

// A box of the laboratory with a tag of 16 cm on each of these faces.
TaggedBody BoxWith(const std::vector<std::string>& faces) {
  const Eigen::Vector3d size_m(0.20, 0.25, 0.35);
  TaggedBody body{"box", Box{size_m}, {}};
  for (const std::string& face : faces) {
    body.tags.push_back(
        {static_cast<int>(body.tags.size()), 0.16, scenarios::TagPose(size_m, face)});
  }
  return body;
}

// What an error-free detector would say of the tags that face the camera.
std::vector<TagDetection> Seen(const TaggedBody& body, const Pose& X_CO) {
  std::vector<TagDetection> seen;
  for (const BodyTag& tag : body.tags) {
    const Pose X_CT = X_CO * tag.X_OT;
    const Eigen::Vector3d into = X_CT.Rotate(Eigen::Vector3d::UnitZ());
    if (into.dot(X_CT.translation().normalized()) < 0.3) continue;
    TagDetection detection;
    detection.id = tag.id;
    const double h = tag.size_m / 2;
    const Eigen::Vector3d corners[] = {{-h, h, 0}, {h, h, 0}, {h, -h, 0}, {-h, -h, 0}};
    for (int k = 0; k < 4; ++k) {
      detection.corners_px.col(k) = robot::Project(Camera(), X_CT * corners[k]);
    }
    seen.push_back(detection);
  }
  return seen;
}

// How a place of an edge errs: for itself, and by where it lies among the pixels.
double ErrorAt(const Eigen::Vector2d& place_px, const Eigen::Vector2d& along, double sigma_px,
               RandomStream& random) {
  Eigen::Index major = 0;
  const double slope = along.cwiseAbs().minCoeff() / along.cwiseAbs().maxCoeff(&major);
  const auto wave = [](double waves) {  // of variance 1
    return std::numbers::sqrt2 * std::sin(2 * std::numbers::pi * waves);
  };
  return sigma_px * (random.Normal() + 2.4 / (1 + 20 * slope) * wave(2 * place_px(1 - major)) +
                     0.4 * wave(place_px(major)));
}

// Looks for each edge of a tag at places along it and lays a line through them, as the detector
// does; corners are where lines meet.
void Disturb(double sigma_px, RandomStream& random, TagDetection* tag) {
  Eigen::Matrix<double, 4, 3> lines;  // unit normal, and its product with the line's points
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d from = tag->corners_px.col(k), to = tag->corners_px.col((k + 1) % 4);
    const Eigen::Vector2d across =
        Eigen::Vector2d(to.y() - from.y(), from.x() - to.x()).normalized();
    const int n = std::max(16, static_cast<int>((to - from).norm() / 8));
    double sum = 0, turn = 0, squares = 0;  // of the errors, with and by their places
    for (int i = 1; i <= n; ++i) {
      const double place = i / (n + 1.0) - 0.5;
      const double off_px =
          ErrorAt(from + (place + 0.5) * (to - from), to - from, sigma_px, random);
      sum += off_px;
      turn += place * off_px;
      squares += place * place;
    }
    const Eigen::Vector2d begin = from + (sum / n - turn / squares / 2) * across;
    const Eigen::Vector2d along = to + (sum / n + turn / squares / 2) * across - begin;
    const Eigen::Vector2d normal = Eigen::Vector2d(along.y(), -along.x()).normalized();
    lines.row(k) << normal.transpose(), normal.dot(begin);
  }
  for (int k = 0; k < 4; ++k) {
    Eigen::Matrix2d N;
    N << lines.row(k).head<2>(), lines.row((k + 3) % 4).head<2>();
    tag->corners_px.col(k) = N.inverse() * Eigen::Vector2d(lines(k, 2), lines((k + 3) % 4, 2));
  }
}

Eigen::Matrix<double, 6, 1> ErrorOf(const Pose& found, const Pose& truth) {
  const Eigen::AngleAxisd turn(found.rotation() * truth.rotation().conjugate());
  Eigen::Matrix<double, 6, 1> error;
  error << found.translation() - truth.translation(), turn.angle() * turn.axis();
  return error;
}

// Some way turned, somewhere before the camera.
Pose PoseBefore(RandomStream& random) {
  const Pose any = RandomPose(random, 0.3);
  return {any.rotation(), any.translation() + Eigen::Vector3d(0, 0, 1.3)};
}

class BodyPose : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!CanFindTags()) GTEST_SKIP() << "built without libapriltag and OpenCV";
  }
};

TEST_F(BodyPose, IsFoundFromOneTagOrSeveralThroughADistortedLens) {
  RandomStream random(1, "poses");
  for (const std::vector<std::string>& faces :
       {std::vector<std::string>{"+x"}, {"-y"}, {"+z"}, {"+x", "-x", "+y", "-y", "+z", "-z"}}) {
    const TaggedBody body = BoxWith(faces);
    int found = 0;
    for (int i = 0; i < 200; ++i) {
      const Pose X_CO = PoseBefore(random);
      const std::vector<TagDetection> seen = Seen(body, X_CO);
      const auto pose = LocateBody(Camera(), body, seen, 0.1);
      ASSERT_EQ(pose.has_value(), !seen.empty());
      if (!pose) continue;
      ++found;
      EXPECT_EQ(pose->num_tags, static_cast<int>(seen.size()));
      EXPECT_LT(pose->reprojection_px, 1e-4);
      EXPECT_LT(ErrorOf(pose->X_CO, X_CO).norm(), 1e-4) << i;
    }
    EXPECT_GT(found, 40);
  }
}

// Of six errors, the squares in units of the covariance have the mean 6 and the variance 12.
TEST_F(BodyPose, HasErrorsOfItsCovariance) {
  RandomStream random(2, "edges");
  const TaggedBody body = BoxWith({"+x", "-x", "+y", "-y", "+z", "-z"});
  constexpr double kSigma_px = 0.1;
  constexpr int kCount = 1000;
  double sum = 0;
  for (int i = 0; i < kCount; ++i) {
    const Pose X_CO = PoseBefore(random);
    std::vector<TagDetection> seen = Seen(body, X_CO);
    for (TagDetection& tag : seen) {
      Disturb(kSigma_px, random, &tag);
    }
    const auto pose = LocateBody(Camera(), body, seen, kSigma_px);
    ASSERT_TRUE(pose);
    const auto error = ErrorOf(pose->X_CO, X_CO);
    sum += error.dot(pose->covariance.ldlt().solve(error));
  }
  const double mean = sum / kCount, standard_error = std::sqrt(12.0 / kCount);
  EXPECT_NEAR(mean, 6, 4 * standard_error);
}

TEST_F(BodyPose, SaysWhereASquareLooksAlikeFromTwoSides) {
  const TaggedBody body = BoxWith({"+x"});
  RandomStream random(3, "tilt");
  const auto locate = [&](double distance_m, double tilt_rad) {
    const Pose X_CT(Eigen::Quaterniond(Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitY())),
                    {0, 0, distance_m});
    const Pose X_CO = X_CT * body.tags[0].X_OT.Inverse();
    std::vector<TagDetection> seen = Seen(body, X_CO);
    for (TagDetection& tag : seen) Disturb(0.1, random, &tag);
    const auto pose = LocateBody(Camera(), body, seen, 0.1);
    return pose ? pose->ambiguity : -1;
  };
  double frontal = 0, tilted = 0;
  for (int i = 0; i < 50; ++i) {
    frontal = std::max(frontal, locate(3, 6 * kDegree));
    tilted = std::max(tilted, locate(2, 40 * kDegree));
  }
  EXPECT_GT(frontal, 0.5);
  EXPECT_LT(tilted, 0.01);
  EXPECT_GE(tilted, 0);
}

TEST_F(BodyPose, TakesOfTwoPosesTheOneThatIsBelieved) {
  const TaggedBody body = BoxWith({"+x"});
  RandomStream random(4, "tilt");
  for (int i = 0; i < 100; ++i) {
    const double tilt_rad = (i % 2 == 0 ? 6 : -6) * kDegree;
    const Pose X_CT(Eigen::Quaterniond(Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitY())),
                    {0.1, 0.1, 2});
    const Pose X_CO = X_CT * body.tags[0].X_OT.Inverse();
    std::vector<TagDetection> seen = Seen(body, X_CO);
    for (TagDetection& tag : seen) Disturb(0.1, random, &tag);
    const RotationPrior prior{X_CO.rotation(), 2 * kDegree};
    const auto pose = LocateBody(Camera(), body, seen, 0.1, prior);
    ASSERT_TRUE(pose);
    EXPECT_LT(pose->X_CO.rotation().angularDistance(X_CO.rotation()), 6 * kDegree);
  }
}

TEST_F(BodyPose, IsNothingWithoutItsTags) {
  TagDetection other;
  other.id = 99;
  other.corners_px << 10, 90, 90, 10, 90, 90, 10, 10;
  EXPECT_FALSE(LocateBody(Camera(), BoxWith({"+x"}), {other}, 0.1));
  EXPECT_FALSE(LocateBody(Camera(), BoxWith({"+x"}), {}, 0.1));
}

}  // namespace
}  // namespace sidestep::hardware::body_pose_test
