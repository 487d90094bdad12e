#include "sidestep/core/number_text.h"

#include <fmt/core.h>

#include <charconv>
#include <cmath>

namespace sidestep {

// Not by fmt, which writes 1e+05 as 100000: what files hold stays as it was.
std::string ShortestText(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value);
  return std::string(text, end.ptr);
}

std::string ShortestNumber(double value) { return ShortestText(value + 0.0); }

std::string FiniteText(const char* format, double value, const std::string& otherwise) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : otherwise;
}

}  // namespace sidestep
