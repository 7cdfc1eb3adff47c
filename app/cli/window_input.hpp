// What a hand does at the window, given to Dear ImGui in its order. However slow frames are, each key sees
// what the one before has done: text, Tab and text again go into two fields.
#pragma once

#include "app/cli/window_keys.hpp"
#include "app/render/window.hpp"

#include <array>
#include <deque>
#include <optional>
#include <vector>

namespace flyball::cli {

// A key or a button that went down or up, or a character that was typed, in GLFW's terms.
struct WindowEvent {
  enum class Kind { key, character, button };
  Kind kind = Kind::key;
  int code = 0, scancode = 0, action = 0, modifiers = 0;
  unsigned character = 0;
  double x = 0, y = 0; // of a button: where the mouse was, in the window's coordinates
};

class WindowInput {
 public:
  // For the present ImGui context, which it is a backend of.
  explicit WindowInput(const Window& window);
  ~WindowInput();
  WindowInput(const WindowInput&) = delete;
  WindowInput& operator=(const WindowInput&) = delete;

  void note(WindowEvent event);
  // The mouse has come to a place, in the window's coordinates.
  void move_to(double x, double y) {
    cursor_ = {x, y};
    inside_ = true;
  }
  // It is elsewhere on the screen.
  void leave() { inside_ = false; }
  // Whether there is more than one frame could take.
  bool pending() const { return !events_.empty(); }
  // Frames that what one read() gave needs until the next may be read: a field that Tab goes to takes the
  // keyboard in the third.
  static constexpr int frames_each = 3;

  // Gives what one frame takes: characters, or one key that does something beside typing one. Presses are
  // added to `keys`.
  void read(std::vector<KeyPress>& keys);
  // A frame in which nothing new happens.
  void rest();
  // Whether the last read() found anything new.
  bool changed() const { return changed_; }

 private:
  void give(const WindowEvent& event, std::vector<KeyPress>& keys);
  void take_over(const std::vector<KeyPress>& keys);
  void hold(const std::vector<KeyPress>& keys);
  void look(const std::vector<KeyPress>& keys);

  const Window& window_;
  std::deque<WindowEvent> events_;
  AltTap alt_;
  std::vector<int> held_;         // shown as down for one frame
  std::array<bool, 5> buttons_{}; // down, of what was given
  bool placed_ = false;           // the mouse is where the next event presses it
  std::array<double, 2> cursor_{};
  bool inside_ = true;                          // the mouse is over the window
  std::optional<std::array<double, 2>> button_; // where one was pressed or let go in the last read()
  std::array<float, 5> mouse_{};
  bool changed_ = false;
};

} // namespace flyball::cli
