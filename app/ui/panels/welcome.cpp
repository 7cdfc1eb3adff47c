// What an empty document shows instead of nothing: the first steps.
#include "app/session/session.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/dialog_state.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/tool_state.hpp"
#include "app/ui/widgets/card.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <imgui_internal.h>

#include <algorithm>
#include <array>

namespace flyball {

namespace {

struct FirstStep {
  const char* title;
  const char* text;
  std::array<const char*, 3> commands;
};
constexpr std::array first_steps{
    FirstStep{"1  Place bodies",
              "Choose a form, then click in the view. Sizes and masses can be typed at the right.",
              {"insert.rod", "insert.ball", "insert.block"}},
    FirstStep{"2  Join them",
              "Click the point where two bodies meet, or a body and the ground.",
              {"insert.joint", "insert.spring", "insert.distance"}},
    FirstStep{"3  Drive and explore",
              "Select a joint and tick Drive; Tab goes to Explore, where sliders try other values, and back.",
              {nullptr, nullptr, nullptr}},
};

// Where the strip of tools ended in the last frame, and a gap: a card is begun before it.
float right_of_tools(float otherwise, float gap) {
  const ImGuiWindow* tools = ImGui::FindWindowByName("tools");
  return tools && tools->WasActive ? tools->Pos.x + tools->Size.x + gap : otherwise;
}

} // namespace

void welcome(const Session& session, Ui& ui, const ToolState& tool, const DialogState& dialog,
             const CommandRunner& commands, const PanelRect& view) {
  if (!session.mechanism().bodies.empty() || tool.tool != Tool::select || dialog.showing ||
      !session.problem.empty())
    return;
  const UiColors& colors = colors_of(ui);
  const float s = ui.scale, right = view.x + view.width - 10 * s;
  const float left = right_of_tools(view.x + 10 * s, 10 * s), middle = view.y + view.height / 2;
  // Where there is no room for all of it: titles and two buttons, beside the tools.
  const bool narrow = right - left < 340 * s || view.height < 420 * s;
  if (narrow) {
    ImGui::SetNextWindowPos({left, middle}, ImGuiCond_Always, {0, 0.5f});
    ImGui::SetNextWindowSize({right - left, 0});
  } else {
    const float width = std::min({430 * s, view.width - 90 * s, right - left});
    ImGui::SetNextWindowPos({std::max(view.x + (view.width - width) / 2, left), middle}, ImGuiCond_Always,
                            {0, 0.5f});
    ImGui::SetNextWindowSize({width, 0});
  }
  begin_card("welcome", s, narrow ? ImVec2(12 * s, 10 * s) : ImVec2(20 * s, 16 * s));
  heading(ui, "Build a mechanism");
  for (const FirstStep& step : first_steps) {
    ImGui::Dummy({0, 3 * s});
    ImGui::PushFont(ui.fonts.strong);
    ImGui::TextUnformatted(step.title);
    ImGui::PopFont();
    if (!narrow) paragraph(step.text, colors.dim);
    bool first = true;
    for (const char* id : step.commands) {
      if (!id || narrow) continue; // there they are tools
      if (!first) ImGui::SameLine();
      first = false;
      if (text_button(ui, std::string("welcome/") + id, command(id).title)) commands.run(id);
      help_on_hover(command(id).help);
    }
  }
  ImGui::Dummy({0, 6 * s});
  if (text_button(ui, "welcome/examples", "Start from an example…", true)) commands.run("file.examples");
  beside_or_below("Open…");
  if (text_button(ui, "welcome/open", "Open…")) commands.run("file.open");
  paragraph("Ctrl+P finds every command, ? lists the keys.", colors.dim);
  ImGui::End();
}

} // namespace flyball
