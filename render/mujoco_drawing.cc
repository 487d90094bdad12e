#include "sidestep/render/mujoco_drawing.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace sidestep::render {

DrawingContext::DrawingContext(const mjModel& model, mjtFontScale font_scale) {
  mjr_defaultContext(&context_);
  mjr_makeContext(&model, &context_, font_scale);
  mjr_setBuffer(mjFB_OFFSCREEN, &context_);
}

DrawingContext::~DrawingContext() { mjr_freeContext(&context_); }

void DrawingContext::Render(mjvScene& scene) const {
  // MuJoCo finds its buffer through the context; another model's may be bound now.
  mjr_restoreBuffer(&context_);
  mjr_render(viewport(), &scene, &context_);
}

Image DrawingContext::Read() const {
  const mjrRect buffer = viewport();
  const auto row_bytes = 3 * static_cast<std::size_t>(buffer.width);
  std::vector<std::uint8_t> rgb(row_bytes * static_cast<std::size_t>(buffer.height));
  mjr_readPixels(rgb.data(), nullptr, buffer, &context_);
  Image image(buffer.width, buffer.height);
  for (int y = 0; y < buffer.height; ++y) {  // OpenGL's rows begin at the bottom.
    const auto from = rgb.end() - static_cast<std::ptrdiff_t>(row_bytes) * (y + 1);
    std::copy(from, from + static_cast<std::ptrdiff_t>(row_bytes), image.row(y));
  }
  return image;
}

Scene::Scene(const mjModel& model, int max_geoms) {
  mjv_defaultScene(&scene_);
  mjv_makeScene(&model, &scene_, max_geoms);
}

Scene::~Scene() { mjv_freeScene(&scene_); }

}  // namespace sidestep::render
