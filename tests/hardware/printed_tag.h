#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sidestep/robot/camera_image.h"
#include "sidestep/scenarios/tag.h"

namespace sidestep {

/// A picture of nothing but paper.
inline robot::GreyImage Paper(int width, int height) {
  const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  return {width, height, std::vector<std::uint8_t>(count, 230)};
}

/// Prints a tag whose upper left corner, that of its white rim, is at pixel (left, top).
inline void Print(int id, int left, int top, int module_px, robot::GreyImage* image) {
  constexpr int n = scenarios::kTagModules;
  const auto black = scenarios::BlackModules(id);
  for (int y = 0; y < n * module_px; ++y) {
    for (int x = 0; x < n * module_px; ++x) {
      const bool is_black = black[static_cast<std::size_t>(n * (y / module_px) + x / module_px)];
      image->At(left + x, top + y) = is_black ? 20 : 230;
    }
  }
}

}  // namespace sidestep
