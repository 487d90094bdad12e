#include "sidestep/cli/heat_slice.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "sidestep/cli/slice_axes.h"
#include "sidestep/core/number_text.h"

namespace sidestep::cli {
namespace {

constexpr render::Color kSolid{110, 110, 120}, kBelieved{70, 160, 255}, kPlace{60, 255, 60};
constexpr int kInset = 12, kLine = 18, kBar = 14;  // pixels

// Black, red, yellow, white, as iron when it is heated; u from 0 to 1.
render::Color Heat(double u) {
  const auto channel = [](double x) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(x, 0.0, 1.0)));
  };
  return {channel(3 * u), channel(3 * u - 1), channel(3 * u - 2)};
}

// One layer of the grids: differences, and what is solid.
class Layer {
 public:
  Layer(const bench::AuditGrids& grids, int k) : grids_(grids), k_(k) {
    for (int j = 0; j < size(1); ++j) {
      for (int i = 0; i < size(0); ++i) {
        if (!IsSolid(i, j)) largest_m_ = std::max(largest_m_, Error(i, j));
      }
    }
  }

  int size(std::size_t axis) const { return grids_.truth_W.spec().size[axis]; }
  double largest_m() const { return largest_m_; }
  bool IsSolid(int i, int j) const { return grids_.truth_W.At(i, j, k_) < 0; }
  bool IsBelievedSolid(int i, int j) const {
    return i >= 0 && j >= 0 && i < size(0) && j < size(1) && grids_.field_W.At(i, j, k_) < 0;
  }
  render::Color ColorOf(int i, int j) const {
    return IsSolid(i, j) ? kSolid : Heat(largest_m_ > 0 ? Error(i, j) / largest_m_ : 0);
  }

 private:
  double Error(int i, int j) const {
    return std::abs(double{grids_.field_W.At(i, j, k_)} - grids_.truth_W.At(i, j, k_));
  }

  const bench::AuditGrids& grids_;
  int k_;
  double largest_m_ = 0;
};

// The layer alone, so many pixels a cell.
render::Image DrawLayer(const Layer& layer, int pixels) {
  const int nx = layer.size(0), ny = layer.size(1);
  const int rim = std::max(1, pixels / 3);
  render::Image image(nx * pixels, ny * pixels);
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      const int x = i * pixels, y = (ny - 1 - j) * pixels;
      image.Fill({x, y, pixels, pixels}, layer.ColorOf(i, j));
      if (!layer.IsBelievedSolid(i, j)) continue;
      if (!layer.IsBelievedSolid(i - 1, j)) image.Fill({x, y, rim, pixels}, kBelieved);
      if (!layer.IsBelievedSolid(i, j + 1)) image.Fill({x, y, pixels, rim}, kBelieved);
      if (!layer.IsBelievedSolid(i + 1, j)) {
        image.Fill({x + pixels - rim, y, rim, pixels}, kBelieved);
      }
      if (!layer.IsBelievedSolid(i, j - 1)) {
        image.Fill({x, y + pixels - rim, pixels, rim}, kBelieved);
      }
    }
  }
  return image;
}

// Heat from nothing to the largest difference, with its ends named, then what the rims mean.
void DrawLegend(render::Image& image, int y, double largest_m, const render::Font& font) {
  const int length = image.width() / 3;
  const double text_x = font.Draw(image, kInset, y, kLine, kInk, "0 ") + 4;
  for (int n = 0; n < length; ++n) {
    const double u = static_cast<double>(n) / std::max(1, length - 1);
    image.Fill({static_cast<int>(text_x) + n, y + (kLine - kBar) / 2, 1, kBar}, Heat(u));
  }
  font.Draw(image, text_x + length + 8, y, kLine, kInk, FiniteText("{:.1f} mm", 1e3 * largest_m));

  struct Sign {
    const char* text;
    render::Color color;
    bool is_rim;
  };
  double x = kInset;
  y += kLine + kInset / 2;
  for (const Sign& sign :
       {Sign{"truly solid", kSolid, false}, Sign{"solid to the field", kBelieved, true},
        Sign{"most wrong", kPlace, true}}) {
    const render::PixelRect swatch{static_cast<int>(x), y + (kLine - kBar) / 2, kBar, kBar};
    image.Fill(swatch, sign.is_rim ? Heat(0) : sign.color);
    image.Outline(swatch, sign.color, 2);
    x = font.Draw(image, x + kBar + 6, y, kLine, kInk, sign.text) + 18;
  }
}

}  // namespace

render::Image DrawHeatSlice(const bench::AuditGrids& grids, const Eigen::Vector3d& p_W,
                            const std::vector<std::string>& title, const render::Font& font) {
  const GridSpec& grid = grids.field_W.spec();
  const auto [nx, ny, nz] = grid.size;
  const auto [pi, pj, pk] = grid.CellOf(p_W);
  const Layer layer(grids, std::clamp(pk, 0, nz - 1));
  const int pixels = std::clamp(576 / std::max(nx, ny), 1, 24);
  render::Image cells = DrawLayer(layer, pixels);
  cells.Outline({(pi - 1) * pixels, (ny - 2 - pj) * pixels, 3 * pixels, 3 * pixels}, kPlace, 2);
  const render::Image slice = WithAxes(cells, ExtentOf(grid), "", font);

  const int head = kInset + kLine * static_cast<int>(title.size()) + kInset / 2;
  const int foot = kInset + 2 * kLine + kInset;
  render::Image image(std::max(slice.width(), 480) + 2 * kInset, head + slice.height() + foot);
  image.Fill({0, 0, image.width(), image.height()}, kPaper);
  for (std::size_t n = 0; n < title.size(); ++n) {
    font.Draw(image, kInset, kInset + kLine * static_cast<int>(n), kLine, kInk, title[n]);
  }
  image.Paste(slice, kInset, head);
  DrawLegend(image, head + slice.height() + kInset / 2, layer.largest_m(), font);
  return image;
}

}  // namespace sidestep::cli
