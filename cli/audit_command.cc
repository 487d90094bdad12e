#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/episode.h"
#include "bench/field_audit.h"
#include "bench/result_file.h"
#include "cli/command.h"
#include "cli/number_range.h"
#include "cli/wiring.h"
#include "core/input_error.h"
#include "render/image.h"
#include "render/video_writer.h"
#include "sdf/map/nrrd_file.h"

namespace sidestep {
namespace {

struct AuditOptions {
  std::string scenario;
  Overrides overrides;
  std::vector<double> ahead_s = {0, 0.5, 1, 2};
  int num_points = 20000;
  std::string out;
  bool json = false;
};

// Black, red, yellow, white, as iron when it is heated; u from 0 to 1.
Color Heat(double u) {
  const auto channel = [](double x) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0, 1.0)));
  };
  return {channel(3 * u), channel(3 * u - 1), channel(3 * u - 2)};
}

// The error in the horizontal layer of cells of a place, seen from above, +y upwards; solids in
// grey, the place in a green frame.
Image HeatSlice(const AuditGrids& grids, const Eigen::Vector3d& p_W) {
  constexpr int kPixels = 6;  // a cell
  constexpr Color kSolid{110, 110, 120}, kPlace{60, 255, 60};
  const GridSpec& grid = grids.field_W.spec();
  const auto [nx, ny, nz] = grid.size;
  const auto [pi, pj, pk] = grid.CellOf(p_W);
  const int k = std::clamp(pk, 0, nz - 1);
  const auto error_m = [&](int i, int j) {
    return std::abs(grids.field_W.At(i, j, k) - grids.truth_W.At(i, j, k));
  };
  float largest_m = 1e-6F;
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      if (grids.truth_W.At(i, j, k) >= 0) largest_m = std::max(largest_m, error_m(i, j));
    }
  }
  Image image(nx * kPixels, ny * kPixels);
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const PixelRect cell{i * kPixels, (ny - 1 - j) * kPixels, kPixels, kPixels};
      const bool solid = grids.truth_W.At(i, j, k) < 0;
      image.Fill(cell, solid ? kSolid : Heat(double{error_m(i, j) / largest_m}));
    }
  }
  image.Outline({(pi - 1) * kPixels, (ny - 2 - pj) * kPixels, 3 * kPixels, 3 * kPixels}, kPlace, 2);
  return image;
}

OccupancyGrid TrueOccupancy(const SdfGrid& truth_W) {
  OccupancyGrid occupancy(truth_W.spec());
  std::transform(truth_W.distance_m().begin(), truth_W.distance_m().end(), occupancy.cells.begin(),
                 [](float distance_m) { return distance_m < 0 ? 1 : 0; });
  return occupancy;
}

SdfGrid Difference(const AuditGrids& grids) {
  AlignedVector<float> difference_m = grids.field_W.distance_m();
  for (std::size_t n = 0; n < difference_m.size(); ++n) {
    difference_m[n] -= grids.truth_W.distance_m()[n];
  }
  return SdfGrid(grids.field_W.spec(), std::move(difference_m));
}

void PrintRows(const std::vector<AuditRow>& rows) {
  std::printf(
      "ahead s  zone       points   error mm: median      p99      max"
      "   gradient deg: median     p99\n");
  for (const AuditRow& row : rows) {
    std::printf("%7.2f  %-7s %9zu %18.2f %8.2f %8.2f", row.ahead_s, ToString(row.zone).c_str(),
                row.num_points, 1e3 * row.median_m, 1e3 * row.p99_m, 1e3 * row.max_m);
    if (!std::isnan(row.gradient_median_deg)) {
      std::printf(" %22.2f %7.2f", row.gradient_median_deg, row.gradient_p99_deg);
    }
    std::printf("\n");
  }
}

std::string Json(const std::vector<AuditRow>& rows, const AuditPlace& worst) {
  nlohmann::ordered_json json;
  for (const AuditRow& row : rows) {
    nlohmann::ordered_json entry = {{"ahead_s", row.ahead_s},   {"zone", ToString(row.zone)},
                                    {"points", row.num_points}, {"median_m", row.median_m},
                                    {"p99_m", row.p99_m},       {"max_m", row.max_m}};
    if (!std::isnan(row.gradient_median_deg)) {
      entry["gradient_median_deg"] = row.gradient_median_deg;
      entry["gradient_p99_deg"] = row.gradient_p99_deg;
      entry["gradient_max_deg"] = row.gradient_max_deg;
    }
    json["errors"].push_back(entry);
  }
  json["worst"] = {{"cycle_s", worst.t_cycle.seconds()},
                   {"t_s", worst.t.seconds()},
                   {"p_W", {worst.p_W.x(), worst.p_W.y(), worst.p_W.z()}},
                   {"field_m", worst.field_m},
                   {"truth_m", worst.truth_m}};
  return json.dump(2) + "\n";
}

int Audit(const AuditOptions& options) {
  const DataPaths paths = FindDataPaths();
  const Problem problem = LoadProblem(options.scenario, options.overrides, paths);
  const std::string out =
      options.out.empty() ? "out/" + problem.scenario.name + "/audit" : options.out;
  std::error_code error;
  std::filesystem::create_directories(out, error);
  if (error || !std::filesystem::is_directory(out)) {
    throw InputError("--out", "'" + out + "' cannot be made a folder");
  }

  FieldAudit audit(problem.scenario, options.ahead_s, options.num_points);
  int num_cycles = 0;
  RunEpisode(
      problem.scenario, problem.robot, SimulatedWorlds(paths),
      [&](EpisodeTime t, std::shared_ptr<const DistanceField> field, const WorldTruth* truth) {
        audit.Look(t, std::move(field), *truth);
        ++num_cycles;
      });
  if (num_cycles == 0) {
    std::fprintf(stderr, "audit: the episode had no planning cycle\n");
    return 1;
  }

  const std::vector<AuditRow> rows = audit.Rows();
  const AuditPlace& worst = audit.worst();
  const AuditGrids grids = audit.WorstGrids();
  WritePng(HeatSlice(grids, worst.p_W), out + "/slice.png");
  WriteNrrd(grids.field_W, out + "/field.nrrd");
  WriteNrrd(grids.truth_W, out + "/truth.nrrd");
  WriteNrrd(Difference(grids), out + "/difference.nrrd");
  WriteNrrd(TrueOccupancy(grids.truth_W), out + "/occupancy.nrrd");
  const std::string json = Json(rows, worst);
  WriteTextFile(out + "/audit.json", json);
  if (options.json) {
    std::fputs(json.c_str(), stdout);
    return 0;
  }
  std::printf("%d planning cycles, %d points each, knowledge: %s\n", num_cycles, options.num_points,
              problem.scenario.knowledge.c_str());
  PrintRows(rows);
  std::printf(
      "worst in free space: %.1f mm instead of %.1f mm at (%.3f, %.3f, %.3f) m, asked at "
      "%.2f s about %.2f s\n",
      1e3 * worst.field_m, 1e3 * worst.truth_m, worst.p_W.x(), worst.p_W.y(), worst.p_W.z(),
      worst.t_cycle.seconds(), worst.t.seconds());
  std::printf(
      "written: %s/{audit.json, slice.png, field.nrrd, truth.nrrd, difference.nrrd, "
      "occupancy.nrrd}\n",
      out.c_str());
  return 0;
}

}  // namespace

void AddAuditCommand(CommandLine& line) {
  auto options = std::make_shared<AuditOptions>();
  CLI::App* const audit = line.app.add_subcommand(
      "audit", "Run one episode; compare the fields that the planner saw with the true geometry");
  Overrides& overrides = options->overrides;
  audit->add_option("SCENARIO", options->scenario, "A name (see `sidestep list`) or a path")
      ->required();
  audit->add_option("--knowledge", overrides.knowledge, "What the planner is told, as for `run`");
  audit->add_option("--predictor", overrides.predictor, "How objects are extrapolated");
  audit->add_option("--speed", overrides.speed_m_s, "Speed of every moving obstacle [m/s]")
      ->check(NumberFrom(0.0, 100.0));
  audit->add_option("--seed", overrides.seed, "Seed of everything random")
      ->check(NumberFrom(0, 2147483647));
  audit
      ->add_option("--ahead", options->ahead_s,
                   "Times after each cycle that the field is asked about [s]")
      ->delimiter(',')
      ->check(NumberFrom(0.0, 60.0))
      ->capture_default_str();
  audit->add_option("--points", options->num_points, "Random points of the grid that are compared")
      ->check(NumberFrom(1, 10000000))
      ->capture_default_str();
  audit->add_option("--out", options->out, "Folder for the results [out/SCENARIO/audit]");
  audit->add_flag("--json", options->json, "Print audit.json instead of the table");
  audit->callback([&line, options] { line.exit_code = Audit(*options); });
}

}  // namespace sidestep
