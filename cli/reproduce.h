#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sidestep/bench/report/figure.h"
#include "sidestep/bench/reproduce/csv_table.h"
#include "sidestep/cli/command.h"

namespace sidestep::cli {

/// The experiments of `sidestep reproduce`, a sub-command or two in each file.
void AddReproduceOpenLoop(CommandLine& line, CLI::App& reproduce);
void AddReproduceSdfTiming(CommandLine& line, CLI::App& reproduce);
void AddReproduceClosedLoop(CommandLine& line, CLI::App& reproduce);

/// A published table to show or compare with, which must have these columns; none without a path.
/// @throws InputError.
std::optional<bench::CsvTable> ReadPublished(const std::string& path,
                                             const std::vector<std::string>& columns);

/// Draws a figure into the folder and says so; where gnuplot is absent it says what to do.
/// @return the SVG file's path, empty if there is none.
std::string DrawInto(const std::string& folder, const std::string& name,
                     const bench::Figure& figure);

}  // namespace sidestep::cli
