#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace sidestep::cli {

/// A script for bash that completes commands, options, and the names that `sidestep list` knows,
/// made from the same objects that `--help` prints. What it does not know it leaves to file names.
std::string BashCompletion(const CLI::App& program);

}  // namespace sidestep::cli
