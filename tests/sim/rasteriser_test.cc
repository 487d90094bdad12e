#include "sidestep/sim/rasteriser.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <ostream>

#include "sidestep/core/shape.h"
#include "sidestep/sim/mujoco_pose.h"
#include "tests/sim/small_model.h"
#include "tests/support/random_points.h"

namespace sidestep::sim::rasteriser_test {
namespace {

using Eigen::Vector3d;

const GridSpec kGrid{{-0.78, -0.8, -0.82}, 0.04, {41, 40, 39}};

// How far a point of a body's frame is inside that body's solid, as in core/shape.h or in closed
// form; only its sign and its being near zero matter.
using Signed = std::function<double(const SmallModel&, const Vector3d&)>;

Signed Of(const Shape& shape) {
  return [shape](const SmallModel&, const Vector3d& p) { return SignedDistance(shape, p); };
}

double InPlane(const SmallModel&, const Vector3d& p) { return p.z(); }

double InOctahedron(const SmallModel&, const Vector3d& p) {
  return std::abs(p.x()) / 0.3 + std::abs(p.y()) / 0.2 + std::abs(p.z()) / 0.45 - 1;
}

// The corners are the origin and (0.6, 0, 0), (0.1, 0.5, 0), (0, 0.1, 0.4): inside, all barycentric
// coordinates are positive.
double InTetrahedron(const SmallModel&, const Vector3d& p) {
  Eigen::Matrix3d edges;
  edges << 0.6, 0.1, 0, 0, 0.5, 0.1, 0, 0, 0.4;
  const Vector3d coordinates = edges.inverse() * p;
  return -std::min(coordinates.minCoeff(), 1 - coordinates.sum());
}

// The surface is where MuJoCo's vertical ray meets it.
double InHeightField(const SmallModel& m, const Vector3d& p) {
  const double outside = std::max({std::abs(p.x()) - 0.5, std::abs(p.y()) - 0.3, -0.1 - p.z()});
  if (outside > 0) return outside;
  const Pose X_WG = GeomPose(*m.data, 0);
  const Vector3d from = X_WG * Vector3d(p.x(), p.y(), 2), down = X_WG.Rotate({0, 0, -1});
  const double length = mj_rayHfield(m.model.get(), m.data.get(), 0, from.data(), down.data());
  return std::max(outside, p.z() - (2 - length));
}

struct Case {
  const char* name;
  const char* geom;
  const char* asset;
  Signed inside;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

const char* const kOctahedron =
    "<mesh name='m' vertex='0.3 0 0  -0.3 0 0  0 0.2 0  0 -0.2 0  0 0 0.45  0 0 -0.45'/>";
const char* const kTetrahedron = "<mesh name='m' vertex='0 0 0  0.6 0 0  0.1 0.5 0  0 0.1 0.4'/>";
const char* const kHeightField = "<hfield name='h' nrow='4' ncol='6' size='0.5 0.3 0.4 0.1'/>";

const Case kCases[] = {
    {"Plane", "type='plane' size='0 0 1'", "", InPlane},
    {"Sphere", "type='sphere' size='0.31'", "", Of(Sphere{0.31})},
    {"Capsule", "type='capsule' size='0.13 0.25'", "", Of(Capsule{0.13, 0.5})},
    {"Ellipsoid", "type='ellipsoid' size='0.1 0.25 0.4'", "", Of(Ellipsoid{{0.1, 0.25, 0.4}})},
    {"Cylinder", "type='cylinder' size='0.21 0.33'", "", Of(Cylinder{0.21, 0.66})},
    {"Box", "type='box' size='0.11 0.24 0.43'", "", Of(Box{{0.22, 0.48, 0.86}})},
    {"ThinBox", "type='box' size='0.5 0.4 0.005'", "", Of(Box{{1, 0.8, 0.01}})},
    {"Octahedron", "type='mesh' mesh='m'", kOctahedron, InOctahedron},
    {"Tetrahedron", "type='mesh' mesh='m'", kTetrahedron, InTetrahedron},
    {"HeightField", "type='hfield' hfield='h'", kHeightField, InHeightField},
};

class EveryGeomType : public testing::TestWithParam<Case> {};

TEST_P(EveryGeomType, MarksExactlyTheCellsWhoseCentreIsInside) {
  const std::string geom = std::string("<geom ") + GetParam().geom + "/>";
  SmallModel m("<body mocap='true'>" + geom + "</body>",
               std::string("<asset>") + GetParam().asset + "</asset>");
  RandomStream random(7, "heights and poses");
  if (m.model->nhfielddata > 0) {
    for (int i = 0; i < m.model->nhfielddata; ++i) {
      m.model->hfield_data[i] = static_cast<float>(random.Uniform());
    }
  }
  const Rasteriser rasteriser(*m.model, CellRule::kCentre);
  for (int trial = 0; trial < 12; ++trial) {
    const Pose X_WO = RandomPose(random, /*reach_m=*/0.6);
    m.Place(0, X_WO);
    OccupancyGrid grid(kGrid);
    const std::vector<std::size_t> filled = rasteriser.Fill(*m.data, 0, &grid);
    EXPECT_EQ(filled.size(), grid.CountFilled());
    int num_wrong = 0, num_inside = 0;
    for (int k = 0; k < kGrid.size[2]; ++k) {
      for (int j = 0; j < kGrid.size[1]; ++j) {
        for (int i = 0; i < kGrid.size[0]; ++i) {
          const Vector3d p_OQ = X_WO.Inverse() * kGrid.Center(i, j, k);
          const double distance = GetParam().inside(m, p_OQ);
          if (std::abs(distance) < 1e-5) continue;  // single-precision vertices
          num_inside += distance < 0;
          num_wrong += (distance < 0) != grid.At(i, j, k);
        }
      }
    }
    EXPECT_EQ(num_wrong, 0) << "of " << num_inside << " cells, trial " << trial;
    EXPECT_GT(num_inside, 0);
  }
}

// Of the 26 around a cell, or the cell itself.
bool HasFilledNeighbour(const OccupancyGrid& grid, std::size_t cell) {
  const auto [i, j, k] = grid.spec.CellOf(grid.spec.CenterOf(cell));
  for (int n = 0; n < 27; ++n) {
    const int a = i + n % 3 - 1, b = j + n / 3 % 3 - 1, c = k + n / 9 - 1;
    if (grid.spec.Contains(a, b, c) && grid.At(a, b, c)) return true;
  }
  return false;
}

// What is inside, anywhere in the cell, by a lattice of points: where one is, the cell is filled;
// a filled cell has one within a step of the lattice around it.
TEST_P(EveryGeomType, MarksTheCellsThatItReachesIntoIfToldSo) {
  const std::string geom = std::string("<geom ") + GetParam().geom + "/>";
  SmallModel m("<body mocap='true'>" + geom + "</body>",
               std::string("<asset>") + GetParam().asset + "</asset>");
  RandomStream random(8, "heights and poses");
  if (m.model->nhfielddata > 0) {
    for (int i = 0; i < m.model->nhfielddata; ++i) {
      m.model->hfield_data[i] = static_cast<float>(random.Uniform());
    }
  }
  const GridSpec spec{{-0.78, -0.8, -0.82}, 0.1, {17, 16, 16}};
  const Rasteriser rasteriser(*m.model, CellRule::kTouched);
  const Rasteriser centres(*m.model, CellRule::kCentre);
  constexpr int kSteps = 8;
  const double step_m = spec.cell_m / kSteps;
  for (int trial = 0; trial < 2; ++trial) {
    const Pose X_WO = RandomPose(random, /*reach_m=*/0.4);
    m.Place(0, X_WO);
    OccupancyGrid grid(spec), by_centres(spec);
    rasteriser.Fill(*m.data, 0, &grid);
    centres.Fill(*m.data, 0, &by_centres);
    int num_missed = 0, num_idle = 0, num_doubtful = 0;
    for (std::size_t cell = 0; cell < grid.cells.size(); ++cell) {
      EXPECT_LE(by_centres.cells[cell], grid.cells[cell]);
      if (by_centres.cells[cell] != 0 || !HasFilledNeighbour(grid, cell)) continue;
      ++num_doubtful;
      bool inside = false, near = false;
      for (int n = 0; n < (kSteps + 3) * (kSteps + 3) * (kSteps + 3) && !inside; ++n) {
        const int at[] = {n % (kSteps + 3) - 1, n / (kSteps + 3) % (kSteps + 3) - 1,
                          n / ((kSteps + 3) * (kSteps + 3)) - 1};
        const Vector3d from_corner = step_m * Vector3d(at[0], at[1], at[2]);
        const Vector3d p_WQ =
            spec.CenterOf(cell) + from_corner - Vector3d::Constant(spec.cell_m / 2);
        if (GetParam().inside(m, X_WO.Inverse() * p_WQ) > -1e-5) continue;
        near = true;
        inside = *std::min_element(at, at + 3) >= 0 && *std::max_element(at, at + 3) <= kSteps;
      }
      num_missed += inside && grid.cells[cell] == 0;
      num_idle += !near && grid.cells[cell] != 0;
    }
    EXPECT_EQ(num_missed, 0) << "of " << grid.CountFilled() << " cells, trial " << trial;
    EXPECT_LE(num_idle, num_doubtful / 50);  // a tip between the points
    EXPECT_GT(grid.CountFilled(), by_centres.CountFilled());
  }
}

TEST(OccupancyRasteriser, FillsNothingBeyondTheFacesOfABoxOfWholeCells) {
  SmallModel m("<body mocap='true'><geom type='box' size='0.24 0.26 0.6'/></body>");
  const GridSpec spec{{-1, -1, -1}, 0.04, {96, 96, 96}};
  m.Place(0, Pose::Translation({0.02, 0.0, 0.62}));  // its faces are faces of cells
  OccupancyGrid grid(spec);
  Rasteriser(*m.model, CellRule::kTouched).Fill(*m.data, 0, &grid);
  EXPECT_EQ(grid.CountFilled(), 12u * 13 * 30);
}

TEST(OccupancyRasteriser, LosesNoThinSheetOrPoleThatIsTouched) {
  SmallModel m(
      "<body mocap='true'><geom type='box' size='0.25 0.01 0.25'/></body>"
      "<body mocap='true'><geom type='cylinder' size='0.015 0.3'/></body>");
  const GridSpec spec{{-1, -1, -1}, 0.04, {50, 50, 50}};
  const Rasteriser touched(*m.model, CellRule::kTouched), centres(*m.model, CellRule::kCentre);
  for (int geom = 0; geom < 2; ++geom) {
    int num_lost = 0;
    for (int step = 0; step < 40; ++step) {
      m.Place(geom, Pose::Translation({0.001 * step, 0.001 * step, 0}));
      OccupancyGrid grid(spec), by_centres(spec);
      touched.Fill(*m.data, geom, &grid);
      centres.Fill(*m.data, geom, &by_centres);
      EXPECT_GT(grid.CountFilled(), 0u);
      num_lost += by_centres.CountFilled() == 0;
    }
    EXPECT_GT(num_lost, 10) << "centres see it, too: not a test";
  }
}

INSTANTIATE_TEST_SUITE_P(OccupancyRasteriser, EveryGeomType, testing::ValuesIn(kCases),
                         [](const auto& test) { return test.param.name; });

int CountFilled(const SmallModel& m, const GridSpec& spec) {
  OccupancyGrid grid(spec);
  Rasteriser(*m.model, CellRule::kCentre).Fill(*m.data, 0, &grid);
  return static_cast<int>(grid.CountFilled());
}

TEST(OccupancyRasteriser, FillsTwelveCellsForABoxOfTwelveCellsWhereverItStands) {
  SmallModel m("<body mocap='true'><geom type='box' size='0.24 0.26 0.6'/></body>");
  const GridSpec spec{{-1, -1, -1}, 0.04, {96, 96, 96}};
  for (int step = 0; step <= 200; ++step) {  // through whole and half cells, and all between
    const double x = -0.4 + step * 0.005;
    m.Place(0, Pose::Translation({x, 1 - 1.4 * step * 0.001, 0.6}));
    const int count = CountFilled(m, spec);
    EXPECT_EQ(count % (12 * 13 * 30), 0) << "at x = " << x << ": " << count;
    EXPECT_EQ(count / (12 * 13 * 30), 1) << "at x = " << x;
  }
}

TEST(OccupancyRasteriser, GivesACellOnTheFaceOfTwoBoxesToOneOfThem) {
  SmallModel m(
      "<body mocap='true'><geom type='box' size='0.2 0.2 0.2'/></body>"
      "<body mocap='true'><geom type='box' size='0.2 0.2 0.2'/></body>");
  const GridSpec spec{{-1, -1, -1}, 0.1, {21, 21, 21}};  // the faces run through centres of cells
  const Rasteriser rasteriser(*m.model, CellRule::kCentre);
  for (int axis = 0; axis < 3; ++axis) {
    m.Place(1, Pose::Translation(0.4 * Vector3d::Unit(axis)));
    OccupancyGrid first(spec), second(spec), both(spec);
    rasteriser.Fill(*m.data, 0, &first);
    rasteriser.Fill(*m.data, 1, &second);
    rasteriser.Fill(*m.data, 0, &both);
    rasteriser.Fill(*m.data, 1, &both);
    EXPECT_EQ(first.CountFilled(), 64u);
    EXPECT_EQ(second.CountFilled(), 64u);
    EXPECT_EQ(both.CountFilled(), 128u) << "along axis " << axis;
  }
}

TEST(OccupancyRasteriser, TreatsTheFacesOfABoxMeshLikeThoseOfABox) {
  SmallModel box("<geom type='box' size='0.3 0.2 0.1' pos='0.1 0.2 0.3'/>");
  SmallModel mesh(
      "<geom type='mesh' mesh='m' pos='0.1 0.2 0.3'/>",
      "<asset><mesh name='m' vertex='-0.3 -0.2 -0.1  0.3 -0.2 -0.1  -0.3 0.2 -0.1  "
      "0.3 0.2 -0.1  -0.3 -0.2 0.1  0.3 -0.2 0.1  -0.3 0.2 0.1  0.3 0.2 0.1'/></asset>");
  const GridSpec spec{{-1, -1, -1}, 0.1, {21, 21, 21}};
  OccupancyGrid from_box(spec), from_mesh(spec);
  Rasteriser(*box.model, CellRule::kCentre).Fill(*box.data, 0, &from_box);
  Rasteriser(*mesh.model, CellRule::kCentre).Fill(*mesh.data, 0, &from_mesh);
  EXPECT_EQ(from_box.CountFilled(), 6u * 4u * 2u);
  // MuJoCo turns a mesh into its principal axes; faces are half-open along those.
  EXPECT_EQ(from_mesh.CountFilled(), 6u * 4u * 2u);
}

TEST(OccupancyRasteriser, ReturnsOnlyWhatWasFreeBefore) {
  SmallModel m("<geom type='box' size='0.2 0.2 0.2'/><geom type='sphere' size='0.3'/>");
  const Rasteriser rasteriser(*m.model, CellRule::kCentre);
  OccupancyGrid grid(kGrid), sphere(kGrid);
  const std::size_t box = rasteriser.Fill(*m.data, 0, &grid).size();
  rasteriser.Fill(*m.data, 1, &sphere);
  const std::vector<std::size_t> added = rasteriser.Fill(*m.data, 1, &grid);
  EXPECT_EQ(box + added.size(), grid.CountFilled());
  EXPECT_LT(added.size(), sphere.CountFilled());
  EXPECT_TRUE(std::is_sorted(added.begin(), added.end()));
  EXPECT_THAT(rasteriser.Fill(*m.data, 1, &grid), testing::IsEmpty());
}

TEST(OccupancyRasteriser, LeavesOutRobotFloorAndPictures) {
  const SmallModel m(
      "<geom name='floor' type='plane' size='0 0 1'/>"
      "<body name='robot'><geom type='box' size='0.1 0.1 0.1' pos='0.3 0 0'/>"
      "<body><joint/><geom type='box' size='0.1 0.1 0.1' pos='-0.3 0 0'/></body></body>"
      "<body><geom type='box' size='0.1 0.1 0.1' pos='0 0.4 0' contype='0' conaffinity='0'/></body>"
      "<body><geom name='crate' type='box' size='0.1 0.1 0.1' pos='0 -0.4 0'/></body>"
      "<body mocap='true'><geom name='guest' type='sphere' size='0.1' pos='0 0 0.5'/></body>");
  OccupancyGrid wanted(kGrid);
  const Rasteriser rasteriser(*m.model, CellRule::kCentre);
  rasteriser.Fill(*m.data, m.Geom("crate"), &wanted);
  rasteriser.Fill(*m.data, m.Geom("guest"), &wanted);
  EXPECT_GT(wanted.CountFilled(), 0u);
  EXPECT_EQ(RasteriseWorld(*m.model, *m.data, kGrid, CellRule::kCentre).cells, wanted.cells);
}

}  // namespace
}  // namespace sidestep::sim::rasteriser_test
