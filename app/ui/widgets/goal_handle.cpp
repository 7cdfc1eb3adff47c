#include "app/ui/widgets/goal_handle.hpp"

#include "app/session/units.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/widgets/quantity_field.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

void seek_value(Session& session, const std::string& wanted, double value) {
  seek(session, "Bring " + wanted + " to a goal", {{wanted, value}});
}

// Instead of the read-out while a number is typed.
void typed_goal(Session& session, Ui& ui, const GoalHandle& handle, const std::string& field, ImVec2 from,
                ImVec2 to) {
  const float width = std::min(to.x - from.x, 150 * ui.scale);
  ImGui::SetCursorScreenPos({to.x - width, from.y});
  quantity_field(session, ui,
                 {.name = field,
                  .value = handle.value,
                  .unit = handle.unit,
                  .help = "Where it should be.",
                  .set =
                      [&session, wanted = handle.wanted](double value) {
                        seek(session, "Bring " + wanted + " to a goal", {{wanted, value}});
                      }},
                 width);
}

} // namespace

void goal_handle(Session& session, Ui& ui, const GoalHandle& handle) {
  if (session.mode != Mode::explore) {
    note_widget(ui.widgets, handle.name);
    help_on_hover(handle.help.c_str());
    return;
  }
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax(),
               back = ImGui::GetCursorScreenPos();
  const float right = from.x + ImGui::GetContentRegionAvail().x;
  const std::string field = handle.name + "/goal";
  if (typing_in(ui, field)) {
    typed_goal(session, ui, handle, field, from, {std::max(to.x, right), to.y});
    ImGui::SetCursorScreenPos(back);
    return;
  }
  ImGui::SetCursorScreenPos(from);
  const bool pressed =
      ImGui::InvisibleButton(handle.name.c_str(), {std::max(to.x, right) - from.x, to.y - from.y});
  note_widget(ui.widgets, handle.name, KeyUse::aside);
  ImGui::SetCursorScreenPos(back);
  const ShownUnit unit = shown_unit(handle.unit, session.units);
  const double shown = unit.shown(handle.value);
  const bool by_key = has_keyboard(ui, handle.name);
  const bool typed =
      (pressed && by_key) || (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left));
  if (typed)
    return later(ui, [&session, &ui, field, text = short_text(shown, 12) + " " + unit.text] {
      start_typing(session, ui, field, text);
    });
  if (ImGui::IsItemHovered() || ImGui::IsItemActive() || by_key) {
    if (!by_key) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    const ImVec2 line(from.x, to.y - 1);
    ImGui::GetWindowDrawList()->AddLine(line, {std::max(to.x, right), line.y}, packed(colors_of(ui).accent),
                                        std::max(1.f, std::round(ui.scale)));
  }
  if (!ImGui::IsItemActive()) {
    const std::string refusal = goal_refusal(session);
    std::string help = handle.help.empty() ? "" : handle.help + "\n";
    help += refusal.empty()
                ? "Drag sideways to where it should be, or double-click to type it: the pinned sliders that "
                  "are not held follow."
                : "Could be dragged to where it should be. " + refusal;
    help_on_hover(help.c_str());
  }
  if (const auto dragged = dragged_number(ui, handle.name, shown, unit.text))
    later(ui, [&session, wanted = handle.wanted, value = unit.si(*dragged)] {
      seek_value(session, wanted, value);
    });
}

} // namespace flyball
