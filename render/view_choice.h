#pragma once

#include <vector>

#include "render/camera.h"
#include "render/trace_model.h"

namespace sidestep {

/// Chooses one view for all traces, from what they show: the arms throughout, everything that
/// stands, and the obstacles from their start until they have passed, within the first 3 s. Among
/// views from all around and somewhat above, it takes the one in which obstacles hide least of the
/// arms, cross the picture rather than come at it, and everything is large.
/// Moves the traces to other moments.
CameraView ChooseView(const std::vector<TraceModel*>& traces, const Frustum& frustum);

}  // namespace sidestep
