// The five field scenes, and what the composite fields of them come to.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "sidestep/bench/reproduce/field_scene.h"
#include "sidestep/bench/reproduce/field_timer.h"
#include "sidestep/bench/reproduce/sdf_timing.h"
#include "sidestep/scenarios/scenario.h"

namespace sidestep::bench::reproduce_sdf_timing_test {
namespace {

constexpr EpisodeTime kFirst(0.2), kSecond(0.6);

const std::string kScenarios = SIDESTEP_SOURCE_DIR "/scenarios";

scenarios::Scenario Scene(const std::string& name) {
  return LoadBoxScene(kScenarios + "/" + name + ".yaml");
}

class FieldScenes : public ::testing::TestWithParam<std::string> {};

TEST_P(FieldScenes, AreComposedExactlyInFreeSpaceWithinTheMargin) {
  const GridSpec grid = PublishedTimingGrid(64);
  FieldTimer timer(Scene(GetParam()), grid, 0.2, kFirst, kSecond);
  int compared = 0;
  for (const double t_s : {0.0, 0.3, 0.6, 1.1, 1.7}) {
    const EpisodeTime t(t_s);
    if (!timer.HoldsAllObjects(t)) continue;
    ++compared;
    EXPECT_EQ(timer.Compare(t).free_m, 0) << t_s;
  }
  EXPECT_GE(compared, 3);
}

TEST_P(FieldScenes, MoveAsPublished) {
  const scenarios::Scenario scene = Scene(GetParam());
  const GridSpec grid = PublishedTimingGrid(96);
  const FieldTimer timer(scene, grid, 0.2, kFirst, kSecond);
  ASSERT_EQ(timer.objects().size(), scene.moving_obstacles.size());
  for (const scenarios::MovingObstacle& obstacle : scene.moving_obstacles) {
    const Eigen::Vector3d p_m = PoseAt(obstacle, EpisodeTime(1.5)).translation();
    double nearest_m = 1e9;
    for (const sdf::MovingField& object : timer.objects()) {
      const Eigen::Vector3d p_WO = object.X_WO(EpisodeTime(1.5)).translation();
      nearest_m = std::min(nearest_m, (p_WO - p_m).cwiseAbs().maxCoeff());
    }
    // Half a cell where it was last seen, and for each 0.4 s of the 0.9 s since then a whole one.
    EXPECT_LE(nearest_m, (0.5 + 0.9 / 0.4) * grid.cell_m);
  }
}

INSTANTIATE_TEST_SUITE_P(All, FieldScenes, ::testing::ValuesIn(FieldSceneNames()),
                         [](const auto& test) { return test.param; });

TEST(FieldScene, HasTheStaticCellsOfTheAuthorsMap) {
  const GridSpec grid = PublishedTimingGrid(96);
  EXPECT_EQ(grid.cell_m, 0.04);
  EXPECT_EQ(StaticOccupancy(Scene("field_large_block"), grid).CountFilled(), 0u);
  // The pillar fills 5 x 5 x 49 cells wherever it is whole.
  EXPECT_EQ(MovingOccupancy(Scene("field_one_pillar"), grid, kSecond).CountFilled(), 5u * 5 * 49);
}

TEST(PublishedTimingGrid, HasThePublishedCells) {
  for (const auto& [voxels, cell_m] :
       {std::pair(64, 0.05), std::pair(96, 0.04), std::pair(128, 0.03), std::pair(160, 0.02),
        std::pair(288, 0.02), std::pair(320, 0.01)}) {
    EXPECT_DOUBLE_EQ(PublishedTimingGrid(voxels).cell_m, cell_m) << voxels;
  }
}

TEST(FieldTimer, RefusesMomentsThatDoNotFollow) {
  const scenarios::Scenario scene = Scene("field_one_box");
  EXPECT_THROW(FieldTimer(scene, PublishedTimingGrid(64), 0.2, kSecond, kFirst),
               std::invalid_argument);
}

TEST(SdfTiming, MakesARowOfEachSize) {
  const CsvTable table = MakeSdfTimingTable(RunSdfTiming(
      {.voxels_per_side = {32, 64}, .scenes = {"field_large_block"}, .repeats = 2}, kScenarios));
  ASSERT_EQ(table.num_rows(), 2u);
  const auto at = [&](std::size_t row, const char* column) {
    return table.At(row, table.Find(column).value()).value();
  };
  EXPECT_EQ(at(1, "voxels_per_side"), 64);
  EXPECT_EQ(at(1, "n_predictions"), 62);
  EXPECT_EQ(at(1, "n_init_values"), 2);
  EXPECT_EQ(at(1, "largest_error_free_m"), 0);
  EXPECT_LE(at(1, "full_computation_ms_q10"), at(1, "full_computation_ms_median"));
  EXPECT_LE(at(1, "full_computation_ms_median"), at(1, "full_computation_ms_q90"));

  CsvTable published({"voxels_per_side", "full_computation_mean_ms"});
  published.AddRow({64, 9.34});
  EXPECT_THAT(DescribeSdfTiming(table, published), ::testing::HasSubstr("(9.34)"));
  const Figure figure = MakeSdfTimingFigure(table, published);
  EXPECT_EQ(figure.panels.at(0).series.size(), 7u) << "six measures and one set of rings";
}

}  // namespace
}  // namespace sidestep::bench::reproduce_sdf_timing_test
