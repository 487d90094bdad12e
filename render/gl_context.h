#pragma once

#include <memory>
#include <string>

namespace sidestep::render {

/// An OpenGL context that draws into memory, with OSMesa: no display, no GPU, the same picture each
/// time. While it lives it is current in the thread that made it; have one a process. Everything
/// that draws takes it by reference, as a proof that it is there, and must not outlive it.
class GlContext {
 public:
  /// Obeys MUJOCO_GL: `osmesa`, empty or unset; anything else is refused.
  /// @throws InputError if MUJOCO_GL names another back end or `disable`, or OSMesa does not work.
  GlContext();
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  const std::string& renderer() const { return renderer_; }  ///< GL_RENDERER
  const std::string& version() const { return version_; }    ///< GL_VERSION

 private:
  struct Mesa;
  std::unique_ptr<Mesa> mesa_;
  std::string renderer_, version_;
};

/// One line for people: the OpenGL that would draw, or why none can.
std::string DescribeGl();

}  // namespace sidestep::render
