#include "sidestep/render/lens.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sidestep::render {
namespace {

constexpr double kSamples = 2;  // of the ideal picture to a pixel of the camera
constexpr int kLensMargin = 3;  // beyond what the lens shows

}  // namespace

Lens::Lens(const robot::CameraIntrinsics& camera, double blur_px) : camera_(camera) {
  if (camera.width < 1 || camera.height < 1 || !(camera.fx > 0) || !(camera.fy > 0)) {
    throw std::invalid_argument("Lens: a camera without pixels");
  }
  step_ = 1 / (kSamples * std::max(camera.fx, camera.fy));
  constexpr double kNone = std::numeric_limits<double>::infinity();
  Eigen::Array2d least = Eigen::Array2d::Constant(kNone), most = -least;
  std::vector<Eigen::Vector2d> seen;
  seen.reserve(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      seen.push_back(robot::Unproject(camera, {u, v}));
      least = least.min(seen.back().array());
      most = most.max(seen.back().array());
    }
  }
  left_ = least.x() - kLensMargin * step_;
  top_ = least.y() - kLensMargin * step_;
  const Eigen::Array2d size = (most - least) / step_ + 2 * kLensMargin;
  constexpr double kMostPixels = 8192;  // a lens that folds its picture has no end
  if (!(size < kMostPixels).all()) {
    throw std::invalid_argument("Lens: its distortion reaches too far");
  }
  width_ = static_cast<int>(std::ceil(size.x()));
  height_ = static_cast<int>(std::ceil(size.y()));

  sources_.reserve(seen.size());
  for (const Eigen::Vector2d& at : seen) {
    const double x = (at.x() - left_) / step_ - 0.5, y = (at.y() - top_) / step_ - 0.5;
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    sources_.push_back({j * width_ + i, static_cast<float>(x - i), static_cast<float>(y - j)});
  }

  const double sigma = kSamples * std::sqrt(blur_px * blur_px + 1.0 / 12);
  const int reach = static_cast<int>(std::ceil(3 * sigma));
  double sum = 0;
  std::vector<double> weights;
  for (int k = 0; k <= reach; ++k) {
    weights.push_back(std::exp(-k * k / (2 * sigma * sigma)));
    sum += (k == 0 ? 1 : 2) * weights.back();
  }
  for (const double weight : weights) kernel_.push_back(static_cast<float>(weight / sum));
}

// Along each axis in turn; what lies beyond the picture is as its edge.
void Lens::Blur(std::vector<float>* picture) const {
  const int reach = static_cast<int>(kernel_.size()) - 1;
  const auto w = static_cast<std::size_t>(width_);
  std::vector<float> row(w + 2 * static_cast<std::size_t>(reach));
  for (int y = 0; y < height_; ++y) {
    float* const out = picture->data() + static_cast<std::size_t>(y) * w;
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = out[std::clamp(static_cast<int>(i) - reach, 0, width_ - 1)];
    }
    const float* const in = row.data() + reach;
    for (int x = 0; x < width_; ++x) out[x] = kernel_[0] * in[x];
    for (int k = 1; k <= reach; ++k) {
      const float weight = kernel_[static_cast<std::size_t>(k)];
      for (int x = 0; x < width_; ++x) out[x] += weight * (in[x - k] + in[x + k]);
    }
  }
  const std::vector<float> before = *picture;
  for (int y = 0; y < height_; ++y) {
    const auto row_of = [&](int at) {
      return before.data() + static_cast<std::size_t>(std::clamp(at, 0, height_ - 1)) * w;
    };
    float* const out = picture->data() + static_cast<std::size_t>(y) * w;
    const float* const middle = row_of(y);
    for (std::size_t x = 0; x < w; ++x) out[x] = kernel_[0] * middle[x];
    for (int k = 1; k <= reach; ++k) {
      const float weight = kernel_[static_cast<std::size_t>(k)];
      const float* const above = row_of(y - k);
      const float* const below = row_of(y + k);
      for (std::size_t x = 0; x < w; ++x) out[x] += weight * (above[x] + below[x]);
    }
  }
}

std::vector<float> Lens::Apply(const std::vector<float>& ideal) const {
  if (ideal.size() != static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {
    throw std::invalid_argument("Lens: an ideal picture of another size");
  }
  std::vector<float> blurred = ideal;
  Blur(&blurred);
  std::vector<float> picture;
  picture.reserve(sources_.size());
  for (const Source& source : sources_) {
    const float* const upper = blurred.data() + source.index;
    const float* const lower = upper + width_;
    const float above = upper[0] + source.right * (upper[1] - upper[0]);
    const float below = lower[0] + source.right * (lower[1] - lower[0]);
    picture.push_back(above + source.down * (below - above));
  }
  return picture;
}

}  // namespace sidestep::render
