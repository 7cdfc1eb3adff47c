#include "app/render/offscreen.hpp"

#include "app/render/gl.hpp"

#include <GL/osmesa.h>

#include <array>
#include <dlfcn.h>

namespace flyball {

namespace {

struct CloseLibrary {
  void operator()(void* handle) const { dlclose(handle); }
};

void* open_library() {
  for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"})
    if (void* handle = dlopen(name, RTLD_NOW | RTLD_LOCAL)) return handle;
  throw GlError("drawing without a display needs libOSMesa (package libosmesa6)");
}

} // namespace

struct OffscreenContext::State {
  std::unique_ptr<void, CloseLibrary> library;
  decltype(&OSMesaCreateContextAttribs) create = nullptr;
  decltype(&OSMesaMakeCurrent) make_current = nullptr;
  decltype(&OSMesaDestroyContext) destroy = nullptr;
  decltype(&OSMesaGetProcAddress) address = nullptr;
  OSMesaContext context = nullptr;
  // OSMesa insists on a picture of its own; everything is drawn into framebuffer objects instead.
  std::array<unsigned char, 4> pixel{};

  template <typename Function>
  void find(Function& function, const char* name) {
    function = reinterpret_cast<Function>(dlsym(library.get(), name));
    if (!function) throw GlError(std::string("libOSMesa has no ") + name);
  }
  ~State() {
    if (context) destroy(context);
  }
};

OffscreenContext::OffscreenContext() : state_(std::make_unique<State>()) {
  state_->library.reset(open_library());
  state_->find(state_->create, "OSMesaCreateContextAttribs");
  state_->find(state_->make_current, "OSMesaMakeCurrent");
  state_->find(state_->destroy, "OSMesaDestroyContext");
  state_->find(state_->address, "OSMesaGetProcAddress");
  constexpr int attributes[] = {OSMESA_FORMAT,
                                OSMESA_RGBA,
                                OSMESA_DEPTH_BITS,
                                0,
                                OSMESA_PROFILE,
                                OSMESA_CORE_PROFILE,
                                OSMESA_CONTEXT_MAJOR_VERSION,
                                3,
                                OSMESA_CONTEXT_MINOR_VERSION,
                                3,
                                0};
  state_->context = state_->create(attributes, nullptr);
  if (!state_->context) throw GlError("OSMesa gives no OpenGL 3.3 core context");
  make_current();
  if (!gladLoadGL(reinterpret_cast<GLADloadfunc>(state_->address)))
    throw GlError("OSMesa: the functions of OpenGL 3.3 could not be loaded");
}

OffscreenContext::~OffscreenContext() = default;
OffscreenContext::OffscreenContext(OffscreenContext&&) noexcept = default;
OffscreenContext& OffscreenContext::operator=(OffscreenContext&&) noexcept = default;

void OffscreenContext::make_current() {
  if (!state_->make_current(state_->context, state_->pixel.data(), GL_UNSIGNED_BYTE, 1, 1))
    throw GlError("OSMesa: the context cannot be made current");
}

std::string OffscreenContext::description() const {
  return std::string(reinterpret_cast<const char*>(glGetString(GL_RENDERER))) + ", OpenGL " +
         reinterpret_cast<const char*>(glGetString(GL_VERSION));
}

} // namespace flyball
