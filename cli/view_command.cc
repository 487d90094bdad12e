#include <memory>
#include <string>
#include <vector>

#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/data_paths.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/scenario_options.h"
#include "sidestep/cli/trace_files.h"
#include "sidestep/cli/trace_replay.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/render/replay/page.h"

namespace sidestep::cli {
namespace {

struct ViewOptions {
  std::vector<std::string> traces, models;
  std::string out = "view.html";
  ReplayOptions replay;
};

int View(const ViewOptions& options) {
  CheckIsNoTrace(options.out, options.traces);
  CheckCanWrite(options.out);
  const std::vector<render::NamedRecording> traces = ReadTraces(options.traces);
  const render::ReplaySet set =
      MakeReplaySet(traces, FindDataPaths(options.models), options.replay);
  const auto& header = traces.front().recording.header;
  const auto scenario = header.find("scenario");
  const std::string page =
      render::ReplayPage(scenario == header.end() ? traces.front().name : scenario->second, set);
  WriteFile(options.out, page);
  Print("written  {}: {} trace{}, {:.1f} MB; open it in a browser\n", options.out, traces.size(),
        traces.size() == 1 ? "" : "s", static_cast<double>(page.size()) / 1e6);
  return 0;
}

}  // namespace

void AddViewCommand(CommandLine& line) {
  auto options = std::make_shared<ViewOptions>();
  CLI::App* const view = line.app.add_subcommand(
      "view", "Make a page that replays traces in 3-D in a browser, side by side and in step");
  view->add_option("TRACE", options->traces, "trace.h5 of `sidestep run`, one or more")->required();
  view->add_option("--out", options->out, "The page to write, one file that needs no network")
      ->capture_default_str();
  view->add_option("--title", options->replay.titles,
                   "A title for each trace [what its planner was told]");
  view->add_option("--field-points", options->replay.field_points,
                   "Points of the planner's field along the workspace's longest side; 0: none")
      ->check(NumberFrom(0, 256))
      ->capture_default_str();
  AddModels(*view, options->models);
  view->footer(
      "The page shows the robot and what moves, the path so far and the plan, where the obstacle\n"
      "was expected, the planner's spheres and a slice of its field, and below them clearance and\n"
      "contact over time. Space plays, the arrows step, dragging turns the view; the page lists "
      "all\n"
      "keys. FILE#t=1.2&show=field,spheres&theme=dark opens it at a moment. The spheres and the\n"
      "field are worked out anew and need the robot's files as they were (--models).");
  view->callback([&line, options] { line.exit_code = View(*options); });
}

}  // namespace sidestep::cli
