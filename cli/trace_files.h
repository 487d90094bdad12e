#pragma once

#include <string>
#include <vector>

#include "sidestep/render/comparison.h"

namespace sidestep::cli {

/// Reads traces, named by their files. @throws InputError; of a run that was killed it says how to
/// make a trace of what there is.
std::vector<render::NamedRecording> ReadTraces(const std::vector<std::string>& paths);

/// @throws InputError if a file that is to be written is one of the traces that are read.
void CheckIsNoTrace(const std::string& output, const std::vector<std::string>& traces);

}  // namespace sidestep::cli
