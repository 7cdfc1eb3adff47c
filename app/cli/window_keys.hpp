// What was pressed in a window, as the keyboard's layout has it.
#pragma once

#include "app/ui/app.hpp"

#include <optional>

namespace flyball::cli {

// From GLFW's key callback: letters, keys without a character, and anything together with Ctrl. Nothing for
// the rest, which typed_sign() has, and for keys that repeat nothing while they are held.
std::optional<KeyPress> pressed_key(int key, int scancode, int action, int modifiers);
// Alt pressed and let go with nothing in between, which opens the menus.
class AltTap {
 public:
  std::optional<KeyPress> see(int key, int action);
  void disturb() { down_ = false; } // by a click, say

 private:
  bool down_ = false;
};
// From GLFW's character callback: digits and signs, wherever the layout has them and with whatever keys.
std::optional<KeyPress> typed_sign(unsigned character);

} // namespace flyball::cli
