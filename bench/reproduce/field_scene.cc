#include "sidestep/bench/reproduce/field_scene.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "sidestep/bench/reproduce/published_rasteriser.h"

namespace sidestep::bench {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

const FieldScene::MovingBox kHighBox = {
    {{0.3, 0.25, 1.45}, {0.15, 0.15, 0.15}}, {-0.6, 0, 0}, kNever};
const FieldScene::MovingBox kOtherHighBox = {
    {{0.55, -0.95, 1.45}, {0.15, 0.15, 0.15}}, {-0.17, 0.6, 0}, 2};
const FieldScene::MovingBox kPillar = {
    {{0.55, -0.95, -0.05}, {0.15, 0.15, 1.9}}, {-0.17, 0.6, 0}, 2};
const FieldScene::MovingBox kOtherPillar = {
    {{0.3, 0.25, -0.05}, {0.15, 0.15, 1.9}}, {-0.6, 0, 0}, kNever};
const FieldScene::MovingBox kBlock = {{{0.4, 0.4, 0.4}, {0.2, 0.2, 0.2}}, {-0.17, 0.6, 0}, kNever};

std::vector<FieldScene> Scenes() {
  const std::vector<PublishedBox> table_and_cabinet =
      MakeOpenLoopExperiment("wam_single_pillar").static_boxes;
  return {
      {"field_one_box", table_and_cabinet, {kHighBox}},
      {"field_two_boxes", table_and_cabinet, {kHighBox, kOtherHighBox}},
      {"field_one_pillar", table_and_cabinet, {kPillar}},
      {"field_two_pillars", table_and_cabinet, {kOtherPillar, kPillar}},
      {"field_large_block", {}, {kBlock}},
  };
}

void FillBox(OccupancyGrid& occupancy, const PublishedBox& box) {
  Fill(occupancy,
       PublishedBoxCells(occupancy.spec, box.center_m, box.size_m, BoxAlignment::kIntended));
}

}  // namespace

std::vector<std::string> FieldSceneNames() {
  std::vector<std::string> names;
  for (const FieldScene& scene : Scenes()) names.push_back(scene.name);
  return names;
}

FieldScene MakeFieldScene(const std::string& name) {
  for (const FieldScene& scene : Scenes()) {
    if (scene.name == name) return scene;
  }
  throw std::invalid_argument("unknown field scene '" + name + "'");
}

GridSpec PublishedTimingGrid(int voxels_per_side) {
  if (voxels_per_side < 2) throw std::invalid_argument("PublishedTimingGrid: needs >= 2 voxels");
  const int cell_cm = (300 + voxels_per_side - 1) / voxels_per_side;
  return {Eigen::Vector3d(-1, -1, -1),
          cell_cm / 100.0,
          {voxels_per_side, voxels_per_side, voxels_per_side}};
}

OccupancyGrid StaticOccupancy(const FieldScene& scene, const GridSpec& grid) {
  OccupancyGrid occupancy(grid);
  for (const PublishedBox& box : scene.static_boxes) FillBox(occupancy, box);
  return occupancy;
}

OccupancyGrid MovingOccupancy(const FieldScene& scene, const GridSpec& grid, EpisodeTime t) {
  OccupancyGrid occupancy(grid);
  for (const FieldScene::MovingBox& moving : scene.moving_boxes) {
    PublishedBox box = moving.at_start;
    box.center_m += std::min(t.seconds(), moving.stop_s) * moving.velocity_m_s;
    FillBox(occupancy, box);
  }
  return occupancy;
}

}  // namespace sidestep::bench
