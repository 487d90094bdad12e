#include "sidestep/sdf/map/evidence_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sidestep/core/random.h"

namespace sidestep::sdf::evidence_map_test {
namespace {

const GridSpec kGrid = {{0.05, -0.95, -0.95}, 0.1, {30, 20, 20}};

std::size_t CellAt(const Eigen::Vector3d& p_W) {
  const auto [i, j, k] = kGrid.CellOf(p_W);
  return kGrid.Index(i, j, k);
}

EvidenceOptions Weighed() {
  EvidenceOptions options;
  options.hit = 0.7;
  options.miss = 1.4;
  options.least = -2.8;
  options.most = 2.8;
  options.settle_scans = 10;
  options.decay_per_s = 7;
  options.noise_sigmas = 4;
  options.least_cells = 6;
  return options;
}

// The camera stands at the origin and looks along x: its z axis.
const Pose kCamera = Pose(Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY())),
                          Eigen::Vector3d::Zero());

Eigen::Matrix3Xd InCamera(const std::vector<Eigen::Vector3d>& points_W) {
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(points_W.size()));
  for (std::size_t n = 0; n < points_W.size(); ++n) {
    points.col(static_cast<Eigen::Index>(n)) = kCamera.Inverse() * points_W[n];
  }
  return points;
}

Scan Seen(const std::vector<Eigen::Vector3d>& hits_W, const std::vector<Eigen::Vector3d>& ends_W,
          double t_s) {
  Scan scan;
  scan.t = EpisodeTime(t_s);
  scan.kind = ScanKind::kSurface;
  scan.sensor = "camera";
  scan.X_WC = kCamera;
  scan.p_CP = InCamera(hits_W);
  scan.p_CFree = InCamera(ends_W);
  return scan;
}

// Rays through a square of so many cells, 0.1 m apart, that end at depth x.
std::vector<Eigen::Vector3d> Square(double x_m, int cells, double y_m = 0.05) {
  std::vector<Eigen::Vector3d> points;
  for (int j = 0; j < cells; ++j) {
    for (int k = 0; k < cells; ++k) points.emplace_back(x_m, y_m + 0.1 * j, 0.05 + 0.1 * k);
  }
  return points;
}

// One cell, on its own: what is to be true of it is a sum that anybody can write down.
TEST(EvidenceMap, SumsAndClampsWhatScansSayOfACell) {
  const EvidenceOptions options = Weighed();
  RandomStream random(1, "hits");
  const Eigen::Vector3d point(1.55, 0.05, 0.05), beyond(2.55, 0.08, 0.08);
  for (const double p_hit : {0.2, 0.5, 0.7, 0.9}) {
    EvidenceMap map(kGrid, options, {});
    double sum = 0;
    bool once_free = false;
    for (int n = 0; n < 300; ++n) {
      const bool hit = random.Uniform() < p_hit;
      if (hit) {
        map.Update(Seen({point}, {}, n / 30.0));
        sum = std::min(sum + options.hit, options.most);
      } else {
        map.Update(Seen({}, {beyond}, n / 30.0));
        sum = std::max(sum - options.miss, options.least);
      }
      if (sum <= options.least + 1e-6) once_free = true;
      ASSERT_EQ(map.filled().cells[CellAt(point)] != 0, sum > 1e-3) << p_hit << " scan " << n;
      ASSERT_EQ(map.once_free()[CellAt(point)] != 0, once_free) << p_hit << " scan " << n;
    }
  }
}

TEST(EvidenceMap, ForgetsWhatWasSeenInPassingAndKeepsWhatHasSettled) {
  const Eigen::Vector3d point(1.55, 0.05, 0.05);
  const struct {
    int free, hits;
    double kept_s;  // after the last hit; by the sum, from -2.8 to at most 2.8, at 7 a second
  } cases[] = {{0, 1, 1e9}, {3, 5, 0.1}, {3, 7, 0.3}, {3, 12, 0.4}, {3, 14, 1e9}};
  EvidenceOptions options = Weighed();
  options.decay_per_s = 7;
  for (const auto& [free, hits, kept_s] : cases) {
    EvidenceMap map(kGrid, options, {});
    double t_s = 0;
    for (int n = 0; n < free; ++n) map.Update(Seen({}, {{2.55, 0.08, 0.08}}, t_s += 0.01));
    for (int n = 0; n < hits; ++n) map.Update(Seen({point}, {}, t_s += 0.01));
    for (double hidden_s = 0.01; hidden_s < 2; hidden_s += 0.01) {
      map.Update(Seen({{0.35, 0.02, 0.02}}, {}, t_s + hidden_s));
      if (std::abs(hidden_s - kept_s) < 0.015) continue;
      ASSERT_EQ(map.filled().cells[CellAt(point)] != 0, hidden_s < kept_s)
          << hits << " hits, hidden for " << hidden_s;
    }
  }
}

TEST(EvidenceMap, BelievesAtOnceInWhatIsLargeAndNotInASinglePoint) {
  for (const int cells : {1, 2, 5}) {
    EvidenceMap map(kGrid, Weighed(), {});
    for (int n = 0; n < 5; ++n) map.Update(Seen({}, Square(2.55, cells), n / 30.0));
    int scans = 0;
    const Eigen::Vector3d point(1.55, 0.05 * 1.55 / 2.55, 0.05 * 1.55 / 2.55);
    while (map.filled().cells[CellAt(point)] == 0) {
      ASSERT_LT(scans, 10);
      std::vector<Eigen::Vector3d> hits = Square(2.55, cells);
      for (Eigen::Vector3d& hit : hits) hit *= 1.55 / 2.55;
      map.Update(Seen(hits, {}, (5 + scans) / 30.0));
      ++scans;
    }
    EXPECT_EQ(scans, cells == 5 ? 1 : 5) << cells;  // from -2.8, by 0.7
  }
}

// A wall, seen with noise: after the first scan nothing is to change.
TEST(EvidenceMap, TakesAWallsNoiseForTheWall) {
  for (const double noise_per_m : {0.002, 0.005, 0.01}) {
    EvidenceMap map(kGrid, Weighed(), {{"camera", {UnseenSpace::kRemembered, noise_per_m}}});
    RandomStream random(2, "noise");
    const std::vector<Eigen::Vector3d> wall = Square(2.03, 8, -0.35);
    const auto scan = [&](int n) {
      std::vector<Eigen::Vector3d> hits = wall;
      for (Eigen::Vector3d& hit : hits) {
        hit *= 1 + noise_per_m * hit.x() * random.Normal();
      }
      return Seen(hits, {}, n / 30.0);
    };
    map.Update(scan(0));
    const std::vector<std::uint8_t> at_first = map.filled().cells;
    int changed = 0, came = 0;
    for (int n = 1; n < 200; ++n) {
      map.Update(scan(n));
      for (std::size_t c = 0; c < at_first.size(); ++c) {
        changed += map.filled().cells[c] != at_first[c] ? 1 : 0;
        came += map.filled().cells[c] != 0 && map.once_free()[c] != 0 ? 1 : 0;
      }
    }
    EXPECT_EQ(came, 0) << noise_per_m;
    // Of 64 rays a few began so far out that they are seen to be elsewhere.
    EXPECT_LT(changed / 200.0, 5) << noise_per_m;
  }
}

// At 0.01 the depth of a wall 2 m away is off by 4 cm: the first scan fills cells before it.
TEST(EvidenceMap, ThinsAWallToItsOwnCellsWhereRaysAreAveraged) {
  const auto thickness = [](int average_scans) {
    EvidenceOptions options = Weighed();
    options.average_scans = average_scans;
    EvidenceMap map(kGrid, options, {{"camera", {UnseenSpace::kRemembered, 0.01}}});
    RandomStream random(2, "noise");
    for (int n = 0; n < 60; ++n) {
      std::vector<Eigen::Vector3d> hits = Square(2.06, 8, -0.35);
      Scan scan = Seen(hits, {}, n / 30.0);
      for (int ray = 0; ray < scan.p_CP.cols(); ++ray) {
        scan.p_CP.col(ray) *= 1 + 0.01 * scan.p_CP(2, ray) * random.Normal();
        scan.rays.push_back(ray);
      }
      map.Update(scan);
    }
    int before = 0;
    for (std::size_t c = 0; c < map.filled().cells.size(); ++c) {
      if (map.filled().cells[c] != 0 && kGrid.CenterOf(c).x() < 2) ++before;
    }
    return before;
  };
  EXPECT_GT(thickness(1), 5);
  EXPECT_EQ(thickness(60), 0);
}

// A ray goes past the end of another, through the cell before it.
TEST(EvidenceMap, DoesNotSayThatSpaceIsFreeWhereANoisyRayMayHaveEnded) {
  for (const double noise_per_m : {0.0, 0.01}) {
    EvidenceMap map(kGrid, Weighed(), {{"camera", {UnseenSpace::kRemembered, noise_per_m}}});
    for (int n = 0; n < 20; ++n) {
      map.Update(Seen({{2.05, 0.05, 0.05}}, {{2.9, 0.09, 0.05}}, n / 30.0));
    }
    EXPECT_NE(map.filled().cells[CellAt({2.05, 0.05, 0.05})], 0);
    EXPECT_EQ(map.once_free()[CellAt({1.95, 0.05, 0.05})] != 0, noise_per_m == 0) << noise_per_m;
    EXPECT_NE(map.once_free()[CellAt({1.65, 0.05, 0.05})], 0) << "0.16 m are 4 deviations";
  }
}

// Something comes, and stays: its cells were known to be free.
TEST(EvidenceMap, TakesWhatARayHasSeenUnchangedForLongForWhatRests) {
  EvidenceOptions options = Weighed();
  options.settle_scans = 60;
  options.average_scans = 60;
  EvidenceMap map(kGrid, options, {{"camera", {UnseenSpace::kRemembered, 0.002}}});
  const std::size_t cell = CellAt({1.05, 0.05, 0.05});
  for (int n = 0; n < 40; ++n) {
    Scan scan = Seen(Square(n < 10 ? 2.05 : 1.05, 4), {}, n / 30.0);
    for (int ray = 0; ray < scan.p_CP.cols(); ++ray) scan.rays.push_back(ray);
    map.Update(scan);
    if (n < 9) continue;
    if (n == 9) {
      EXPECT_NE(map.once_free()[cell], 0);
      continue;
    }
    EXPECT_NE(map.filled().cells[cell], 0) << n;
    EXPECT_EQ(map.once_free()[cell] != 0, n < 24) << n;
  }
}

TEST(EvidenceMap, SeesWhatStandsClearOfTheNoiseBeforeAWall) {
  EvidenceMap map(kGrid, Weighed(), {{"camera", {UnseenSpace::kRemembered, 0.002}}});
  for (int n = 0; n < 20; ++n) map.Update(Seen(Square(2.05, 4), {}, n / 30.0));
  std::vector<Eigen::Vector3d> hits = Square(2.05, 4);
  for (Eigen::Vector3d& hit : hits) hit *= 1.75 / 2.05;  // 0.3 m before it, 4 deviations are 0.03 m
  map.Update(Seen(hits, {}, 1));
  for (const Eigen::Vector3d& hit : hits) {
    EXPECT_TRUE(map.filled().cells[CellAt(hit)] != 0);
    EXPECT_TRUE(map.once_free()[CellAt(hit)] != 0);
  }
  EXPECT_TRUE(map.filled().cells[CellAt({2.05, 0.05, 0.05})] != 0) << "what it hides is remembered";
}

TEST(EvidenceMap, RefusesWhatIsOutOfItsBounds) {
  const auto with = [](const auto& change) {
    EvidenceOptions options = Weighed();
    change(options);
    return options;
  };
  const EvidenceOptions bad[] = {with([](EvidenceOptions& o) { o.hit = 0; }),
                                 with([](EvidenceOptions& o) { o.miss = -1; }),
                                 with([](EvidenceOptions& o) { o.least = 0; }),
                                 with([](EvidenceOptions& o) { o.most = 0; }),
                                 with([](EvidenceOptions& o) { o.decay_per_s = -1; }),
                                 with([](EvidenceOptions& o) { o.noise_sigmas = std::nan(""); }),
                                 with([](EvidenceOptions& o) { o.settle_scans = 0; }),
                                 with([](EvidenceOptions& o) { o.average_scans = 0; }),
                                 with([](EvidenceOptions& o) { o.least_cells = 0; })};
  for (const EvidenceOptions& options : bad) {
    EXPECT_THROW(EvidenceMap(kGrid, options, {}), std::invalid_argument);
  }
  std::map<std::string, CameraView> nine;
  for (int n = 0; n < 9; ++n) nine[std::to_string(n)] = {};
  EXPECT_THROW(EvidenceMap(kGrid, Weighed(), nine), std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::sdf::evidence_map_test
