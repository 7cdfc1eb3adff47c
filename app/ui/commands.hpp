// Everything a person can ask for by name: one table that menus, shortcuts, the palette and the sheet of
// shortcuts are made of.
#pragma once

#include "app/ui/ui.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace flyball {

struct App;

struct Command {
  const char* id;    // "edit.undo": its menu and a word; menus hold the commands in the table's order
  const char* title; // as in the menu
  const char* help;  // one sentence
  KeyPress key{};    // key 0: none
  KeyPress also{};   // another key for it
  void (*run)(App&) = nullptr;
  bool (*enabled)(const App&) = nullptr;      // null: always
  bool (*checked)(const App&) = nullptr;      // null: no state
  bool separated = false;                     // a line above it in the menu
  std::string (*label)(const App&) = nullptr; // a longer title; null: `title`
  const char* words = nullptr;                // by which the palette finds it as well
  const char* lacks = nullptr;                // a clause on why it is not enabled; null: a selection
};

std::span<const Command> commands();
const Command& command(std::string_view id); // throws std::out_of_range

// The commands as menus and buttons see them, which need to know nothing of what they act on.
class CommandRunner {
 public:
  explicit CommandRunner(App& app) : app_(&app) {}
  bool enabled(const Command& command) const;
  bool checked(const Command& command) const;
  std::string label(const Command& command) const;
  std::string about(const Command& command) const;    // what it does, or why it cannot now
  void run(const Command& command) const;             // whether or not it is enabled
  void run(std::string_view id) const;                // where it is enabled
  void open(const std::filesystem::path& file) const; // asks first

 private:
  App* app_;
};

// "Ctrl+Shift+Z", "F2", "Delete"; empty without one.
std::string key_text(const KeyPress& key);

// The keys of the last frames, unless something is being typed.
void handle_shortcuts(App& app);

std::span<const char* const> menu_titles(); // of the bar, from left to right

// GLFW's codes of keys without a character.
namespace keys {
inline constexpr int escape = 256, enter = 257, tab = 258, backspace = 259, insert = 260, del = 261,
                     right = 262, left = 263, down = 264, up = 265, page_up = 266, page_down = 267,
                     home = 268, end = 269, f1 = 290, f2 = 291, f6 = 295, f10 = 299, alt = 342, menu = 348;
} // namespace keys

} // namespace flyball
