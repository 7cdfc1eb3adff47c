#include "app/ui/keyboard/keyboard.hpp"

#include "app/render/imgui_compat.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/dialog_state.hpp"
#include "app/ui/keyboard/focus_order.hpp"
#include "app/ui/keyboard/menu_keys.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace flyball {

namespace {

constexpr int patience_to_draw = 4; // frames in which a widget may be undrawn before the focus goes elsewhere
constexpr int rows_a_page = 10;

bool is_arrow(int key) {
  return key >= keys::right && key <= keys::up;
}
bool is_digit_or_sign(int key) {
  return (key >= '0' && key <= '9') || key == '-' || key == '+' || key == '.' || key == ',';
}

// The field that Dear ImGui types in.
const KeyStop* typed_stop(const KeyboardState& state) {
  const ImGuiContext& context = *ImGui::GetCurrentContext();
  if (context.ActiveId == 0 || !context.IO.WantTextInput) return nullptr;
  const auto found = std::ranges::find(state.stops, context.ActiveId, &KeyStop::id);
  return found == state.stops.end() ? nullptr : &*found;
}

const KeyStop* focused_stop(const KeyboardState& state) {
  if (const KeyStop* typed = typed_stop(state)) return typed;
  return stop_named(state.stops, state.at);
}

// Lists are walked through by arrows also after a click; otherwise it takes a key to have the focus.
bool has_keys(const KeyboardState& state, const KeyStop* stop) {
  return stop && (state.ring || stop->use == KeyUse::row);
}

// Characters that come before the field has the keyboard wait for it.
void hold_characters(KeyboardState& state) {
  if (state.ahead_frames == 0) return;
  ImVector<ImWchar>& queue = ImGui::GetIO().InputQueueCharacters;
  for (const ImWchar character : queue)
    state.ahead.push_back(character);
  queue.resize(0);
  if (--state.ahead_frames > 0) return;
  for (const ImWchar character : state.ahead)
    queue.push_back(character);
  state.ahead.clear();
}

void begin_typing(KeyboardState& state, const KeyStop& stop) {
  imgui_compat::press_item(stop.id, true);
  state.ahead_frames = 2; // it is pressed in the next frame, and takes characters from the one after that
}

void go(Ui& ui, const KeyStop& stop, bool type) {
  KeyboardState& state = ui.keyboard;
  if (typed_stop(state)) ImGui::ClearActiveID(); // what was typed is taken
  state.at = stop.name;
  state.region = region_of(stop);
  state.was[state.region] = stop.name;
  state.ring = true;
  state.reveal = 3;
  state.missing = 0;
  state.opening.clear();
  if (!type || stop.use != KeyUse::type) return;
  begin_typing(state, stop);
  state.opening = stop.name;
}

void go_to_view(Ui& ui, bool ring) {
  KeyboardState& state = ui.keyboard;
  if (typed_stop(state)) ImGui::ClearActiveID();
  state.at.clear();
  state.region = view_region;
  state.ring = ring;
  ui.keyboard.focus = {};
}

void go_to_region(Ui& ui, int step) {
  KeyboardState& state = ui.keyboard;
  const KeyStop* now = focused_stop(state);
  const std::string next = next_region(state.stops, now ? region_of(*now) : std::string(view_region), step);
  if (next == view_region) return go_to_view(ui, true);
  const auto was = state.was.find(next);
  const KeyStop* stop = was == state.was.end() ? nullptr : stop_named(state.stops, was->second);
  if (!stop || region_of(*stop) != next) stop = tab_stop(state, next, nullptr, 1);
  if (stop) go(ui, *stop, false);
}

void press(Ui& ui, const KeyStop& stop) {
  if (stop.use == KeyUse::type) return begin_typing(ui.keyboard, stop);
  if (stop.use == KeyUse::slide) {
    // Its number is typed in the field beside it.
    if (const KeyStop* field = stop_named(ui.keyboard.stops, stop.name + "/value")) go(ui, *field, true);
    return;
  }
  imgui_compat::press_item(stop.id, false);
}

// Digits begin the number of the slider or field that has the keys.
void begin_number(Ui& ui, const KeyStop& stop) {
  press(ui, stop);
  KeyboardState& state = ui.keyboard;
  if (state.ahead_frames == 0) return;
  ImVector<ImWchar>& queue = ImGui::GetIO().InputQueueCharacters;
  for (const ImWchar character : queue)
    state.ahead.push_back(character);
  queue.resize(0);
}

bool nudge(Ui& ui, const KeyStop& stop, const KeyPress& key) {
  const bool plot = stop.use == KeyUse::plot;
  KeyNudge wanted{.name = stop.name};
  wanted.size = key.shift ? 0.1 : key.ctrl ? 10 : 1;
  switch (key.key) {
  case keys::right: wanted.x = 1; break;
  case keys::left: wanted.x = -1; break;
  case keys::up: wanted.y = plot ? 1 : 0; break;
  case keys::down: wanted.y = plot ? -1 : 0; break;
  case keys::page_up:
  case keys::page_down:
    wanted.x = key.key == keys::page_up ? 1 : -1;
    wanted.size = 10;
    break;
  case keys::home: wanted.end = plot ? 0 : -1, wanted.fit = plot; break;
  case keys::end: wanted.end = plot ? 0 : 1; break;
  case '+':
  case '=': wanted.zoom = plot && !key.ctrl ? 1 : 0; break;
  case '-': wanted.zoom = plot && !key.ctrl ? -1 : 0; break;
  case keys::enter: wanted.enter = plot; break;
  default: break;
  }
  if (!wanted.x && !wanted.y && !wanted.end && !wanted.zoom && !wanted.fit && !wanted.enter) return false;
  if (ui.keyboard.nudge.name == stop.name) { // several in one frame
    wanted.x += ui.keyboard.nudge.x;
    wanted.y += ui.keyboard.nudge.y;
  }
  ui.keyboard.nudged = stop.name;
  ui.keyboard.nudge = std::move(wanted);
  ui.keyboard.ring = true;
  return true;
}

bool move_by_arrow(Ui& ui, const KeyStop& stop, const KeyPress& key) {
  const KeyStop* next = nullptr;
  if (key.key == keys::home || key.key == keys::end)
    next = last_stop(ui.keyboard, stop, key.key == keys::end);
  else if (key.key == keys::page_up || key.key == keys::page_down)
    next = stop.use == KeyUse::row
               ? row_away(ui.keyboard.stops, stop, key.key == keys::page_down ? rows_a_page : -rows_a_page)
               : nullptr;
  else if (is_arrow(key.key))
    next = nearest_stop(ui.keyboard.stops, stop, key.key);
  else
    return false;
  if (!next) return true;
  go(ui, *next, false);
  // Parts are chosen as one goes through them; rows that do more wait for Enter.
  if (next->use == KeyUse::row && next->name.starts_with("outline/")) press(ui, *next);
  return true;
}

// Escape goes back one step: from a list or menu to what opened it, from a widget to the view.
bool step_out(Ui& ui, const DialogState& dialog) {
  KeyboardState& state = ui.keyboard;
  const int open = ImGui::GetCurrentContext()->OpenPopupStack.Size;
  if (dialog.showing && open <= 1) return false; // has its own use for it
  if (open > 0) {
    ImGui::ClosePopupToLevel(open - 1, true);
    return true;
  }
  if (!state.ring) { // of clicks key_focus.hpp keeps account
    state.at.clear();
    return false;
  }
  go_to_view(ui, false);
  return true;
}

bool take_stop_key(Ui& ui, const KeyStop& stop, const KeyPress& key) {
  KeyboardState& state = ui.keyboard;
  const bool number = stop.use == KeyUse::slide || stop.use == KeyUse::type;
  if ((stop.use == KeyUse::slide || stop.use == KeyUse::plot) && nudge(ui, stop, key)) return true;
  if (!key.ctrl && (key.key == keys::menu || (key.shift && key.key == keys::f10))) {
    state.menu_of = stop.name;
    return true;
  }
  if (move_by_arrow(ui, stop, key)) return true;
  if (!state.ring) return false;
  if (key.key == keys::enter || (key.key == ' ' && !key.ctrl && stop.use != KeyUse::plot)) {
    press(ui, stop);
    return true;
  }
  if (key.ctrl) return number && (key.key == 'X' || key.key == 'V'); // it is not the part that is meant
  if (key.key == keys::f2 && number) {
    press(ui, stop);
    return true;
  }
  if (key.key == keys::del || key.key == keys::backspace) return number;
  if (!is_digit_or_sign(key.key)) return false;
  if (number) begin_number(ui, stop);
  return true; // the beginning of a number is no command
}

bool take_focus_key(Ui& ui, const DialogState& dialog, const CommandRunner& commands, const KeyPress& key) {
  KeyboardState& state = ui.keyboard;
  const KeyStop* stop = focused_stop(state);
  const bool typing = ImGui::GetIO().WantTextInput;
  const int open = ImGui::GetCurrentContext()->OpenPopupStack.Size;
  if (key.alt || key.key == keys::alt) return take_alt(ui, dialog, key);
  if (key.key == keys::escape) return !typing && step_out(ui, dialog);
  if (open == 0 && (key.key == keys::f6 || (key.ctrl && key.key == keys::tab))) {
    go_to_region(ui, key.shift ? -1 : 1);
    return true;
  }
  // A command, but one for the field that is typed in.
  if (typing && key.ctrl && key.key == 'L' && !focused_address(ui).empty()) {
    commands.run("edit.pin");
    return true;
  }
  if (key.key == keys::tab && !key.ctrl && !key.shift && typing && completes(ui.completion)) {
    ui.completion.taken = ui.completion.marked;
    return true;
  }
  if (key.key == keys::tab && !key.ctrl) {
    // The mouse has been at a row or a slider, and is done there.
    const bool clicked =
        stop && (stop->use == KeyUse::row || stop->use == KeyUse::slide) && !state.ring && open == 0;
    if (open == 0 && !typing && (!stop || clicked)) return false; // a command in the view
    const std::string region = stop ? region_of(*stop) : popup_region();
    if (const KeyStop* next = tab_stop(state, region, stop, key.shift ? -1 : 1)) go(ui, *next, true);
    return true;
  }
  if (typing) return false;
  if (open > 0 && take_menu_arrow(ui, stop, key)) return true;
  if (open > 0 && !stop && is_arrow(key.key) && !dialog.showing) { // dialogs have their own use for them
    if (const KeyStop* first = tab_stop(state, popup_region(), nullptr, 1)) go(ui, *first, false);
    return true;
  }
  return has_keys(state, stop) && take_stop_key(ui, *stop, key);
}

// A popup that opens has the keys, and gives them back when it goes.
void follow_popups(Ui& ui) {
  KeyboardState& state = ui.keyboard;
  const auto open = static_cast<std::size_t>(ImGui::GetCurrentContext()->OpenPopupStack.Size);
  while (state.behind.size() < open) {
    state.behind.emplace_back(state.at, state.ring);
    state.at = std::exchange(state.entry, {});
    state.ring = state.ring || !state.at.empty();
    state.missing = 0;
  }
  while (state.behind.size() > open) {
    std::tie(state.at, state.ring) = state.behind.back();
    state.behind.pop_back();
    state.missing = 0;
    if (const KeyStop* stop = stop_named(state.stops, state.at)) state.region = region_of(*stop);
  }
  if (open == 0) state.menu = -1;
  const std::string popup = popup_region();
  if (popup.empty() || ImGui::GetIO().WantTextInput) return;
  const KeyStop* stop = stop_named(state.stops, state.at);
  if ((stop && region_of(*stop) == popup) || !state.ring) return;
  const auto chosen = std::ranges::find_if(
      state.stops, [&](const KeyStop& each) { return each.chosen && region_of(each) == popup; });
  if (chosen != state.stops.end())
    go(ui, *chosen, false);
  else if (const KeyStop* first = tab_stop(state, popup, nullptr, 1))
    go(ui, *first, false);
}

// A click takes the keys to what was clicked, without a ring.
void follow_clicks(Ui& ui) {
  KeyboardState& state = ui.keyboard;
  const ImGuiIO& io = ImGui::GetIO();
  const bool clicked = ImGui::IsMouseClicked(0) || ImGui::IsMouseClicked(1) || ImGui::IsMouseClicked(2);
  if (!ui.keys.empty()) state.by_key = true;
  const bool moved = io.MousePos.x != state.mouse.x || io.MousePos.y != state.mouse.y;
  if (moved || io.MouseWheel != 0 || clicked) state.by_key = false;
  state.mouse = io.MousePos;
  if (!clicked) return;
  state.nudged.clear();
  state.ring = false;
  state.at.clear();
  const ImGuiWindow* under = ImGui::GetCurrentContext()->HoveredWindow;
  for (const KeyStop& stop : state.stops) {
    const ImVec2 at = io.MousePos;
    const bool within = at.x >= stop.from.x && at.x < stop.to.x && at.y >= stop.from.y && at.y < stop.to.y;
    if (!within || !under || stop.window != under) continue;
    if (is_pressed(stop.use)) continue; // done with by the click
    state.at = stop.name;
    state.region = region_of(stop);
  }
}

// Of a region that has gone, or of a widget that has. What the next key would press, perhaps to delete all
// that has just been selected, is not what anybody went to.
void find_another(Ui& ui) {
  KeyboardState& state = ui.keyboard;
  const std::vector<KeyStop>& stops = ui.widgets.stops;
  const KeyStop* nearest = nullptr;
  for (std::size_t i = 0; i < stops.size(); ++i)
    if (region_of(stops[i]) == state.region && !is_pressed(stops[i].use) && (!nearest || i <= state.place))
      nearest = &stops[i];
  if (nearest && state.opening == state.at && nearest->use == KeyUse::type) return go(ui, *nearest, true);
  if (nearest)
    state.at = nearest->name;
  else
    state.at.clear();
  state.missing = 0;
}

} // namespace

void take_keyboard(Ui& ui, const DialogState& dialog, const CommandRunner& commands, bool taken) {
  KeyboardState& state = ui.keyboard;
  state.stops = std::exchange(ui.widgets.stops, {});
  if (const auto view = ui.widgets.find("view"); view != ui.widgets.end()) state.view = view->second;
  imgui_compat::keep_tab();
  state.nudge = {};
  state.open_menu.clear();
  hold_characters(state);
  follow_popups(ui);
  follow_clicks(ui);
  if (const KeyStop* typed = typed_stop(state)) {
    state.at = typed->name;
    state.region = region_of(*typed);
    state.was[state.region] = typed->name;
  }
  const KeyStop* stop = focused_stop(state);
  ui.tooltip.keyed = state.ring && state.by_key && stop && !typed_stop(state) ? stop->id : 0;
  if (taken) return;
  std::erase_if(ui.keys, [&](const KeyPress& key) { return take_focus_key(ui, dialog, commands, key); });
}

void settle_keyboard(Ui& ui) {
  KeyboardState& state = ui.keyboard;
  state.menu_of.clear();
  if (!state.sought.empty() && --state.sought_frames < 0) state.sought.clear();
  const std::vector<KeyStop>& stops = ui.widgets.stops;
  const auto found = std::ranges::find(stops, state.at, &KeyStop::name);
  if (state.at.empty()) return draw_view_ring(ui);
  if (typed_stop(state)) state.opening.clear();
  if (found == stops.end()) {
    if (++state.missing > patience_to_draw) find_another(ui);
    return;
  }
  state.missing = 0;
  state.place = static_cast<std::size_t>(found - stops.begin());
  state.region = region_of(*found);
  if (state.reveal > 0) {
    --state.reveal;
    bring_into_sight(ui, *found);
  }
  draw_focus_ring(ui, *found);
}

void focus_widget(Ui& ui, const std::string& name) {
  ui.keyboard.at = name;
  ui.keyboard.ring = true;
  ui.keyboard.reveal = 4;
  ui.keyboard.missing = 0;
}

void seek_number(Ui& ui, const std::string& address) {
  ui.keyboard.sought = address;
  ui.keyboard.sought_frames = patience_to_draw;
}

void note_number(Ui& ui, const std::string& name, const std::string& address) {
  mark_address(ui.widgets, address);
  KeyboardState& state = ui.keyboard;
  if (address.empty() || address != state.sought) return;
  state.sought.clear();
  focus_widget(ui, name);
  if (name.starts_with("inspector/") && !state.section.empty()) ui.sections.open[state.section] = true;
}

void enter_dialog_at(Ui& ui, const std::string& name) {
  ui.keyboard.entry = name;
}

bool has_keyboard(const Ui& ui, const std::string& name) {
  return ui.keyboard.ring && ui.keyboard.at == name;
}

const KeyNudge* nudge_of(const Ui& ui, const std::string& name) {
  return ui.keyboard.nudge.name == name ? &ui.keyboard.nudge : nullptr;
}

bool nudge_value(const Ui& ui, const std::string& name, double& value, double from, double to) {
  const KeyNudge* nudge = nudge_of(ui, name);
  if (!nudge || !(to > from)) return false;
  double next = value + nudge->x * nudge->size * (to - from) / 100;
  if (nudge->end != 0) next = nudge->end < 0 ? from : to;
  next = std::clamp(next, from, to);
  return std::exchange(value, next) != next;
}

bool takes_menu_key(Ui& ui, const std::string& name) {
  if (ui.keyboard.menu_of != name || name.empty()) return false;
  ui.keyboard.menu_of.clear();
  return true;
}

bool enter_is_taken(const Ui& ui) {
  const KeyStop* stop = stop_named(ui.keyboard.stops, ui.keyboard.at);
  return ui.keyboard.ring && stop && region_of(*stop) == popup_region();
}

bool goes_on_nudging(const Ui& ui) {
  const KeyboardState& state = ui.keyboard;
  return !ui.keys.empty() && state.ring && !state.at.empty() && state.nudged == state.at &&
         std::ranges::all_of(ui.keys, [](const KeyPress& key) {
           return is_arrow(key.key) || key.key == keys::page_up || key.key == keys::page_down;
         });
}

std::string focused_address(const Ui& ui) {
  const KeyStop* stop = stop_named(ui.keyboard.stops, ui.keyboard.at);
  return stop ? stop->address : std::string();
}

} // namespace flyball
