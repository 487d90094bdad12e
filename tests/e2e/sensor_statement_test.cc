// Each sensor model against its own statement, measured back from a trace. Statistical bounds are
// four standard errors wide; the seeds are fixed, so a result stays what it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <optional>

#include "sidestep/bench/episode.h"
#include "sidestep/core/input_error.h"
#include "sidestep/core/shape.h"
#include "sidestep/sim/sensors.h"
#include "sidestep/sim/simulation.h"
#include "tests/sim/two_link.h"

namespace sidestep {
namespace {

// An arm that slowly swings, and a sensor; about ten seconds.
scenarios::Scenario SwingingScenario() {
  scenarios::Scenario scenario = sim::TwoLinkScenario();
  scenario.q_start = Eigen::Vector2d(-1, 0);
  scenario.q_goal = Eigen::Vector2d(1, 0);
  scenario.horizon_s = 10;
  scenario.step_s = 0.5;
  scenario.planner = "straight_line";
  scenario.epsilon_m = 0.1;
  scenario.knowledge = "execute_and_update";
  scenario.predictor = "two_frame";
  scenario.replan_rate_hz = 0.2;
  scenario.latency_s = 0.1;
  scenario.seed = 7;
  return scenario;
}

record::Recording Record(const scenarios::Scenario& scenario) {
  const auto make_world = [](const scenarios::Scenario& of, const robot::RobotModel& robot) {
    return bench::MakeEpisodeWorld(std::make_shared<sim::Simulation>(of, robot, sim::kTestModels));
  };
  const bench::EpisodeResult result =
      bench::RunEpisode(scenario, sim::TwoLink(scenario), make_world);
  bench::RequireWhole(result);
  return result.recording;
}

// The grids that a trace tells of, one a scan.
std::vector<std::vector<std::uint8_t>> GridsOf(const record::Recording& recording,
                                               const GridSpec& grid) {
  std::vector<std::vector<std::uint8_t>> grids;
  std::vector<std::uint8_t> cells(grid.num_cells(), 0);
  for (const record::ObservationRecord& observation : recording.observations) {
    for (const std::int64_t cell : observation.changed_cells) {
      cells[static_cast<std::size_t>(cell)] ^= 1;
    }
    grids.push_back(cells);
  }
  return grids;
}

// Mean, and how far it is from `expected` in standard errors.
double StandardErrorsOff(const std::vector<double>& values, double expected, double deviation) {
  double sum = 0;
  for (const double value : values) sum += value;
  const auto n = static_cast<double>(values.size());
  return std::abs(sum / n - expected) / (deviation / std::sqrt(n));
}

// The chance that a normal variable of this deviation falls into [low, high).
double NormalPart(double low, double high, double deviation) {
  const double scale = 1 / (deviation * std::sqrt(2.0));
  return 0.5 * (std::erf(high * scale) - std::erf(low * scale));
}

// Whether counts of cells along one axis, by their offset from the middle, are those of a normal
// variable that is rounded to cells.
void ExpectNormalCounts(const std::map<int, int>& counts, double cell_m, double middle_m,
                        double deviation_m) {
  int total = 0;
  for (const auto& [offset, count] : counts) total += count;
  for (int offset = -3; offset <= 3; ++offset) {
    const double low = (offset - 0.5) * cell_m - middle_m;
    const double p = NormalPart(low, low + cell_m, deviation_m);
    const auto found = counts.find(offset);
    EXPECT_NEAR(found == counts.end() ? 0 : found->second, p * total,
                4 * std::sqrt(total * p * (1 - p)) + 1)
        << "cells from the middle: " << offset;
  }
}

TEST(SensorDelivery, HasItsRateLatencyJitterAndDropout) {
  scenarios::Scenario scenario = SwingingScenario();
  scenario.sensor.rate_hz = 40;
  scenario.sensor.latency_s = 0.05;
  scenario.sensor.jitter_s = 0.02;  // less than a period: none overtakes another
  scenario.sensor.dropout = 0.2;
  const record::Recording recording = Record(scenario);
  const double end_s = recording.control.back().t.seconds();
  const double num_captures = std::floor((end_s - 0.07) * 40) + 1;
  std::vector<double> delays;
  for (const record::ObservationRecord& observation : recording.observations) {
    const double k = observation.t.seconds() * 40;
    EXPECT_NEAR(k, std::round(k), 1e-9);
    const double delay = observation.t_arrival.seconds() - observation.t.seconds();
    EXPECT_GE(delay, 0.05 - 1e-9);
    EXPECT_LT(delay, 0.071);  // rounded up to a tick
    delays.push_back(delay);
  }
  ASSERT_GT(delays.size(), 250u);
  EXPECT_LT(StandardErrorsOff(delays, 0.05 + 0.01 + 0.0005, 0.02 / std::sqrt(12.0)), 4);
  EXPECT_NEAR(static_cast<double>(delays.size()), 0.8 * num_captures,
              4 * std::sqrt(0.2 * 0.8 * num_captures) + 1);
}

TEST(SensorDelivery, ThrowsAwayScansThatNewerOnesOvertook) {
  scenarios::Scenario scenario = SwingingScenario();
  scenario.sensor.rate_hz = 100;
  scenario.sensor.jitter_s = 0.05;
  const record::Recording recording = Record(scenario);
  const std::vector<record::ObservationRecord>& observations = recording.observations;
  ASSERT_GT(observations.size(), 100u);
  for (std::size_t i = 1; i < observations.size(); ++i) {
    EXPECT_LT(observations[i - 1].t, observations[i].t);
    EXPECT_LE(observations[i - 1].t_arrival, observations[i].t_arrival);
  }
  EXPECT_LT(static_cast<double>(observations.size()),
            0.9 * 100 * recording.control.back().t.seconds());
}

TEST(SensorDelivery, WithoutImperfectionsIsPromptAndComplete) {
  scenarios::Scenario scenario = SwingingScenario();
  const record::Recording recording = Record(scenario);
  for (std::size_t k = 0; k < recording.observations.size(); ++k) {
    EXPECT_NEAR(recording.observations[k].t.seconds(), static_cast<double>(k) / 30, 1e-3);
    EXPECT_EQ(recording.observations[k].t, recording.observations[k].t_arrival);
  }
}

TEST(OccupancyNoise, FlipsCellsAsOftenAsItSays) {
  scenarios::Scenario scenario = SwingingScenario();
  scenario.static_obstacles = {{"shelf", Pose::Translation({0, 0.7, 0.4}), Box{{0.4, 0.2, 0.3}}}};
  const std::vector<std::uint8_t> truth = GridsOf(Record(scenario), scenario.grid).front();
  scenario.sensor.noise = scenarios::OccupancyNoise{.false_filled = 0.002, .false_free = 0.1};
  const auto grids = GridsOf(Record(scenario), scenario.grid);
  double free_cells = 0, false_filled = 0, filled_cells = 0, false_free = 0;
  for (const std::vector<std::uint8_t>& cells : grids) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      (truth[i] != 0 ? filled_cells : free_cells) += 1;
      if (truth[i] == 0 && cells[i] != 0) ++false_filled;
      if (truth[i] != 0 && cells[i] == 0) ++false_free;
    }
  }
  ASSERT_GT(grids.size(), 200u);
  EXPECT_NEAR(false_filled, 0.002 * free_cells, 4 * std::sqrt(0.002 * free_cells));
  EXPECT_NEAR(false_free, 0.1 * filled_cells, 4 * std::sqrt(0.1 * 0.9 * filled_cells));
}

TEST(OccupancyNoise, DisplacesPointsByItsDeviationAlongEachAxis) {
  scenarios::Scenario scenario = SwingingScenario();
  scenario.sensor.rate_hz = 200;
  const Eigen::Vector3d p_WCell = scenario.grid.Center(20, 40, 30);
  scenario.static_obstacles = {
      {"grain", Pose::Translation(p_WCell), Box{Eigen::Vector3d::Constant(0.02)}}};
  constexpr double kDeviation = 0.03;
  scenario.sensor.noise = scenarios::OccupancyNoise{.position_noise_m = kDeviation};
  std::map<int, int> counts[3];
  for (const std::vector<std::uint8_t>& cells : GridsOf(Record(scenario), scenario.grid)) {
    const auto filled = std::find(cells.begin(), cells.end(), 1);
    ASSERT_NE(filled, cells.end());
    const Eigen::Vector3d p_W =
        scenario.grid.CenterOf(static_cast<std::size_t>(filled - cells.begin()));
    for (int a = 0; a < 3; ++a) {
      ++counts[a][static_cast<int>(std::round((p_W - p_WCell)(a) / scenario.grid.cell_m))];
    }
  }
  for (const std::map<int, int>& along_axis : counts) {
    ExpectNormalCounts(along_axis, scenario.grid.cell_m, 0, kDeviation);
  }
}

TEST(DepthCamera, HasTheNoiseThatItSaysAtItsDepth) {
  scenarios::Scenario scenario = SwingingScenario();
  scenario.sensor.name = "depth_camera";
  scenario.sensor.rate_hz = 200;
  // One ray along x through the middles of cells, onto a wall in the middle of cell 40.
  const Eigen::Vector3d p_WWall = scenario.grid.Center(40, 45, 35);
  scenario.static_obstacles = {
      {"wall", Pose::Translation(p_WWall + Eigen::Vector3d(0.1, 0, 0)), Box{{0.2, 0.3, 0.3}}}};
  scenarios::CameraSettings camera;
  camera.position_m = p_WWall - Eigen::Vector3d(2, 0, 0);
  camera.look_at_m = p_WWall;
  camera.width = camera.height = 1;
  camera.noise_per_m = 0.01;
  camera.pixel_dropout = 0.25;
  camera.unseen = "free";
  scenario.sensor.camera = camera;
  scenario.evidence.single_frames = true;
  const record::Recording recording = Record(scenario);
  std::map<int, int> counts;
  int measured = 0;
  for (const std::vector<std::uint8_t>& cells : GridsOf(recording, scenario.grid)) {
    const auto filled = std::find(cells.begin(), cells.end(), 1);
    if (filled == cells.end()) continue;
    ++measured;
    const Eigen::Vector3d p_W =
        scenario.grid.CenterOf(static_cast<std::size_t>(filled - cells.begin()));
    ++counts[static_cast<int>(std::round((p_W - p_WWall).x() / scenario.grid.cell_m))];
  }
  const auto scans = static_cast<double>(recording.observations.size());
  EXPECT_NEAR(measured, 0.75 * scans, 4 * std::sqrt(0.75 * 0.25 * scans));
  ExpectNormalCounts(counts, scenario.grid.cell_m, 0, 0.01 * 2 * 2);
}

TEST(DepthCamera, FindsTheSpaceBeforeTheRobotFreeAgainWhereSomethingHasPassed) {
  scenarios::Scenario scenario = SwingingScenario();
  scenario.moving_obstacles = {
      sim::Passing("cart", Sphere{0.15}, {-0.7, -0.8, 0.3}, {1, 0, 0}, 0.5)};
  scenario.sensor.name = "depth_camera";
  scenarios::CameraSettings camera;  // looks at the arm's side; the ball goes by before it
  camera.position_m = {0.4, -2.5, 0.3};
  camera.look_at_m = {0.4, 0, 0.3};
  camera.range_m = 4;
  camera.unseen = "remembered";
  scenario.sensor.camera = camera;
  const record::Recording recording = Record(scenario);
  int most = 0, left = 0;
  for (const std::vector<std::uint8_t>& cells : GridsOf(recording, scenario.grid)) {
    left = static_cast<int>(std::count(cells.begin(), cells.end(), 1));
    most = std::max(most, left);
  }
  EXPECT_GT(most, 20);
  EXPECT_EQ(left, 0);
}

TEST(TagCamera, HasTheErrorsThatItsCovarianceSays) {
  scenarios::Scenario scenario = SwingingScenario();
  scenario.moving_obstacles = {
      sim::Passing("cart", Box{{0.3, 0.2, 0.2}}, {0.8, -0.9, 0.6}, {0, 1, 0}, 0.15)};
  scenario.moving_obstacles[0].rpy_rad = {0.1, -0.2, 0.7};
  scenario.sensor.name = "tags";
  scenario.sensor.rate_hz = 50;
  scenarios::TagSettings tags;
  tags.position_m = {2.5, 0, 1.5};
  tags.across_noise = 0.003;
  tags.along_noise_per_m = 0.01;
  tags.rotation_noise_rad = 0.03;
  scenario.sensor.tags = tags;
  const record::Recording recording = Record(scenario);

  std::vector<double> squares, across, along;
  for (const record::ObservationRecord& observation : recording.observations) {
    ASSERT_EQ(observation.objects.size(), 1u);
    const record::SeenObject& seen = observation.objects[0];
    EXPECT_EQ(seen.id, "cart");
    const Pose X_WO = PoseAt(scenario.moving_obstacles[0], observation.t);
    Eigen::Matrix<double, 6, 1> error;
    error.head<3>() = seen.X_WO.translation() - X_WO.translation();
    const Eigen::AngleAxisd turn(X_WO.rotation().conjugate() * seen.X_WO.rotation());
    error.tail<3>() = turn.angle() * turn.axis();
    squares.push_back(error.dot(seen.covariance.llt().solve(error)));
    const Eigen::Vector3d sight = X_WO.translation() - tags.position_m;
    const double d = sight.norm(), e = error.head<3>().dot(sight / d);
    along.push_back(std::pow(e / (0.01 * d * d), 2));
    across.push_back((error.head<3>().squaredNorm() - e * e) / std::pow(0.003 * d, 2));
  }
  ASSERT_GT(squares.size(), 400u);
  EXPECT_LT(StandardErrorsOff(squares, 6, std::sqrt(12.0)), 4);  // chi-squared of 6 degrees
  EXPECT_LT(StandardErrorsOff(along, 1, std::sqrt(2.0)), 4);
  EXPECT_LT(StandardErrorsOff(across, 2, std::sqrt(4.0)), 4);
}

// A cart passes behind a screen, before a camera of tags.
scenarios::Scenario BehindAScreen() {
  scenarios::Scenario scenario = SwingingScenario();
  scenario.static_obstacles = {
      {"screen", Pose::Translation({1.2, 0.4, 0.6}), Box{{0.02, 0.4, 0.6}}}};
  scenario.moving_obstacles = {
      sim::Passing("cart", Sphere{0.1}, {0.8, -0.9, 0.6}, {0, 1, 0}, 0.15)};
  scenario.sensor.name = "tags";
  return scenario;
}

TEST(TagCamera, DoesNotFindWhatIsFarAwayOrBehindSomething) {
  scenarios::Scenario scenario = BehindAScreen();
  scenario.sensor.tags = scenarios::TagSettings{.position_m = {2, 0.4, 0.6}, .range_m = 1.5};
  const record::Recording recording = Record(scenario);
  int found = 0;
  for (const record::ObservationRecord& observation : recording.observations) {
    const Eigen::Vector3d p = PoseAt(scenario.moving_obstacles[0], observation.t).translation();
    const double d = (p - scenario.sensor.tags->position_m).norm();
    // Where the line of sight crosses the screen.
    const double y = 0.4 + (p.y() - 0.4) * (2 - 1.2) / (2 - p.x());
    if (std::abs(d - 1.5) < 0.01 || std::abs(std::abs(y - 0.4) - 0.2) < 0.02) continue;
    const bool is_seen = d < 1.5 && std::abs(y - 0.4) > 0.2;
    EXPECT_EQ(observation.objects.size(), is_seen ? 1u : 0u) << "at " << p.transpose();
    if (is_seen) ++found;
  }
  EXPECT_GT(found, 5);
}

// Two carts that are in sight all the time, seen without noise.
scenarios::Scenario TwoTaggedCarts() {
  scenarios::Scenario scenario = SwingingScenario();
  scenario.moving_obstacles = {
      sim::Passing("cart", Box{{0.3, 0.2, 0.2}}, {0.9, -0.9, 0.6}, {0, 1, 0}, 0.15),
      sim::Passing("other", Box{{0.2, 0.2, 0.3}}, {-0.9, 0.9, 0.3}, {0, -1, 0}, 0.15)};
  scenario.moving_obstacles[0].rpy_rad = {0.1, -0.2, 0.7};
  scenario.sensor.name = "tags";
  scenario.sensor.rate_hz = 50;
  scenario.sensor.tags = scenarios::TagSettings{
      .position_m = {2.5, 0, 2.5}, .across_noise = 0, .along_noise_per_m = 0};
  return scenario;
}

// In how many scans a fault of some probability shows, by `shows(scan)`.
void ExpectAsOften(const record::Recording& recording, double probability,
                   const std::function<int(const record::ObservationRecord&)>& count_in,
                   int chances_a_scan) {
  double count = 0;
  for (const record::ObservationRecord& scan : recording.observations) count += count_in(scan);
  const double chances = chances_a_scan * static_cast<double>(recording.observations.size());
  EXPECT_GT(chances, 400);
  EXPECT_NEAR(count, probability * chances,
              4 * std::sqrt(probability * (1 - probability) * chances) + 1);
}

TEST(TagCamera, MisplacesFlipsSwapsAndImaginesTagsAsOftenAsItSays) {
  constexpr double kOften = 0.1;
  const auto truth_of = [](const scenarios::Scenario& scenario, const record::SeenObject& seen,
                           EpisodeTime t) {
    return PoseAt(scenario.moving_obstacles[seen.id == "cart" ? 0 : 1], t);
  };
  struct Fault {
    const char* name;
    double scenarios::TagSettings::*probability;
    int chances_a_scan;
    // How often it shows in a scan, by how far tags are off [m] and turned [rad].
    std::function<int(const std::vector<double>& off_m, const std::vector<double>& turned_rad)>
        count;
  };
  const auto above = [](const std::vector<double>& values, double least) {
    return static_cast<int>(
        std::count_if(values.begin(), values.end(), [&](double value) { return value > least; }));
  };
  const std::vector<Fault> faults = {
      {"outliers", &scenarios::TagSettings::outliers, 2,
       [&](const auto& off_m, const auto&) { return above(off_m, 1e-3); }},
      {"flips", &scenarios::TagSettings::flips, 2,
       [&](const auto&, const auto& turned_rad) { return above(turned_rad, 0.02); }},
      {"swaps", &scenarios::TagSettings::swaps, 1,
       [&](const auto& off_m, const auto&) { return above(off_m, 0.5) == 2 ? 1 : 0; }},
      {"phantoms", &scenarios::TagSettings::phantoms, 1,
       [&](const auto& off_m, const auto&) { return off_m.size() == 3 ? 1 : 0; }}};
  for (const Fault& fault : faults) {
    SCOPED_TRACE(fault.name);
    scenarios::Scenario scenario = TwoTaggedCarts();
    (*scenario.sensor.tags).*fault.probability = kOften;
    const record::Recording recording = Record(scenario);
    int num_wrong = 0;
    ExpectAsOften(
        recording, kOften,
        [&](const record::ObservationRecord& scan) {
          std::vector<double> off_m, turned_rad;
          for (const record::SeenObject& seen : scan.objects) {
            const Pose X_WO = truth_of(scenario, seen, scan.t);
            off_m.push_back((seen.X_WO.translation() - X_WO.translation()).norm());
            turned_rad.push_back(seen.X_WO.rotation().angularDistance(X_WO.rotation()));
            if (off_m.size() <= 2 && off_m.back() < 1e-9 && turned_rad.back() < 1e-9) continue;
            ++num_wrong;
            if (fault.probability == &scenarios::TagSettings::outliers) {
              EXPECT_LE(off_m.back(), scenario.sensor.tags->outlier_m);
            }
          }
          return fault.count(off_m, turned_rad);
        },
        fault.chances_a_scan);
    EXPECT_GT(num_wrong, 20);
  }
}

// The two poses lean to either side of the line of sight, about the middle of the face.
TEST(TagCamera, FlipsATagAboutItsLineOfSight) {
  scenarios::Scenario scenario = TwoTaggedCarts();
  scenario.horizon_s = 2;
  scenario.sensor.tags->flips = 1;
  const record::Recording recording = Record(scenario);
  ASSERT_GT(recording.observations.size(), 50u);
  for (const record::ObservationRecord& scan : recording.observations) {
    ASSERT_EQ(scan.objects.size(), 2u);
    const Pose truth = PoseAt(scenario.moving_obstacles[0], scan.t);
    const Pose& flipped = scan.objects[0].X_WO;
    int num_explained = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d n_O = Eigen::Vector3d::Unit(axis);
      for (const double side : {-1.0, 1.0}) {
        const Eigen::Vector3d p_O =
            side * n_O.cwiseProduct(HalfExtents(scenario.moving_obstacles[0].shape));
        const Eigen::Vector3d p_W = truth * p_O;
        if ((flipped * p_O - p_W).norm() > 1e-6) continue;
        const Eigen::Vector3d sight = (scenario.sensor.tags->position_m - p_W).normalized();
        const Eigen::Vector3d n = truth.rotation() * (side * n_O);
        const Eigen::Vector3d mirrored = 2 * n.dot(sight) * sight - n;
        EXPECT_LT((flipped.rotation() * (side * n_O) - mirrored).norm(), 1e-6);
        EXPECT_GT(n.dot(sight), 0) << "it looks at the camera";
        ++num_explained;
      }
    }
    EXPECT_EQ(num_explained, 1);
  }
}

TEST(TagCamera, FindsATagOfSomeSizeOnlyIfAllOfItIsInSightOrBadlyIfItMay) {
  scenarios::Scenario scenario = BehindAScreen();
  constexpr double kSize_m = 0.2;
  for (const double partly_hidden : {0.0, 1.0}) {
    scenario.sensor.tags = scenarios::TagSettings{.position_m = {2, 0.4, 0.6},
                                                  .across_noise = 0,
                                                  .along_noise_per_m = 0,
                                                  .size_m = kSize_m,
                                                  .partly_hidden = partly_hidden};
    const record::Recording recording = Record(scenario);
    int num_parts = 0;
    for (const record::ObservationRecord& scan : recording.observations) {
      const Eigen::Vector3d p = PoseAt(scenario.moving_obstacles[0], scan.t).translation();
      // Where the lines of sight to the tag's sides cross the screen's plane, from its middle.
      const auto crosses_at = [&](double side_m) {
        return std::abs((p.y() + side_m - 0.4) * (2 - 1.2) / (2 - p.x()));
      };
      const double sides[] = {crosses_at(-kSize_m / 2), crosses_at(kSize_m / 2)};
      const double nearest = std::min(sides[0], sides[1]), other = std::max(sides[0], sides[1]);
      if (std::abs(nearest - 0.2) < 0.02 || std::abs(other - 0.2) < 0.02) continue;
      const bool is_whole = nearest > 0.2, is_part = !is_whole && other > 0.2;
      EXPECT_EQ(scan.objects.size(), is_whole || (is_part && partly_hidden == 1) ? 1u : 0u)
          << p.transpose();
      if (scan.objects.empty()) continue;
      const double off_m = (scan.objects[0].X_WO.translation() - p).norm();
      EXPECT_LE(off_m, is_part ? kSize_m / 2 : 1e-9);
      num_parts += is_part ? 1 : 0;
    }
    EXPECT_EQ(num_parts > 3, partly_hidden == 1);
  }
}

// Every registered sensor, with the settings that it needs.
class EverySensor : public ::testing::TestWithParam<std::string> {
 protected:
  static scenarios::Scenario Scene() {
    scenarios::Scenario scenario = SwingingScenario();
    scenario.horizon_s = 2;
    scenario.static_obstacles = {{"shelf", Pose::Translation({0, 0.7, 0.4}), Box{{0.4, 0.2, 0.3}}}};
    scenario.moving_obstacles = {
        sim::Passing("cart", Box{{0.3, 0.2, 0.2}}, {0.8, -0.9, 0.6}, {0, 1, 0}, 0.4)};
    scenario.sensor.name = GetParam();
    scenario.sensor.latency_s = 0.03;
    scenario.sensor.dropout = 0.1;
    if (GetParam() == "occupancy")
      scenario.sensor.noise = scenarios::OccupancyNoise{0.001, 0.1, 0.01};
    if (GetParam() == "depth_camera") {
      scenarios::CameraSettings camera;
      camera.position_m = {2, 0, 1.5};
      camera.look_at_m = {0, 0, 0.4};
      camera.width = 40;
      camera.height = 30;
      camera.noise_per_m = 0.003;
      scenario.sensor.camera = camera;
    }
    if (GetParam() == "tags")
      scenario.sensor.tags = scenarios::TagSettings{.position_m = {2, 0, 1.5}};
    return scenario;
  }

  // The same, seen at once and without an error.
  static scenarios::Scenario ExactScene() {
    scenarios::Scenario scenario = Scene();
    scenarios::SensorSettings& sensor = scenario.sensor;
    sensor.latency_s = sensor.dropout = 0;
    sensor.cells = CellRule::kCentre;  // then every point lies in what it is of
    if (sensor.noise) sensor.noise = scenarios::OccupancyNoise{};
    if (sensor.camera) sensor.camera->noise_per_m = 0;
    if (sensor.tags) sensor.tags->across_noise = sensor.tags->along_noise_per_m = 0;
    return scenario;
  }
};

// The distance from a box that stands level.
double Distance(const Eigen::Vector3d& size_m, const Eigen::Vector3d& p_WBox,
                const Eigen::Vector3d& p_W) {
  return SignedDistance(Box{size_m}, p_W - p_WBox);
}

TEST_P(EverySensor, FindsAKnownThingWhereItIsAndNothingElse) {
  // Nothing hides the cart. It runs so fast that a scan one period old would be seen to be wrong.
  scenarios::Scenario scenario = ExactScene();
  const Eigen::Vector3d cart_size_m(0.3, 0.2, 0.2);
  scenario.moving_obstacles = {
      sim::Passing("cart", Box{cart_size_m}, {0.8, -0.9, 0.6}, {0, 1, 0}, 3)};
  sim::Simulation simulation(scenario, sim::TwoLink(scenario), sim::kTestModels);
  const double resolution_m = 0.05;  // of cells; of pixels on the cart
  int num_seen = 0, num_of_shelf = 0;
  for (int capture = 0; capture < 16; ++capture) {
    simulation.robot().AdvanceTo(simulation.sensor().NextDue());
    const std::optional<Scan> scan = simulation.sensor().Read(simulation.world().time());
    ASSERT_TRUE(scan.has_value());
    EXPECT_EQ(scan->t, simulation.world().time());
    const Eigen::Vector3d p_WCart = PoseAt(scenario.moving_obstacles[0], scan->t).translation();
    double y_min = 10, y_max = -10;
    for (Eigen::Index i = 0; i < scan->p_CP.cols(); ++i) {
      const Eigen::Vector3d p_W = scan->X_WC * scan->p_CP.col(i);
      const double to_cart_m = Distance(cart_size_m, p_WCart, p_W);
      const double to_shelf_m = Distance({0.4, 0.2, 0.3}, {0, 0.7, 0.4}, p_W);
      const double to_floor_m = p_W.z() - scenario.floor_m;
      EXPECT_LT(std::min({to_cart_m, to_shelf_m, to_floor_m}), 1e-6) << p_W.transpose();
      if (to_shelf_m < 1e-6) ++num_of_shelf;
      if (to_cart_m > 1e-6) continue;
      y_min = std::min(y_min, p_W.y());
      y_max = std::max(y_max, p_W.y());
    }
    for (const ObjectObservation& object : scan->objects) {
      EXPECT_EQ(object.id, "cart");
      EXPECT_LT((object.X_WO.translation() - p_WCart).norm(), 1e-9);
      y_min = object.X_WO.translation().y() - 0.1;
      y_max = object.X_WO.translation().y() + 0.1;
    }
    if (y_max < y_min) continue;  // beyond the picture
    ++num_seen;
    EXPECT_NEAR(y_min, p_WCart.y() - 0.1, resolution_m);
    EXPECT_NEAR(y_max, p_WCart.y() + 0.1, resolution_m);
  }
  EXPECT_GE(num_seen, 14);
  EXPECT_GE(num_of_shelf, 100);
}

bool AreEqual(const record::Recording& a, const record::Recording& b) {
  return std::equal(
      a.observations.begin(), a.observations.end(), b.observations.begin(), b.observations.end(),
      [](const auto& x, const auto& y) {
        const auto same = [](const record::SeenObject& s, const record::SeenObject& o) {
          return s.X_WO.translation() == o.X_WO.translation();
        };
        return x.t == y.t && x.t_arrival == y.t_arrival && x.changed_cells == y.changed_cells &&
               std::equal(x.objects.begin(), x.objects.end(), y.objects.begin(), y.objects.end(),
                          same);
      });
}

TEST_P(EverySensor, SaysTheSameAgainForTheSameSeedAndOtherThingsForAnother) {
  scenarios::Scenario scenario = Scene();
  const record::Recording first = Record(scenario);
  EXPECT_GT(first.observations.size(), 30u);
  EXPECT_TRUE(AreEqual(first, Record(scenario)));
  scenario.seed = 8;
  EXPECT_FALSE(AreEqual(first, Record(scenario)));
}

TEST_P(EverySensor, SaysTheSameInTwoEpisodesAtOnceAsAlone) {
  scenarios::Scenario scenario = Scene();
  scenario.horizon_s = 1;
  scenario.step_s = 0.1;
  const record::Recording alone = Record(scenario);
  auto one = std::async(std::launch::async, [&] { return Record(scenario); });
  auto other = std::async(std::launch::async, [&] { return Record(scenario); });
  EXPECT_TRUE(AreEqual(alone, one.get()));
  EXPECT_TRUE(AreEqual(alone, other.get()));
}

TEST_P(EverySensor, ServesEveryKindOfKnowledge) {
  for (const char* const knowledge :
       {"static", "execute_and_update", "prediction", "full_knowledge"}) {
    SCOPED_TRACE(knowledge);
    scenarios::Scenario scenario = ExactScene();
    scenario.knowledge = knowledge;
    scenario.replan_rate_hz = 5;
    const record::Recording recording = Record(scenario);
    EXPECT_GT(recording.cycles.size(), 5u);
    // How far the cart was from where it was expected; a camera takes its face for the whole of it.
    const double error_m = recording.metrics.at("prediction_error_100ms_m");
    if (scenario.knowledge == "prediction") {
      EXPECT_LT(error_m, GetParam() == "depth_camera" ? 0.2 : 0.03);
    } else if (scenario.knowledge == "full_knowledge") {
      EXPECT_LT(error_m, 1e-9);
    } else {
      EXPECT_TRUE(std::isnan(error_m)) << "nothing is expected to move";
    }
  }
}

TEST_P(EverySensor, RefusesTheSettingsOfAnother) {
  scenarios::Scenario scenario = Scene();
  scenario.lines["sensor"] = 12;
  scenario.sensor.noise = scenarios::OccupancyNoise{};
  scenario.sensor.camera = scenarios::CameraSettings{};
  scenario.sensor.tags = scenarios::TagSettings{};
  EXPECT_THAT([&] { Record(scenario); },
              ::testing::ThrowsMessage<InputError>(::testing::MatchesRegex(
                  "two_link.yaml:12: sensor.(noise|camera|tags): is not for the sensor '" +
                  GetParam() + "'")));
}

INSTANTIATE_TEST_SUITE_P(Registered, EverySensor, ::testing::ValuesIn(sim::SensorNames()),
                         [](const auto& test) { return test.param; });

TEST(EverySensorThatNeedsSettings, SaysSo) {
  for (const char* const name : {"depth_camera", "tags"}) {
    scenarios::Scenario scenario = SwingingScenario();
    scenario.sensor.name = name;
    EXPECT_THROW(Record(scenario), InputError) << name;
  }
}

}  // namespace
}  // namespace sidestep
