#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/bench/database/run_choice.h"
#include "sidestep/bench/database/run_database.h"
#include "sidestep/cli/command.h"
#include "sidestep/cli/console.h"
#include "sidestep/cli/number_range.h"
#include "sidestep/cli/out_folder.h"
#include "sidestep/cli/run_traces.h"
#include "sidestep/cli/trace_files.h"
#include "sidestep/core/atomic_file.h"
#include "sidestep/core/input_error.h"
#include "sidestep/record/recording_file.h"
#include "sidestep/render/comparison.h"
#include "sidestep/render/gl_context.h"
#include "sidestep/render/video.h"
#include "sidestep/render/video_writer.h"

namespace sidestep::cli {
namespace {

struct RenderOptions {
  std::vector<std::string> traces;
  std::string database;  // whose runs are filmed instead
  bench::RunChoice choice;
  bool alone = false;
  std::string video, still;
  std::optional<double> at_s;
  std::string size = "1280x720";
  int frames_per_second = 30;
  double playback_speed = 1;
  std::string camera;
  std::vector<std::string> titles;
};

volatile std::sig_atomic_t interrupted = 0;  // the one thing a signal handler may touch

// While it lives, Ctrl-C only sets `interrupted`.
class InterruptGuard {
 public:
  InterruptGuard() : previous_(std::signal(SIGINT, [](int) { interrupted = 1; })) {}
  ~InterruptGuard() { std::signal(SIGINT, previous_); }
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

 private:
  void (*previous_)(int);
};

void ParseSize(const std::string& text, render::PictureOptions* picture) {
  int used = 0;
  const bool parsed =
      std::sscanf(text.c_str(), "%dx%d%n", &picture->width, &picture->height, &used) == 2 &&
      static_cast<std::size_t>(used) == text.size();
  constexpr int kMaxPixels = 7680;
  if (!parsed || picture->width < 2 || picture->height < 2 || picture->width > kMaxPixels ||
      picture->height > kMaxPixels) {
    throw InputError("--size", "must be WIDTHxHEIGHT in pixels, each 2 to 7680, is '" + text + "'");
  }
}

// Before anything is drawn.
void CheckOutputs(const RenderOptions& options, const render::PictureOptions& picture) {
  if (!options.video.empty()) {
    render::CheckVideoName(options.video);
    if (picture.width % 2 != 0 || picture.height % 2 != 0) {
      throw InputError("--size",
                       "a video's width and height must be even, is '" + options.size + "'");
    }
    CheckIsNoTrace(options.video, options.traces);
    CheckCanWrite(options.video);
  }
  if (!options.still.empty()) {
    render::CheckPngName(options.still);
    CheckIsNoTrace(options.still, options.traces);
    CheckCanWrite(options.still);
  }
}

bool ShowProgress(int done, int total) {
  if (isatty(STDERR_FILENO) != 0) {
    constexpr int kWidth = 40;
    const int filled = kWidth * done / total;
    PrintError("\r[{}{}] {} of {} frames{}", std::string(filled, '#'),
               std::string(kWidth - filled, '.'), done, total, done == total ? "\n" : "");
  } else if (done % std::max(1, total / 4) == 0 && done < total) {
    PrintError("rendered {} of {} frames\n", done, total);
  }
  return interrupted == 0;
}

// What is asked for, if it can be made. @throws InputError.
render::PictureOptions PictureOf(const RenderOptions& options) {
  if (options.video.empty() && options.still.empty()) {
    throw InputError("--out", "give --out FILE.mp4, --still FILE.png, or both");
  }
  if (options.at_s && options.still.empty()) throw InputError("--at", "needs --still");
  render::PictureOptions picture;
  ParseSize(options.size, &picture);
  CheckOutputs(options, picture);
  picture.camera = options.camera;
  picture.titles = options.titles;
  picture.playback_speed = options.playback_speed;
  return picture;
}

int RenderTraces(const RenderOptions& options, const render::PictureOptions& picture,
                 const std::vector<render::NamedRecording>& traces) {
  const render::GlContext gl;
  render::Comparison comparison(gl, traces, picture);
  for (const std::string& name : comparison.names_not_shown()) {
    PrintError("'{}': pictures have no letters but ASCII's; others show as '?'\n", name);
  }
  if (!options.still.empty()) {
    render::RenderStill(comparison, options.still,
                        options.at_s ? std::optional(EpisodeTime(*options.at_s)) : std::nullopt);
    Print("written  {}\n", options.still);
  }
  if (options.video.empty()) return 0;

  const InterruptGuard guard;
  const auto begin = std::chrono::steady_clock::now();
  const int frames = render::RenderVideo(
      comparison, options.video, {options.frames_per_second, options.playback_speed}, ShowProgress);
  if (interrupted != 0) {
    PrintError("\nstopped; {} was not written\n", options.video);
    return 1;
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
  Print("written  {}: {} frames, {:.1f} frames/s, {}\n", options.video, frames,
        frames / elapsed.count(), gl.renderer());
  return 0;
}

// Those of a chosen run and of the one beside it, as far as they are kept.
RenderOptions TracesOf(const bench::ChosenRun& run, const RunTraces& traces,
                       const RenderOptions& options) {
  RenderOptions film = options;
  const auto add = [&](std::int64_t id, const std::string& name, const std::string& command) {
    if (const std::optional<std::string> trace = traces.Find(id)) {
      film.traces.push_back(*trace);
      film.titles.push_back(name.empty() ? "run " + std::to_string(id) : name);
    } else {
      PrintError("run {} has no trace{}\n", id,
                 command.empty() ? "" : "; it is made again by: " + command);
    }
  };
  add(run.id, run.name, run.command);
  if (run.beside_id && !options.alone) add(*run.beside_id, run.beside_name, run.beside_command);
  return film;
}

// Of every chosen run a film of its own, in the folder that --out names.
int RenderChosen(const RenderOptions& options) {
  if (!options.traces.empty())
    throw InputError("--from", "films runs of a database: give no TRACE");
  if (!options.still.empty() || !options.titles.empty()) {
    throw InputError("--from", "makes one video a run, without --still and --title");
  }
  if (options.video.empty()) throw InputError("--out", "give a folder for the videos");
  const bench::RunDatabase database(options.database);
  const std::vector<bench::ChosenRun> runs = bench::ChooseRuns(database, options.choice);
  if (runs.empty()) throw InputError("--where", "no run of " + options.database + " is like that");
  const std::string folder = MakeOutFolder(options.video, {});
  const RunTraces traces(database, options.database);
  int num_films = 0;
  bool is_one_damaged = false;
  for (const bench::ChosenRun& run : runs) {
    RenderOptions film = TracesOf(run, traces, options);
    if (film.traces.empty()) continue;
    film.video = folder + "/run-" + std::to_string(run.id) + ".mp4";
    Print("run {}: {}\n", run.id, run.what);
    const render::PictureOptions picture = PictureOf(film);
    std::vector<render::NamedRecording> recordings;
    try {
      recordings = ReadTraces(film.traces);
    } catch (const InputError& error) {  // the other films do not need it
      PrintError("{}\n", error.what());
      is_one_damaged = true;
      continue;
    }
    if (RenderTraces(film, picture, recordings) != 0) return 1;
    ++num_films;
  }
  if (is_one_damaged) return 1;
  if (num_films > 0) return 0;
  PrintError("no trace of these runs is kept (a sweep keeps them with `traces: all`)\n");
  return 1;
}

int Render(const RenderOptions& options) {
  if (!options.database.empty()) return RenderChosen(options);
  if (options.traces.empty()) throw InputError("TRACE", "give one or more traces, or --from DB");
  const render::PictureOptions picture = PictureOf(options);
  return RenderTraces(options, picture, ReadTraces(options.traces));
}

}  // namespace

void AddRenderCommand(CommandLine& line) {
  auto options = std::make_shared<RenderOptions>();
  CLI::App* const render = line.app.add_subcommand(
      "render", "Film one or more traces side by side, without a display; or draw a still");
  render->add_option("TRACE", options->traces, "trace.h5 of `sidestep run`, one or more");
  render->add_option("--out", options->video,
                     "The video to write, FILE.mp4; with --from a folder for them");
  render->add_option("--still", options->still, "A picture to write, FILE.png");
  render
      ->add_option("--at", options->at_s,
                   "The still's moment [s], not after the end [the first contact, else the least "
                   "clearance]")
      ->check(NumberFrom(0.0, 1e6));
  render->add_option("--size", options->size,
                     "WIDTHxHEIGHT of the whole picture, even for a video [1280x720]");
  render->add_option("--fps", options->frames_per_second, "Frames a second of video [30]")
      ->check(NumberFrom(1, 240));
  render->add_option("--speed", options->playback_speed, "Playback speed, 0.5 is half [1]")
      ->check(NumberFrom(0.001, 1000.0));
  render->add_option("--camera", options->camera, "A camera of the model [chosen to fit]");
  render->add_option("--title", options->titles,
                     "A title for each trace [what its planner was told]");
  CLI::Option* const from =
      render->add_option("--from", options->database,
                         "results.db of `sidestep sweep`, whose runs are filmed, each beside the\n"
                         "same case under the other value of what the sweep asks");
  render
      ->add_option("--where", options->choice.where,
                   "Which runs: an SQL expression over the columns of `results` [all]")
      ->needs(from);
  render
      ->add_option("--order", options->choice.order,
                   "Which first: terms of SQL's ORDER BY [min_clearance_m]")
      ->needs(from);
  render->add_option("--top", options->choice.top, "At most so many runs [4]")
      ->needs(from)
      ->check(NumberFrom(1, 1000));
  render->add_flag("--alone", options->alone, "Only the runs themselves, nothing beside them")
      ->needs(from);
  render->footer(
      "Of the run beside, columns are called beside_COLUMN. So the largest paired difference is\n"
      "  sidestep render --from DB --order 'abs(min_clearance_m - beside_min_clearance_m) DESC' "
      "--top 1 --out DIR\n"
      "and every collision that the other one does not have\n"
      "  sidestep render --from DB --where \"outcome = 'collision' AND beside_outcome = 'goal'\" "
      "--top 100 --out DIR\n"
      "Films are made of kept traces alone (`traces: all` or `failures` in the sweep's file).");
  render->callback([&line, options] { line.exit_code = Render(*options); });
}

}  // namespace sidestep::cli
