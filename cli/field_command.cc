#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/bench/sensor_watch.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/render/image.h"
#include "sidestep/render/video_writer.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::cli {
namespace {

struct FieldOptions {
  std::string scenario, out;
  Overrides overrides;
  std::vector<std::string> settings;
  double time_s = 0.5, height_m = 0.6, reach_m = 0.5;
  std::vector<double> ahead_s = {0};
};

// What a model of the world believes at a time, having seen everything until then, while the robot
// rests. The world is kept, because beliefs under full knowledge ask it.
struct Belief {
  bench::EpisodeWorld world;
  std::unique_ptr<sdf::WorldModel> model;
  EpisodeTime t;
  std::shared_ptr<const sdf::DistanceField> field;
};

Belief Watch(Scene scene, const FieldOptions& options) {
  Belief belief;
  belief.world = std::move(scene.world);
  belief.model = sdf::MakeWorldModel(
      bench::MakeWorldModelOptions(scene.scenario, options.reach_m, belief.world));
  bench::SensorWatch sensor(*belief.world.sensor);
  while (sensor.NextDue().seconds() <= options.time_s) {
    const EpisodeTime now = sensor.NextDue();
    belief.world.robot->AdvanceTo(now);
    if (const std::optional<Scan> scan = sensor.Read(now)) belief.model->Observe(*scan);
  }
  if (!sensor.has_seen()) throw InputError("--time", "the sensor has seen nothing until then");
  belief.t = EpisodeTime(options.time_s);
  belief.field = belief.model->MakeField();
  return belief;
}

// Solids are dark, near is warm, far is pale.
render::Color ColorOf(double distance_m, double reach_m) {
  if (distance_m <= 0) return {110, 30, 30};
  const double far = std::min(1.0, distance_m / reach_m);
  const auto mix = [far](double near_value, double far_value) {
    return static_cast<std::uint8_t>(std::lround(near_value + far * (far_value - near_value)));
  };
  return {mix(250, 245), mix(150, 248), mix(70, 252)};
}

// One level slice: the field at a time, a thin line for each tenth of a metre, and in black what is
// truly solid then of everything that moves. y points up, x to the right.
render::Image Slice(const Belief& belief, const GridSpec& grid, EpisodeTime t, double height_m) {
  constexpr int kPixelsPerCell = 3;
  const double pixel_m = grid.cell_m / kPixelsPerCell;
  const int width = grid.size[0] * kPixelsPerCell, height = grid.size[1] * kPixelsPerCell;
  const auto point = [&](int x, int y) {
    return Eigen::Vector3d(grid.first_center_m.x() - grid.cell_m / 2 + (x + 0.5) * pixel_m,
                           grid.first_center_m.y() - grid.cell_m / 2 + (height - y - 0.5) * pixel_m,
                           height_m);
  };
  const std::vector<ObjectObservation> obstacles = belief.world.truth->ObstaclesAt(t);
  const auto is_truly_filled = [&](const Eigen::Vector3d& p_W) {
    return std::any_of(obstacles.begin(), obstacles.end(), [&](const ObjectObservation& o) {
      return SignedDistance(o.shape, o.X_WO.Inverse() * p_W) < 0;
    });
  };
  const auto distance_at = [&](int x, int y) {
    return belief.field->Sample(point(x, y), t).distance_m;
  };
  render::Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double d = distance_at(x, y);
      image.Blend(x, y, ColorOf(d, belief.field->max_distance_m()), 1);
      const auto ring = [](double distance_m) { return std::floor(distance_m / 0.1); };
      if (ring(d) != ring(distance_at(x + 1, y)) || ring(d) != ring(distance_at(x, y + 1))) {
        image.Blend(x, y, {60, 60, 60}, 0.35);
      }
      const bool filled = is_truly_filled(point(x, y));
      if (filled != is_truly_filled(point(x + 1, y)) ||
          filled != is_truly_filled(point(x, y + 1))) {
        image.Blend(x, y, {0, 0, 0}, 1);
      }
    }
  }
  return image;
}

int DrawField(FieldOptions options) {
  render::CheckPngName(options.out);
  CheckCanWrite(options.out);
  options.overrides.settings = ParseSettings(options.settings);
  Scene scene = LoadScene(options.scenario, options.overrides, FindDataPaths());
  const GridSpec grid = scene.scenario.grid;
  const Belief belief = Watch(std::move(scene), options);
  constexpr int kGap = 6;
  std::vector<render::Image> slices;
  for (const double ahead_s : options.ahead_s) {
    slices.push_back(Slice(belief, grid, belief.t + HorizonOffset(ahead_s), options.height_m));
  }
  const int width = slices.front().width() + kGap;
  render::Image image(width * static_cast<int>(slices.size()) - kGap, slices.front().height());
  image.Fill({0, 0, image.width(), image.height()}, {255, 255, 255});
  for (std::size_t i = 0; i < slices.size(); ++i) {
    image.Paste(slices[i], width * static_cast<int>(i), 0);
  }
  render::WritePng(image, options.out);
  Print("written  {}\n", options.out);
  return 0;
}

}  // namespace

void AddFieldCommand(CommandLine& line) {
  auto options = std::make_shared<FieldOptions>();
  CLI::App* const field = line.app.add_subcommand(
      "field", "Draw a level slice of the distances that a planner would believe in");
  field->add_option("SCENARIO", options->scenario, "A name (see `sidestep list`) or a path")
      ->required();
  field->add_option("--out", options->out, "The picture to write, FILE.png")->required();
  field->add_option("--time", options->time_s, "When the world was last seen [s] [0.5]")
      ->check(NumberFrom(0.0, 60.0));
  field
      ->add_option("--ahead", options->ahead_s,
                   "For how long after that [s], one slice each, side by side [0]")
      ->delimiter(',')
      ->check(NumberFrom(0.0, 60.0));
  field->add_option("--height", options->height_m, "Of the slice, in the world [m] [0.6]")
      ->check(NumberFrom(-100.0, 100.0));
  field->add_option("--reach", options->reach_m, "Greater distances look alike [m] [0.5]")
      ->check(NumberFrom(0.01, 10.0));
  field->add_option("--knowledge", options->overrides.knowledge, "What the planner is told");
  field->add_option("--predictor", options->overrides.predictor, "How objects are extrapolated");
  field->add_option("--set", options->settings, "KEY=VALUE, as for `sidestep run`")
      ->allow_extra_args(false);
  field->footer(
      "Solids are dark red, what is near them orange, what is far pale; a line for each 0.1 m. "
      "Black\n"
      "outlines are where moving obstacles will truly be.");
  field->callback([&line, options] { line.exit_code = DrawField(*options); });
}

}  // namespace sidestep::cli
