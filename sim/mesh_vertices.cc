#include "sidestep/sim/mesh_vertices.h"

#include <cstddef>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string>

namespace sidestep::sim {

std::vector<Eigen::Vector3d> VerticesOf(const char* text) {
  std::istringstream words(text == nullptr ? "" : text);
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    char* end = nullptr;
    numbers.push_back(std::strtod(word.c_str(), &end));
    if (*end != '\0') throw std::invalid_argument("must be numbers");
  }
  if (numbers.size() % 3 != 0) throw std::invalid_argument("must be three numbers for each point");
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < numbers.size(); i += 3) {
    points.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  }
  return points;
}

}  // namespace sidestep::sim
