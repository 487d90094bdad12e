#pragma once

#include <string_view>

namespace sidestep::render {

// The files of a replay's page, as they are: Debian's three.js, and those of render/replay/web/.
extern const std::string_view kThreeNoticeJs, kThreeJs, kOrbitControlsJs;
extern const std::string_view kReplayCss, kReplayDataJs, kReplaySceneJs, kReplayChartJs, kReplayJs;
extern const std::string_view kReplayPageHtml;

}  // namespace sidestep::render
