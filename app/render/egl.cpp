#include "app/render/offscreen_provider.hpp"

#if __has_include(<EGL/eglext.h>)

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <string_view>

namespace flyball {
namespace {

// The display of this process. EGL counts no users of a display, so it is initialised once and stays.
class EglDisplay {
 public:
  static const EglDisplay& instance() {
    static const EglDisplay display;
    return display;
  }

  template <typename Function>
  void find(Function& function, const char* name) const {
    find_function(library_, function, name);
  }
  EGLDisplay get() const { return display_; }
  EGLConfig config() const { return config_; }

 private:
  EglDisplay() {
    if (!library_) throw GlError("there is no libEGL (package libegl1 with a driver such as libegl-mesa0)");
    decltype(&eglQueryString) query = nullptr;
    decltype(&eglGetProcAddress) address = nullptr;
    find(query, "eglQueryString");
    find(address, "eglGetProcAddress");
    const char* const known = query(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const std::string_view extensions = known ? known : "";
    const auto display_of =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(address("eglGetPlatformDisplayEXT"));
    const bool surfaceless = extensions.find("EGL_MESA_platform_surfaceless") != std::string_view::npos;
    if (display_of && surfaceless &&
        initialize(display_of(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)))
      return;
    // Drivers other than Mesa's list their cards.
    const auto devices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(address("eglQueryDevicesEXT"));
    std::array<EGLDeviceEXT, 16> device{};
    EGLint count = 0;
    if (display_of && devices && devices(device.size(), device.data(), &count))
      for (EGLint i = 0; i < count; ++i)
        if (initialize(display_of(EGL_PLATFORM_DEVICE_EXT, device[static_cast<std::size_t>(i)], nullptr)))
          return;
    throw GlError("EGL has no display without a surface; is there a driver (package libegl-mesa0)?");
  }

  bool initialize(EGLDisplay display) {
    decltype(&eglInitialize) start = nullptr;
    decltype(&eglBindAPI) bind = nullptr;
    decltype(&eglChooseConfig) choose = nullptr;
    find(start, "eglInitialize");
    find(bind, "eglBindAPI");
    find(choose, "eglChooseConfig");
    if (display == EGL_NO_DISPLAY || !start(display, nullptr, nullptr) || !bind(EGL_OPENGL_API)) return false;
    // Everything is drawn into framebuffer objects, so that any configuration does.
    constexpr EGLint attributes[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_DONT_CARE,
                                     EGL_NONE};
    EGLint count = 0;
    if (!choose(display, attributes, &config_, 1, &count) || count < 1) return false;
    display_ = display;
    return true;
  }

  RuntimeLibrary library_{"libEGL.so.1", "libEGL.so"};
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLConfig config_ = nullptr;
};

class EglProvider final : public OffscreenProvider {
 public:
  EglProvider() : display_(EglDisplay::instance()) {
    decltype(&eglCreateContext) create = nullptr;
    decltype(&eglBindAPI) bind = nullptr;
    display_.find(create, "eglCreateContext");
    display_.find(bind, "eglBindAPI");
    display_.find(make_current_, "eglMakeCurrent");
    display_.find(current_, "eglGetCurrentContext");
    display_.find(destroy_, "eglDestroyContext");
    display_.find(address_, "eglGetProcAddress");
    constexpr EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                     3,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     3,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                     EGL_NONE};
    bind(EGL_OPENGL_API); // a setting of the thread
    context_ = create(display_.get(), display_.config(), EGL_NO_CONTEXT, attributes);
    if (context_ == EGL_NO_CONTEXT) throw GlError("EGL gives no OpenGL 3.3 core context");
  }
  ~EglProvider() override {
    // Another may have become the thread's since.
    if (current_() == context_) make_current_(display_.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    destroy_(display_.get(), context_);
  }
  const char* name() const override { return "EGL"; }
  void make_current() override {
    if (!make_current_(display_.get(), EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      throw GlError("EGL: the context cannot be made current without a surface");
  }
  GLADloadfunc loader() const override { return reinterpret_cast<GLADloadfunc>(address_); }

 private:
  const EglDisplay& display_;
  decltype(&eglMakeCurrent) make_current_ = nullptr;
  decltype(&eglGetCurrentContext) current_ = nullptr;
  decltype(&eglDestroyContext) destroy_ = nullptr;
  decltype(&eglGetProcAddress) address_ = nullptr;
  EGLContext context_ = EGL_NO_CONTEXT;
};

} // namespace

std::unique_ptr<OffscreenProvider> make_egl_provider() {
  return std::make_unique<EglProvider>();
}

} // namespace flyball

#else

namespace flyball {

std::unique_ptr<OffscreenProvider> make_egl_provider() {
  throw GlError("this build is without EGL");
}

} // namespace flyball

#endif
