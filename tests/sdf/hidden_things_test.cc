// Things that pass behind others, come out from behind them, and merge with each other, against
// where they truly are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/core/random.h"
#include "sidestep/sdf/prediction/registry.h"
#include "sidestep/sdf/tracking/object_tracker.h"
#include "sidestep/sdf/world_model.h"
#include "tests/sdf/box_scene.h"
#include "tests/sdf/cell_camera.h"

namespace sidestep::sdf {
namespace {

using ::testing::Contains;
using ::testing::Not;

constexpr double kRate_hz = 30;
using Objects = std::vector<std::shared_ptr<const TrackedObject>>;

GridSpec RoomGrid() { return {{-0.98, -0.98, 0.02}, 0.04, {50, 50, 12}}; }

Eigen::Vector3d BoxCentre(const TrackedObject& object, EpisodeTime t) {
  const auto predictor = MakePredictor("kalman_cv");
  return predictor->PredictPose(object, t).translation() + object.box_center_O;
}

// A room that is looked at by a camera or, without one, wholly.
class Room {
 public:
  Room(std::vector<SceneBox> boxes, const ObjectTrackerOptions& options,
       const std::optional<Eigen::Vector3d>& p_WCamera)
      : boxes_(std::move(boxes)), tracker_(RoomGrid(), options) {
    if (p_WCamera) camera_.emplace(RoomGrid(), *p_WCamera);
  }

  template <class Check>
  void RunUntil(double t_end_s, const Check& check) {
    for (; frame_ / kRate_hz < t_end_s - 1e-9; ++frame_) {
      const EpisodeTime t(frame_ / kRate_hz);
      const OccupancyGrid truth = Rasterise(boxes_, RoomGrid(), t);
      if (camera_) {
        camera_->Look(truth);
        tracker_.Update(camera_->map(), t, {camera_->seen()});
      } else {
        tracker_.Update(truth, t);
      }
      for (const TrackEvent& event : tracker_.TakeEvents()) story_.push_back(event);
      check(t);
    }
  }
  void RunUntil(double t_end_s) {
    RunUntil(t_end_s, [](EpisodeTime) {});
  }

  Objects objects() const { return tracker_.MovingObjects(); }
  const ObjectTracker& tracker() const { return tracker_; }
  std::vector<std::string> Words() const {
    std::vector<std::string> words;
    for (const TrackEvent& event : story_) words.push_back(event.what);
    return words;
  }
  double TimeOf(const std::string& what) const {
    for (const TrackEvent& event : story_) {
      if (event.what == what) return event.t.seconds();
    }
    return NAN;
  }

 private:
  std::vector<SceneBox> boxes_;
  ObjectTracker tracker_;
  std::optional<CellCamera> camera_;
  std::vector<TrackEvent> story_;
  int frame_ = 0;
};

// A screen, and a box that passes behind it: from the camera it is hidden for about 0.3 s at 1 m/s.
const Eigen::Vector3d kCamera(0, -3, 0.3), kBehind(-0.8, 0.4, 0.2), kBox(0.2, 0.24, 0.32);
SceneBox Screen() { return StillBox({0.56, 0.04, 0.48}, {0, -0.3, 0.24}); }
ObjectTrackerOptions Coasting(double coast_s) {
  return {.max_distance_m = 0.3, .coast = HorizonOffset(coast_s)};
}

class BehindAScreen : public ::testing::TestWithParam<double> {};

TEST_P(BehindAScreen, AThingGoesOnAndComesOutUnderItsName) {
  const double speed_m_s = GetParam();
  const SceneBox box = MovingBox(kBox, kBehind, {speed_m_s, 0, 0});
  Room room({Screen(), box}, Coasting(1.2), kCamera);
  const double t_out_s = 1.45 / speed_m_s;
  std::set<int> ids;
  double worst_m = 0, hidden_for_s = 0, last_sigma_m = 0;
  room.RunUntil(t_out_s, [&](EpisodeTime t) {
    if (t.seconds() < 0.2) return;
    const Objects objects = room.objects();
    ASSERT_EQ(objects.size(), 1u) << "at " << t.seconds();
    ids.insert(objects[0]->id);
    const double unseen_s = (t - objects[0]->latest().t).seconds();
    hidden_for_s = std::max(hidden_for_s, unseen_s);
    worst_m = std::max(worst_m, std::abs((BoxCentre(*objects[0], t) - box.p_WO(t)).x()));
    const auto motion = MakePredictor("kalman_cv")->Predict(*objects[0]);
    const double sigma_m = std::sqrt(motion.covariance_m2(t)(0, 0));
    if (unseen_s > 0.1) {
      EXPECT_GT(sigma_m, last_sigma_m) << "it gets less sure";
    }
    last_sigma_m = sigma_m;
  });
  EXPECT_EQ(ids.size(), 1u);
  EXPECT_GT(hidden_for_s, 0.2 / speed_m_s) << "it was hidden at all";
  EXPECT_LT(worst_m, 0.1);
  EXPECT_THAT(room.Words(), Contains(track_event::kHidden));
  EXPECT_THAT(room.Words(), Contains(track_event::kFound));
  EXPECT_THAT(room.Words(), Not(Contains(track_event::kLost)));
}

INSTANTIATE_TEST_SUITE_P(Speeds, BehindAScreen, ::testing::Values(0.5, 0.8, 1.0, 1.4),
                         [](const auto& test) {
                           return std::to_string(std::lround(1000 * test.param)) +
                                  "MillimetresPerSecond";
                         });

TEST(AHiddenThing, IsGivenUpAfterTheTimeThatItMayCoast) {
  Room room({Screen(), MovingBox(kBox, kBehind, {0.5, 0, 0})}, Coasting(0.2), kCamera);
  double last_seen_s = 0, last_there_s = 0;
  room.RunUntil(1.9, [&](EpisodeTime t) {
    for (const auto& object : room.objects()) {
      last_seen_s = object->latest().t.seconds();
      last_there_s = t.seconds();
    }
  });
  EXPECT_NEAR(last_there_s - last_seen_s, 0.2, 1.01 / kRate_hz);
}

TEST(AHiddenThing, IsGivenUpSoonerWhereItShouldHaveComeOutAndDidNot) {
  SceneBox box = MovingBox(kBox, kBehind, {0.8, 0, 0});
  box.is_there = [](EpisodeTime t) { return t.seconds() < 1; };  // it stays behind the screen
  Room room({Screen(), box}, Coasting(10), kCamera);
  room.RunUntil(1.1);
  EXPECT_EQ(room.objects().size(), 1u);
  room.RunUntil(2.2);
  EXPECT_EQ(room.objects().size(), 0u);
  EXPECT_NEAR(room.TimeOf(track_event::kLost), 1.55, 0.25);
}

// The same, but nothing is hidden: a cell that was seen to be free says that it is not there.
TEST(AThingThatVanishesInPlainSight, DoesNotCoast) {
  SceneBox box = MovingBox(kBox, kBehind, {0.8, 0, 0});
  box.is_there = [](EpisodeTime t) { return t.seconds() < 0.5; };
  for (const auto& camera : {std::optional<Eigen::Vector3d>(), std::optional(kCamera)}) {
    Room room({box}, Coasting(10), camera);
    room.RunUntil(0.9);
    EXPECT_NEAR(room.TimeOf(track_event::kLost), 0.5 + 4 / kRate_hz, 1.01 / kRate_hz);
  }
}

TEST(AThingThatNobodyHasSeen, IsKnownToMoveSoonAfterItComesOutAndNotTakenForFurniture) {
  for (const double speed_m_s : {0.3, 0.6, 1.0, 1.4}) {
    SCOPED_TRACE(speed_m_s);
    const SceneBox box = MovingBox(kBox, {-0.1, 0.4, 0.2}, {speed_m_s, 0, 0});
    Room room({Screen(), box}, Coasting(1), kCamera);
    double t_seen_s = NAN, t_moves_s = NAN;
    room.RunUntil(0.75 / speed_m_s, [&](EpisodeTime t) {
      const bool is_out = box.p_WO(t).x() + 0.1 > 0.28 * 3.4 / 2.7 + 0.02;
      if (is_out && std::isnan(t_seen_s)) t_seen_s = t.seconds();
      if (!room.objects().empty() && std::isnan(t_moves_s)) t_moves_s = t.seconds();
      if (t.seconds() > t_seen_s + 0.2 + 0.06 / speed_m_s) {
        ASSERT_EQ(room.objects().size(), 1u) << "at " << t.seconds();
        const Eigen::Vector3d v = MeanVelocity(room.objects()[0]->history, kVelocityBaseline);
        EXPECT_NEAR(v.x(), speed_m_s, 0.45) << "at " << t.seconds();
      }
    });
    EXPECT_LT(t_moves_s - t_seen_s, 0.1 + 0.06 / speed_m_s);
  }
}

// Where nothing was ever known to be free, nothing can be said to have come to.
TEST(AThingThatComesFromWhereNobodyCouldSee, IsKnownToMoveWhenItHasLeftWhereItWas) {
  constexpr double kSpeed_m_s = 0.8;
  const std::vector<std::uint8_t> nowhere(RoomGrid().num_cells(), 0);
  const SceneBox moving = MovingBox({0.2, 0.4, 0.4}, {-0.7, 0.4, 0.24}, {kSpeed_m_s, 0, 0});
  const SceneBox board = StillBox({1.6, 0.04, 0.32}, {0.1, -0.2, 0.2});
  ObjectTrackerOptions options = Coasting(1);
  options.least_cells = 6;
  ObjectTracker tracker(RoomGrid(), options);
  for (int frame = 0; frame < 24; ++frame) {
    const EpisodeTime t(frame / kRate_hz);
    OccupancyGrid map = Rasterise({moving, board}, RoomGrid(), t);
    std::vector<std::uint8_t> seen(map.cells.size(), 1);
    for (std::size_t cell = 0; cell < map.cells.size(); ++cell) {
      const Eigen::Vector3d p_W = RoomGrid().CenterOf(cell);
      // The box comes out of the dark; the board, which is still, comes to light as quickly.
      const bool is_dark =
          p_W.y() > 0 ? p_W.x() < -0.54 : p_W.x() > -0.6 + kSpeed_m_s * t.seconds();
      if (is_dark) map.cells[cell] = seen[cell] = 0;
    }
    tracker.Update(map, t, {seen, nowhere});
  }
  const Objects objects = tracker.MovingObjects();
  ASSERT_EQ(objects.size(), 1u);
  EXPECT_GT(objects[0]->latest().p_WO.y(), 0);
}

// The scan of such a camera: a point in each filled cell that it sees, and rays that pass through
// each free one.
Scan ScanOf(const CellCamera& camera, EpisodeTime t) {
  Scan scan;
  scan.t = t;
  scan.kind = ScanKind::kSurface;
  scan.X_WC = Pose::Translation(kCamera);
  std::vector<Eigen::Vector3d> points, free;
  for (std::size_t cell = 0; cell < camera.seen().size(); ++cell) {
    if (camera.seen()[cell] == 0) continue;
    const Eigen::Vector3d p_CP = RoomGrid().CenterOf(cell) - kCamera;
    if (camera.map().cells[cell] != 0) {
      points.push_back(p_CP);
    } else {
      free.push_back(p_CP + RoomGrid().cell_m * p_CP.normalized());
    }
  }
  const auto in_columns = [](const std::vector<Eigen::Vector3d>& list) {
    Eigen::Matrix3Xd columns(3, static_cast<Eigen::Index>(list.size()));
    for (Eigen::Index n = 0; n < columns.cols(); ++n) {
      columns.col(n) = list[static_cast<std::size_t>(n)];
    }
    return columns;
  };
  scan.p_CP = in_columns(points);
  scan.p_CFree = in_columns(free);
  return scan;
}

TEST(WorldModel, FollowsWhatACameraLosesBehindAScreenForAsLongAsItMayCoast) {
  const SceneBox box = MovingBox(kBox, kBehind, {1, 0, 0});
  for (const double coast_s : {0.1, 1.0}) {
    WorldModelOptions options;
    options.grid = RoomGrid();
    options.max_distance_m = 0.3;
    options.coast = HorizonOffset(coast_s);
    const auto world = MakeWorldModel(options);
    CellCamera camera(RoomGrid(), kCamera);
    EpisodeTime t;
    for (int frame = 0; frame <= 24; ++frame) {  // it was seen last at 0.5 s
      t = EpisodeTime(frame / kRate_hz);
      camera.Look(Rasterise({Screen(), box}, RoomGrid(), t));
      world->Observe(ScanOf(camera, t));
    }
    world->MakeField();
    const std::vector<PredictedObject> objects = world->DescribeObjects({t});
    ASSERT_EQ(objects.size(), coast_s > 0.5 ? 1u : 0u);
    if (objects.empty()) continue;
    EXPECT_NEAR(objects[0].X_WO[0].translation().x(), box.p_WO(t).x(), 0.1);
  }
}

// Two boxes, and who is who.
struct Pair {
  SceneBox boxes[2];
  bool TouchOrOverlapAt(EpisodeTime t, double gap_m) const {
    const Eigen::Vector3d off = (boxes[0].p_WO(t) - boxes[1].p_WO(t)).cwiseAbs();
    return ((off - (boxes[0].size_m + boxes[1].size_m) / 2).array() < gap_m).all();
  }
};

// On level ways that meet; boxes like things that move: a quarter to half a metre long.
Pair DrawPair(RandomStream& random) {
  const auto size = [&] {
    return Eigen::Vector3d(random.Uniform(0.2, 0.4), random.Uniform(0.2, 0.4), 0.4);
  };
  while (true) {
    Pair pair;
    const double t_meet_s = random.Uniform(0.6, 0.9);
    for (SceneBox& box : pair.boxes) {
      const double angle = random.Uniform(-3.1, 3.1), speed_m_s = random.Uniform(0.5, 1.2);
      const Eigen::Vector3d v(speed_m_s * std::cos(angle), speed_m_s * std::sin(angle), 0);
      const Eigen::Vector3d p_meet(random.Uniform(-0.3, 0.3), random.Uniform(-0.3, 0.3), 0.2);
      box = MovingBox(size(), p_meet - t_meet_s * v, v);
    }
    // They touch, but do not go through each other.
    bool touch = false, overlap = false, begin_apart = true, end_apart = true;
    for (double t_s = 0; t_s < 1.5; t_s += 0.01) {
      touch |= pair.TouchOrOverlapAt(EpisodeTime(t_s), 0.02);
      overlap |= pair.TouchOrOverlapAt(EpisodeTime(t_s), 0);
      const bool near = pair.TouchOrOverlapAt(EpisodeTime(t_s), 0.1);
      if (t_s < 0.3) begin_apart &= !near;
      if (t_s > 1.2) end_apart &= !near;
    }
    bool in_room = true;
    for (const SceneBox& box : pair.boxes) {
      for (const double t_s : {0.0, 1.5}) {
        in_room &= (box.p_WO(EpisodeTime(t_s)).head<2>().cwiseAbs().array() < 0.75).all();
      }
    }
    if (touch && !overlap && begin_apart && end_apart && in_room) return pair;
  }
}

TEST(TwoThatTouchOnTheirWays, KeepTheirMotionsAndComeOutUnderTheirNames) {
  RandomStream random(1, "crossings");
  int num_merged = 0;
  for (int run = 0; run < 60; ++run) {
    SCOPED_TRACE("run " + std::to_string(run));
    const Pair pair = DrawPair(random);
    Room room({pair.boxes[0], pair.boxes[1]}, Coasting(1), std::nullopt);
    int ids[2] = {0, 0};
    room.RunUntil(1.5, [&](EpisodeTime t) {
      if (t.seconds() < 0.25) return;
      const Objects objects = room.objects();
      ASSERT_EQ(objects.size(), 2u) << "at " << t.seconds();
      for (int b = 0; b < 2; ++b) {
        const Eigen::Vector3d p_W = pair.boxes[b].p_WO(t);
        const auto of = std::min_element(
            objects.begin(), objects.end(), [&](const auto& one, const auto& other) {
              return (BoxCentre(*one, t) - p_W).norm() < (BoxCentre(*other, t) - p_W).norm();
            });
        if (ids[b] == 0) ids[b] = (*of)->id;
        EXPECT_EQ((*of)->id, ids[b]) << "box " << b << " at " << t.seconds();
        EXPECT_LT((BoxCentre(**of, t) - p_W).norm(), 0.07) << "box " << b << " at " << t.seconds();
      }
    });
    EXPECT_NE(ids[0], ids[1]);
    const std::vector<std::string> words = room.Words();
    num_merged += std::count(words.begin(), words.end(), std::string(track_event::kMerged)) > 0;
  }
  EXPECT_GT(num_merged, 30) << "they are in one piece for a while";
}

TEST(TwoThatGoTogetherForLong, AreTwoAllTheTime) {
  // Side by side, touching, from 0.3 s to 2.3 s; then one turns off.
  const auto way = [](double side, double off_m_s) {
    return [=](EpisodeTime t) -> Eigen::Vector3d {
      const double apart_m = std::max(0.0, 0.3 - t.seconds()) + std::max(0.0, t.seconds() - 2.3);
      return {-0.7 + 0.5 * t.seconds(), side * (0.1 + off_m_s * apart_m), 0.2};
    };
  };
  Room room({{{0.28, 0.2, 0.4}, way(-1, 0.6)}, {{0.28, 0.2, 0.4}, way(1, 0.6)}}, Coasting(1),
            std::nullopt);
  std::set<int> ids;
  room.RunUntil(2.7, [&](EpisodeTime t) {
    if (t.seconds() < 0.2) return;
    ASSERT_EQ(room.objects().size(), 2u) << "at " << t.seconds();
    for (const auto& object : room.objects()) {
      ids.insert(object->id);
      const double side = BoxCentre(*object, t).y() < 0 ? -1 : 1;
      EXPECT_LT((BoxCentre(*object, t) - way(side, 0.6)(t)).norm(), 0.06) << t.seconds();
    }
  });
  EXPECT_EQ(ids.size(), 2u);
}

TEST(ATrackThatIsTooFast, IsTold) {
  // 0.4 m a scan: farther than 4 m/s and two cells.
  Room room({MovingBox(kBox, {-0.9, 0, 0.2}, {12, 0, 0})}, Coasting(1), std::nullopt);
  room.RunUntil(0.15);
  EXPECT_THAT(room.Words(), Contains(track_event::kTooFast));
  Room slower({MovingBox(kBox, {-0.9, 0, 0.2}, {3, 0, 0})}, Coasting(1), std::nullopt);
  slower.RunUntil(0.5);
  EXPECT_THAT(slower.Words(), Not(Contains(track_event::kTooFast)));
}

}  // namespace
}  // namespace sidestep::sdf
