#include "sidestep/sim/mesh_corners.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "sidestep/core/input_error.h"

namespace sidestep::sim {
namespace {

namespace fs = std::filesystem;
using Corners = std::vector<Eigen::Vector3d>;

constexpr std::uintmax_t kMaxMeshBytes = 256u << 20;

std::string ReadBytes(const std::string& path) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw InputError(path, error.message());
  if (size > kMaxMeshBytes) throw InputError(path, "is longer than 256 MiB");
  std::ifstream stream(path, std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream && !stream.eof()) throw InputError(path, "cannot be read");
  return bytes;
}

bool ReadNumbers(std::istream& words, Eigen::Vector3d* numbers) {
  for (double& number : *numbers) {
    std::string word;
    if (!(words >> word)) return false;
    char* end = nullptr;
    number = std::strtod(word.c_str(), &end);
    if (*end != '\0' || !std::isfinite(number)) return false;
  }
  return true;
}

// 80 bytes of anything, a count, and for each triangle its normal, three corners, two bytes more.
Corners ParseBinaryStl(const std::string& bytes, const std::string& path) {
  constexpr std::size_t kHead = 84, kTriangle = 50;
  Corners corners;
  for (std::size_t at = kHead; at + kTriangle <= bytes.size(); at += kTriangle) {
    float numbers[12];
    std::memcpy(numbers, bytes.data() + at, sizeof numbers);
    for (int corner = 1; corner <= 3; ++corner) {
      corners.push_back(Eigen::Map<const Eigen::Vector3f>(numbers + 3 * corner).cast<double>());
      if (!corners.back().allFinite()) throw InputError(path, "has a corner that is not finite");
    }
  }
  return corners;
}

bool IsBinaryStl(const std::string& bytes) {
  constexpr std::size_t kHead = 84, kTriangle = 50;
  if (bytes.size() < kHead) return false;
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return bytes.size() == kHead + kTriangle * static_cast<std::size_t>(count);
}

Corners ParseTextStl(const std::string& text, const std::string& path) {
  Corners corners;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (word != "vertex") continue;
    corners.emplace_back();
    if (!ReadNumbers(words, &corners.back())) {
      throw InputError(path, "has a vertex that is not three numbers");
    }
  }
  return corners;
}

Corners ParseObj(const std::string& text, const std::string& path) {
  Corners vertices, corners;
  std::vector<bool> used;
  std::istringstream lines(text);
  int number = 0;
  const auto fail = [&](const std::string& why) { throw InputError(path, number, "", why); };
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    if (kind == "v") {
      vertices.emplace_back();
      if (!ReadNumbers(words, &vertices.back())) fail("v: must be three numbers");
      used.push_back(false);
    } else if (kind == "f") {  // each corner: its vertex, from 1, or from -1 back; texture, normal
      for (std::string corner; words >> corner;) {
        const long given = std::strtol(corner.c_str(), nullptr, 10);
        const auto count = static_cast<long>(vertices.size());
        const long index = given < 0 ? count + given : given - 1;
        if (index < 0 || index >= count) fail("f: there is no vertex " + corner);
        used[static_cast<std::size_t>(index)] = true;
      }
    }
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (used[i]) corners.push_back(vertices[i]);
  }
  return corners;
}

}  // namespace

Eigen::Matrix3Xd ReadMeshCorners(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (ending != ".stl" && ending != ".obj") throw InputError(path, "must be an STL or OBJ file");
  const std::string bytes = ReadBytes(path);
  Corners corners = ending == ".obj"     ? ParseObj(bytes, path)
                    : IsBinaryStl(bytes) ? ParseBinaryStl(bytes, path)
                                         : ParseTextStl(bytes, path);
  const auto before = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  };
  std::sort(corners.begin(), corners.end(), before);
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  if (corners.size() < 4) throw InputError(path, "is no solid: it has fewer than four corners");
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(corners.size()));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    points.col(static_cast<Eigen::Index>(i)) = corners[i];
  }
  return points;
}

}  // namespace sidestep::sim
