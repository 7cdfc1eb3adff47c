#include "app/ui/commands.hpp"

#include "app/ui/app.hpp"
#include "app/ui/file_commands.hpp"
#include "app/ui/key_focus.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/widgets/typed_field.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace flyball {

namespace {

bool pressed(const Command& command, KeyPress key) {
  // Where a sign sits on the keyboard, and whether Shift is needed for it, is the layout's business.
  if (key.key == '?' || key.key == '+' || key.key == '=') key.shift = false;
  return key.key != 0 && (key == command.key || key == command.also);
}

} // namespace

const Command& command(std::string_view id) {
  const auto found = std::ranges::find(commands(), id, &Command::id);
  if (found == commands().end()) throw std::out_of_range("no command " + std::string(id));
  return *found;
}

bool CommandRunner::enabled(const Command& command) const {
  return !command.enabled || command.enabled(*app_);
}

bool CommandRunner::checked(const Command& command) const {
  return command.checked && command.checked(*app_);
}

std::string CommandRunner::label(const Command& command) const {
  return command.label ? command.label(*app_) : command.title;
}

std::string CommandRunner::about(const Command& command) const {
  constexpr const char* selection = "there is nothing selected that it applies to.";
  return enabled(command) ? command.help
                          : std::string("Not now: ") + (command.lacks ? command.lacks : selection);
}

void CommandRunner::run(const Command& command) const {
  command.run(*app_);
}

void CommandRunner::run(std::string_view id) const {
  if (const Command& wanted = command(id); enabled(wanted)) run(wanted);
}

void CommandRunner::open(const std::filesystem::path& file) const {
  open_file(*app_, file);
}

std::string key_text(const KeyPress& key) {
  if (key.key == 0) return {};
  std::string text = std::string(key.ctrl ? "Ctrl+" : "") + (key.shift ? "Shift+" : "");
  switch (key.key) {
  case ' ': return text + "Space";
  case keys::escape: return text + "Esc";
  case keys::tab: return text + "Tab";
  case keys::backspace: return text + "Backspace";
  case keys::del: return text + "Delete";
  case keys::f1: return text + "F1";
  case keys::f2: return text + "F2";
  case keys::f6: return text + "F6";
  case keys::f10: return text + "F10";
  case keys::menu: return text + "Menu";
  default: return text + static_cast<char>(key.key);
  }
}

namespace {

// Something has come up that has its own use for keys.
bool keys_are_wanted(const Panels& panels, const DialogState& dialog) {
  return dialog.showing || dialog.wanted != Dialog::none || panels.palette.showing() ||
         panels.palette.wanted() || panels.shortcuts.open;
}

void act_on(App& app, const KeyPress& key) {
  // The first Escape gives the keys back to the view.
  if (key == KeyPress{keys::escape} && std::exchange(app.ui.keyboard.focus, {}).in_panel) return;
  // The next one takes away what lies over the view.
  if (key == KeyPress{keys::escape} && !std::exchange(app.session.problem, {}).empty()) return;
  for (const Command& command : commands())
    if (pressed(command, key) && app.commands.enabled(command)) {
      if (may_command(app.session, app.ui, key)) command.run(app);
      return;
    }
  may_command(app.session, app.ui, key); // no command, but maybe the beginning of a number
}

// "Ctrl+S", which no text has a use for.
bool is_of_files(const KeyPress& key) {
  return key.ctrl && std::ranges::any_of(commands(), [&](const Command& command) {
           return std::string_view(command.id).starts_with("file.") && pressed(command, key);
         });
}

} // namespace

void handle_shortcuts(App& app) {
  // The palette has its own use for keys.
  if (app.panels->palette.showing()) return;
  const std::vector<KeyPress> pressed_keys = std::exchange(app.ui.keys, {});
  if (app.dialog.showing) return;
  const bool typing = ImGui::GetIO().WantTextInput || !app.ui.fields.typing.name.empty();
  for (const KeyPress& key : pressed_keys) {
    if (keys_are_wanted(*app.panels, app.dialog)) continue;
    if (!typing || (is_of_files(key) && finish_typing(app.session, app.ui))) act_on(app, key);
  }
}

} // namespace flyball
