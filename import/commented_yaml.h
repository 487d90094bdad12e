#pragma once

#include <string>
#include <vector>

#include "sidestep/scenarios/scenario.h"

namespace sidestep::imports {

/// The scenario's own text (scenarios::ToYaml) for a person to go on with: each common key with a
/// line on what it does, under a head of comment lines.
std::string CommentedYaml(const scenarios::Scenario& scenario,
                          const std::vector<std::string>& head);

}  // namespace sidestep::imports
