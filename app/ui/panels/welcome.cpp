// What an empty document shows instead of nothing: the first steps.
#include "app/session/session.hpp"
#include "app/ui/commands.hpp"
#include "app/ui/dialog_state.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/tool_state.hpp"
#include "app/ui/widgets/card.hpp"
#include "app/ui/widgets/widgets.hpp"

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

} // namespace

void welcome(const Session& session, Ui& ui, const ToolState& tool, const DialogState& dialog,
             const CommandRunner& commands, const PanelRect& view) {
  if (!session.mechanism().bodies.empty() || tool.tool != Tool::select || dialog.showing) return;
  const UiColors& colors = colors_of(ui);
  const float s = ui.scale, width = std::min(430 * s, view.width - 90 * s);
  ImGui::SetNextWindowPos({view.x + view.width / 2, view.y + view.height / 2}, ImGuiCond_Always,
                          {0.5f, 0.5f});
  ImGui::SetNextWindowSize({width, 0});
  begin_card("welcome", s, {20 * s, 16 * s});
  heading(ui, "Build a mechanism");
  for (const FirstStep& step : first_steps) {
    ImGui::Dummy({0, 3 * s});
    ImGui::PushFont(ui.fonts.strong);
    ImGui::TextUnformatted(step.title);
    ImGui::PopFont();
    paragraph(step.text, colors.dim);
    bool first = true;
    for (const char* id : step.commands) {
      if (!id) continue;
      if (!first) ImGui::SameLine();
      first = false;
      if (text_button(ui, std::string("welcome/") + id, command(id).title)) commands.run(id);
      help_on_hover(command(id).help);
    }
  }
  ImGui::Dummy({0, 6 * s});
  if (text_button(ui, "welcome/examples", "Start from an example…", true)) commands.run("file.examples");
  ImGui::SameLine();
  if (text_button(ui, "welcome/open", "Open…")) commands.run("file.open");
  paragraph("Ctrl+P finds every command, ? lists the keys.", colors.dim);
  ImGui::End();
}

} // namespace flyball
