#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "sidestep/bench/report/figure.h"
#include "sidestep/cli/command.h"

namespace sidestep::cli {

/// The experiments of `sidestep reproduce`, a sub-command or two in each file.
void AddReproduceOpenLoop(CommandLine& line, CLI::App& reproduce);
void AddReproduceSdfTiming(CommandLine& line, CLI::App& reproduce);
void AddReproduceClosedLoop(CommandLine& line, CLI::App& reproduce);

/// Draws a figure into the folder and says so; where gnuplot is absent it says what to do.
/// @return the SVG file's path, empty if there is none.
std::string DrawInto(const std::string& folder, const std::string& name,
                     const bench::Figure& figure);

}  // namespace sidestep::cli
