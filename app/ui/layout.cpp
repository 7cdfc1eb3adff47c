#include "app/ui/layout.hpp"

#include "app/session/session.hpp"
#include "app/ui/keyboard/keyboard.hpp"
#include "app/ui/ui.hpp"
#include "app/ui/widgets/ui_style.hpp"

#include <algorithm>
#include <cmath>

namespace flyball {

namespace {

constexpr float toolbar_height = 68, narrow_width = 1060; // points
constexpr float key_step = 10;                            // points that a key moves a line between panels
// Points that a study and then the view are to have while nobody has chosen: below that plots say little.
constexpr float study_height = 290, view_beside_study = 200;
// In a window too low for both, which is then shared.
constexpr float least_study = 175, view_beside_least = 115;
constexpr float least_panel = 230, most_panel = 560, least_view = 240; // points

float panel_width(float wanted, float room) {
  return std::clamp(wanted, least_panel, std::max(least_panel, std::min(most_panel, room)));
}

// Of the height of two panels, for the upper one.
float upper_share(const Session& session, const Ui& ui, const PanelSizes& sizes, const Layout& layout,
                  float height) {

  if (layout.stacked && session.mode == Mode::explore) {
    if (sizes.stacked_share > 0) return sizes.stacked_share;
    if (sizes.parameters_height == 0) return 0.4f;
    return std::clamp(sizes.parameters_height * ui.scale / height, 0.15f, 0.5f);
  }
  return sizes.inspector_share;
}

// Two panels one above the other.
void divide(const PanelRect& whole, float share, PanelRect& upper, PanelRect& lower) {
  upper = lower = whole;
  upper.height = std::round(whole.height * share);
  lower.y += upper.height;
  lower.height -= upper.height;
}

// With the second view to the right of the first.
void share_view(const Session& session, Layout& layout) {
  if (!motion_beside(session)) return;
  layout.beside = layout.view;
  layout.view.width = std::max(std::floor(layout.view.width / 2), 1.f);
  layout.beside.x += layout.view.width;
  layout.beside.width = std::max(layout.beside.width - layout.view.width, 1.f);
}

// Returns how far the person has dragged the line this frame. Each has a small window of its own, above the
// sizes.
// `below`: pixels under the line that take hold of it, too.
float splitter(Ui& ui, const char* name, const PanelRect& line, bool upright, float below = 0) {
  const float grip = 4 * ui.scale, thick = std::max(1.f, std::round(ui.scale));
  const ImVec2 from(line.x - (upright ? grip : 0), line.y - (upright ? 0 : grip));
  const ImVec2 size(upright ? 2 * grip : line.width,
                    upright ? line.height : std::max(2 * grip, grip + below));
  ImGui::SetNextWindowPos(from);
  ImGui::SetNextWindowSize(size);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1, 1});
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoBringToFrontOnFocus |
                   ImGuiWindowFlags_NoNav);
  ImGui::PopStyleVar(2);
  ImGui::InvisibleButton("line", size);
  note_widget(ui.widgets, name, KeyUse::slide);
  const bool active = ImGui::IsItemActive();
  const bool lit = active || ImGui::IsItemHovered() || has_keyboard(ui, name);
  if (lit) ImGui::SetMouseCursor(upright ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
  const UiColors& colors = ui_colors(ui.theme);
  const ImVec2 to(line.x + (upright ? thick : line.width), line.y + (upright ? line.height : thick));
  ImGui::GetWindowDrawList()->AddRectFilled(
      {line.x, line.y}, to, ImGui::ColorConvertFloat4ToU32(lit ? colors.accent : colors.border));
  ImGui::End();
  if (const KeyNudge* nudge = nudge_of(ui, name)) // to the left and upwards, or to the right and downwards
    return static_cast<float>(nudge->x * nudge->size) * key_step * ui.scale;
  if (!active) return 0;
  return upright ? ImGui::GetIO().MouseDelta.x : ImGui::GetIO().MouseDelta.y;
}

} // namespace

Layout view_alone_layout(float width, float height) {
  Layout layout;
  layout.view = {0, 0, width, height};
  return layout;
}

Layout layout_of(const Session& session, const Ui& ui, const PanelSizes& sizes, float width, float height) {
  const float s = ui.scale;
  const bool building = session.mode == Mode::build;
  Layout layout;
  const float top = std::round(toolbar_height * s);
  float below = std::max(height - top, 1.f);
  layout.toolbar = {0, 0, width, top};
  if (!building && session.study.open != StudyKind::none) {
    float study = below * sizes.study_share;
    if (!sizes.study_chosen)
      study = std::max({study, std::min(study_height * s, below - view_beside_study * s),
                        std::min(least_study * s, below - view_beside_least * s)});
    study = std::round(study);
    below -= study;
    layout.study = {0, top + below, width, study};
  }
  layout.stacked = width < narrow_width * s;
  if (layout.stacked) {
    const float panel = std::round(s * panel_width(sizes.stacked_width, width / s - least_view));
    layout.view = {0, top, std::max(width - panel, 1.f), below};
    share_view(session, layout);
    layout.side = {layout.view.width, top, panel, below};
    const float share = upper_share(session, ui, sizes, layout, below);
    if (building)
      divide(layout.side, share, layout.outline, layout.inspector);
    else
      divide(layout.side, share, layout.parameters, layout.results);
    return layout;
  }
  const float right = std::round(s * panel_width(sizes.results_width, width / s - least_view - least_panel));
  const float left = std::round(s * panel_width(sizes.parameters_width, (width - right) / s - least_view));
  (building ? layout.outline : layout.parameters) = {0, top, left, below};
  layout.side = {width - right, top, right, below};
  if (building || !session.selection().empty())
    divide(layout.side, upper_share(session, ui, sizes, layout, below), layout.inspector, layout.results);
  else
    layout.results = layout.side;
  layout.view = {left, top, std::max(width - left - right, 1.f), below};
  share_view(session, layout);
  return layout;
}

void drag_splitters(Session& session, Ui& ui, PanelSizes& sizes, const Layout& layout) {
  const float s = ui.scale;

  const auto clamped = [](float points) { return std::clamp(points, least_panel, most_panel); };
  const PanelRect& side = layout.side;
  float& side_width = layout.stacked ? sizes.stacked_width : sizes.results_width;
  if (!layout.stacked) {
    const float by = splitter(ui, "splitter/left", {layout.view.x, layout.view.y, 1, side.height}, true);
    sizes.parameters_width = clamped(sizes.parameters_width + by / s);
  }
  side_width =
      clamped(side_width - splitter(ui, "splitter/right", {side.x, side.y, 1, side.height}, true) / s);
  if (layout.study.height > 0) {
    const PanelRect& study = layout.study;
    const float moved = splitter(ui, "splitter/study", {study.x, study.y, study.width, 1}, false);
    const float whole = study.height + side.height;
    if (moved != 0) {
      sizes.study_share = std::clamp((study.height - moved) / whole, 0.2f, 0.75f);
      sizes.study_chosen = true;
    }
  }
  const PanelRect& lower = layout.results.height > 0 ? layout.results : layout.inspector;
  if (lower.height == side.height) return;
  const bool titled = layout.results.height > 0 && layout.inspector.height > 0;
  const float by = splitter(ui, "splitter/lower", {side.x, lower.y, side.width, 1}, false,
                            titled ? results_title_height(ui) : 0);
  if (by == 0) return;
  const float share =
      std::clamp(upper_share(session, ui, sizes, layout, side.height) + by / side.height, 0.15f, 0.85f);
  (layout.stacked && session.mode == Mode::explore ? sizes.stacked_share : sizes.inspector_share) = share;
}

float results_title_height(const Ui& ui) {
  return std::round(ImGui::GetFontSize() + 9 * ui.scale);
}

void begin_panel(const char* name, const PanelRect& rect, int more_flags) {
  ImGui::SetNextWindowPos({rect.x, rect.y});
  ImGui::SetNextWindowSize({rect.width, rect.height});
  ImGui::Begin(name, nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | more_flags);
}

} // namespace flyball
