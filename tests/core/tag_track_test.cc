#include "sidestep/core/tag_track.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "sidestep/core/random.h"

namespace sidestep::tag_track_test {
namespace {

constexpr double kPeriod_s = 1.0 / 30;
constexpr double kSigma_m = 0.005;
const Eigen::Matrix3d kR_m2 = kSigma_m * kSigma_m * Eigen::Matrix3d::Identity();

Eigen::Vector3d Normal3(RandomStream& random) {
  return Eigen::Vector3d{random.Normal(), random.Normal(), random.Normal()};
}

// Something that moves as the filter takes it to: its acceleration is constant from one sighting to
// the next, and anew at each.
class Wanderer {
 public:
  Wanderer(RandomStream& random, double sigma_a_m_s2)
      : random_(random), sigma_a_m_s2_(sigma_a_m_s2) {
    v_ = Normal3(random) / 4;
  }
  void Go() {
    const Eigen::Vector3d a = sigma_a_m_s2_ * Normal3(random_);
    p_ += kPeriod_s * v_ + kPeriod_s * kPeriod_s / 2 * a;
    v_ += kPeriod_s * a;
  }
  const Eigen::Vector3d& p() const { return p_; }
  const Eigen::Vector3d& v() const { return v_; }
  Eigen::Vector3d Seen() { return p_ + kSigma_m * Normal3(random_); }

 private:
  RandomStream& random_;
  double sigma_a_m_s2_;
  Eigen::Vector3d p_ = Eigen::Vector3d(0.4, 0.5, 0.4), v_;
};

EpisodeTime Time(int k) { return EpisodeTime(k * kPeriod_s); }

// Means over runs and sightings of the squared errors in units of the covariance, and their bounds:
// 95 % of a chi-square by its normal approximation.
TEST(TagTrack, IsAsSureOfItselfAsItMayBe) {
  RandomStream random(1, "runs");
  TagTrackOptions options;
  options.expected = options.gate;  // nothing is believed less than its covariance says
  double nees = 0, nis = 0, late = 0;
  int count = 0, rejected = 0, offered = 0;
  for (int run = 0; run < 200; ++run) {
    TagTrack track(options);
    Wanderer thing(random, options.sigma_a_m_s2);
    for (int k = 0; k < 60; ++k, thing.Go()) {
      const TagTrack::Verdict verdict = track.Update(Time(k), thing.Seen(), kR_m2);
      if (k < 10) continue;
      ++offered;
      rejected += verdict.is_taken ? 0 : 1;
      if (!verdict.is_taken || k % 10 != 0)
        continue;  // so far apart, errors are nearly independent
      Eigen::Matrix<double, 6, 1> error;
      const PointEstimate now = *track.At(Time(k));
      error << now.p_W - thing.p(), now.v_W - thing.v();
      nees += error.dot(now.covariance.ldlt().solve(error));
      nis += verdict.nis;
      ++count;
      // A picture that arrives two periods late: the estimate is made up to then.
      Wanderer ahead = thing;
      ahead.Go();
      ahead.Go();
      const PointEstimate later = *track.At(Time(k + 2));
      const Eigen::Vector3d off = later.p_W - ahead.p();
      late += off.dot(later.covariance.topLeftCorner<3, 3>().ldlt().solve(off));
    }
  }
  const auto expect = [&](double sum, int dims) {
    EXPECT_NEAR(sum / count, dims, 1.96 * std::sqrt(2.0 * dims / count)) << dims;
  };
  expect(nees, 6);
  expect(nis, 3);
  // Here the acceleration changes after each period, not after both: a little less spread.
  EXPECT_NEAR(late / count, 3, 0.3);
  EXPECT_LT(rejected, 0.02 * offered);
}

// As against a track that does not see them. Some are as far as a sighting may be off.
TEST(TagTrack, IsMovedByOutliersByLessThanTwoCentimetres) {
  double farthest_m = 0;
  for (int run = 0; run < 100; ++run) {
    RandomStream random(static_cast<std::uint64_t>(run), "outliers");
    TagTrack track, spared;
    const Eigen::Vector3d v(0.1, -0.3, 0);
    for (int k = 0; k < 150; ++k) {
      const Eigen::Vector3d p = Eigen::Vector3d(0.4, 1, 0.4) + k * kPeriod_s * v;
      Eigen::Vector3d seen = p + kSigma_m * Normal3(random);
      if (random.Uniform() < 0.1) {  // elsewhere, from a few centimetres to half a metre
        seen += random.Uniform(0.03, 0.5) * Normal3(random).normalized();
      } else {
        spared.Update(Time(k), seen, kR_m2);
      }
      track.Update(Time(k), seen, kR_m2);
      if (k < 10) continue;
      const auto now = track.At(Time(k)), without = spared.At(Time(k));
      ASSERT_TRUE(now && without) << "run " << run << ", sighting " << k;
      farthest_m = std::max(farthest_m, (now->p_W - without->p_W).norm());
    }
  }
  EXPECT_LT(farthest_m, 0.02);
}

TEST(TagTrack, BeginsWhenThreeSightingsAgree) {
  TagTrack track;
  EXPECT_FALSE(track.Update(Time(0), {0, 0, 0}, kR_m2).is_taken);
  EXPECT_FALSE(track.Update(Time(1), {2, 0, 0}, kR_m2).is_taken) << "elsewhere";
  EXPECT_FALSE(track.Update(Time(2), {2, 0.01, 0}, kR_m2).is_taken);
  EXPECT_FALSE(track.is_followed());
  EXPECT_TRUE(track.Update(Time(3), {2, 0.02, 0}, kR_m2).is_taken);
  EXPECT_TRUE(track.is_followed());
  EXPECT_NEAR(track.At(Time(3))->p_W.y(), 0.02, 0.005);
}

TEST(TagTrack, IsLostAfterFiveMistakesInARowAndBeginsWhereTheyAgree) {
  TagTrack track;
  for (int k = 0; k < 10; ++k) track.Update(Time(k), {0, 0, 0}, kR_m2);
  for (int k = 10; k < 14; ++k) {
    EXPECT_FALSE(track.Update(Time(k), {0.5, 0, 0}, kR_m2).is_taken);
    EXPECT_LT(track.At(Time(k))->p_W.norm(), 0.01) << "it is held to be where it was";
  }
  EXPECT_TRUE(track.Update(Time(14), {0.5, 0, 0}, kR_m2).is_taken) << "it really is there";
  EXPECT_EQ(track.num_losses(), 1);
  EXPECT_NEAR(track.At(Time(14))->p_W.x(), 0.5, 0.005);
}

TEST(TagTrack, IsLostAfterThreeTenthsOfASecondWithoutSighting) {
  TagTrack track;
  for (int k = 0; k < 10; ++k) track.Update(Time(k), {0, 0, 0}, kR_m2);
  track.PassTime(Time(9) + HorizonOffset(0.299));
  EXPECT_TRUE(track.is_followed());
  track.PassTime(Time(9) + HorizonOffset(0.301));
  EXPECT_FALSE(track.is_followed());
  EXPECT_FALSE(track.At(Time(20)));
  EXPECT_EQ(track.num_losses(), 1);
  EXPECT_FALSE(track.Update(Time(20), {0, 0, 0}, kR_m2).is_taken) << "it must be found anew";
}

TEST(TagTrack, ThatHoldsOnIsLostOnlyToWhatAgrees) {
  RandomStream random(4, "mistakes");
  TagTrack track({.holds_on = true});
  for (int k = 0; k < 10; ++k) track.Update(Time(k), {0, 0, 0}, kR_m2);
  for (int k = 10; k < 16; ++k) {
    EXPECT_FALSE(track.Update(Time(k), 2 * Normal3(random), kR_m2).is_taken) << "anywhere";
    EXPECT_TRUE(track.is_followed());
  }
  TagTrack::Verdict verdict;
  int k = 16;
  for (; !verdict.is_taken; ++k) verdict = track.Update(Time(k), {0.5, 0, 0}, kR_m2);
  EXPECT_EQ(k, 16 + 3) << "three agree";
  EXPECT_EQ(verdict.num_begun_with, 3);
  EXPECT_EQ(track.num_losses(), 1);
}

TEST(TagTrack, RefusesWhatIsTurnedAsNothingTurns) {
  TagTrack track({.most_turn_rad_s = 6});
  const auto turned = [](double rad) {
    return SeenTurn{Eigen::Quaterniond(Eigen::AngleAxisd(rad, Eigen::Vector3d::UnitX())), 0.01};
  };
  for (int k = 0; k < 10; ++k) track.Update(Time(k), {0, 0, 0}, kR_m2, turned(0.19 * k));
  EXPECT_TRUE(track.is_followed()) << "5.7 rad/s";
  EXPECT_FALSE(track.Update(Time(10), {0, 0, 0}, kR_m2, turned(0.19 * 9 + 0.3)).is_taken);
  EXPECT_TRUE(track.Update(Time(11), {0, 0, 0}, kR_m2, turned(0.19 * 11)).is_taken);
  EXPECT_TRUE(track.Update(Time(12), {0, 0, 0}, kR_m2).is_taken) << "nobody says how it is turned";
}

TEST(TagTrack, TellsHowFarASightingIsFromWhatIsExpected) {
  TagTrack track;
  EXPECT_TRUE(std::isinf(track.DistanceOf(Time(0), {0, 0, 0}, kR_m2)));
  track.Update(Time(0), {0, 0, 0}, kR_m2);
  EXPECT_LT(track.DistanceOf(Time(1), {0, 0, 0}, kR_m2), 1e-9) << "of what may become a track";
  for (int k = 1; k < 10; ++k) track.Update(Time(k), {0, 0, 0}, kR_m2);
  const Eigen::Vector3d seen(0.01, 0.005, 0);
  const double distance = track.DistanceOf(Time(10), seen, kR_m2);
  EXPECT_GT(distance, 0);
  EXPECT_EQ(track.Update(Time(10), seen, kR_m2).nis, distance);
}

TEST(TagTrack, RefusesWhatIsFasterThanAnythingThere) {
  TagTrack track({.sigma_v_m_s = 100});
  const auto at = [](int k) { return Eigen::Vector3d(3.0 * k * kPeriod_s, 0, 0); };
  for (int k = 0; k < 10; ++k) EXPECT_FALSE(track.Update(Time(k), at(k), kR_m2 / 100).is_taken);
}

}  // namespace
}  // namespace sidestep::tag_track_test
