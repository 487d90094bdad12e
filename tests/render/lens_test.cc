#include "sidestep/render/lens.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sidestep::render::lens_test {
namespace {

robot::CameraIntrinsics SmallCamera() {
  robot::CameraIntrinsics camera = robot::PinholeOf(160, 90, 1.2);
  camera.distortion = {0.1, -0.2, 0.002, -0.001, 0.05};
  return camera;
}

// The brightness at (x/z, y/z) of each pixel of the ideal picture.
template <class Brightness>
std::vector<float> Ideal(const Lens& lens, Brightness brightness) {
  std::vector<float> picture;
  const double step = (lens.right() - lens.left()) / lens.ideal_width();
  for (int j = 0; j < lens.ideal_height(); ++j) {
    for (int i = 0; i < lens.ideal_width(); ++i) {
      picture.push_back(static_cast<float>(
          brightness(lens.left() + (i + 0.5) * step, lens.top() + (j + 0.5) * step)));
    }
  }
  return picture;
}

TEST(Lens, LeavesEvenLightAsItIs) {
  const Lens lens(SmallCamera(), 0.7);
  for (const float level : lens.Apply(Ideal(lens, [](double, double) { return 100; }))) {
    EXPECT_NEAR(level, 100, 1e-3);
  }
}

TEST(Lens, ShowsEachDirectionWhereTheCameraHasIt) {
  for (const double blur_px : {0.0, 0.7, 2.0}) {
    const Lens lens(SmallCamera(), blur_px);
    const auto x_of = lens.Apply(Ideal(lens, [](double x, double) { return 100 * x; }));
    const auto y_of = lens.Apply(Ideal(lens, [](double, double y) { return 100 * y; }));
    const int w = lens.camera().width, reach = 8;  // at the rim, the blur has no more than the rim
    for (int v = reach; v < lens.camera().height - reach; v += 7) {
      for (int u = reach; u < w - reach; u += 7) {
        const Eigen::Vector2d ideal = robot::Unproject(lens.camera(), {u, v});
        const auto n = static_cast<std::size_t>(v * w + u);
        EXPECT_NEAR(x_of[n], 100 * ideal.x(), 2e-3);
        EXPECT_NEAR(y_of[n], 100 * ideal.y(), 2e-3);
      }
    }
  }
}

TEST(Lens, BlursAnEdgeAsMuchAsItSays) {
  const robot::CameraIntrinsics camera = robot::PinholeOf(160, 90, 1.2);
  const double blur_px = 1.5;
  const Lens lens(camera, blur_px);
  const auto picture = lens.Apply(Ideal(lens, [](double x, double) { return x > 0 ? 1 : 0; }));
  const double sigma_px = std::sqrt(blur_px * blur_px + 1.0 / 12);
  for (int u = 70; u < 90; ++u) {
    const double expected = 0.5 * (1 + std::erf((u - camera.cx) / (sigma_px * std::sqrt(2.0))));
    EXPECT_NEAR(picture[static_cast<std::size_t>(40 * 160 + u)], expected, 0.01) << u;
  }
}

TEST(Lens, RefusesToFoldThePicture) {
  robot::CameraIntrinsics camera = robot::PinholeOf(160, 90, 1.2);
  camera.distortion = {-1, -1, 0, 0, -1};
  EXPECT_THROW(Lens(camera, 0.7), std::invalid_argument);
}

}  // namespace
}  // namespace sidestep::render::lens_test
