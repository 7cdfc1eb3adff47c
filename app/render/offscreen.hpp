// An OpenGL context without a display: OSMesa, loaded when asked for, so that the program runs without it.
#pragma once

#include <memory>
#include <string>

namespace flyball {

class OffscreenContext {
 public:
  // Makes the context current on this thread. Throws GlError naming the package to install where libOSMesa
  // is missing.
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(OffscreenContext&&) noexcept;
  OffscreenContext& operator=(OffscreenContext&&) noexcept;

  void make_current();
  std::string description() const; // renderer and version, as OpenGL reports them

 private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace flyball
