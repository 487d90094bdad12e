// Every fast path of the distance fields answers what the simple one does, whatever the grid: each
// input is read as one grid or scene, for one of the checks listed at the end.
#include <fuzzer/FuzzedDataProvider.h>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "sidestep/sdf/composite_field.h"
#include "sidestep/sdf/dense_composite.h"
#include "sidestep/sdf/map/distance_transform.h"
#include "sidestep/sdf/map/fast_distance_transform.h"
#include "sidestep/sdf/map/fast_distance_transform_envelope.h"
#include "sidestep/sdf/map/object_field.h"
#include "sidestep/sdf/map/occupancy_from_scan.h"
#include "sidestep/sdf/tracking/segmentation.h"
#include "tests/sdf/only_target.h"

namespace sidestep {
namespace {

// A power of two, so that what the checks compute beside the library is exact.
constexpr double kCell_m = 0.0625;

void Require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "field_fuzzer: %s\n", what);
  std::abort();
}

bool AreSame(std::span<const float> a, std::span<const float> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

// --- Scenes --------------------------------------------------------------------------------------

using Input = FuzzedDataProvider;

int Number(Input& input, int low, int high) { return input.ConsumeIntegralInRange(low, high); }

// Any shape, also thin or one cell, of at most `max_cells`.
std::array<int, 3> ReadSize(Input& input, int max_cells) {
  std::array<int, 3> size;
  for (int& cells : size) {
    cells = Number(input, 1, std::min(max_cells, Number(input, 0, 7) == 0 ? 1200 : 70));
    max_cells /= cells;
  }
  if (input.ConsumeBool()) std::swap(size[0], size[1]);
  if (input.ConsumeBool()) std::swap(size[1], size[2]);
  return size;
}

// Empty or full, then boxes and walls in it, then single cells.
OccupancyGrid ReadGrid(Input& input, const std::array<int, 3>& size) {
  OccupancyGrid grid({Eigen::Vector3d::Constant(-1), kCell_m, size});
  std::fill(grid.cells.begin(), grid.cells.end(), input.ConsumeBool() ? 1 : 0);
  const auto [nx, ny, nz] = size;
  for (int n = Number(input, 0, 5); n > 0; --n) {
    const std::array<int, 3> first = {Number(input, 0, nx - 1), Number(input, 0, ny - 1),
                                      Number(input, 0, nz - 1)};
    const std::array<int, 3> last = {Number(input, first[0], nx - 1),
                                     Number(input, first[1], ny - 1),
                                     Number(input, first[2], nz - 1)};
    const bool is_diagonal = input.ConsumeBool();
    for (int k = first[2]; k <= last[2]; ++k)
      for (int j = first[1]; j <= last[1]; ++j)
        for (int i = first[0]; i <= last[0]; ++i) {
          if (is_diagonal && (i + j + k) % 7 != 0) continue;
          grid.cells[grid.spec.Index(i, j, k)] ^= 1;
        }
  }
  const std::size_t step = input.ConsumeIntegralInRange<std::size_t>(1, 97);
  std::size_t cell = 0;
  for (const std::uint8_t byte : input.ConsumeBytes<std::uint8_t>(input.remaining_bytes() / 2)) {
    grid.cells[cell % grid.cells.size()] ^= byte & 1;
    cell += 1 + step * (byte >> 1) / 128;
  }
  return grid;
}

OccupancyGrid ReadGrid(Input& input, int max_cells) {
  const std::array<int, 3> size = ReadSize(input, max_cells);
  return ReadGrid(input, size);
}

sdf::DistanceConvention ReadConvention(Input& input) {
  return input.ConsumeBool() ? sdf::DistanceConvention::kSurface : sdf::DistanceConvention::kBwdist;
}

double ReadQuarters_m(Input& input, int low, int high) {
  return kCell_m / 4 * Number(input, low, high);
}
Eigen::Vector3d ReadPoint(Input& input, int reach) {  // in quarter cells
  const double x = ReadQuarters_m(input, -reach, reach), y = ReadQuarters_m(input, -reach, reach);
  return {x, y, ReadQuarters_m(input, -reach, reach)};
}

// --- The transform -------------------------------------------------------------------------------

std::vector<float> TransformByBruteForce(const OccupancyGrid& grid,
                                         sdf::DistanceConvention convention) {
  const auto square = [&](int offset) {
    const int faces = convention == sdf::DistanceConvention::kSurface && offset != 0 ? 1 : 0;
    return (2 * std::abs(offset) - faces) * (2 * std::abs(offset) - faces);
  };
  const int nx = grid.spec.size[0], ny = grid.spec.size[1];
  const int count = static_cast<int>(grid.cells.size());
  std::vector<float> distance_m;
  for (int a = 0; a < count; ++a) {
    int nearest = std::numeric_limits<int>::max();
    const std::uint8_t filled = grid.cells[static_cast<std::size_t>(a)];
    for (int b = 0; b < count; ++b) {
      if (grid.cells[static_cast<std::size_t>(b)] == filled) continue;
      nearest = std::min(nearest, square(a % nx - b % nx) + square(a / nx % ny - b / nx % ny) +
                                      square(a / nx / ny - b / nx / ny));
    }
    const float distance =
        nearest == std::numeric_limits<int>::max()
            ? sdf::kNoSurfaceDistance_m
            : static_cast<float>(kCell_m / 2 * std::sqrt(static_cast<float>(nearest)));
    distance_m.push_back(filled != 0 ? -distance : distance);
  }
  return distance_m;
}

void CheckTransform(Input& input) {
  sdf::DistanceTransformOptions options;
  options.convention = ReadConvention(input);
  if (input.ConsumeBool()) options.max_distance_m = kCell_m / 2 * Number(input, 1, 600);
  options.num_threads = Number(input, 0, 7) == 0 ? Number(input, 2, 5) : 1;
  options.min_lane_bits = 8 << Number(input, 0, 2);
  const OccupancyGrid grid = ReadGrid(input, Number(input, 0, 15) == 0 ? 12000 : 2500);

  const sdf::SdfGrid simple = sdf::ComputeSignedDistance(grid, options.convention);
  if (grid.cells.size() <= 300) {
    Require(AreSame(simple.distance_m(), TransformByBruteForce(grid, options.convention)),
            "the simple transform differs from brute force");
  }
  sdf::AlignedVector<float> expected = simple.distance_m();
  const float limit = static_cast<float>(options.max_distance_m);
  for (float& distance : expected) distance = std::clamp(distance, -limit, limit);

  static sdf::FastDistanceTransform
      transform;  // Its memory serves all grids, whatever came before.
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const sdf::OnlyTarget only(target);
    std::vector<float> actual(grid.cells.size(), std::nanf(""));
    transform.Compute(grid, options, actual);
    Require(AreSame(actual, expected), hwy::TargetName(target));
  }
}

void CheckEnvelope(Input& input) {
  const std::uint32_t far = input.ConsumeIntegralInRange<std::uint32_t>(1, 1U << 20);
  const std::uint32_t steepness = input.ConsumeIntegralInRange<std::uint32_t>(0, 300);
  const auto cost = [&](std::uint32_t k) { return steepness * k * k; };
  std::vector<std::uint32_t> values(static_cast<std::size_t>(Number(input, 1, 60)));
  for (std::uint32_t& value : values) value = input.ConsumeIntegralInRange(0U, far);
  std::vector<std::uint32_t> expected(values.size(), far);
  for (std::uint32_t t = 0; t < values.size(); ++t) {
    for (std::uint32_t s = 0; s < values.size(); ++s) {
      if (values[s] >= far) continue;
      expected[t] = std::min(expected[t], values[s] + cost(std::max(s, t) - std::min(s, t)));
    }
  }
  std::vector<sdf::fast_transform::EnvelopePiece> pieces(values.size());
  sdf::fast_transform::TransformLineByEnvelope(values.data(), values.size(), far, cost,
                                               pieces.data());
  Require(values == expected, "the lower envelope differs from the minimum over all sources");
}

// --- Composites ----------------------------------------------------------------------------------

struct Scene {
  std::shared_ptr<const sdf::SdfGrid> static_W;
  std::vector<sdf::MovingField> objects;
  double clamp_m = 0;
};

Scene ReadScene(Input& input, int max_objects, bool may_turn) {
  Scene scene;
  scene.clamp_m = kCell_m / 2 * Number(input, 1, 6);
  const sdf::DistanceConvention convention = ReadConvention(input);
  const double max_growth_m = ReadQuarters_m(input, 0, 4);
  std::vector<std::shared_ptr<const sdf::SdfGrid>> shapes;
  for (int n = Number(input, 1, 2); n > 0; --n) {
    shapes.push_back(std::make_shared<sdf::SdfGrid>(
        sdf::MakeObjectField(ReadGrid(input, 30), scene.clamp_m + max_growth_m, convention)));
  }
  for (int n = Number(input, 0, max_objects); n > 0; --n) {
    sdf::MovingField& object = scene.objects.emplace_back();
    object.field_O = shapes[static_cast<std::size_t>(n) % shapes.size()];
    const Eigen::Vector3d p = ReadPoint(input, 200), v = ReadPoint(input, 8);
    const Eigen::Vector3d rpy_rad = may_turn ? ReadPoint(input, 200) : Eigen::Vector3d::Zero();
    object.X_WO = [=](EpisodeTime t) {
      return Pose::FromRollPitchYaw(rpy_rad, p + t.seconds() * v);
    };
    object.max_growth_m = max_growth_m;
    if (input.ConsumeBool()) object.growth_m = [=](EpisodeTime t) { return t.seconds() * 0.01; };
  }
  scene.static_W =
      std::make_shared<sdf::SdfGrid>(sdf::ComputeSignedDistance(ReadGrid(input, 800), convention));
  return scene;
}

// By definition, without any shortcut.
double LeastDistance_m(const sdf::SdfGrid& static_W, const StaticSolids& exact,
                       const std::vector<sdf::PlacedObject>& objects, double clamp_m,
                       const Eigen::Vector3d& p_WQ) {
  double least_m = clamp_m;
  const sdf::GridSample fixed = static_W.Sample(p_WQ);
  if (fixed.in_grid) least_m = std::min(least_m, fixed.distance_m);
  for (const HalfSpace& solid : exact.half_spaces) {
    least_m = std::min(least_m, SignedDistance(solid, p_WQ));
  }
  for (const PlacedShape& solid : exact.shapes) {
    least_m = std::min(least_m, SignedDistance(solid.shape, solid.X_WO.Inverse() * p_WQ));
  }
  for (const sdf::PlacedObject& object : objects) {
    const sdf::GridSample sample = object.field_O->Sample(object.X_WO.Inverse() * p_WQ);
    if (sample.in_grid) least_m = std::min(least_m, sample.distance_m - object.growth_m);
  }
  return least_m;
}

void CheckQueries(Input& input) {
  const EpisodeTime t(Number(input, 0, 40));
  const Eigen::Index num_points = Number(input, 0, 7) == 0 ? 140 : Number(input, 1, 20);
  const Scene scene = ReadScene(input, Number(input, 0, 3) == 0 ? 40 : 5, true);
  std::vector<sdf::PlacedObject> at_t;
  for (const sdf::MovingField& object : scene.objects) {
    const double growth_m =
        object.growth_m ? std::clamp(object.growth_m(t), 0.0, object.max_growth_m) : 0;
    at_t.push_back({object.field_O.get(), {}, object.X_WO(t), growth_m});
  }
  StaticSolids exact;
  if (input.ConsumeBool()) {
    exact.half_spaces.push_back({Eigen::Vector3d::UnitZ(), ReadPoint(input, 200).z()});
  }
  if (input.ConsumeBool()) {
    exact.shapes.push_back({Box{{0.3, 0.02, 0.2}},
                            Pose::FromRollPitchYaw(ReadPoint(input, 200), ReadPoint(input, 200))});
  }
  Eigen::Matrix3Xd p_WQ(3, num_points);
  Eigen::VectorXd least_m(num_points);
  for (Eigen::Index s = 0; s < num_points; ++s) {
    p_WQ.col(s) = ReadPoint(input, 300);
    if (input.ConsumeBool()) p_WQ.col(s) *= 0.99;  // off the centres and borders
    least_m(s) = LeastDistance_m(*scene.static_W, exact, at_t, scene.clamp_m, p_WQ.col(s));
  }
  const sdf::CompositeField field(scene.static_W, scene.objects, scene.clamp_m, exact);
  const sdf::PlacedComposite placed = field.PlacedAt(t);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const sdf::OnlyTarget only(target);
    sdf::DistanceSamples batch;
    field.SampleMany(p_WQ, t, batch);
    sdf::SampleColumns columns;
    placed.SampleMany(sdf::PointColumns(p_WQ.transpose()), columns);
    int num_outside = 0;
    for (Eigen::Index s = 0; s < num_points; ++s) {
      const sdf::DistanceSample one = placed.Sample(p_WQ.col(s));
      num_outside += one.in_grid ? 0 : 1;
      Require(batch.distance_m(s) == one.distance_m && columns.distance_m(s) == one.distance_m &&
                  batch.gradient_W.col(s) == one.gradient_W &&
                  columns.gradient_W.row(s).transpose() == one.gradient_W,
              "a batched query differs from a single one");
      Require(std::abs(one.distance_m - least_m(s)) < 1e-9,
              "a query differs from the least of all fields");
    }
    Require(batch.num_outside == num_outside && columns.num_outside == num_outside,
            "points outside are counted wrongly");
  }
}

// A composite at time t by definition: each object at the nearest whole cell.
sdf::AlignedVector<float> ComposeCellByCell(const Scene& scene, EpisodeTime t) {
  const GridSpec& spec = scene.static_W->spec();
  sdf::AlignedVector<float> least_m = scene.static_W->distance_m();
  for (const sdf::MovingField& object : scene.objects) {
    const GridSpec& object_spec = object.field_O->spec();
    const Eigen::Vector3d from_first =
        object.X_WO(t).translation() + object_spec.first_center_m - spec.first_center_m;
    const Eigen::Vector3d whole = (from_first / kCell_m).array().round();
    for (std::size_t cell = 0; cell < least_m.size(); ++cell) {
      const Eigen::Vector3d p_O =
          object_spec.first_center_m + spec.CenterOf(cell) - spec.first_center_m - kCell_m * whole;
      const auto [i, j, k] = object_spec.CellOf(p_O);
      if (!object_spec.Contains(i, j, k)) continue;
      least_m[cell] = std::min(least_m[cell], object.field_O->At(i, j, k));
    }
  }
  return least_m;
}

void CheckDenseGrids(Input& input) {
  const int num_steps = Number(input, 1, 6);
  const Scene scene = ReadScene(input, 4, false);
  sdf::DenseSteps steps(scene.static_W, scene.objects);
  for (int n = 0; n < num_steps; ++n) {
    const EpisodeTime t(Number(input, 0, 40));
    const sdf::AlignedVector<float> expected = ComposeCellByCell(scene, t);
    Require(AreSame(sdf::ComposeDense(*scene.static_W, scene.objects, t).distance_m(), expected),
            "the dense composite differs from the least of all fields");
    Require(AreSame(steps.At(t), expected), "the incremental composite differs from the dense one");
  }
}

// --- Scans ---------------------------------------------------------------------------------------

// Which component each cell belongs to, as the lowest cell of it; -1 for a free cell.
std::vector<int> LabelByFlooding(const OccupancyGrid& grid) {
  std::vector<int> labels(grid.cells.size(), -1);
  const int nx = grid.spec.size[0], ny = grid.spec.size[1];
  for (std::size_t seed = 0; seed < labels.size(); ++seed) {
    if (grid.cells[seed] == 0 || labels[seed] >= 0) continue;
    labels[seed] = static_cast<int>(seed);
    std::vector<int> front = {static_cast<int>(seed)};
    while (!front.empty()) {
      const int cell = front.back();
      front.pop_back();
      for (int n = 0; n < 27; ++n) {
        const int i = cell % nx + n % 3 - 1, j = cell / nx % ny + n / 3 % 3 - 1;
        const int k = cell / nx / ny + n / 9 - 1;
        if (!grid.spec.Contains(i, j, k) || !grid.At(i, j, k)) continue;
        int& label = labels[grid.spec.Index(i, j, k)];
        if (label >= 0) continue;
        label = static_cast<int>(seed);
        front.push_back(static_cast<int>(grid.spec.Index(i, j, k)));
      }
    }
  }
  return labels;
}

void CheckSegmentation(Input& input) {
  OccupancyGrid grid = ReadGrid(input, 4000);
  std::vector<std::uint8_t> left_out(grid.cells.size(), 0);
  const std::vector<std::uint8_t> bytes = input.ConsumeRemainingBytes<std::uint8_t>();
  for (std::size_t n = 0; n < std::min(bytes.size(), left_out.size()); ++n) {
    left_out[n] = bytes[n] & 2;
  }
  std::vector<int> labels(grid.cells.size(), -1);
  for (const sdf::Component& component : sdf::FindComponents(grid, left_out)) {
    Require(std::is_sorted(component.cells.begin(), component.cells.end()), "cells are unsorted");
    for (const std::size_t cell : component.cells) {
      Require(labels[cell] == -1, "a cell is in two components");
      labels[cell] = static_cast<int>(component.cells.front());
    }
    const OccupancyGrid shape = sdf::CutOut(component, grid.spec);
    Require(shape.CountFilled() == component.cells.size(), "a component is cut out wrongly");
  }
  for (std::size_t n = 0; n < left_out.size(); ++n) {
    if (left_out[n] != 0) grid.cells[n] = 0;
  }
  Require(labels == LabelByFlooding(grid), "components differ from those of a flood");
}

void CheckRasteriser(Input& input) {
  const GridSpec spec{Eigen::Vector3d::Constant(-1), kCell_m, ReadSize(input, 3000)};
  sdf::ScanRasteriser rasteriser(spec);
  Scan scan;
  for (int n = Number(input, 1, 12); n > 0; --n) {
    // As a sensor does: some of what it saw before, then other points; sometimes from elsewhere.
    if (Number(input, 0, 7) == 0) scan.X_WC = Pose::Translation(ReadPoint(input, 20));
    const Eigen::Index num_kept = Number(input, 0, static_cast<int>(scan.p_CP.cols()));
    const Eigen::Index num_new = Number(input, 0, 40);
    scan.p_CP.conservativeResize(3, num_kept + num_new);
    for (Eigen::Index p = num_kept; p < scan.p_CP.cols(); ++p) {
      scan.p_CP.col(p) = ReadPoint(input, 120);
      if (Number(input, 0, 15) == 0) scan.p_CP(1, p) = std::numeric_limits<double>::quiet_NaN();
    }
    OccupancyGrid expected(spec);
    for (Eigen::Index p = 0; p < scan.p_CP.cols(); ++p) {
      const Eigen::Vector3d p_WP = scan.X_WC.translation() + scan.p_CP.col(p);
      if (!p_WP.allFinite()) continue;
      const auto [i, j, k] = spec.CellOf(p_WP);
      if (spec.Contains(i, j, k)) expected.cells[spec.Index(i, j, k)] = 1;
    }
    Require(rasteriser.Fill(scan).cells == expected.cells,
            "the rasteriser differs from filling point by point");
  }
}

constexpr void (*kChecks[])(Input&) = {CheckTransform,  CheckEnvelope,     CheckQueries,
                                       CheckDenseGrids, CheckSegmentation, CheckRasteriser};

}  // namespace
}  // namespace sidestep

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  sidestep::Input input(bytes, size);
  input.PickValueInArray(sidestep::kChecks)(input);
  return 0;
}
