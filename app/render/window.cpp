#include "app/render/window.hpp"

#include "app/platform/runtime_library.hpp"
#include "app/render/gl.hpp"

#include <algorithm>
#include <cstdlib>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace flyball {

namespace {

std::string glfw_error() {
  const char* words = nullptr;
  glfwGetError(&words);
  return words ? words : "unknown error";
}

// GLFW is global by nature; windows share it, the last one out closes it.
class GlfwSession {
 public:
  GlfwSession() {
    if (count_ == 0 && !glfwInit()) throw GlError("no window: " + glfw_error());
    ++count_;
  }
  ~GlfwSession() {
    if (--count_ == 0) glfwTerminate();
  }
  GlfwSession(const GlfwSession&) = delete;
  GlfwSession& operator=(const GlfwSession&) = delete;

 private:
  inline static int count_ = 0;
};

// What to do when the display goes; a C library calls it.
std::function<void()>& lost_display() {
  static std::function<void()> call;
  return call;
}

int display_is_lost(void*) {
  if (lost_display()) lost_display()();
  // Xlib would call exit(), whose handlers wait for threads that wait for the display.
  std::_Exit(EXIT_FAILURE);
}

// No larger than what the desktop leaves of the screen.
void fit_to_screen(GLFWwindow* window) {
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (!monitor) return;
  int x = 0, y = 0, width = 0, height = 0, most_wide = 0, most_high = 0;
  glfwGetMonitorWorkarea(monitor, &x, &y, &most_wide, &most_high);
  glfwGetWindowSize(window, &width, &height);
  if (most_wide <= 0 || most_high <= 0 || (width <= most_wide && height <= most_high)) return;
  glfwSetWindowSize(window, std::min(width, most_wide), std::min(height, most_high));
}

struct DestroyWindow {
  void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};

} // namespace

struct Window::State {
  GlfwSession session;
  std::unique_ptr<GLFWwindow, DestroyWindow> window;
};

void on_lost_display(std::function<void()> call) {
  lost_display() = std::move(call);
  // GLFW has loaded Xlib where it uses it.
  const RuntimeLibrary xlib({"libX11.so.6"}, RuntimeLibrary::Which::loaded);
  using Handler = int (*)(void*);
  if (const auto set = xlib.find<Handler (*)(Handler)>("XSetIOErrorHandler"))
    set(lost_display() ? display_is_lost : nullptr);
}

Window::Window(const std::string& title, int width, int height) : state_(std::make_unique<State>()) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  glfwWindowHint(GLFW_DEPTH_BITS, 0);
  glfwWindowHint(GLFW_STENCIL_BITS, 0);
  state_->window.reset(glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr));
  if (!state_->window) throw GlError("no window: " + glfw_error());
  fit_to_screen(state_->window.get());
  glfwMakeContextCurrent(state_->window.get());
  if (!gladLoadGL(reinterpret_cast<GLADloadfunc>(glfwGetProcAddress)))
    throw GlError("no window: the functions of OpenGL 3.3 could not be loaded");
  glfwSwapInterval(1);
}

Window::~Window() = default;
Window::Window(Window&&) noexcept = default;
Window& Window::operator=(Window&&) noexcept = default;

GLFWwindow* Window::handle() const {
  return state_->window.get();
}

Window::Size Window::size() const {
  Size size;
  glfwGetWindowSize(handle(), &size.width, &size.height);
  return size;
}

Window::Size Window::framebuffer_size() const {
  Size size;
  glfwGetFramebufferSize(handle(), &size.width, &size.height);
  return size;
}

float Window::content_scale() const {
  float x = 1, y = 1;
  glfwGetWindowContentScale(handle(), &x, &y);
  return x;
}

bool Window::should_close() const {
  return glfwWindowShouldClose(handle());
}
void Window::set_should_close(bool close) {
  glfwSetWindowShouldClose(handle(), close);
}
void Window::set_title(const std::string& title) {
  glfwSetWindowTitle(handle(), title.c_str());
}
void Window::swap() {
  glfwSwapBuffers(handle());
}

void Window::wait_events(double seconds) {
  if (seconds > 0)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
}

bool Window::visible() const {
  return glfwGetWindowAttrib(handle(), GLFW_VISIBLE) != 0 &&
         glfwGetWindowAttrib(handle(), GLFW_ICONIFIED) == 0;
}

std::string Window::description() const {
  return std::string(reinterpret_cast<const char*>(glGetString(GL_RENDERER))) + ", OpenGL " +
         reinterpret_cast<const char*>(glGetString(GL_VERSION));
}

} // namespace flyball
