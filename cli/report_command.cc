#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sidestep/bench/database/run_database.h"
#include "sidestep/bench/report/gnuplot.h"
#include "sidestep/bench/report/svg.h"
#include "sidestep/bench/report/sweep_report.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/run_traces.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/cli/shell_quote.h"
#include "sidestep/cli/trace_files.h"
#include "sidestep/cli/trace_replay.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"

namespace sidestep::cli {
namespace {

struct ReportOptions {
  std::string database, out = "report.html", over, figures;
  std::vector<std::string> compare, models;
  int replays = 1;
};

// The runs of pairs that tell most and whose traces are kept, side by side.
bench::ReportReplays MakeReplays(const bench::RunDatabase& database,
                                 const bench::ReportSource& source, const ReportOptions& options) {
  bench::ReportReplays replays;
  if (options.replays == 0) return replays;
  const RunTraces traces(database, options.database);
  const bench::RunTable& runs = source.runs();
  for (const auto& [of, with] : source.TellingPairs()) {
    if (static_cast<int>(replays.replays.size()) == options.replays) break;
    std::vector<std::string> paths, titles;
    for (const std::size_t run : {of, with}) {
      const std::optional<std::string> path = traces.Find(runs.id[run]);
      if (!path) continue;
      const auto factor = static_cast<std::size_t>(source.question().factor);
      paths.push_back(*path);
      titles.push_back(
          runs.factors[factor].values[static_cast<std::size_t>(runs.levels[factor][run])]);
    }
    if (paths.empty()) continue;
    ReplayOptions replay;
    replay.titles = titles;
    std::optional<render::ReplaySet> set;
    try {
      set = MakeReplaySet(ReadTraces(paths), FindDataPaths(options.models), replay);
    } catch (const InputError& error) {  // the figures do not need it
      PrintError("no replay: {}\n", error.what());
      continue;
    }
    std::string title = "seed " + std::to_string(runs.seed[of]);
    for (std::size_t f = 0; f < runs.factors.size(); ++f) {
      if (static_cast<int>(f) == source.question().factor) continue;
      title += ", " + runs.factors[f].name + " " +
               runs.factors[f].values[static_cast<std::size_t>(runs.levels[f][of])];
    }
    replays.replays.push_back({title, render::ReplayJson(*set)});
  }
  if (!replays.replays.empty()) {
    replays.style = render::ReplayStyle();
    replays.scripts = render::ReplayScripts();
  }
  return replays;
}

void WriteFigures(const std::vector<bench::ReportFigure>& figures, const std::string& folder) {
  bool are_drawn = true;
  for (const auto& [name, panel] : figures) {
    const std::string stem = folder + "/" + name;
    are_drawn = bench::DrawFigure({{panel}}, stem) && are_drawn;
    WriteFile(stem + ".svg", bench::ToSvg(panel, bench::SvgPlace::kFile));
  }
  if (!are_drawn) {
    Print("not drawn: {}/*.png: gnuplot is missing or failed ({})\n", folder,
          bench::kGnuplotRemedy);
  }
  Print("written  {}/: {} figures\n", folder, figures.size());
}

int Report(const ReportOptions& options) {
  CheckCanWrite(options.out);
  std::error_code error;
  if (std::filesystem::equivalent(options.out, options.database, error)) {
    throw InputError(options.out, "is the database, it must not be written over");
  }
  if (!options.figures.empty()) MakeOutFolder(options.figures, {});
  const bench::RunDatabase database(options.database);
  if (database.num_runs() == 0) throw InputError(options.database, "holds no runs");
  bench::ReportRequest request;
  if (!options.compare.empty()) {
    request.factor = options.compare[0];
    request.of = options.compare[1];
    request.with = options.compare[2];
  }
  request.over = options.over;
  request.database = ShellQuoted(options.database);
  const std::string folder = std::filesystem::path(options.database).parent_path().string();
  if (!folder.empty()) request.folder = ShellQuoted(folder + "/");
  const bench::ReportSource source(database, request);
  const bench::SweepReport report = source.Make(MakeReplays(database, source, options));
  WriteFile(options.out, report.html);
  if (!options.figures.empty()) WriteFigures(report.figures, options.figures);
  Print("{}\n\nwritten  {}: {:.1f} MB; open it in a browser\n", report.answer, options.out,
        static_cast<double>(report.html.size()) / 1e6);
  return 0;
}

}  // namespace

void AddReportCommand(CommandLine& line) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* const report = line.app.add_subcommand(
      "report", "Make a page of a sweep's results: what was asked, in a sentence and in figures");
  report->add_option("DB", options->database, "results.db of `sidestep sweep`")->required();
  report->add_option("--out", options->out, "The page to write, one file that needs no network")
      ->capture_default_str();
  report
      ->add_option("--compare", options->compare,
                   "FACTOR VALUE VALUE: what is compared first [what the sweep asks]")
      ->expected(3);
  report->add_option("--over", options->over,
                     "FACTOR along which the comparison is shown [the one with most values]");
  report->add_option("--figures", options->figures,
                     "A folder for every figure as a file of its own, SVG and PNG");
  report
      ->add_option("--replays", options->replays,
                   "So many pairs of runs are replayed in the page, if their traces are kept")
      ->check(NumberFrom(0, 20))
      ->capture_default_str();
  AddModels(*report, options->models);
  report->footer(
      "Runs are compared in pairs that agree in everything but FACTOR, the seed included. The "
      "page\n"
      "also shows the rate over everything that was varied, distributions of clearance and cycle\n"
      "times, the latency that was charged and needed, every failure with the command that runs "
      "it\n"
      "again, and where it all comes from. PNG files need gnuplot.");
  report->callback([&line, options] { line.exit_code = Report(*options); });
}

}  // namespace sidestep::cli
