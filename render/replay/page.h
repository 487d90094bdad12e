#pragma once

#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "sidestep/render/camera.h"
#include "sidestep/render/replay/replay.h"

namespace sidestep::render {

/// Replays that are shown together, and from where at first.
struct ReplaySet {
  std::vector<Replay> replays;  ///< at least one
  CameraView view;              ///< fits a picture of 4 to 3, kReplayFieldOfView_rad high
};
inline constexpr double kReplayFieldOfView_rad = 32 * std::numbers::pi / 180;

/// Replays as the browser reads them: JSON that may stand in a page's `<script>`. Arrays of numbers
/// are base64 of little-endian float32.
std::string ReplayJson(const ReplaySet& set);

/// What a page needs once to show replays, for other pages that hold some: a style sheet, and
/// scripts that define `mountReplay(element, data)`.
std::string ReplayStyle();
std::string ReplayScripts();

/// One page that stands alone and shows the replays side by side, in step. Nothing is loaded from
/// anywhere: it works from a file, without a network.
std::string ReplayPage(const std::string& title, const ReplaySet& set);

/// What turns one list of bytes into another of the same length: pieces of {so many bytes stay, so
/// many follow and take the place of those that were there, they themselves}, both counts with
/// seven bits a byte, the least first, and the eighth set in all but the last.
/// @throws std::invalid_argument for two lengths.
std::vector<std::uint8_t> PackChanges(const std::vector<std::uint8_t>& before,
                                      const std::vector<std::uint8_t>& now);

}  // namespace sidestep::render
