// What makes OpenGL contexts without a display: one implementation a library.
#pragma once

#include "app/render/gl.hpp"

#include <dlfcn.h>
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

// A library of the system's, loaded at run time.
class RuntimeLibrary {
 public:
  // The first of these names that is there.
  explicit RuntimeLibrary(std::initializer_list<const char*> names) {
    for (const char* name : names)
      if (!handle_) handle_.reset(dlopen(name, RTLD_NOW | RTLD_LOCAL));
  }
  explicit operator bool() const { return handle_ != nullptr; }
  template <typename Function>
  void find(Function& function, const char* name) const {
    function = reinterpret_cast<Function>(dlsym(handle_.get(), name));
    if (!function) throw GlError(std::string("the library has no ") + name);
  }

 private:
  struct Close {
    void operator()(void* handle) const { dlclose(handle); }
  };
  std::unique_ptr<void, Close> handle_;
};

} // namespace flyball
