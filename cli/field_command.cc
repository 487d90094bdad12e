#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/bench/scan_order.h"
#include "sidestep/bench/sensor_watch.h"
#include "sidestep/bench/true_world.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/cli/slice_axes.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/render/font.h"
#include "sidestep/render/gl_context.h"
#include "sidestep/render/image.h"
#include "sidestep/render/video_writer.h"
#include "sidestep/sdf/world_model.h"

namespace sidestep::cli {
namespace {

struct FieldOptions {
  ScenarioOptions scenario;
  std::string out;
  double time_s = 0.5, height_m = 0.6, reach_m = 0.5;
  std::vector<double> ahead_s = {0};
};

// What a model of the world believes at a time, having seen everything until then, while the robot
// rests.
struct Belief {
  EpisodeTime t;
  std::shared_ptr<const sdf::DistanceField> field;
  sdf::ShapeField moving;  // where that truly will be
};

Belief Watch(const Scene& scene, const FieldOptions& options) {
  const auto model = sdf::MakeWorldModel(
      bench::MakeWorldModelOptions(scene.scenario, options.reach_m, scene.world));
  std::vector<bench::SensorWatch> sensors;
  std::vector<std::string> names;
  for (const robot::NamedSensor& sensor : scene.world.sensors) {
    sensors.emplace_back(sensor, /*has_own_clock=*/false);
    names.push_back(sensor.name);
  }
  bench::ScanOrder order(names);
  bool has_seen = false;
  while (true) {
    EpisodeTime now = order.NextDue();
    for (const bench::SensorWatch& sensor : sensors) now = std::min(now, sensor.NextDue());
    if (now.seconds() > options.time_s) break;
    scene.world.robot->AdvanceTo(now);
    for (bench::SensorWatch& sensor : sensors) {
      if (sensor.NextDue() > now) continue;
      if (std::optional<Scan> scan = sensor.Read(now)) order.Put(*std::move(scan), now);
    }
    for (auto scans = order.Take(now); !scans.empty(); scans = order.Take(now)) {
      model->Observe(scans);
      has_seen = true;
    }
  }
  if (!has_seen) throw InputError("--time", "the sensor has seen nothing until then");
  return {EpisodeTime(options.time_s), model->MakeField(),
          sdf::ShapeField({}, bench::TrueMotions(scene.scenario))};
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
  const int pixels_a_cell = std::max(3, 288 / std::max(grid.size[0], grid.size[1]));
  const double pixel_m = grid.cell_m / pixels_a_cell;
  const int width = grid.size[0] * pixels_a_cell, height = grid.size[1] * pixels_a_cell;
  const auto point = [&](int x, int y) {
    return Eigen::Vector3d(grid.first_center_m.x() - grid.cell_m / 2 + (x + 0.5) * pixel_m,
                           grid.first_center_m.y() - grid.cell_m / 2 + (height - y - 0.5) * pixel_m,
                           height_m);
  };
  const auto is_truly_filled = [&](const Eigen::Vector3d& p_W) {
    return belief.moving.Distance(p_W, t) < 0;
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

// What the colours mean: a bar from solid to far with its ends in metres.
void DrawScale(render::Image& image, int y, double reach_m, const render::Font& font) {
  constexpr int kHeight = 12, kLength = 160;
  double x = font.Draw(image, kPlotLeft, y, kLetters, kInk, "solid ");
  image.Fill({static_cast<int>(x), y + 1, 2 * kHeight, kHeight}, ColorOf(-1, reach_m));
  x = font.Draw(image, x + 2 * kHeight + 12, y, kLetters, kInk, "0 ");
  for (int n = 0; n < kLength; ++n) {
    const double distance_m = reach_m * std::max(n, 1) / (kLength - 1);
    image.Fill({static_cast<int>(x) + n, y + 1, 1, kHeight}, ColorOf(distance_m, reach_m));
  }
  image.Outline({static_cast<int>(x), y + 1, kLength, kHeight}, kInk, 1);
  font.Draw(image, x + kLength, y, kLetters, kInk, fmt::format(" {:g} m or more", reach_m));
}

void CheckHeight(double height_m, const GridSpec& grid) {
  const double low_m = grid.first_center_m.z() - grid.cell_m / 2;
  const double high_m = low_m + grid.cell_m * grid.size[2];
  if (height_m >= low_m && height_m <= high_m) return;
  throw InputError("--height",
                   fmt::format("must be within the workspace, from {:g} to {:g} m, is {:g}", low_m,
                               high_m, height_m));
}

// Whose belief the picture shows.
std::string TitleOf(const scenarios::Scenario& scenario, double time_s) {
  const bool predicts = scenario.knowledge == ToString(sdf::Knowledge::kPrediction);
  return fmt::format("{}: what {}{} believes, having seen {:g} s", scenario.name,
                     scenario.knowledge, predicts ? " (" + scenario.predictor + ")" : "", time_s);
}

int DrawField(const FieldOptions& options) {
  render::CheckPngName(options.out);
  CheckCanWrite(options.out);
  const Scene scene = LoadScene(options.scenario.scenario, ParseOverrides(options.scenario),
                                FindDataPaths(options.scenario.models));
  const GridSpec& grid = scene.scenario.grid;
  CheckHeight(options.height_m, grid);
  const Belief belief = Watch(scene, options);
  const render::GlContext gl;  // has the letters
  const render::Font font(gl);
  std::vector<render::Image> slices;
  for (const double ahead_s : options.ahead_s) {
    const EpisodeTime t = belief.t + HorizonOffset(ahead_s);
    const std::string title = fmt::format("{:g} s, z = {:g} m", t.seconds(), options.height_m);
    slices.push_back(
        WithAxes(Slice(belief, grid, t, options.height_m), ExtentOf(grid), title, font));
  }
  constexpr int kScale = 26, kHead = 22;
  const int width = slices.front().width(), height = slices.front().height();
  render::Image image(std::max(width * static_cast<int>(slices.size()), 400),
                      kHead + height + kScale);
  image.Fill({0, 0, image.width(), image.height()}, kPaper);
  font.Draw(image, kPlotLeft, 4, kLetters, kInk, TitleOf(scene.scenario, options.time_s));
  for (std::size_t i = 0; i < slices.size(); ++i) {
    image.Paste(slices[i], width * static_cast<int>(i), kHead);
  }
  DrawScale(image, kHead + height + 4, options.reach_m, font);
  render::WritePng(image, options.out);
  Print("written  {}\n", options.out);
  return 0;
}

}  // namespace

void AddFieldCommand(CommandLine& line) {
  auto options = std::make_shared<FieldOptions>();
  CLI::App* const field = line.app.add_subcommand(
      "field", "Draw a level slice of the distances that a planner would believe in");
  AddScenarioOptions(*field, options->scenario);
  field->add_option("--out", options->out, "The picture to write, FILE.png")->required();
  field->add_option("--time", options->time_s, "When the world was last seen [s] [0.5]")
      ->check(NumberFrom(0.0, 60.0));
  field
      ->add_option("--ahead", options->ahead_s,
                   "For how long after that [s], one slice each, side by side [0]")
      ->delimiter(',')
      ->check(NumberFrom(0.0, 60.0));
  field->add_option("--height", options->height_m, "Of the slice, within the workspace [m] [0.6]")
      ->check(NumberFrom(-1e12, 1e12));
  field->add_option("--reach", options->reach_m, "Greater distances look alike [m] [0.5]")
      ->check(NumberFrom(0.01, 10.0));
  field->footer(
      "Solids are dark red, what is near them orange, what is far pale; a line for each 0.1 m. "
      "Black\n"
      "outlines are where moving obstacles will truly be. Axes in metres, x to the right, y up.");
  field->callback([&line, options] { line.exit_code = DrawField(*options); });
}

}  // namespace sidestep::cli
