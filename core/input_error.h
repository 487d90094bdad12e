#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>

namespace sidestep {

/// What a person wrote is wrong. The text is one line, `FILE:LINE: KEY: WHY` (parts that do not
/// apply are left out), so that an editor can jump there. The command exits with 2.
class InputError : public std::runtime_error {
 public:
  InputError(const std::string& file, int line, const std::string& key, const std::string& why)
      : InputError(file + ":" + std::to_string(line), (key.empty() ? "" : key + ": ") + why) {}
  InputError(const std::string& what, const std::string& why)
      : std::runtime_error(OneLine(what + ": " + why)) {}

 private:
  // Messages quote what stands in files, and that may hold anything.
  static std::string OneLine(std::string text) {
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 32; };
    std::replace_if(text.begin(), text.end(), is_control, ' ');
    return text;
  }
};

}  // namespace sidestep
