#include "sidestep/render/image.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sidestep::render {

Image::Image(int width, int height) : width_(width), height_(height) {
  if (width < 1 || height < 1) throw std::invalid_argument("Image: sizes must be >= 1");
  bytes_.resize(RowStart(height), 0);
}

Color Image::At(int x, int y) const {
  const std::uint8_t* const pixel = row(y) + 3 * x;
  return {pixel[0], pixel[1], pixel[2]};
}

void Image::Blend(int x, int y, Color color, double opacity) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  std::uint8_t* const pixel = row(y) + 3 * x;
  const auto mix = [opacity](std::uint8_t below, std::uint8_t above) {
    return static_cast<std::uint8_t>(std::lround(below + opacity * (above - below)));
  };
  pixel[0] = mix(pixel[0], color.r);
  pixel[1] = mix(pixel[1], color.g);
  pixel[2] = mix(pixel[2], color.b);
}

void Image::Fill(const PixelRect& rect, Color color) {
  const int right = std::min(rect.x + rect.width, width_);
  const int bottom = std::min(rect.y + rect.height, height_);
  for (int y = std::max(rect.y, 0); y < bottom; ++y) {
    for (int x = std::max(rect.x, 0); x < right; ++x) {
      std::uint8_t* const pixel = row(y) + 3 * x;
      pixel[0] = color.r;
      pixel[1] = color.g;
      pixel[2] = color.b;
    }
  }
}

void Image::Outline(const PixelRect& rect, Color color, int thickness) {
  const int inner_height = rect.height - 2 * thickness;
  Fill({rect.x, rect.y, rect.width, thickness}, color);
  Fill({rect.x, rect.y + rect.height - thickness, rect.width, thickness}, color);
  Fill({rect.x, rect.y + thickness, thickness, inner_height}, color);
  Fill({rect.x + rect.width - thickness, rect.y + thickness, thickness, inner_height}, color);
}

void Image::Paste(const Image& other, int x, int y) {
  const int left = std::max(x, 0);
  const int right = std::min(x + other.width(), width_);
  if (right <= left) return;
  for (int to = std::max(y, 0); to < std::min(y + other.height(), height_); ++to) {
    const std::uint8_t* const from = other.row(to - y) + 3 * (left - x);
    std::copy(from, from + 3 * (right - left), row(to) + 3 * left);
  }
}

}  // namespace sidestep::render
