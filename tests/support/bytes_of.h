#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace sidestep {

/// All that is in a file; empty if there is none.
inline std::string BytesOf(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace sidestep
