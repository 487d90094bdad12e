#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

namespace sidestep::cli {

/// The manual of the whole command line: for the program and for each of its commands one page in
/// roff, by file name (`sidestep.1`, `sidestep-run.1`, ...). A command of a command has a section
/// in its parent's page. Made from the same objects that `--help` prints, so the two cannot differ.
/// Hidden commands (of no group) are left out.
std::map<std::string, std::string> ManPages(const CLI::App& program, const std::string& version);

}  // namespace sidestep::cli
