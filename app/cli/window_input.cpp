#include "app/cli/window_input.hpp"

#include "app/render/imgui_compat.hpp"

#include <backends/imgui_impl_glfw.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace flyball::cli {

namespace {

bool is_modifier(int key) {
  return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER;
}

// Whether it only adds to a text: letters, digits, signs, which come as characters, too.
bool only_types(const WindowEvent& event) {
  if (event.kind == WindowEvent::Kind::character) return true;
  if (event.kind == WindowEvent::Kind::button) return false;
  const bool command = (event.modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0;
  return is_modifier(event.code) || (!command && event.code < GLFW_KEY_ESCAPE);
}

bool is_press(const WindowEvent& event) {
  return event.kind == WindowEvent::Kind::button && event.action == GLFW_PRESS;
}

// Before 1.87 Dear ImGui asks for the present place in every frame.
void place_mouse([[maybe_unused]] GLFWwindow* window, [[maybe_unused]] double x, [[maybe_unused]] double y) {
#if IMGUI_VERSION_NUM >= 18700
  ImGui_ImplGlfw_CursorPosCallback(window, x, y);
#endif
}

// As they are once the event has happened: GLFW tells them as they were before.
[[maybe_unused]] void set_modifiers_after(const WindowEvent& event) {
  const auto down = [&](int left, int right, int bit) {
    if (event.code == left || event.code == right) return event.action != GLFW_RELEASE;
    return (event.modifiers & bit) != 0;
  };
  imgui_compat::set_modifiers(down(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL, GLFW_MOD_CONTROL),
                              down(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT, GLFW_MOD_SHIFT),
                              down(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT, GLFW_MOD_ALT));
}

} // namespace

WindowInput::WindowInput(const Window& window) : window_(window) {
  ImGui_ImplGlfw_InitForOpenGL(window.handle(), false);
  imgui_compat::take_events_at_once(); // read() gives as many as a frame is to see
  glfwGetCursorPos(window.handle(), &cursor_[0], &cursor_[1]);
}

WindowInput::~WindowInput() {
  ImGui_ImplGlfw_Shutdown();
}

void WindowInput::note(WindowEvent event) {
  // Of a key that is held while more waits: Dear ImGui repeats by a clock of its own, and text comes as
  // characters.
  if (event.kind == WindowEvent::Kind::key && event.action == GLFW_REPEAT && pending()) return;
  event.x = cursor_[0];
  event.y = cursor_[1];
  events_.push_back(event);
}

void WindowInput::give(const WindowEvent& event, std::vector<KeyPress>& keys) {
  GLFWwindow* window = window_.handle();
  switch (event.kind) {
  case WindowEvent::Kind::key:
    ImGui_ImplGlfw_KeyCallback(window, event.code, event.scancode, event.action, event.modifiers);
    if constexpr (imgui_compat::queues_events)
      set_modifiers_after(event); // it has asked for the present ones
    if (const auto press = pressed_key(event.code, event.scancode, event.action, event.modifiers))
      keys.push_back(*press);
    if (const auto tap = alt_.see(event.code, event.action)) keys.push_back(*tap);
    break;
  case WindowEvent::Kind::character:
    ImGui_ImplGlfw_CharCallback(window, event.character);
    if (const auto press = typed_sign(event.character)) keys.push_back(*press);
    break;
  case WindowEvent::Kind::button:
    place_mouse(window, event.x, event.y);
    ImGui_ImplGlfw_MouseButtonCallback(window, event.code, event.action, event.modifiers);
    alt_.disturb();
    if (event.code >= 0 && event.code < static_cast<int>(buttons_.size()))
      buttons_[static_cast<std::size_t>(event.code)] = event.action != GLFW_RELEASE;
    button_ = {event.x, event.y};
    break;
  }
}

void WindowInput::read(std::vector<KeyPress>& keys) {
  button_.reset();
  if (!events_.empty() && !placed_ && is_press(events_.front())) {
    // The mouse comes to the place first, where what lies under it is seen, and is pressed then.
    placed_ = true;
    button_ = {events_.front().x, events_.front().y};
    return take_over(keys);
  }
  placed_ = false;
  bool typed = false; // a key that does more comes by itself, when what was typed has been taken
  while (!events_.empty()) {
    const WindowEvent event = events_.front();
    const bool types = only_types(event);
    if (!types && typed) break;
    events_.pop_front();
    give(event, keys);
    if (!types) break;
    typed = true;
  }
  take_over(keys);
}

void WindowInput::rest() {
  take_over({});
}

// The interface counts in pixels; on some desktops the mouse counts in points. `keys` went down since the
// last frame: Dear ImGui 1.86 would not see one that is up again by now.
void WindowInput::take_over(const std::vector<KeyPress>& keys) {
  const auto [x, y] = button_.value_or(cursor_);
  if (inside_ || button_) place_mouse(window_.handle(), x, y);
  ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  if constexpr (!imgui_compat::queues_events) { // else they come in their order by themselves
    for (std::size_t i = 0; i < buttons_.size(); ++i)
      io.MouseDown[i] = buttons_[i];
    if (button_) io.MousePos = {static_cast<float>(x), static_cast<float>(y)};
  }
  hold(keys);
  look(keys);
  const auto points = window_.size(), pixels = window_.framebuffer_size();
  if (points.width <= 0 || points.width == pixels.width || !ImGui::IsMousePosValid()) return;
  const float ratio = static_cast<float>(pixels.width) / static_cast<float>(points.width);
  io.MousePos = {io.MousePos.x * ratio, io.MousePos.y * ratio};
}

void WindowInput::look(const std::vector<KeyPress>& keys) {
  const ImGuiIO& io = ImGui::GetIO();
  const std::array now{io.MousePos.x, io.MousePos.y, io.MouseDown[0] ? 1.f : 0.f, io.MouseDown[1] ? 1.f : 0.f,
                       io.MouseDown[2] ? 1.f : 0.f};
  changed_ = now != mouse_ || io.MouseWheel != 0 || io.InputQueueCharacters.Size > 0 || !keys.empty();
  mouse_ = now;
}

void WindowInput::hold(const std::vector<KeyPress>& keys) {
  if constexpr (imgui_compat::queues_events) return;
  for (const int key : held_)
    imgui_compat::set_key(key, glfwGetKey(window_.handle(), key) == GLFW_PRESS);
  held_.clear();
  for (const KeyPress& press : keys) {
    const bool known = press.key >= GLFW_KEY_SPACE && press.key <= GLFW_KEY_LAST;
    if (!known || imgui_compat::key_is_down(press.key)) continue;
    imgui_compat::set_key(press.key, true);
    held_.push_back(press.key);
  }
}

} // namespace flyball::cli
