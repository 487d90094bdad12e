#pragma once

#include <map>
#include <string>

namespace sidestep::cli {

/// What may differ between machines that run one build, of this one: its name, its processor, the
/// libraries.
std::map<std::string, std::string> Machine();
/// The same of the machine of a run, as far as the versions that it tells say it.
std::map<std::string, std::string> MachineIn(std::map<std::string, std::string> versions);

}  // namespace sidestep::cli
