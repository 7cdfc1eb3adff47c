#include "app/panels/panels.hpp"
#include "app/panels/widgets.hpp"
#include "app/render/icons.hpp"
#include "app/render/imgui_compat.hpp"
#include "app/viewport/picking.hpp"

#include <cmath>

namespace flyball {

namespace {

constexpr double zoom_step = 1.15; // a notch of the wheel

ViewSize view_size(const PanelRect& rect) {
  return {static_cast<double>(rect.width), static_cast<double>(rect.height)};
}

void steer(App& app, const PanelRect& rect) {
  const ImGuiIO& io = ImGui::GetIO();
  const ViewSize size = view_size(rect);
  const double dx = static_cast<double>(io.MouseDelta.x), dy = static_cast<double>(io.MouseDelta.y);
  if (ImGui::IsItemActive() && (dx != 0 || dy != 0)) {
    const bool pan = io.KeyShift || ImGui::IsMouseDown(ImGuiMouseButton_Right) ||
                     ImGui::IsMouseDown(ImGuiMouseButton_Middle);
    if (pan)
      app.view.camera.pan(dx, dy, size);
    else
      app.view.camera.orbit(dx, dy, size);
  }
  if (!ImGui::IsItemHovered()) return;
  const Vec2 cursor(static_cast<double>(io.MousePos.x - rect.x), static_cast<double>(io.MousePos.y - rect.y));
  if (io.MouseWheel != 0)
    app.view.camera.zoom(std::pow(zoom_step, static_cast<double>(io.MouseWheel)), cursor, size);
  if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) app.view.fit = app.view.keep_direction = true;
}

void point_at_parts(App& app, const PanelRect& rect) {
  const ImGuiIO& io = ImGui::GetIO();
  if (!ImGui::IsItemHovered() || ImGui::IsItemActive() || !app.open) {
    app.view.hovered = {};
    app.view.pointed_at = Vec2::Constant(-1);
    return;
  }
  // Looking along a ray takes longest in a mechanism of thousands of bodies: only where the hand moves.
  const Vec2 cursor(static_cast<double>(io.MousePos.x - rect.x), static_cast<double>(io.MousePos.y - rect.y));
  if (cursor == app.view.pointed_at) return;
  app.view.pointed_at = cursor;
  const ViewFrame frame = view_frame(app);
  const auto hit = pick(scene_of(frame).instances, frame.camera.ray(cursor, view_size(rect)),
                        4 * static_cast<double>(app.scale));
  app.view.hovered = hit ? hit->part : PartId{};
}

// "arm 1", and what it is.
void part_label(App& app) {
  const PartId part = app.view.hovered;
  const Mechanism& m = app.mechanism;
  const auto i = static_cast<std::size_t>(part.index);
  std::string name, what;
  if (part.kind == PartKind::body && i < m.bodies.size()) {
    name = m.bodies[i].name;
    what = "body, " +
           (m.bodies[i].mass > 0 ? short_text(m.bodies[i].mass) + " kg" : std::string("without mass"));
  } else if (part.kind == PartKind::joint && i < m.joints.size()) {
    name = m.joints[i].name;
    what = std::string(type_name(m.joints[i].type)) + " joint";
  } else if (part.kind == PartKind::force && i < m.forces.size()) {
    name = m.forces[i].name;
    what = type_name(m.forces[i].type);
  } else {
    return;
  }
  ImGui::BeginTooltip();
  ImGui::PushFont(app.fonts.strong);
  ImGui::TextUnformatted(name.c_str());
  ImGui::PopFont();
  ImGui::SameLine();
  ImGui::TextDisabled("%s", what.c_str());
  ImGui::EndTooltip();
}

// What the picture shows, in its upper left corner.
void caption(App& app, const PanelRect& rect) {
  if (!app.open) return;
  const UiColors& colors = colors_of(app);
  const float s = app.scale, x = rect.x + 14 * s;
  float y = rect.y + 11 * s;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect({rect.x, rect.y}, {rect.x + rect.width - 8 * s, rect.y + rect.height}, true);
  const float big = app.fonts.strong->FontSize;
  list.AddText(app.fonts.strong, big, {x, y}, packed(colors.text), app.mechanism.name.c_str());
  y += big + 4 * s;
  const bool solved =
      app.answer.ticket && !app.answer.error && app.answer.solution.status == Status::converged;
  std::string state;
  if (app.answer.ticket && !solved) state = "Drawn pose";
  if (app.playback.time != 0 && solved)
    state = "t = " + short_text(std::floor(app.playback.time * 100) / 100, 6) + " s after the drawn phase";
  if (!state.empty()) list.AddText({x, y}, packed(colors.dim), state.c_str());
  if (!app.notice.empty()) {
    const float line = ImGui::GetTextLineHeight();
    list.AddText({x, rect.y + rect.height - line - 10 * s}, packed(colors.dim), app.notice.c_str());
  }
  list.PopClipRect();
}

// A scene that cannot be read: says so over the picture.
void problem_banner(App& app, const PanelRect& rect) {
  if (app.problem.empty()) return;
  const UiColors& colors = colors_of(app);
  const float s = app.scale, width = std::max(rect.width - 48 * s, 40 * s);
  ImGui::SetNextWindowPos({rect.x + 24 * s, rect.y + rect.height / 2}, ImGuiCond_Always, {0, 0.5f});
  ImGui::SetNextWindowSize({width, 0});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, std::max(1.f, std::round(s)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {16 * s, 14 * s});
  ImGui::Begin("problem", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::PopStyleVar(3);
  ImGui::PushFont(app.fonts.strong);
  ImGui::TextColored(colors.bad, "%s  The scene cannot be opened", icon::warning);
  ImGui::PopFont();
  paragraph(app.problem, colors.text);
  ImGui::Dummy({0, 2 * s});
  if (text_button(app, "problem/close", app.open ? "Keep the open scene" : "Close")) app.problem.clear();
  ImGui::SameLine();
  if (text_button(app, "problem/open", "Open another…")) {
    app.problem.clear();
    show_open_dialog(app);
  }
  ImGui::End();
}

} // namespace

void viewport_panel(App& app, const PanelRect& rect) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  begin_panel("view", rect, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  ImGui::GetWindowDrawList()->AddImage(imgui_compat::texture_id(app.view.texture), {rect.x, rect.y},
                                       {rect.x + rect.width, rect.y + rect.height}, {0, 1}, {1, 0});
  ImGui::InvisibleButton("view", {rect.width, rect.height},
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                             ImGuiButtonFlags_MouseButtonMiddle);
  note_widget(app.widgets, "view");
  steer(app, rect);
  point_at_parts(app, rect);
  caption(app, rect);
  ImGui::End();
  part_label(app);
  problem_banner(app, rect);
}

} // namespace flyball
