#pragma once

#include <functional>
#include <string>

namespace sidestep::import {

/// Runs `work` in a process of its own, and returns what it returned. So libraries that crash, loop
/// or grab memory on a damaged file end that process alone: it may take a minute of CPU time, and
/// 8 GiB. It must neither start threads nor write anything.
/// @throws std::runtime_error, one line: the message of what `work` threw, or what became of it
/// ("crashes", ...).
std::string RunIsolated(const std::function<std::string()>& work);

}  // namespace sidestep::import
