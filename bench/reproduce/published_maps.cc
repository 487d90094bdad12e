#include "sidestep/bench/reproduce/published_maps.h"

#include "sidestep/bench/reproduce/field_scene.h"
#include "sidestep/bench/task_pool.h"
#include "sidestep/sdf/grid_field.h"
#include "sidestep/sdf/map/fast_distance_transform.h"

namespace sidestep::bench {

PublishedMaps::PublishedMaps(const OpenLoopExperiment& experiment, BoxAlignment static_boxes,
                             sdf::DistanceConvention convention, int num_jobs)
    : experiment_(experiment),
      static_occupancy_(StaticOccupancy(experiment.scene, experiment.scene.grid, static_boxes)) {
  for (const double speed_m_s : experiment.speeds_m_s) {
    for (int k = 0; k < experiment.num_states(); ++k) fields_[MovingCells(speed_m_s, k)] = nullptr;
  }
  std::vector<decltype(fields_)::iterator> entries;
  for (auto entry = fields_.begin(); entry != fields_.end(); ++entry) entries.push_back(entry);
  RunTasks(static_cast<int>(entries.size()), num_jobs, [&](int i) {
    auto& [cells, field] = *entries[static_cast<std::size_t>(i)];
    OccupancyGrid occupancy = static_occupancy_;
    Fill(occupancy, cells);
    // No clamp that would bite: the published fields have none.
    field = std::make_unique<sdf::GridField>(
        std::make_shared<const sdf::SdfGrid>(
            sdf::FastDistanceTransform().Compute(occupancy, {.convention = convention})),
        sdf::kNoSurfaceDistance_m);
  });
}

CellRange PublishedMaps::MovingCells(double speed_m_s, int step) const {
  const scenarios::Scenario& scene = experiment_.scene;
  return PublishedBoxCells(scene.grid, experiment_.MovingBoxCenter(speed_m_s, step * scene.step_s),
                           experiment_.moving_box().size_m, BoxAlignment::kIntended);
}

OccupancyGrid PublishedMaps::OccupancyAt(double speed_m_s, int step) const {
  OccupancyGrid occupancy = static_occupancy_;
  Fill(occupancy, MovingCells(speed_m_s, step));
  return occupancy;
}

std::vector<const sdf::DistanceField*> PublishedMaps::FieldsAt(double speed_m_s) const {
  std::vector<const sdf::DistanceField*> fields;
  for (int k = 0; k < experiment_.num_states(); ++k) {
    fields.push_back(fields_.at(MovingCells(speed_m_s, k)).get());
  }
  return fields;
}

}  // namespace sidestep::bench
