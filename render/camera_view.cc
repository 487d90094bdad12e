#include "sidestep/render/camera_view.h"

#include <algorithm>
#include <cmath>

namespace sidestep::render {
namespace {

constexpr Color kTagColor = {40, 220, 90}, kPathColor = {250, 160, 20},
                kTextColor = {255, 255, 255}, kBandColor = {20, 24, 30};
constexpr double kLine_px = 2.5, kNearest_m = 0.05;
constexpr int kPieces = 8;  // of an edge, which a lens bends

Image InColor(const robot::GreyImage& picture) {
  Image image(picture.width, picture.height);
  for (int y = 0; y < picture.height; ++y) {
    std::uint8_t* out = image.row(y);
    for (int x = 0; x < picture.width; ++x, out += 3) {
      std::fill_n(out, 3, picture.At(x, y));
    }
  }
  return image;
}

// From pixel to pixel, whole numbers being the middles of pixels.
void DrawLine(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Color color, double opacity,
              Image* image) {
  const Eigen::Vector2d along = to - from;
  const double length2 = std::max(along.squaredNorm(), 1e-12);
  const Eigen::Array2d reach = Eigen::Array2d::Constant(kLine_px);
  const Eigen::Array2d last(image->width() - 1, image->height() - 1);
  const Eigen::Array2d least = (from.array().min(to.array()) - reach).max(0).floor();
  const Eigen::Array2d most = (from.array().max(to.array()) + reach).min(last).ceil();
  for (int y = static_cast<int>(least.y()); y <= static_cast<int>(most.y()); ++y) {
    for (int x = static_cast<int>(least.x()); x <= static_cast<int>(most.x()); ++x) {
      const Eigen::Vector2d p(x, y);
      const double share = std::clamp((p - from).dot(along) / length2, 0.0, 1.0);
      const double distance_px = (p - from - share * along).norm();
      const double cover = std::clamp(kLine_px / 2 + 0.5 - distance_px, 0.0, 1.0);
      if (cover > 0) image->Blend(x, y, color, opacity * cover);
    }
  }
}

class Drawing {
 public:
  Drawing(const CameraNotes& view, Image* image)
      : view_(view), X_CW_(view.X_WC.Inverse()), image_(*image) {}

  void Line(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W, Color color,
            double opacity) {
    const Eigen::Vector3d from = X_CW_ * from_W, to = X_CW_ * to_W;
    if (from.z() < kNearest_m || to.z() < kNearest_m) return;
    Eigen::Vector2d last = robot::Project(view_.camera, from);
    for (int k = 1; k <= kPieces; ++k) {
      const Eigen::Vector3d p = from + static_cast<double>(k) / kPieces * (to - from);
      const Eigen::Vector2d next = robot::Project(view_.camera, p);
      DrawLine(last, next, color, opacity, &image_);
      last = next;
    }
  }

  void Box(const ViewedBox& box) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int corner = 0; corner < 4; ++corner) {
        Eigen::Vector3d end = box.half_extents_m;
        end((axis + 1) % 3) *= corner % 2 == 0 ? 1 : -1;
        end((axis + 2) % 3) *= corner / 2 == 0 ? 1 : -1;
        Eigen::Vector3d begin = end;
        begin(axis) *= -1;
        Line(box.X_WO * begin, box.X_WO * end, box.color, box.opacity);
      }
    }
  }

 private:
  const CameraNotes& view_;
  Pose X_CW_;
  Image& image_;
};

void DrawText(const std::vector<std::string>& lines, const Font& font, Image* image) {
  if (lines.empty()) return;
  const double height = std::max(14.0, image->height() / 36.0), margin = height / 2;
  double widest = 0;
  for (const std::string& line : lines) widest = std::max(widest, font.Width(line, height));
  const auto band_height =
      static_cast<int>(height * static_cast<double>(lines.size()) + 2 * margin);
  const auto band_width = static_cast<int>(widest + 2 * margin);
  image->Fill({0, 0, band_width, band_height}, kBandColor);
  double y = margin;
  for (const std::string& line : lines) {
    font.Draw(*image, margin, y, height, kTextColor, line);
    y += height;
  }
}

}  // namespace

Image DrawCameraNotes(const robot::GreyImage& picture, const CameraNotes& view, const Font& font) {
  Image image = InColor(picture);
  Drawing drawing(view, &image);
  for (const ViewedBox& box : view.boxes) drawing.Box(box);
  for (Eigen::Index k = 1; k < view.path_W.cols(); ++k) {
    drawing.Line(view.path_W.col(k - 1), view.path_W.col(k), kPathColor, 1);
  }
  for (const auto& corners_px : view.tags_px) {
    for (int k = 0; k < 4; ++k) {
      DrawLine(corners_px.col(k), corners_px.col((k + 1) % 4), kTagColor, 1, &image);
    }
  }
  DrawText(view.lines, font, &image);
  return image;
}

}  // namespace sidestep::render
