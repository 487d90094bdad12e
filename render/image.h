#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sidestep::render {

struct Color {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Color&) const = default;
};

/// A rectangle of pixels; (0, 0) is the image's upper left corner.
struct PixelRect {
  int x = 0, y = 0, width = 0, height = 0;
};

/// An 8-bit RGB picture, rows from the top.
class Image {
 public:
  /// Black. @throws std::invalid_argument unless both sizes are >= 1.
  Image(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }
  Color At(int x, int y) const;
  const std::uint8_t* row(int y) const { return bytes_.data() + RowStart(y); }
  std::uint8_t* row(int y) { return bytes_.data() + RowStart(y); }

  /// Mixes `color` into one pixel: opacity 0 leaves it, 1 replaces it. Outside: nothing happens.
  void Blend(int x, int y, Color color, double opacity);
  /// Paints a rectangle, cut off at the image's edges.
  void Fill(const PixelRect& rect, Color color);
  /// The rectangle's rim, `thickness` pixels wide, inside it.
  void Outline(const PixelRect& rect, Color color, int thickness);
  /// Copies `other` so that its upper left corner is at (x, y), cut off at the edges.
  void Paste(const Image& other, int x, int y);

  bool operator==(const Image&) const = default;

 private:
  std::size_t RowStart(int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) * 3;
  }

  int width_, height_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace sidestep::render
