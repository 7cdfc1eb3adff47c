#include "app/render/offscreen.hpp"

#include "app/render/offscreen_provider.hpp"

#include <cstdlib>
#include <string_view>

namespace flyball {
namespace {

OffscreenLibrary wanted_library() {
  const char* const text = std::getenv("FLYBALL_OFFSCREEN");
  if (!text || !*text) return OffscreenLibrary::any;
  if (std::string_view(text) == "osmesa") return OffscreenLibrary::osmesa;
  if (std::string_view(text) == "egl") return OffscreenLibrary::egl;
  throw GlError(std::string("FLYBALL_OFFSCREEN: expected osmesa or egl, found \"") + text + "\"");
}

std::unique_ptr<OffscreenProvider> make_provider(OffscreenLibrary library) {
  if (library == OffscreenLibrary::egl) return make_egl_provider();
  try {
    return make_osmesa_provider();
  } catch (const GlError& osmesa) {
    if (library == OffscreenLibrary::osmesa) throw;
    try {
      return make_egl_provider();
    } catch (const GlError& egl) {
      throw GlError(std::string("drawing without a display: ") + osmesa.what() + "; " + egl.what());
    }
  }
}

const char* text_of(GLenum what) {
  return reinterpret_cast<const char*>(glGetString(what));
}

} // namespace

OffscreenContext::OffscreenContext() : OffscreenContext(wanted_library()) {}

OffscreenContext::OffscreenContext(OffscreenLibrary library) : provider_(make_provider(library)) {
  make_current();
  if (!gladLoadGL(provider_->loader()))
    throw GlError(std::string(provider_->name()) + ": the functions of OpenGL 3.3 could not be loaded");
}

OffscreenContext::~OffscreenContext() = default;
OffscreenContext::OffscreenContext(OffscreenContext&&) noexcept = default;
OffscreenContext& OffscreenContext::operator=(OffscreenContext&&) noexcept = default;

void OffscreenContext::make_current() {
  provider_->make_current();
}

std::string OffscreenContext::description() const {
  return std::string(provider_->name()) + ", " + text_of(GL_RENDERER) + ", OpenGL " + text_of(GL_VERSION);
}

} // namespace flyball
