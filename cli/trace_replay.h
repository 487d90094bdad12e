#pragma once

#include <string>
#include <vector>

#include "sidestep/cli/data_paths.h"
#include "sidestep/render/comparison.h"
#include "sidestep/render/replay/page.h"

namespace sidestep::cli {

struct ReplayOptions {
  std::vector<std::string> titles;  ///< one a trace, or none: what its planner was told
  int field_points = 48;            ///< of the planner's field along the workspace's longest side
};

/// What a page shows of these traces. The planner's spheres and its field need the robot's own
/// files, as they were at the run; where they are not there, the replay says so.
/// @throws InputError for a trace with nothing to draw, or a wrong number of titles.
render::ReplaySet MakeReplaySet(const std::vector<render::NamedRecording>& traces,
                                const DataPaths& paths, const ReplayOptions& options);

}  // namespace sidestep::cli
