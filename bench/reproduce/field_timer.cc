#include "sidestep/bench/reproduce/field_timer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sidestep/bench/reproduce/published_maps.h"
#include "sidestep/core/cpu_time.h"
#include "sidestep/core/random.h"
#include "sidestep/sdf/map/object_field.h"
#include "sidestep/sdf/prediction/registry.h"
#include "sidestep/sdf/tracking/segmentation.h"
#include "sidestep/sdf/tracking/tracked_object.h"

namespace sidestep::bench {
namespace {

constexpr int kQueries = 20000;

std::vector<sdf::Component> FindObjects(const scenarios::Scenario& scene,
                                        const OccupancyGrid& standing, EpisodeTime t) {
  OccupancyGrid moving = MovingOccupancy(scene, standing.spec, t);
  for (std::size_t i = 0; i < moving.cells.size(); ++i) {
    if (standing.cells[i] != 0) moving.cells[i] = 0;
  }
  return sdf::FindComponents(moving);
}

const sdf::Component& Nearest(const std::vector<sdf::Component>& components,
                              const Eigen::Vector3d& p_W) {
  return *std::min_element(components.begin(), components.end(),
                           [&](const sdf::Component& a, const sdf::Component& b) {
                             return (a.centroid_m - p_W).norm() < (b.centroid_m - p_W).norm();
                           });
}

// The cell of `grid` where the first cell of a shape comes to lie. It is found from the shape's
// padded field as ComposeDense does it, so that both round alike.
std::array<int, 3> Corner(const GridSpec& grid, const GridSpec& shape_O,
                          const sdf::MovingField& object, EpisodeTime t) {
  const GridSpec& field_O = object.field_O->spec();
  const Eigen::Vector3d offset_m =
      object.X_WO(t).translation() + field_O.first_center_m - grid.first_center_m;
  std::array<int, 3> corner{};
  for (std::size_t a = 0; a < 3; ++a) {
    const int padding = (field_O.size[a] - shape_O.size[a]) / 2;
    corner[a] = padding +
                static_cast<int>(std::lround(offset_m(static_cast<Eigen::Index>(a)) / grid.cell_m));
  }
  return corner;
}

Eigen::Matrix3Xd RandomPoints(const GridSpec& grid) {
  RandomStream random(1, "field timer points");
  const Eigen::Vector3d size_m =
      grid.Center(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1) - grid.first_center_m;
  Eigen::Matrix3Xd points(3, kQueries);
  for (Eigen::Index i = 0; i < points.size(); ++i) points(i) = random.Uniform();
  return (points.array().colwise() * size_m.array()).colwise() + grid.first_center_m.array();
}

}  // namespace

FieldTimer::FieldTimer(const scenarios::Scenario& scene, const GridSpec& grid, double margin_m,
                       EpisodeTime first, EpisodeTime second)
    : margin_m_(margin_m),
      static_occupancy_(StaticOccupancy(scene, grid)),
      exact_m_(grid.num_cells()),
      dense_m_(grid.num_cells()),
      queries_W_(RandomPoints(grid)) {
  if (!(first < second)) throw std::invalid_argument("FieldTimer: needs first < second");
  const std::vector<sdf::Component> before = FindObjects(scene, static_occupancy_, first);
  const std::vector<sdf::Component> after = FindObjects(scene, static_occupancy_, second);
  const std::shared_ptr<const sdf::ObstaclePredictor> predictor = sdf::MakePredictor("two_frame");

  double begin_s = ThreadCpuSeconds();
  static_W_ = std::make_shared<const sdf::SdfGrid>(
      transform_.Compute(static_occupancy_, {.convention = kPublishedConvention}));
  init_s_ = ThreadCpuSeconds() - begin_s;
  for (const sdf::Component& component : after) {
    OccupancyGrid shape_O = sdf::CutOut(component, grid);
    shape_O.spec.first_center_m -= component.centroid_m;
    begin_s = ThreadCpuSeconds();
    auto field_O = std::make_shared<const sdf::SdfGrid>(
        sdf::MakeObjectField(shape_O, margin_m, kPublishedConvention));
    init_s_ += ThreadCpuSeconds() - begin_s;

    auto object = std::make_shared<sdf::TrackedObject>();
    if (before.size() == after.size()) {
      object->history.push_back({first, Nearest(before, component.centroid_m).centroid_m});
    }
    object->history.push_back({second, component.centroid_m});
    object->field_O = field_O;
    objects_.push_back({std::move(field_O), [object, predictor](EpisodeTime t) {
                          return predictor->PredictPose(*object, t);
                        }});
    shapes_O_.push_back(std::move(shape_O));
  }
  steps_.emplace(static_W_, objects_);
  steps_->At(second);
}

OccupancyGrid FieldTimer::PredictMap(EpisodeTime t) const {
  OccupancyGrid map = static_occupancy_;
  for (std::size_t n = 0; n < shapes_O_.size(); ++n) {
    const OccupancyGrid& shape = shapes_O_[n];
    const auto [x, y, z] = Corner(map.spec, shape.spec, objects_[n], t);
    for (int k = 0; k < shape.spec.size[2]; ++k) {
      for (int j = 0; j < shape.spec.size[1]; ++j) {
        for (int i = 0; i < shape.spec.size[0]; ++i) {
          if (!shape.At(i, j, k) || !map.spec.Contains(x + i, y + j, z + k)) continue;
          map.cells[map.spec.Index(x + i, y + j, z + k)] = 1;
        }
      }
    }
  }
  return map;
}

void FieldTimer::ComputeExact(const OccupancyGrid& map) {
  transform_.Compute(map, {.convention = kPublishedConvention}, exact_m_);
}

PredictionTimes FieldTimer::Time(EpisodeTime t) {
  PredictionTimes times;
  double begin_s = ThreadCpuSeconds();
  const auto lap = [&begin_s] {
    const double now_s = ThreadCpuSeconds();
    return now_s - std::exchange(begin_s, now_s);
  };
  ComputeExact(PredictMap(t));
  times.full_s = lap();
  sdf::ComposeDense(*static_W_, objects_, t, dense_m_);
  times.dense_s = lap();
  steps_->At(t);
  times.incremental_s = lap();
  const sdf::CompositeField lazy(static_W_, objects_, margin_m_);
  times.lazy_s = lap();
  sdf::DistanceSamples samples;
  lazy.SampleMany(queries_W_, t, samples);
  times.query_s = lap() / static_cast<double>(queries_W_.cols());
  return times;
}

bool FieldTimer::HoldsAllObjects(EpisodeTime t) const {
  const GridSpec& grid = static_occupancy_.spec;
  for (std::size_t n = 0; n < shapes_O_.size(); ++n) {
    const GridSpec& shape = shapes_O_[n].spec;
    const auto [x, y, z] = Corner(grid, shape, objects_[n], t);
    if (!grid.Contains(x, y, z) ||
        !grid.Contains(x + shape.size[0] - 1, y + shape.size[1] - 1, z + shape.size[2] - 1)) {
      return false;
    }
  }
  return true;
}

CompositeError FieldTimer::Compare(EpisodeTime t) {
  const OccupancyGrid map = PredictMap(t);
  ComputeExact(map);
  sdf::ComposeDense(*static_W_, objects_, t, dense_m_);
  CompositeError error;
  for (std::size_t i = 0; i < exact_m_.size(); ++i) {
    const double difference_m = std::abs(dense_m_[i] - exact_m_[i]);
    if (map.cells[i] != 0) {
      error.inside_m = std::max(error.inside_m, difference_m);
    } else if (exact_m_[i] <= margin_m_) {
      error.free_m = std::max(error.free_m, difference_m);
    }
  }
  return error;
}

}  // namespace sidestep::bench
