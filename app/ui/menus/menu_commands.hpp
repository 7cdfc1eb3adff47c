// What the menus' tables are written with. A command is given the parts of the App that it takes.
#pragma once

#include "app/ui/app.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/panel_list.hpp"
#include "app/ui/tools/tools.hpp"

#include <span>
#include <utility>

namespace flyball::menus {

// The commands of each menu, in its order.
std::span<const Command> file();
std::span<const Command> edit();
std::span<const Command> insert();
std::span<const Command> view();
std::span<const Command> units();
std::span<const Command> study();
std::span<const Command> help();

constexpr KeyPress plain(int key) {
  return {key, false, false};
}
constexpr KeyPress ctrl(int key) {
  return {key, true, false};
}
constexpr KeyPress shift(int key) {
  return {key, false, true};
}
constexpr KeyPress ctrl_shift(int key) {
  return {key, true, true};
}

// Each part of the App that a command may take.
struct AnyPart {
  App& app;
  operator Session&() const { return app.session; }
  operator ToolState&() const { return app.tool; }
  operator ViewState&() const { return app.view; }
  operator ViewContext() const { return app.context(); }
};

template <class... Parts>
void give(App& app, void (*command)(Parts...)) {
  command(static_cast<Parts>(AnyPart{app})...);
}

// A command that is given the parts that it takes.
template <auto command>
void given(App& app) {
  give(app, command);
}

template <auto dialog>
void open_dialog_of(App& app) {
  ((*app.panels).*dialog).open(app.session, app.dialog);
}

// What the session tells.
template <auto told>
auto of_session(const App& app) {
  return told(app.session);
}

template <auto told>
bool of_tool(const App& app) {
  return told(app.session, app.tool);
}

inline bool any_selected(const Session& session) {
  return !session.selection().empty();
}
inline bool holds_parts(const Session& session) {
  return !session.mechanism().bodies.empty();
}

template <Tool tool>
void choose_tool(App& app) {
  set_tool(app.session, app.ui, app.tool, tool);
}
template <Tool tool>
bool tool_chosen(const App& app) {
  return app.tool.tool == tool;
}

} // namespace flyball::menus
