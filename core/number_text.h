#pragma once

#include <string>

namespace sidestep {

/// The fewest characters that read back to the same double, as files hold numbers: 0.1, 1e-07, and
/// nan, inf, -inf.
std::string ShortestText(double value);

/// The same with 0 for -0, as people write numbers.
std::string ShortestNumber(double value);

/// A number for people, and what to say where there is none.
/// @param format of the library fmt with one field, e.g. "{:.2f} s".
/// @return `otherwise` if the value is not finite.
std::string FiniteText(const char* format, double value, const std::string& otherwise = "-");

}  // namespace sidestep
