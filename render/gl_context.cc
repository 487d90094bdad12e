#include "sidestep/render/gl_context.h"

#include <GL/gl.h>
#include <GL/osmesa.h>

#include <array>
#include <cstdlib>

#include "sidestep/core/input_error.h"

namespace sidestep::render {
namespace {

// MuJoCo draws into framebuffer objects of its own; OSMesa wants a window nevertheless.
constexpr int kWindowPixels = 16;

void ObeyEnvironment() {
  const char* const variable = std::getenv("MUJOCO_GL");
  const std::string choice = variable == nullptr ? "" : variable;
  if (choice.empty() || choice == "osmesa") return;
  if (choice == "disable" || choice == "disabled" || choice == "off") {
    throw InputError("MUJOCO_GL", "is '" + choice + "', which forbids drawing; unset it to draw");
  }
  throw InputError("MUJOCO_GL", "is '" + choice +
                                    "', which is not built in; unset it, or use 'osmesa' (needs no "
                                    "display and no GPU)");
}

std::string GlString(GLenum name) {
  const GLubyte* const text = glGetString(name);
  return text == nullptr ? "unknown" : reinterpret_cast<const char*>(text);
}

}  // namespace

struct GlContext::Mesa {
  std::array<unsigned char, kWindowPixels* kWindowPixels* 4> window = {};
  OSMesaContext context = nullptr;

  ~Mesa() {
    if (context != nullptr) OSMesaDestroyContext(context);
  }
};

GlContext::GlContext() {
  ObeyEnvironment();
  mesa_ = std::make_unique<Mesa>();
  mesa_->context =
      OSMesaCreateContextExt(OSMESA_RGBA, /*depthBits=*/24, /*stencilBits=*/8, 0, nullptr);
  MakeCurrent();
  renderer_ = GlString(GL_RENDERER);
  version_ = GlString(GL_VERSION);
}

GlContext::~GlContext() {
  if (OSMesaGetCurrentContext() == mesa_->context) OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
}

void GlContext::MakeCurrent() const {
  if (mesa_->context == nullptr ||
      OSMesaMakeCurrent(mesa_->context, mesa_->window.data(), GL_UNSIGNED_BYTE, kWindowPixels,
                        kWindowPixels) == GL_FALSE) {
    throw InputError("OSMesa", "cannot make an OpenGL context (is libosmesa6 whole?)");
  }
}

std::string DescribeGl() {
  try {
    const GlContext gl;
    return "OSMesa: " + gl.renderer() + ", OpenGL " + gl.version();
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace sidestep::render
