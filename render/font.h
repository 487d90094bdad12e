#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "sidestep/render/gl_context.h"
#include "sidestep/render/image.h"

namespace sidestep::render {

/// Smooth text of any size. The letters are those that MuJoCo carries for its own overlays: drawn
/// once at its largest size, then averaged down. Printable ASCII;
/// any other character shows as one '?'.
class Font {
 public:
  explicit Font(const GlContext& gl);

  /// Whether it has every letter of `text`.
  static bool HasAll(const std::string& text);

  /// How wide `text` is at this line height [pixels].
  double Width(const std::string& text, double line_height) const;

  /// Draws one line; (x, y) is its upper left corner, fractions of a pixel count.
  /// @return the x where the text ends.
  double Draw(Image& image, double x, double y, double line_height, Color color,
              const std::string& text) const;

 private:
  static constexpr char kFirst = ' ', kLast = '~';
  struct Glyph {
    int width = 0;                       // of its cell, which is also its advance
    std::vector<std::uint8_t> coverage;  // width x cell_height_, rows from the top, 0 or 1
  };
  // Of each character of `text`.
  std::vector<const Glyph*> GlyphsOf(const std::string& text) const;

  int cell_height_ = 0;
  std::array<Glyph, kLast - kFirst + 1> glyphs_;
};

}  // namespace sidestep::render
