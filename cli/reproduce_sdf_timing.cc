#include <memory>
#include <optional>
#include <string>

#include "sidestep/bench/reproduce/published_columns.h"
#include "sidestep/bench/reproduce/sdf_timing.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/option_lists.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/reproduce.h"
#include "sidestep/core/atomic_file.h"

namespace sidestep::cli {
namespace {

struct SdfTimingCommand {
  bench::SdfTimingOptions options;
  std::string published, out = "out/sdf_timing";
};

// Every prediction needs three grids of floats: 512 voxels a side are 1.6 GB.
constexpr int kMostVoxels = 512;

int Run(const SdfTimingCommand& command) {
  CheckWords("--scenes", command.options.scenes, bench::FieldSceneNames());
  const std::optional<bench::CsvTable> published =
      ReadPublished(command.published, {bench::kVoxelsColumn});
  const std::string out = MakeOutFolder(command.out, {"rows.csv", "figure.gp", "index.html"});

  const std::size_t num_sizes = command.options.voxels_per_side.size();
  const bench::CsvTable table = bench::MakeSdfTimingTable(
      bench::RunSdfTiming(command.options, FindDataPaths().scenarios,
                          [&](int done) { PrintError("{} of {} sizes\n", done, num_sizes); }));
  WriteFile(out + "/rows.csv", table.ToText());
  Print("{}written: {}/rows.csv\n", bench::DescribeSdfTiming(table, published), out);
  const std::string svg = DrawInto(out, "figure", bench::MakeSdfTimingFigure(table, published));
  WriteFile(out + "/index.html", bench::MakeSdfTimingPage(command.options, table, published, svg));
  Print("written: {}/index.html\n", out);
  return 0;
}

}  // namespace

void AddReproduceSdfTiming(CommandLine& line, CLI::App& reproduce) {
  auto options = std::make_shared<SdfTimingCommand>();
  CLI::App* const command = reproduce.add_subcommand(
      "sdf_timing", "Table 1: what a predicted field costs, computed anew or composed");
  command->add_option("--published", options->published, "A CSV file of published means to show");
  command
      ->add_option("--sizes", options->options.voxels_per_side,
                   "Voxels per side, comma-separated [64,96,...,320]")
      ->delimiter(',')
      ->check(NumberFrom(32, kMostVoxels));
  command->add_option("--scenes", options->options.scenes, "Field scenes, comma-separated [all]")
      ->delimiter(',');
  command->add_option("--repeats", options->options.repeats, "How often each is timed [1]")
      ->check(NumberFrom(1, 1000));
  command->add_option("--out", options->out, "Folder for the results [out/sdf_timing]");
  command->callback([&line, options] { line.exit_code = Run(*options); });
}

}  // namespace sidestep::cli
