#pragma once

#include <string>
#include <vector>

#include "sidestep/sdf/world_model.h"

namespace sidestep::cli {

/// What people write after a flag, `option`, that takes several values at once. All throw
/// InputError, naming the flag.

/// One speed, or FIRST:LAST:STEP [m/s]. Each is the double nearest to its decimal fraction, as if
/// it had been typed: repeated sums are off in the last bit, which can put an obstacle into another
/// cell.
std::vector<double> ParseSpeeds(const std::string& option, const std::string& text);

/// "1,4-6" is 1, 4, 5, 6; each from 1 to `most` and none twice.
std::vector<int> ParseNumbers(const std::string& option, const std::string& text, int most);

/// Kinds of knowledge, comma-separated, none twice.
std::vector<sdf::Knowledge> ParseKnowledge(const std::string& option, const std::string& text);

/// Complains unless every word is one of the known.
void CheckWords(const std::string& option, const std::vector<std::string>& words,
                const std::vector<std::string>& known);

}  // namespace sidestep::cli
