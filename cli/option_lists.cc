#include "sidestep/cli/option_lists.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "sidestep/core/input_error.h"
#include "sidestep/core/joined.h"

namespace sidestep::cli {

namespace {

constexpr int kMaxSpeeds = 10000;

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  if (text.empty() || text.back() == separator) parts.emplace_back();
  return parts;
}

double ParseNumber(const std::string& option, const std::string& text) {
  std::size_t end = 0;
  double value = NAN;
  try {
    value = std::stod(text, &end);
  } catch (const std::exception&) {
    end = 0;
  }
  if (end == 0 || end != text.size() || !std::isfinite(value)) {
    throw InputError(option, "'" + text + "' is not a number");
  }
  return value;
}

template <class T>
void AddOnce(const std::string& option, const std::string& word, T value, std::vector<T>& values) {
  if (std::find(values.begin(), values.end(), value) != values.end()) {
    throw InputError(option, "names '" + word + "' twice");
  }
  values.push_back(value);
}

}  // namespace

std::vector<double> ParseSpeeds(const std::string& option, const std::string& text) {
  const std::vector<std::string> parts = Split(text, ':');
  if (parts.size() != 1 && parts.size() != 3) {
    throw InputError(option, "must be one speed or FIRST:LAST:STEP, is '" + text + "'");
  }
  const double first = ParseNumber(option, parts[0]);
  const double last = parts.size() == 3 ? ParseNumber(option, parts[1]) : first;
  const double step = parts.size() == 3 ? ParseNumber(option, parts[2]) : 1;
  if (first < 0 || last < first || !(step > 0) || !((last - first) / step < kMaxSpeeds)) {
    throw InputError(option, "needs 0 <= FIRST <= LAST and a STEP > 0, is '" + text + "'");
  }
  std::vector<double> speeds;
  const int count = static_cast<int>(std::floor((last - first) / step + 1e-6)) + 1;
  for (int i = 0; i < count; ++i) {
    speeds.push_back(std::stod(fmt::format("{:.9f}", first + i * step)));
  }
  return speeds;
}

std::vector<int> ParseNumbers(const std::string& option, const std::string& text, int most) {
  std::vector<int> numbers;
  for (const std::string& part : Split(text, ',')) {
    const std::vector<std::string> ends = Split(part, '-');
    const double first = ParseNumber(option, ends.front());
    const double last = ParseNumber(option, ends.back());
    if (ends.size() > 2 || first != std::floor(first) || last != std::floor(last) || first < 1 ||
        last < first || last > most) {
      throw InputError(option,
                       "'" + part + "' is no number or range within 1-" + std::to_string(most));
    }
    for (int number = static_cast<int>(first); number <= static_cast<int>(last); ++number) {
      AddOnce(option, std::to_string(number), number, numbers);
    }
  }
  return numbers;
}

std::vector<sdf::Knowledge> ParseKnowledge(const std::string& option, const std::string& text) {
  std::vector<sdf::Knowledge> kinds;
  for (const std::string& word : Split(text, ',')) {
    try {
      AddOnce(option, word, sdf::KnowledgeFromString(word), kinds);
    } catch (const std::invalid_argument& error) {
      throw InputError(option, error.what());
    }
  }
  return kinds;
}

void CheckWords(const std::string& option, const std::vector<std::string>& words,
                const std::vector<std::string>& known) {
  for (const std::string& word : words) {
    if (std::find(known.begin(), known.end(), word) != known.end()) continue;
    throw InputError(option, "must be one of " + Joined(known) + ", is '" + word + "'");
  }
}

}  // namespace sidestep::cli
