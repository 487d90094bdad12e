#include "sidestep/render/font.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "sidestep/core/utf8.h"
#include "sidestep/render/mujoco_drawing.h"
#include "sidestep/sim/mujoco_model.h"

namespace sidestep::render {
namespace {

// An empty world whose only use is an off-screen buffer that holds the widest letter.
constexpr const char* kBlankWorld =
    "<mujoco><visual><global offwidth='256' offheight='160'/><quality offsamples='0' "
    "shadowsize='1'/></visual><worldbody/></mujoco>";
constexpr int kBufferWidth = 256, kBufferHeight = 160;

}  // namespace

Font::Font(const GlContext&) {
  const sim::MujocoModelPtr model = sim::LoadMujocoModel(kBlankWorld, "font");
  const DrawingContext drawing(*model, mjFONTSCALE_300);
  const mjrContext& context = drawing.context();
  cell_height_ = context.charHeightBig;
  const mjrRect buffer = {0, 0, kBufferWidth, kBufferHeight};
  std::vector<unsigned char> rgb(3 * kBufferWidth * kBufferHeight);
  for (char letter = kFirst; letter <= kLast; ++letter) {
    Glyph& glyph = glyphs_[static_cast<std::size_t>(letter - kFirst)];
    glyph.width = context.charWidthBig[static_cast<unsigned char>(letter)];
    mjr_rectangle(buffer, 0, 0, 0, 1);
    const char text[] = {letter, '\0'};
    mjr_text(mjFONT_BIG, text, &context, 0, 0, 1, 1, 1);
    mjr_readPixels(rgb.data(), nullptr, buffer, &context);
    for (int y = cell_height_ - 1; y >= 0; --y) {  // OpenGL's rows begin at the bottom.
      for (int x = 0; x < glyph.width; ++x) {
        const int red = 3 * (y * kBufferWidth + x);
        glyph.coverage.push_back(rgb[static_cast<std::size_t>(red)] > 127);
      }
    }
  }
}

bool Font::HasAll(const std::string& text) {
  return std::all_of(text.begin(), text.end(),
                     [](char letter) { return letter >= kFirst && letter <= kLast; });
}

std::vector<const Font::Glyph*> Font::GlyphsOf(const std::string& text) const {
  std::vector<const Glyph*> glyphs;
  for (std::size_t at = 0; at < text.size();) {
    const char letter = text[at];
    const bool known = letter >= kFirst && letter <= kLast;
    glyphs.push_back(&glyphs_[static_cast<std::size_t>((known ? letter : '?') - kFirst)]);
    at += std::max<std::size_t>(1, Utf8Length(std::string_view(text).substr(at)));
  }
  return glyphs;
}

double Font::Width(const std::string& text, double line_height) const {
  int width = 0;
  for (const Glyph* const glyph : GlyphsOf(text)) width += glyph->width;
  return width * line_height / cell_height_;
}

double Font::Draw(Image& image, double x, double y, double line_height, Color color,
                  const std::string& text) const {
  const double scale = line_height / cell_height_;  // pixels of the image a pixel of the letter
  for (const Glyph* const letter : GlyphsOf(text)) {
    const Glyph& glyph = *letter;
    const double width = glyph.width * scale;
    for (int py = static_cast<int>(std::floor(y)); py < y + line_height; ++py) {
      for (int px = static_cast<int>(std::floor(x)); px < x + width; ++px) {
        // The share of this pixel that the letter covers: the mean of the letter's pixels in it.
        const int top = std::clamp(static_cast<int>((py - y) / scale), 0, cell_height_);
        const int bottom = std::clamp(static_cast<int>((py + 1 - y) / scale), 0, cell_height_);
        const int left = std::clamp(static_cast<int>((px - x) / scale), 0, glyph.width);
        const int right = std::clamp(static_cast<int>((px + 1 - x) / scale), 0, glyph.width);
        int covered = 0;
        for (int v = top; v < bottom; ++v) {
          for (int u = left; u < right; ++u) {
            const int pixel = v * glyph.width + u;
            covered += glyph.coverage[static_cast<std::size_t>(pixel)];
          }
        }
        if (covered > 0) image.Blend(px, py, color, std::min(1.0, covered * scale * scale));
      }
    }
    x += width;
  }
  return x;
}

}  // namespace sidestep::render
