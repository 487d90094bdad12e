#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sidestep/bench/episode.h"
#include "sidestep/bench/field_audit.h"
#include "sidestep/bench/json_text.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/heat_slice.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/cli/thin_things.h"
#include "sidestep/cli/wiring.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/render/font.h"
#include "sidestep/render/gl_context.h"
#include "sidestep/render/video_writer.h"
#include "sidestep/sdf/map/nrrd_file.h"

namespace sidestep::cli {
namespace {

struct AuditOptions {
  ScenarioOptions scenario;
  std::vector<double> ahead_s = {0, 0.5, 1, 2};
  int num_points = 20000;
  std::string out;
  bool json = false;
};

OccupancyGrid TrueOccupancy(const sdf::SdfGrid& truth_W) {
  OccupancyGrid occupancy(truth_W.spec());
  std::transform(truth_W.distance_m().begin(), truth_W.distance_m().end(), occupancy.cells.begin(),
                 [](float distance_m) { return distance_m < 0 ? 1 : 0; });
  return occupancy;
}

sdf::SdfGrid Difference(const bench::AuditGrids& grids) {
  sdf::AlignedVector<float> difference_m = grids.field_W.distance_m();
  for (std::size_t n = 0; n < difference_m.size(); ++n) {
    difference_m[n] -= grids.truth_W.distance_m()[n];
  }
  return sdf::SdfGrid(grids.field_W.spec(), std::move(difference_m));
}

void PrintRows(const std::vector<bench::AuditRow>& rows) {
  Print(
      "                         error, mm                          gradient off by, degrees\n"
      "ahead s  zone      points  median     p99     max too far    median    p99    max\n");
  for (const bench::AuditRow& row : rows) {
    Print("{:7.2f}  {:<7} {:8} {:7.2f} {:7.2f} {:7.2f} {:7.2f}", row.ahead_s, ToString(row.zone),
          row.num_points, 1e3 * row.median_m, 1e3 * row.p99_m, 1e3 * row.max_m,
          1e3 * row.too_far_max_m);
    if (!std::isnan(row.gradient_median_deg)) {
      Print("   {:7.2f} {:6.2f} {:6.2f}", row.gradient_median_deg, row.gradient_p99_deg,
            row.gradient_max_deg);
    }
    Print("\n");
  }
}

// What the picture shows, in two lines.
std::vector<std::string> PictureTitle(const scenarios::Scenario& scenario,
                                      const bench::AuditPlace& worst) {
  return {fmt::format("{}: |field - truth| at z = {:.2f} m", scenario.name, worst.p_W.z()),
          fmt::format("knowledge: {}; made at {:.2f} s, asked about {:.2f} s", scenario.knowledge,
                      worst.t_cycle.seconds(), worst.t.seconds())};
}

std::string Json(const std::vector<bench::AuditRow>& rows, const bench::AuditPlace& worst) {
  nlohmann::ordered_json json;
  for (const bench::AuditRow& row : rows) {
    nlohmann::ordered_json entry = {{"ahead_s", row.ahead_s},
                                    {"zone", ToString(row.zone)},
                                    {"points", row.num_points},
                                    {"median_m", row.median_m},
                                    {"p99_m", row.p99_m},
                                    {"max_m", row.max_m},
                                    {"too_far_max_m", row.too_far_max_m}};
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
  return bench::JsonText(json);
}

int Audit(const AuditOptions& options) {
  const DataPaths paths = FindDataPaths(options.scenario.models);
  const Problem problem =
      LoadProblem(options.scenario.scenario, ParseOverrides(options.scenario), paths);
  WarnOfThinThings(problem.scenario);
  const OutFolder folder(
      options.out.empty() ? "out/" + problem.scenario.name + "/audit" : options.out,
      {"slice.png", "field.nrrd", "truth.nrrd", "difference.nrrd", "occupancy.nrrd", "audit.json"});

  const std::string& out = folder.path();
  bench::FieldAudit audit(problem.scenario, options.ahead_s, options.num_points);
  int num_cycles = 0;
  bench::EpisodeOptions episode;
  episode.observe_field = [&](EpisodeTime t, const std::shared_ptr<const sdf::DistanceField>& field,
                              const robot::WorldTruth* truth) {
    audit.Look(t, *field, *truth);
    ++num_cycles;
  };
  const bench::EpisodeResult result =
      bench::RunEpisode(problem.scenario, problem.robot, SimulatedWorlds(paths), episode);
  bench::RequireWhole(result);
  if (num_cycles == 0) {
    PrintError("audit: the episode had no planning cycle: {}\n", result.reason);
    return 1;
  }

  const std::vector<bench::AuditRow> rows = audit.Rows();
  const bench::AuditPlace& worst = audit.worst();
  const bench::AuditGrids& grids = audit.worst_grids();
  const render::GlContext gl;  // has the letters
  render::WritePng(
      DrawHeatSlice(grids, worst.p_W, PictureTitle(problem.scenario, worst), render::Font(gl)),
      out + "/slice.png");
  sdf::WriteNrrd(grids.field_W, out + "/field.nrrd");
  sdf::WriteNrrd(grids.truth_W, out + "/truth.nrrd");
  sdf::WriteNrrd(Difference(grids), out + "/difference.nrrd");
  sdf::WriteNrrd(TrueOccupancy(grids.truth_W), out + "/occupancy.nrrd");
  const std::string json = Json(rows, worst);
  WriteFile(out + "/audit.json", json);
  if (options.json) {
    PrintText(json);
    return 0;
  }
  Print("{} planning cycles, {} points each, knowledge: {}\n", num_cycles, options.num_points,
        problem.scenario.knowledge);
  PrintRows(rows);
  if (worst.field_m == worst.truth_m) {
    Print("no point in free space was wrong\n");
  } else {
    Print(
        "most wrong in free space: {:.1f} mm instead of {:.1f} mm at ({:.3f}, {:.3f}, {:.3f}) m; "
        "field made at {:.2f} s, asked about {:.2f} s\n",
        1e3 * worst.field_m, 1e3 * worst.truth_m, worst.p_W.x(), worst.p_W.y(), worst.p_W.z(),
        worst.t_cycle.seconds(), worst.t.seconds());
  }
  Print(
      "written: {}/{{audit.json, slice.png, field.nrrd, truth.nrrd, difference.nrrd, "
      "occupancy.nrrd}}\n",
      out);
  return 0;
}

}  // namespace

void AddAuditCommand(CommandLine& line) {
  auto options = std::make_shared<AuditOptions>();
  CLI::App* const audit = line.app.add_subcommand(
      "audit", "Run one episode; compare the fields that the planner saw with the true geometry");
  AddScenarioOptions(*audit, options->scenario);
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
  audit->footer(
      "The error is |field - min(truth, clamp)|: the clamp is the planner's safety margin plus "
      "its\n"
      "largest sphere; `too far` is the most by which the field said more than that. Zones, by the "
      "true distance d:\n"
      "  inside  d < 0                          near  0 <= d < 1.75 cells\n"
      "  margin  from there to clamp - 1 cell   edge  from there to the clamp\n"
      "  beyond  d > clamp: the field should answer its clamp\n"
      "Fields and truth of the most wrong place outside solids are written as NRRD, which "
      "ParaView\n"
      "and Python read, and as a heat picture of one layer, slice.png.");
  audit->callback([&line, options] { line.exit_code = Audit(*options); });
}

}  // namespace sidestep::cli
