#pragma once

#include <vector>

#include "sidestep/render/camera.h"
#include "sidestep/render/trace_model.h"

namespace sidestep::render {

/// Chooses one view for all traces, from what they show in their first 3 s: the arms throughout,
/// everything that stands, and each obstacle from 0.7 s before until 0.4 s after it passes. Among
/// views from all around and somewhat above, it takes the one in which the arms stand out most
/// from the obstacles, the motions run across the picture, and everything is large.
/// Moves the traces to other moments.
CameraView ChooseView(const std::vector<TraceModel*>& traces, const Frustum& frustum);

}  // namespace sidestep::render
