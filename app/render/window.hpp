// A window on the desktop with an OpenGL 3.3 core context, through GLFW.
#pragma once

#include <functional>
#include <memory>
#include <string>

struct GLFWwindow;

namespace flyball {

// When the display goes, Xlib ends the program; it calls this first, from whichever thread notices. Nothing
// to do with windows or OpenGL works any more. Empty for none.
void on_lost_display(std::function<void()> call);

class Window {
 public:
  // Makes its context current. Throws GlError in GLFW's words where there is no display or no OpenGL 3.3.
  Window(const std::string& title, int width, int height);
  ~Window();
  Window(Window&&) noexcept;
  Window& operator=(Window&&) noexcept;

  GLFWwindow* handle() const; // for the ImGui backend and input
  struct Size {
    int width = 0, height = 0;
  };
  Size size() const;             // window coordinates, as the mouse reports them
  Size framebuffer_size() const; // pixels
  float content_scale() const;   // 1 or 2 for most displays
  bool should_close() const;
  void set_should_close(bool close);
  void set_title(const std::string& title);
  void swap();
  // Handles what the person did; waits up to `seconds` for something to happen, not at all for 0.
  void wait_events(double seconds);
  // Whether any of it can be seen: not while it is an icon or unmapped.
  bool visible() const;
  std::string description() const; // renderer and version, as OpenGL reports them

 private:
  struct State;
  std::unique_ptr<State> state_;
};

} // namespace flyball
