#pragma once

#include <string>

#include "sidestep/bench/report/figure.h"

namespace sidestep::bench {

/// Where an SVG picture goes.
enum class SvgPlace {
  kPage,  ///< into a page: its letters and lines take the page's colours (--ink, --quiet, --line)
  kFile   ///< a file of its own, black on white
};

/// One panel as SVG. Points tell their values when pointed at. Written by hand, so that equal
/// panels give equal bytes and no program is needed.
/// @throws std::invalid_argument for series whose columns differ in length.
std::string ToSvg(const Panel& panel, SvgPlace place, int width_px = 560, int height_px = 330);

}  // namespace sidestep::bench
