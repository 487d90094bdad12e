#pragma once

#include <string>

#include "sidestep/bench/report/figure.h"

namespace sidestep::bench {

/// The version of the gnuplot that pictures are drawn with, e.g. "gnuplot 5.4 patchlevel 4"; empty
/// if there is none.
std::string GnuplotVersion();

/// How to get it, for messages.
inline constexpr const char* kGnuplotRemedy = "apt-get install gnuplot-nox";

/// Draws `stem`.svg and `stem`.png and leaves the script beside them, `stem`.gp, so that they can
/// be drawn again or otherwise.
/// @return whether it was drawn: false if gnuplot is absent or failed, and then only the script is
/// there. @throws InputError if that cannot be written.
bool DrawFigure(const Figure& figure, const std::string& stem);

}  // namespace sidestep::bench
