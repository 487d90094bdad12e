#pragma once

#include <functional>
#include <optional>
#include <string>

#include "sidestep/core/time.h"
#include "sidestep/render/comparison.h"

namespace sidestep::render {

/// Whether to go on after `done` of `total` frames.
using RenderProgress = std::function<bool(int done, int total)>;

struct VideoOptions {
  int frames_per_second = 30;
  double playback_speed = 1;  ///< seconds of the episode a second of video, > 0
};

/// Films a comparison from its beginning to its end and one second of rest, in step with the
/// episodes' clock. @return the number of frames; fewer than planned if `progress` said stop, and
/// then no file is left. @throws InputError as VideoWriter does, and for a speed that is not > 0.
int RenderVideo(Comparison& comparison, const std::string& path, const VideoOptions& options,
                const RenderProgress& progress);

/// Writes one picture as PNG: at `t`, or at the moment that tells most. @throws InputError as
/// WritePng does, and for a moment after the end of the last episode.
void RenderStill(Comparison& comparison, const std::string& path, std::optional<EpisodeTime> t);

}  // namespace sidestep::render
