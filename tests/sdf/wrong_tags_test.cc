// Tags that are wrong at times, and what is made of them.
#include "tests/sdf/wrong_tags.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/sdf/tracking/object_tracker.h"

namespace sidestep::sdf::wrong_tags_test {
namespace {

// Over 400 seeds: wrong_tags_seeds_test, which is slow.
TEST(TagsThatMisbehave, MoveTheEstimateByLessThanTwoCentimetresAndLeaveItAsSureAsItMayBe) {
  ExpectLittleHarmOfWrongTags(30);
}

// Two pass each other; at times they are taken for each other.
TEST(TagsThatAreSwapped, KeepTheirNames) {
  for (int seed = 0; seed < 10; ++seed) {
    RandomStream random(static_cast<std::uint64_t>(seed), "swaps");
    NamedObjects objects(Gated());
    for (int k = 0; k < 90; ++k) {
      const EpisodeTime t(k * kPeriod_s);
      const Pose a = Pose::Translation({-1 + t.seconds(), 0.4, 0.5});
      const Pose b = Pose::Translation({1 - t.seconds(), -0.4, 0.5});
      std::vector<ObjectObservation> scan = {See("a", t, a, random), See("b", t, b, random)};
      if (random.Uniform() < 0.1) std::swap(scan[0].X_WO, scan[1].X_WO);
      objects.Update(scan, t);
      if (k < kSettled) continue;
      ASSERT_EQ(objects.Objects().size(), 2u);
      const auto predictor = MakePredictor("kalman_cv");
      for (const NamedObject& named : objects.Objects()) {
        const Pose& truth = named.object->id == -1 ? a : b;
        const Eigen::Vector3d p_W = predictor->PredictPose(*named.object, t).translation();
        EXPECT_LT((p_W - truth.translation()).norm(), 0.06) << "seed " << seed << ", scan " << k;
      }
    }
  }
}

ObjectObservation SeenAt(int k, const Eigen::Vector3d& p_W) {
  RandomStream exact(1, "exact");
  ObjectObservation seen = See("cart", EpisodeTime(k * kPeriod_s), Pose::Translation(p_W), exact);
  seen.X_WO = Pose::Translation(p_W);
  return seen;
}

std::vector<std::string> WordsOf(NamedObjects& objects) {
  std::vector<std::string> words;
  for (const TrackEvent& event : objects.TakeEvents()) words.push_back(event.what);
  return words;
}

TEST(GatedTags, BeginWhenThreeSightingsAgreeWithAllThree) {
  NamedObjects objects(Gated());
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE(objects.Objects().empty());
    objects.Update({SeenAt(k, {0.03 * k, 0, 0.5})}, EpisodeTime(k * kPeriod_s));
  }
  ASSERT_EQ(objects.Objects().size(), 1u);
  EXPECT_EQ(objects.Objects()[0].object->history.size(), 3u);
  EXPECT_EQ(objects.Objects()[0].object->first_seen, EpisodeTime(0));
  EXPECT_EQ(WordsOf(objects), std::vector<std::string>{track_event::kAppeared});
}

TEST(GatedTags, AreNotMadeOfPhantoms) {
  RandomStream random(3, "phantoms");
  NamedObjects objects(Gated());
  for (int k = 0; k < 600; ++k) {
    const EpisodeTime t(k * kPeriod_s);
    std::vector<ObjectObservation> scan;
    if (random.Uniform() < 0.1) scan.push_back(SeenAt(k, 2 * Normal3(random)));
    objects.Update(scan, t);
    EXPECT_TRUE(objects.Objects().empty()) << k;
  }
}

// What stops dead does not fit; it is believed after four scans, and what moved before is
// forgotten.
TEST(GatedTags, FollowWhatStopsDeadAfterFourScans) {
  NamedObjects objects(Gated());
  const auto at = [](int k) { return Eigen::Vector3d(0, 1.4 * kPeriod_s * std::min(k, 30), 0.5); };
  const auto predictor = MakePredictor("kalman_cv");
  for (int k = 0; k < 45; ++k) {
    const EpisodeTime t(k * kPeriod_s);
    objects.Update({SeenAt(k, at(k))}, t);
    if (k < 20 || (k > 30 && k < 35)) continue;
    const PredictedMotion motion = predictor->Predict(*objects.Objects().at(0).object);
    EXPECT_LT((motion.X_WO(t).translation() - at(k)).norm(), 0.03) << k;
    const Eigen::Vector3d later = motion.X_WO(t + HorizonOffset(0.5)).translation();
    EXPECT_LT((later - at(k + 15)).norm(), k > 35 || k < 15 ? 0.1 : 0.8) << k;
  }
  const std::vector<std::string> words = WordsOf(objects);
  EXPECT_GE(std::count(words.begin(), words.end(), std::string(track_event::kRefused)), 1);
}

TEST(GatedTags, TellOfWhatIsTooFastToBeFollowed) {
  NamedObjects objects(Gated());
  for (int k = 0; k < 10; ++k) {
    objects.Update({SeenAt(k, {0.3 * k, 0, 0.5})}, EpisodeTime(k * kPeriod_s));  // 9 m/s
  }
  EXPECT_TRUE(objects.Objects().empty());
  EXPECT_EQ(WordsOf(objects), std::vector<std::string>{track_event::kTooFast});
}

TEST(NamedObjects, CoastForAsLongAsTheyMay) {
  for (const double coast_s : {0.3, 1.0, 2.5}) {
    NamedObjectsOptions options = Gated();
    options.coast = HorizonOffset(coast_s);
    options.gates = GatesOfTags(4, options.coast);
    NamedObjects objects(options);
    for (int k = 0; k < 10; ++k) {
      objects.Update({SeenAt(k, {0.03 * k, 0, 0.5})}, EpisodeTime(k * kPeriod_s));
    }
    const EpisodeTime last(9 * kPeriod_s);
    objects.Update({}, last + HorizonOffset(coast_s - 0.001));
    EXPECT_EQ(objects.Objects().size(), 1u) << coast_s;
    objects.Update({}, last + HorizonOffset(coast_s + 0.001));
    EXPECT_TRUE(objects.Objects().empty()) << coast_s;
  }
}

}  // namespace
}  // namespace sidestep::sdf::wrong_tags_test
