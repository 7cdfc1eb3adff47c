#include "app/render/offscreen_provider.hpp"

// Mesa has it up to 25.0.
#if __has_include(<GL/osmesa.h>)

// glad takes back the words for calling conventions that it shares with <GL/gl.h>.
#ifndef APIENTRY
#define APIENTRY
#endif
#ifndef GLAPI
#define GLAPI extern
#endif
#include <GL/osmesa.h>

#include <array>

namespace flyball {
namespace {

class OsmesaProvider final : public OffscreenProvider {
 public:
  OsmesaProvider() {
    if (!library_) throw GlError("there is no libOSMesa (package libosmesa6)");
    find_function(library_, create_, "OSMesaCreateContextAttribs");
    find_function(library_, make_current_, "OSMesaMakeCurrent");
    find_function(library_, destroy_, "OSMesaDestroyContext");
    find_function(library_, address_, "OSMesaGetProcAddress");
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
    context_ = create_(attributes, nullptr);
    if (!context_) throw GlError("OSMesa gives no OpenGL 3.3 core context");
  }
  ~OsmesaProvider() override {
    if (context_) destroy_(context_);
  }
  const char* name() const override { return "OSMesa"; }
  void make_current() override {
    if (!make_current_(context_, pixel_.data(), GL_UNSIGNED_BYTE, 1, 1))
      throw GlError("OSMesa: the context cannot be made current");
  }
  GLADloadfunc loader() const override { return reinterpret_cast<GLADloadfunc>(address_); }

 private:
  RuntimeLibrary library_{"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"};
  decltype(&OSMesaCreateContextAttribs) create_ = nullptr;
  decltype(&OSMesaMakeCurrent) make_current_ = nullptr;
  decltype(&OSMesaDestroyContext) destroy_ = nullptr;
  decltype(&OSMesaGetProcAddress) address_ = nullptr;
  OSMesaContext context_ = nullptr;
  // OSMesa insists on a picture of its own; everything is drawn into framebuffer objects instead.
  std::array<unsigned char, 4> pixel_{};
};

} // namespace

std::unique_ptr<OffscreenProvider> make_osmesa_provider() {
  return std::make_unique<OsmesaProvider>();
}

} // namespace flyball

#else

namespace flyball {

std::unique_ptr<OffscreenProvider> make_osmesa_provider() {
  throw GlError("this build is without OSMesa");
}

} // namespace flyball

#endif
