// What is written over the 3-D view: what the picture shows, what lies under the cursor, what to do next.
#include "app/panels/view_overlays.hpp"

#include "app/panels/file_commands.hpp"
#include "app/panels/motion_control.hpp"
#include "app/panels/tools.hpp"
#include "app/panels/widgets.hpp"
#include "app/render/icons.hpp"

#include <cmath>

namespace flyball {

namespace {

// Which is which of the two that are drawn at one place.
void draw_legend(const App& app, ImVec2 at) {
  const UiColors& colors = colors_of(app);
  const float side = std::round(ImGui::GetFontSize() * 0.6f), line = ImGui::GetTextLineHeight();
  const float top = at.y + std::round((line - side) / 2);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({at.x, top}, {at.x + side, top + side}, packed(to_imgui(palette(app.theme).motion)),
                     2 * app.scale);
  const MotionRun* shown = shown_motion(app);
  const bool damped = !shown || shown->run->damped;
  list.AddText({at.x + side + 6 * app.scale, at.y}, packed(colors.dim),
               damped ? "the damped motion" : "the motion without dampers");
}

// A line on a plate of its own, above the status, in the middle of the view's width.
void draw_line(const App& app, const PanelRect& rect, const std::string& text, const ImVec4& color,
               float& y) {
  if (text.empty()) return;
  const UiColors& colors = colors_of(app);
  const float s = app.scale, pad = 9 * s;
  // Clear of the axes in the corner.
  const float margin = std::min(96 * s, rect.width / 8);
  const float room = std::max(rect.width - 2 * margin - 2 * pad, 40 * s);
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, room);
  const float x = std::round(rect.x + (rect.width - size.x) / 2);
  y -= size.y + 8 * s;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ImVec4 plate = colors.panel;
  plate.w = 0.9f;
  list.AddRectFilled({x - pad, y - 3 * s}, {x + size.x + pad, y + size.y + 3 * s}, packed(plate), 5 * s);
  list.AddText(app.fonts.text, ImGui::GetFontSize(), {x, y}, packed(color), text.c_str(), nullptr, room);
  y -= 4 * s;
}

} // namespace

void part_label(App& app) {
  const PartId part = app.view.hovered;
  if (places(app.tool.tool)) return;
  const Mechanism& m = *view_frame(app).mechanism;
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

void caption(App& app, const PanelRect& rect) {
  const UiColors& colors = colors_of(app);
  const float s = app.scale, x = rect.x + 14 * s;
  float y = rect.y + 11 * s;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect({rect.x, rect.y}, {rect.x + rect.width - 8 * s, rect.y + rect.height}, true);
  const float big = app.fonts.strong->FontSize;
  list.AddText(app.fonts.strong, big, {x, y}, packed(colors.text), app.mechanism().name.c_str());
  y += big + 4 * s;
  const bool solved = converged(app);
  std::string state;
  if (app.mode == Mode::build ? !app.mechanism().bodies.empty() : app.answer.ticket && !solved)
    state = "Drawn pose";
  if (app.playback.time != 0 && solved)
    state = "t = " + short_text(std::floor(app.playback.time * 100) / 100, 6) + " s after the drawn phase";
  if (!state.empty()) {
    list.AddText({x, y}, packed(colors.dim), state.c_str());
    y += ImGui::GetTextLineHeightWithSpacing();
  }
  if (solved && !app.motion.poses.empty() && !motion_beside(app) && app.mode == Mode::explore)
    draw_legend(app, {x, y});
  list.PopClipRect();
}

void motion_caption(App& app, const PanelRect& rect) {
  const UiColors& colors = colors_of(app);
  const float s = app.scale, big = app.fonts.strong->FontSize;
  const ImVec2 at(rect.x + 14 * s, rect.y + 11 * s);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddText(app.fonts.strong, big, at, packed(colors.text), "Motion");
  const MotionRun* shown = shown_motion(app);
  const std::string what = !shown ? "Computing…" : shown->run->damped ? "damped" : "without dampers";
  list.AddText({at.x, at.y + big + 4 * s}, packed(colors.dim), what.c_str());
}

void view_lines(App& app, const PanelRect& rect) {
  const UiColors& colors = colors_of(app);
  float y = rect.y + rect.height - 42 * app.scale;
  draw_line(app, rect, tool_hint(app), colors.text, y);
  draw_line(app, rect, app.notice, colors.dim, y);
}

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
  if (text_button(app, "problem/close", "Keep the open scene")) app.problem.clear();
  ImGui::SameLine();
  if (text_button(app, "problem/open", "Open another…")) {
    app.problem.clear();
    show_open_dialog(app);
  }
  ImGui::End();
}

} // namespace flyball
