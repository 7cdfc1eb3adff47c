#include "app/cli/window_keys.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace flyball::cli {

namespace {

bool is_letter(int key) {
  return key >= 'A' && key <= 'Z';
}

// The key as the layout labels it; on layouts of other scripts as it is on an English one.
int labelled(int key, int scancode) {
  if (key == GLFW_KEY_KP_ENTER) return GLFW_KEY_ENTER;
  if (key == GLFW_KEY_KP_ADD) return '+';
  if (key == GLFW_KEY_KP_SUBTRACT) return '-';
  if (key == GLFW_KEY_KP_0) return '0';
  if (key == GLFW_KEY_SPACE || key >= GLFW_KEY_ESCAPE) return key;
  const char* name = glfwGetKeyName(key, scancode);
  if (!name || name[0] <= ' ' || name[1] != 0) return key;
  return name[0] >= 'a' && name[0] <= 'z' ? name[0] - 'a' + 'A' : name[0];
}

// What a person holds down to have it again and again.
bool repeats(const KeyPress& press) {
  if (press.ctrl) return press.key == 'Z' || press.key == 'Y';
  return (press.key >= GLFW_KEY_RIGHT && press.key <= GLFW_KEY_PAGE_DOWN) || press.key == GLFW_KEY_TAB;
}

} // namespace

std::optional<KeyPress> pressed_key(int key, int scancode, int action, int modifiers) {
  if (action == GLFW_RELEASE || key == GLFW_KEY_UNKNOWN) return std::nullopt;
  KeyPress press;
  press.key = labelled(key, scancode);
  press.alt = (modifiers & GLFW_MOD_ALT) != 0;
  if (press.alt && (action == GLFW_REPEAT || !is_letter(press.key))) return std::nullopt;
  press.ctrl = (modifiers & (GLFW_MOD_CONTROL | GLFW_MOD_SUPER)) != 0;
  press.shift = (modifiers & GLFW_MOD_SHIFT) != 0;
  const bool menu = press.key == GLFW_KEY_MENU;
  const bool bare = (press.key >= GLFW_KEY_ESCAPE && press.key < GLFW_KEY_KP_0) || menu;
  if ((press.key >= GLFW_KEY_KP_0 && !menu) ||
      !(press.ctrl || bare || is_letter(press.key) || press.key == ' '))
    return std::nullopt;
  if (action == GLFW_REPEAT && !repeats(press)) return std::nullopt;
  return press;
}

std::optional<KeyPress> AltTap::see(int key, int action) {
  const bool alt = key == GLFW_KEY_LEFT_ALT;
  const bool tapped = alt && action == GLFW_RELEASE && down_;
  if (action != GLFW_REPEAT || !alt) down_ = alt && action == GLFW_PRESS;
  return tapped ? std::optional(KeyPress{GLFW_KEY_LEFT_ALT, false, false}) : std::nullopt;
}

std::optional<KeyPress> typed_sign(unsigned character) {
  const int key = character > ' ' && character < 127 ? static_cast<int>(character) : 0;
  if (key == 0 || is_letter(key) || (key >= 'a' && key <= 'z')) return std::nullopt;
  return KeyPress{key, false, false};
}

} // namespace flyball::cli
