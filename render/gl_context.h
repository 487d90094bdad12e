#pragma once

#include <memory>
#include <string>

namespace sidestep::render {

/// An OpenGL context that draws into memory, with OSMesa: no display, no GPU, the same picture each
/// time. It is current in the thread that made it until another one is made there; who draws beside
/// others calls MakeCurrent first. Everything that draws takes it by reference, as a proof that it
/// is there, and must not outlive it.
class GlContext {
 public:
  /// Obeys MUJOCO_GL: `osmesa`, empty or unset; anything else is refused.
  /// @throws InputError if MUJOCO_GL names another back end or `disable`, or OSMesa does not work.
  GlContext();
  ~GlContext();
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Makes it current again, in the calling thread, where another one may have been meanwhile.
  void MakeCurrent() const;

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
