// The tools, as a strip of buttons at the left edge of the view.
#include "app/ui/commands.hpp"
#include "app/ui/tools/tool_glyphs.hpp"
#include "app/ui/tools/tools.hpp"
#include "app/ui/widgets/card.hpp"
#include "app/ui/widgets/tooltip.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <array>
#include <cmath>

namespace flyball {

namespace {

struct ToolButton {
  Tool tool;
  const char* name;
  const char* command;
  bool separated = false; // begins a group
};
constexpr std::array buttons{
    ToolButton{Tool::select, "tools/select", "view.select"},
    ToolButton{Tool::rotate, "tools/rotate", "view.rotate"},
    ToolButton{Tool::pull, "tools/pull", "view.pull"},
    ToolButton{Tool::box, "tools/box", "view.box"},
    ToolButton{Tool::ball, "tools/ball", "insert.ball", true},
    ToolButton{Tool::block, "tools/block", "insert.block"},
    ToolButton{Tool::rod, "tools/rod", "insert.rod"},
    ToolButton{Tool::plate, "tools/plate", "insert.plate"},
    ToolButton{Tool::disc, "tools/disc", "insert.disc"},
    ToolButton{Tool::joint, "tools/joint", "insert.joint", true},
    ToolButton{Tool::distance, "tools/distance", "insert.distance"},
    ToolButton{Tool::spring, "tools/spring", "insert.spring"},
    ToolButton{Tool::damper, "tools/damper", "insert.damper"},
    ToolButton{Tool::bearing, "tools/bearing", "insert.bearing"},
    ToolButton{Tool::force, "tools/force", "insert.force", true},
    ToolButton{Tool::torque, "tools/torque", "insert.torque"},
    ToolButton{Tool::drag, "tools/drag", "insert.drag"},
    ToolButton{Tool::vane, "tools/vane", "insert.vane"},
};

constexpr float top = 46, bottom = 110; // points of the view that the caption and the cube with its axes need
constexpr float button_side = 26, strip_pad = 4, group_gap = 7;

// What it is and how to call it, beside the strip.
void tell(const Ui& ui, const char* id) {
  if (!ImGui::IsItemHovered() || !pointed_long()) return;
  const Command& wanted = command(id);
  ImGui::BeginTooltip();
  ImGui::PushFont(ui.fonts.strong);
  ImGui::TextUnformatted(wanted.title);
  ImGui::PopFont();
  if (const std::string key = key_text(wanted.key); !key.empty()) {
    ImGui::SameLine();
    ImGui::TextDisabled("%s", key.c_str());
  }
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 18);
  ImGui::TextUnformatted(wanted.help);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

// A square with a glyph; returns whether it was pressed.
template <class Draw>
bool glyph_button(Ui& ui, const char* name, bool on, const Draw& draw) {
  const UiColors& colors = colors_of(ui);
  const float s = ui.scale, width = button_side * s;
  const ImVec2 from = ImGui::GetCursorScreenPos(), to(from.x + width, from.y + width);
  const bool pressed = ImGui::InvisibleButton(name, {width, width});
  note_widget(ui.widgets, name);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (on || ImGui::IsItemHovered())
    list.AddRectFilled(from, to, packed(on ? colors.accent : colors.raised), 4 * s);
  draw(list, ImVec2(from.x + width / 2, from.y + width / 2), 8.5f * s,
       packed(on ? colors.on_accent : colors.text));
  return pressed;
}

} // namespace

void tool_strip(Session& session, Ui& ui, ToolState& tool, const PanelRect& view) {
  if (session.mode != Mode::build) return;
  const UiColors& colors = colors_of(ui);
  const float s = ui.scale;
  // In a low view the groups stand in as many columns as they need.
  const float room = std::max(view.height / s - top - bottom, 4 * button_side + 2 * strip_pad);
  ImGui::SetNextWindowPos({std::round(view.x + 10 * s), std::round(view.y + top * s)});
  begin_chip("tools", s, 6, {strip_pad * s, strip_pad * s});
  const ImVec2 origin = ImGui::GetCursorScreenPos();
  float x = 0, y = 0, tallest = 0;
  const auto place = [&](bool separated) {
    const float gap = separated && y > 0 ? group_gap : 0;
    if (y + gap + button_side + 2 * strip_pad > room) {
      x += button_side + strip_pad;
      y = 0;
    } else if (gap > 0) {
      const float line = origin.y + s * (y + group_gap / 2);
      ImGui::GetWindowDrawList()->AddLine({origin.x + s * (x + 3), line},
                                          {origin.x + s * (x + button_side - 3), line}, packed(colors.border),
                                          std::max(1.f, std::round(s)));
      y += gap;
    }
    ImGui::SetCursorScreenPos({origin.x + x * s, origin.y + y * s});
    y += button_side;
    tallest = std::max(tallest, y);
  };
  for (const ToolButton& button : buttons) {
    place(button.separated);
    const bool on = tool.tool == button.tool;
    if (glyph_button(ui, button.name, on, [&](ImDrawList& list, ImVec2 center, float half, ImU32 ink) {
          draw_tool_glyph(list, button.tool, center, half, ink);
        }))
      set_tool(session, ui, tool, button.tool);
    tell(ui, button.command);
  }
  place(true);
  if (glyph_button(ui, "tools/snap", tool.snap, draw_magnet_glyph)) tool.snap = !tool.snap;
  tell(ui, "view.snap");
  // In its first frame the window is not yet as large as what is in it.
  const float pad = strip_pad * s;
  ui.widgets["tool strip"] = {ImGui::GetWindowPos(),
                              {origin.x + (x + button_side) * s + pad, origin.y + tallest * s + pad}};
  ImGui::End();
}

} // namespace flyball
