// What is written over the 3-D view: what the picture shows, what lies under the cursor, what to do next.
#include "app/ui/panels/view_overlays.hpp"

#include "app/document/gear_kinds.hpp"
#include "app/render/icons.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/dialog_state.hpp"
#include "app/ui/panels/view_drawing.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/view_frame.hpp"
#include "app/ui/widgets/card.hpp"
#include "app/ui/widgets/notice.hpp"
#include "app/ui/widgets/typed_field.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/address.hpp"

#include <cmath>

namespace flyball {

namespace {

// A line on a plate of its own, above the status, in the middle of the view's width. Returns the plate.
WidgetRect draw_line(const Ui& ui, const PanelRect& rect, const std::string& text, ImVec4 color, float& y,
                     float strength = 1) {
  if (text.empty()) return {};
  const UiColors& colors = colors_of(ui);
  const float s = ui.scale, pad = 9 * s;
  // Clear of the axes in the corner.
  const float margin = std::min(96 * s, rect.width / 8);
  const float room = std::max(rect.width - 2 * margin - 2 * pad, 40 * s);
  const std::string lines = in_lines(text, room);
  const ImVec2 size = ImGui::CalcTextSize(lines.c_str(), nullptr, false, room);
  const float x = std::round(rect.x + (rect.width - size.x) / 2);
  for (const char* other : {"explored", "legend frame"}) { // at the right, the legend perhaps below
    const auto there = ui.widgets.find(other);
    if (there == ui.widgets.end() || there->second.to.y < y - size.y - 11 * s) continue;
    if (x + size.x + 2 * pad > there->second.from.x) y = std::min(y, there->second.from.y - 10 * s);
  }
  y -= size.y + 8 * s;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  ImVec4 plate = colors.panel;
  plate.w = 0.9f * strength;
  color.w *= strength;
  list.AddRectFilled({x - pad, y - 3 * s}, {x + size.x + pad, y + size.y + 3 * s}, packed(plate), 5 * s);
  list.AddText(ui.fonts.text, ImGui::GetFontSize(), {x, y}, packed(color), lines.c_str(), nullptr, room);
  const WidgetRect drawn{{x - pad, y - 3 * s}, {x + size.x + pad, y + size.y + 3 * s}};
  y -= 4 * s;
  return drawn;
}

} // namespace

void part_label(const ViewContext& context) {
  const PartId part = context.view.hovered;
  if (places(context.tool.tool)) return;
  const Mechanism& m = *shown_mechanism(context.session, context.tool);
  const auto i = static_cast<std::size_t>(part.index);
  std::string name, what;
  if (part.kind == PartKind::body && i < m.bodies.size()) {
    name = m.bodies[i].name;
    what = "body, " +
           (m.bodies[i].mass > 0 ? short_text(m.bodies[i].mass) + " kg" : std::string("without mass"));
  } else if (part.kind == PartKind::joint && i < m.joints.size()) {
    name = m.joints[i].name;
    what = joint_noun(m.joints[i]);
  } else if (part.kind == PartKind::force && i < m.forces.size()) {
    name = m.forces[i].name;
    what = force_noun(m.forces[i]);
  } else {
    return;
  }
  ImGui::BeginTooltip();
  ImGui::PushFont(context.ui.fonts.strong);
  ImGui::TextUnformatted(name.c_str());
  ImGui::PopFont();
  ImGui::SameLine();
  ImGui::TextDisabled("%s", what.c_str());
  ImGui::EndTooltip();
}

void caption(const Session& session, Ui& ui, const PanelRect& rect) {
  const UiColors& colors = colors_of(ui);
  const float s = ui.scale, x = rect.x + 14 * s;
  float y = rect.y + 11 * s;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect({rect.x, rect.y}, {rect.x + rect.width - 8 * s, rect.y + rect.height}, true);
  const float big = ui.fonts.strong->FontSize;
  const std::string& name = session.mechanism().name;
  draw_words(ui, ui.fonts.strong, {x, y}, colors.text, name);
  const float wide = ui.fonts.strong->CalcTextSizeA(big, 1e9f, 0, name.c_str()).x;
  ui.widgets["view/name"] = {{x, y}, {x + wide, y + big}};
  y += big + 4 * s;
  const bool solved = converged(session);
  std::string state; // which pose it is, the legend says
  if (session.playback.time != 0 && solved)
    state = "t = " + short_text(std::floor(session.playback.time * 100) / 100, 6) + " s";
  if (rect.width > 460 * s && !state.empty()) state += " after the drawn phase"; // beside the legend
  if (!state.empty()) {
    const ImVec2 size = ImGui::CalcTextSize(state.c_str());
    const ImVec2 from(x - 5 * s, y - 2 * s), to(x + size.x + 5 * s, y + size.y + 2 * s);
    ImVec4 plate = colors.panel; // nothing of the picture crosses the words
    plate.w = 0.9f;
    list.AddRectFilled(from, to, packed(plate), 4 * s);
    list.AddText({x, y}, packed(colors.dim), state.c_str());
    ui.widgets["view/time"] = {from, to};
  }
  list.PopClipRect();
}

void motion_caption(const Session& session, const Ui& ui, const PanelRect& rect) {
  const UiColors& colors = colors_of(ui);
  const float s = ui.scale, big = ui.fonts.strong->FontSize;
  const ImVec2 at(rect.x + 14 * s, rect.y + 11 * s);
  draw_words(ui, ui.fonts.strong, at, colors.text, "Motion");
  const MotionRun* shown = shown_motion(session);
  const std::string words = motion_words(session, shown); // "Motion, damped"
  const std::string what = !shown ? "Computing…" : words.size() > 8 ? words.substr(8) : "";
  draw_words(ui, ui.fonts.text, {at.x, at.y + big + 4 * s}, colors.dim, what);
}

void view_lines(const ViewContext& context, NoticeAge& age, NoticeLog& log, const PanelRect& rect) {
  const UiColors& colors = colors_of(context.ui);
  float y = rect.y + rect.height - 42 * context.ui.scale;
  draw_line(context.ui, rect, tool_hint(context.session, context.tool), colors.text, y);
  context.view.lines_top = y;
  keep_notice(context.session, log);
  age.pointed = false;
  if (is_error(context.session) || context.session.notice.empty()) return;
  const WidgetRect plate = draw_line(context.ui, rect, context.session.notice, colors.dim, y,
                                     notice_strength(context.session, age));
  age.pointed = ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(plate.from, plate.to);
  context.ui.widgets["notice"] = plate;
}

void error_line(Session& session, Ui& ui, const ViewState& view, const PanelRect& rect) {
  if (!is_error(session)) return;
  const UiColors& colors = colors_of(ui);
  const float s = ui.scale, width = std::min(560 * s, std::max(rect.width - 2 * 96 * s, 160 * s));
  ImGui::SetNextWindowPos({std::round(rect.x + rect.width / 2), std::round(view.lines_top)}, ImGuiCond_Always,
                          {0.5f, 1});
  ImGui::SetNextWindowSize({width, 0});
  begin_chip("error", s, 5, {9 * s, 5 * s});
  const float button = ImGui::GetFrameHeight();
  ImGui::AlignTextToFramePadding();
  const float end = ImGui::GetContentRegionAvail().x - button;
  ImGui::PushTextWrapPos(end);
  ImGui::TextColored(colors.bad, "%s", icon::warning);
  ImGui::SameLine(0, 7 * s);
  ImGui::TextUnformatted(in_lines(session.notice, end - ImGui::GetCursorPosX()).c_str());
  ImGui::PopTextWrapPos();
  note_widget(ui.widgets, "error");
  ImGui::SameLine(width - button - 5 * s);
  if (text_button(ui, "error/close", icon::close)) session.notice.clear();
  ImGui::End();
}

namespace {

// "Explored: speed of spin 15 rad/s", or how many are. While building no result is with them. The words give
// way to the number where there is no room (pixels) for both.
std::string tried_text(const Session& session, float room, float least) {
  const Explored& explored = session.document.explored();
  const bool aside = session.mode == Mode::build;
  if (explored.size() > 1)
    return cut_to(std::to_string(explored.size()) + " explored values" + (aside ? " put aside" : ""), room);
  const ShownUnit unit =
      shown_unit(parameter_unit(session.document.stored(), explored.front().address), session.units);
  const auto width = [](const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; };
  std::string number;
  for (int digits = 9; digits >= 3 && (number.empty() || width(number) > room); --digits)
    number =
        short_text(unit.shown(explored.front().value), digits) + (unit.text.empty() ? "" : " " + unit.text);
  const std::string words =
      (aside ? "Put aside: " : "Explored: ") + parameter_phrase(explored.front().address) + " ";
  const float rest = room - width(number);
  return rest < least ? number
                      : (width(words) <= rest ? words : cut_to(words, rest - width(" ")) + " ") + number;
}

} // namespace

void explored_chip(Session& session, Ui& ui, const DialogState& dialog, const PanelRect& view) {
  if (session.document.explored().empty() || dialog.showing || view.width < 300 * ui.scale) return;
  const float s = ui.scale;
  const auto status = ui.widgets.find("status");
  const float bottom =
      status == ui.widgets.end() ? view.y + view.height - 10 * s : status->second.from.y - 6 * s;
  ImGui::SetNextWindowPos({std::round(view.x + view.width - 10 * s), std::round(bottom)}, ImGuiCond_Always,
                          {1, 1});
  begin_chip("explored", s, 5, {8 * s, 4 * s});
  const float cube = 96 * s; // in the other corner
  const float buttons = ImGui::CalcTextSize("KeepBack").x + 4 * ImGui::GetStyle().FramePadding.x + 12 * s;
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(
      tried_text(session, std::max(view.width - cube - buttons - 36 * s, 76 * s), 40 * s).c_str());
  note_widget(ui.widgets, "explored");
  std::string help = session.mode == Mode::build
                         ? "Tried while exploring and put aside while building; saving leaves it out."
                         : "Tried, and not part of the document: saving leaves it out.";
  for (const std::string& each : explored_words(session))
    help += "\n" + each;
  help_on_hover(help.c_str());
  ImGui::SameLine(0, 8 * s);
  if (text_button(ui, "explored/keep", "Keep")) later(ui, [&session] { keep_explored(session); });
  help_on_hover("Makes the explored values the document's; an edit that can be undone.");
  ImGui::SameLine(0, 4 * s);
  if (text_button(ui, "explored/back", "Back")) later(ui, [&session] { drop_explored(session); });
  help_on_hover("Back to the values that are stored.");
  ImGui::End();
}

void problem_banner(Session& session, Ui& ui, const CommandRunner& commands, const PanelRect& rect) {
  if (session.problem.empty()) return;
  const UiColors& colors = colors_of(ui);
  const float s = ui.scale, margin = 24 * s;
  const auto tools = ui.widgets.find("tool strip"); // which stay in reach
  const float left = tools == ui.widgets.end() ? rect.x + margin : tools->second.to.x + 12 * s;
  const float width = std::max(rect.x + rect.width - margin - left, 40 * s);
  ImGui::SetNextWindowPos({std::round(left), rect.y + rect.height / 2}, ImGuiCond_Always, {0, 0.5f});
  ImGui::SetNextWindowSize({width, 0});
  begin_card("problem", s, {16 * s, 14 * s});
  ImGui::PushFont(ui.fonts.strong);
  paragraph(std::string(icon::warning) + "  The scene cannot be opened", colors.bad);
  ImGui::PopFont();
  paragraph(session.problem, colors.text);
  ImGui::Dummy({0, 2 * s});
  if (text_button(ui, "problem/close", "Keep the open scene")) session.problem.clear();
  beside_or_below("Open another…");
  if (text_button(ui, "problem/open", "Open another…")) {
    session.problem.clear();
    commands.run("file.open");
  }
  ImGui::End();
}

} // namespace flyball
