// An OpenGL context without a display: by OSMesa, else by EGL without a surface. Their libraries are loaded
// when asked for, so that the program runs without them.
#pragma once

#include <memory>
#include <string>

namespace flyball {

enum class OffscreenLibrary { any, osmesa, egl }; // any: the first of the others that is there

class OffscreenProvider;

class OffscreenContext {
 public:
  // As the environment variable FLYBALL_OFFSCREEN says: osmesa or egl; unset: any.
  OffscreenContext();
  // Makes the context current on this thread. Throws GlError that says what failed, and which packages would
  // help where nothing is there.
  explicit OffscreenContext(OffscreenLibrary library);
  ~OffscreenContext();
  OffscreenContext(OffscreenContext&&) noexcept;
  OffscreenContext& operator=(OffscreenContext&&) noexcept;

  void make_current();
  // Library, renderer and version: "OSMesa, llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 4.5 ...".
  std::string description() const;

 private:
  std::unique_ptr<OffscreenProvider> provider_;
};

} // namespace flyball
