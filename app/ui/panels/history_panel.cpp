#include "app/ui/panels/history_panel.hpp"

#include "app/session/session.hpp"
#include "app/ui/layout.hpp"
#include "app/ui/ui.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <cmath>

namespace flyball {

namespace {

void step_row(Session& session, Ui& ui, std::size_t i, float height) {
  const UiColors& colors = colors_of(ui);
  const std::size_t present = session.document.position();
  const std::string widget = "history/" + std::to_string(i);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float width = std::max(ImGui::GetContentRegionAvail().x, 1.f);
  if (ImGui::InvisibleButton(widget.c_str(), {width, height}))
    later(ui, [&session, i] { go_to_step(session, i); });
  note_widget(ui.widgets, widget, KeyUse::row);
  if (i == present) mark_chosen(ui.widgets);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 to(from.x + width, from.y + height);
  if (ImGui::IsItemHovered() || i == present)
    list.AddRectFilled(from, to, packed(colors.raised), ImGui::GetStyle().FrameRounding);
  if (i == present)
    list.AddRectFilled(from, {from.x + 3 * ui.scale, to.y}, packed(colors.accent), 1.5f * ui.scale);
  ImGui::SetCursorScreenPos({from.x + 9 * ui.scale, from.y + (height - ImGui::GetTextLineHeight()) / 2});
  ImGui::PushStyleColor(ImGuiCol_Text, i > present ? colors.dim : colors.text);
  clipped_text(session.document.steps()[i].name, width - 12 * ui.scale);
  ImGui::PopStyleColor();
  ImGui::SetCursorScreenPos({from.x, to.y});
}

} // namespace

void HistoryPanel::draw(Session& session, Ui& ui, const PanelRect& view) {
  if (!open) return;
  const float s = ui.scale;
  const float height = ImGui::GetTextLineHeight() + 8 * s, bar = ImGui::GetFrameHeight();
  const float rows = static_cast<float>(std::min<std::size_t>(session.document.steps().size(), 14));
  ImGui::SetNextWindowPos({view.x + view.width - 10 * s, view.y + 10 * s}, ImGuiCond_FirstUseEver, {1, 0});
  ImGui::SetNextWindowSize({std::min(250 * s, view.width), bar + rows * height + 12 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, std::max(1.f, std::round(s)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {6 * s, 6 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, 0});
  if (ImGui::Begin("History", &open,
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                       ImGuiWindowFlags_NoResize)) {
    const auto count = static_cast<int>(session.document.steps().size());
    const auto present = static_cast<int>(session.document.position());
    // The present step stays in view.
    if (present != shown_) {
      shown_ = present;
      const float top = static_cast<float>(present) * height, room = ImGui::GetContentRegionAvail().y;
      if (top < ImGui::GetScrollY() || top + height > ImGui::GetScrollY() + room)
        ImGui::SetScrollY(std::max(top - room / 2, 0.f));
    }
    ImGuiListClipper clipper;
    clipper.Begin(count, height);
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
        step_row(session, ui, static_cast<std::size_t>(i), height);
  }
  ImGui::End();
  ImGui::PopStyleVar(4);
}

} // namespace flyball
