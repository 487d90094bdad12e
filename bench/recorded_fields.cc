#include "sidestep/bench/recorded_fields.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/episode_world.h"
#include "sidestep/bench/true_world.h"
#include "sidestep/core/observations.h"
#include "sidestep/sdf/point_block.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::bench {
namespace {

constexpr std::size_t kMostSamples = 40'000'000;  // that people's browsers bear

sdf::WorldModelOptions OptionsOf(const record::Recording& recording,
                                 const scenarios::Scenario& scenario, double max_distance_m) {
  sdf::WorldModelOptions options = MakeWorldModelOptions(scenario, max_distance_m, EpisodeWorld());
  // Without a truth nobody knew how things move.
  if (!recording.truth.empty()) options.true_obstacles = TrueMotions(scenario);
  return options;
}

// What was observed, moment after moment, as scans of solids.
class RecordedScans {
 public:
  RecordedScans(const record::Recording& recording, const GridSpec& grid)
      : recording_(recording), occupancy_(grid) {}

  /// The next one, if it had come by then; else null.
  const Scan* NextUntil(EpisodeTime t) {
    if (next_ == recording_.observations.size()) return nullptr;
    const record::ObservationRecord& observation = recording_.observations[next_];
    if (observation.t_arrival > t) return nullptr;
    ++next_;
    for (const std::int64_t cell : observation.changed_cells) {
      occupancy_.cells[static_cast<std::size_t>(cell)] ^= 1;
    }
    scan_.t = observation.t;
    scan_.p_CP.resize(3, static_cast<Eigen::Index>(occupancy_.CountFilled()));
    Eigen::Index point = 0;
    for (std::size_t cell = 0; cell < occupancy_.cells.size(); ++cell) {
      if (occupancy_.cells[cell] != 0) scan_.p_CP.col(point++) = occupancy_.spec.CenterOf(cell);
    }
    return &scan_;
  }

 private:
  const record::Recording& recording_;
  std::size_t next_ = 0;
  OccupancyGrid occupancy_;
  Scan scan_;
};

// Points of a grid no denser than the workspace's, that fill it as those do.
GridSpec SampleGrid(const GridSpec& workspace, int most_points) {
  const int longest = *std::max_element(workspace.size.begin(), workspace.size.end());
  const int stride = std::max(1, (longest + most_points - 1) / most_points);
  GridSpec grid = workspace;
  grid.cell_m *= stride;
  for (int axis = 0; axis < 3; ++axis) {
    int& size = grid.size[static_cast<std::size_t>(axis)];
    grid.first_center_m[axis] += 0.5 * workspace.cell_m * ((size - 1) % stride);
    size = (size - 1) / stride + 1;
  }
  return grid;
}

std::vector<std::uint8_t> SampleAt(const sdf::DistanceField& field, const GridSpec& grid,
                                   EpisodeTime t, double max_distance_m) {
  std::vector<std::uint8_t> distance(grid.num_cells());
  const std::unique_ptr<const sdf::FieldSlice> slice = field.At(t);
  sdf::PointBlock block;
  for (std::size_t begin = 0; begin < distance.size(); begin += block.count) {
    block.count = std::min(sdf::PointBlock::kSize, distance.size() - begin);
    for (std::size_t n = 0; n < block.count; ++n) {
      const Eigen::Vector3d p_W = grid.CenterOf(begin + n);
      block.x[n] = p_W.x();
      block.y[n] = p_W.y();
      block.z[n] = p_W.z();
    }
    block.Pad();
    slice->SampleBlock(block);
    for (std::size_t n = 0; n < block.count; ++n) {
      const double share = std::clamp(block.distance_m[n] / max_distance_m, 0.0, 1.0);
      distance[begin + n] = static_cast<std::uint8_t>(std::lround(255 * share));
    }
  }
  return distance;
}

}  // namespace

std::string WhyNoRecordedFields(const record::Recording& recording,
                                const scenarios::Scenario& scenario) {
  if (recording.cycles.empty()) return "no planning cycle was recorded";
  if (recording.observations.empty()) return "no scan was recorded";
  for (const scenarios::SensorSettings& sensor : scenarios::SensorsOf(scenario)) {
    if (sensor.camera) return "a trace does not hold what the depth camera could not see";
    if (sensor.tags || sensor.tag_images) return "a trace holds tagged objects by name only";
  }
  const auto num_cells = static_cast<std::int64_t>(scenario.grid.num_cells());
  for (const record::ObservationRecord& observation : recording.observations) {
    for (const std::int64_t cell : observation.changed_cells) {
      if (cell < 0 || cell >= num_cells) return "its scans do not fit its workspace";
    }
  }
  if (recording.truth.empty() && scenario.knowledge == ToString(sdf::Knowledge::kFullKnowledge)) {
    return "the true motions were not recorded";
  }
  return "";
}

void RemakeFields(const record::Recording& recording, const scenarios::Scenario& scenario,
                  double max_distance_m, const RecordedFieldObserver& look) {
  const auto model = sdf::MakeWorldModel(OptionsOf(recording, scenario, max_distance_m));
  RecordedScans scans(recording, scenario.grid);
  bool has_seen = false;
  for (const CycleRecord& cycle : recording.cycles) {
    while (const Scan* const scan = scans.NextUntil(cycle.t)) {
      model->Observe(*scan);
      has_seen = true;
    }
    if (has_seen) look(cycle, *model->MakeField());
  }
}

FieldSamples SampleRecordedFields(const record::Recording& recording,
                                  const scenarios::Scenario& scenario, double max_distance_m,
                                  const std::vector<double>& ahead_s, int most_points) {
  FieldSamples samples;
  samples.why_none = WhyNoRecordedFields(recording, scenario);
  if (!samples.why_none.empty()) return samples;
  samples.grid = SampleGrid(scenario.grid, most_points);
  samples.max_distance_m = max_distance_m;
  samples.ahead_s = ahead_s;
  const std::size_t all = recording.cycles.size() * ahead_s.size() * samples.grid.num_cells();
  const std::size_t every = all / kMostSamples + 1;
  std::size_t index = 0;
  const auto look = [&](const CycleRecord& cycle, const sdf::DistanceField& field) {
    if (index++ % every != 0) return;
    for (const double ahead : ahead_s) {
      const EpisodeTime t = cycle.t + HorizonOffset(ahead);
      samples.volumes.push_back({cycle.t, t, SampleAt(field, samples.grid, t, max_distance_m)});
    }
  };
  RemakeFields(recording, scenario, max_distance_m, look);
  return samples;
}

}  // namespace sidestep::bench
