// What makes OpenGL contexts without a display: one implementation a library.
#pragma once

#include "app/platform/runtime_library.hpp"
#include "app/render/gl.hpp"

#include <memory>

namespace flyball {

class OffscreenProvider {
 public:
  virtual ~OffscreenProvider() = default;
  virtual const char* name() const = 0;
  virtual void make_current() = 0; // throws GlError
  virtual GLADloadfunc loader() const = 0;
};

// With a context of OpenGL 3.3 core that is not current yet. Throw GlError.
std::unique_ptr<OffscreenProvider> make_osmesa_provider();
std::unique_ptr<OffscreenProvider> make_egl_provider();

// Throws GlError where the library has no such function.
template <typename Function>
void find_function(const RuntimeLibrary& library, Function& function, const char* name) {
  function = library.find<Function>(name);
  if (!function) throw GlError(std::string("the library has no ") + name);
}

} // namespace flyball
