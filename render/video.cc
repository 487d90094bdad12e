#include "sidestep/render/video.h"

#include <cmath>

#include "sidestep/core/input_error.h"
#include "sidestep/core/number_text.h"
#include "sidestep/render/video_writer.h"

namespace sidestep::render {

int RenderVideo(Comparison& comparison, const std::string& path, const VideoOptions& options,
                const RenderProgress& progress) {
  constexpr double kRest_s = 1;
  if (!(options.playback_speed > 0) || !std::isfinite(options.playback_speed)) {
    throw InputError("--speed", "must be > 0");
  }
  VideoWriter video(path, comparison.width(), comparison.height(), options.frames_per_second);
  const double duration_s = comparison.end().seconds() / options.playback_speed + kRest_s;
  const int total = static_cast<int>(std::ceil(duration_s * options.frames_per_second));
  for (int i = 0; i < total; ++i) {
    const double t_s = options.playback_speed * i / options.frames_per_second;
    video.Add(comparison.Draw(EpisodeTime(t_s)));
    if (progress && !progress(i + 1, total)) return i + 1;
  }
  video.Finish();
  return total;
}

void RenderStill(Comparison& comparison, const std::string& path, std::optional<EpisodeTime> t) {
  constexpr double kSample_s = 0.01;  // an episode of 6 s may have its last sample at 5.996 s
  const double end_s = comparison.end().seconds();
  if (t && t->seconds() > end_s + kSample_s) {
    throw InputError("--at", "the last episode ends at " + FiniteText("{:.3f} s", end_s) +
                                 ", before " + FiniteText("{:g} s", t->seconds()));
  }
  WritePng(comparison.Draw(t.value_or(comparison.telling_moment())), path);
}

}  // namespace sidestep::render
