#pragma once

#include <functional>
#include <stdexcept>
#include <string>

#include "sidestep/core/input_error.h"

namespace sidestep::imports {

/// Runs `work` in a process of its own, and returns what it returned. So libraries that crash, loop
/// or grab memory on a damaged file end that process alone: it may take a minute of CPU time, and
/// 8 GiB. It must neither start threads nor write anything.
/// @throws std::runtime_error, one line: the message of what `work` threw, or what became of it
/// ("crashes", ...).
std::string RunIsolated(const std::function<std::string()>& work);

/// What RunIsolated threw, told of a file: as it is where it begins with the file's place.
InputError AsInputError(const std::string& path, const std::runtime_error& error);

}  // namespace sidestep::imports
