// Cells that the authors' code fills: figures read from ori-drs/gpmp2 and from what it computed.

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "sidestep/bench/reproduce/open_loop_experiment.h"
#include "sidestep/bench/reproduce/published_maps.h"
#include "sidestep/bench/reproduce/published_rasteriser.h"

namespace sidestep::bench {

// For the messages of failed expectations.
std::ostream& operator<<(std::ostream& stream, const CellRange& cells) {
  for (std::size_t a = 0; a < 3; ++a) {
    stream << (a == 0 ? "" : ", ") << cells.first[a] << "-" << cells.last[a];
  }
  return stream;
}

}  // namespace sidestep::bench

namespace sidestep::bench::reproduce_rasteriser_test {
namespace {

const std::string kScenarios = SIDESTEP_SOURCE_DIR "/scenarios";

CellRange Cells(int x0, int x1, int y0, int y1, int z0, int z1) {
  return {{x0, y0, z0}, {x1, y1, z1}};
}

CellRange StaticCells(const OpenLoopExperiment& experiment, std::size_t b, BoxAlignment alignment) {
  const scenarios::StaticObstacle& box = experiment.scene.static_obstacles.at(b);
  return PublishedBoxCells(experiment.scene.grid, box.X_WO.translation(),
                           std::get<Box>(box.shape).size_m, alignment);
}

TEST(PublishedRasteriser, SetsTheStaticBoxesOfTheWamExperimentOneCellLow) {
  const std::vector<CellRange> published = {
      Cells(12, 46, 35, 49, 19, 19), Cells(12, 14, 34, 36, 0, 19),  Cells(44, 46, 34, 36, 0, 19),
      Cells(12, 14, 47, 49, 0, 19),  Cells(44, 46, 47, 49, 0, 19),  Cells(42, 56, 34, 34, 0, 47),
      Cells(42, 56, 9, 9, 0, 47),    Cells(32, 42, 34, 34, 0, 47),  Cells(42, 56, 10, 34, 47, 47),
      Cells(42, 56, 10, 34, 34, 34), Cells(42, 56, 10, 34, 22, 22), Cells(42, 56, 10, 34, 9, 9),
  };
  const OpenLoopExperiment wam = MakeOpenLoopExperiment("wam_single_pillar", kScenarios);
  ASSERT_EQ(wam.scene.static_obstacles.size(), published.size());
  for (std::size_t b = 0; b < published.size(); ++b) {
    EXPECT_EQ(StaticCells(wam, b, BoxAlignment::kOneCellLow), published[b]) << "box " << b + 1;
  }
}

TEST(PublishedRasteriser, SetsTheTablesOfThePandaExperimentOneCellLow) {
  const OpenLoopExperiment panda = MakeOpenLoopExperiment("panda_hsr", kScenarios);
  const std::vector<CellRange> published = {Cells(6, 26, 9, 39, 24, 34),
                                            Cells(40, 60, 9, 39, 24, 34)};
  for (std::size_t b = 0; b < published.size(); ++b) {
    EXPECT_EQ(StaticCells(panda, b, BoxAlignment::kOneCellLow), published[b]);
  }
  EXPECT_EQ(StaticCells(panda, 0, BoxAlignment::kIntended), Cells(7, 27, 10, 40, 25, 35));
}

// Positions on exact half cells, where the last bit decides, are among them.
struct MovingCase {
  const char* experiment;
  double speed_m_s;
  int step;
  CellRange cells;
};
TEST(PublishedRasteriser, FollowsTheMovingBoxes) {
  const std::vector<MovingCase> cases = {
      {"wam_single_pillar", 0.1, 0, Cells(37, 41, 0, 3, 0, 48)},
      {"panda_hsr", 1.0, 0, Cells(29, 41, 68, 82, 25, 55)},
      {"panda_hsr", 1.0, 1, Cells(29, 41, 66, 80, 25, 55)},  // ties: centres 72.5, 67.5, 57.5
      {"panda_hsr", 1.0, 3, Cells(29, 41, 61, 75, 25, 55)},
      {"panda_hsr", 1.0, 7, Cells(29, 41, 50, 64, 25, 55)},
      {"panda_hsr", 2.0, 30, CellRange()},  // has left the grid
  };
  for (const MovingCase& test : cases) {
    const OpenLoopExperiment experiment = MakeOpenLoopExperiment(test.experiment, kScenarios);
    const Eigen::Vector3d center_m = experiment.MovingBoxCenter(test.speed_m_s, test.step * 0.1);
    EXPECT_EQ(PublishedBoxCells(experiment.scene.grid, center_m, experiment.moving_box().size_m,
                                BoxAlignment::kIntended),
              test.cells)
        << test.experiment << " at " << test.speed_m_s << " m/s, step " << test.step;
  }
}

TEST(OpenLoopExperiment, StopsThePillarAfterTwoSeconds) {
  const OpenLoopExperiment wam = MakeOpenLoopExperiment("wam_single_pillar", kScenarios);
  EXPECT_NE(wam.MovingBoxCenter(0.7, 1.9), wam.MovingBoxCenter(0.7, 2.0));
  EXPECT_EQ(wam.MovingBoxCenter(0.7, 2.0), wam.MovingBoxCenter(0.7, 3.0));
}

struct CountCase {
  const char* experiment;
  std::size_t static_cells, all_cells;
};
TEST(PublishedMaps, FillAsManyCellsAsTheAuthorsDo) {
  for (const CountCase& test :
       {CountCase{"wam_single_pillar", 4515, 5495}, CountCase{"panda_hsr", 14322, 20367}}) {
    OpenLoopExperiment experiment = MakeOpenLoopExperiment(test.experiment, kScenarios);
    experiment.speeds_m_s.clear();  // no fields
    const PublishedMaps maps(experiment, BoxAlignment::kOneCellLow,
                             sdf::DistanceConvention::kBwdist, 1);
    EXPECT_EQ(maps.static_occupancy().CountFilled(), test.static_cells) << test.experiment;
    EXPECT_EQ(maps.OccupancyAt(1.0, 0).CountFilled(), test.all_cells) << test.experiment;
  }
}

TEST(PublishedMaps, HoldTheAuthorsDistancesToTheBit) {
  OpenLoopExperiment wam = MakeOpenLoopExperiment("wam_single_pillar", kScenarios);
  wam.speeds_m_s = {0.1};
  const PublishedMaps maps(wam, BoxAlignment::kOneCellLow, sdf::DistanceConvention::kBwdist, 1);
  const sdf::DistanceField& field = *maps.FieldsAt(0.1)[0];
  struct Value {
    int i, j, k;
    double distance_m;  // a float
  };
  for (const Value& value : {Value{0, 0, 0, 1.4422204494476318},
                             {25, 25, 25, 0.4560701847076416},
                             {39, 1, 24, -0.11999999731779099},
                             {30, 30, 30, 0.17888544499874115},
                             {44, 35, 19, -0.03999999910593033},
                             {63, 63, 63, 1.3541048765182495}}) {
    const Eigen::Vector3d p_W = wam.scene.grid.Center(value.i, value.j, value.k);
    EXPECT_NEAR(field.Sample(p_W, EpisodeTime()).distance_m, value.distance_m, 1e-14);
  }
}

}  // namespace
}  // namespace sidestep::bench::reproduce_rasteriser_test
