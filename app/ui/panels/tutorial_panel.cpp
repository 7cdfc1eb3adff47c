#include "app/ui/panels/tutorial_panel.hpp"

#include "app/ui/layout.hpp"
#include "app/ui/ui.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace flyball {

void TutorialPanel::draw(Ui& ui, const PanelRect& view) {
  if (!open) return;
  const float s = ui.scale;
  ImGui::SetNextWindowPos({view.x + view.width - 10 * s, view.y + 10 * s}, ImGuiCond_Appearing, {1, 0});
  ImGui::SetNextWindowSize({std::min(380 * s, view.width - 20 * s), std::min(420 * s, view.height - 20 * s)},
                           ImGuiCond_Appearing);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, std::max(1.f, std::round(s)));
  if (ImGui::Begin("A governor from nothing", &open,
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings)) {
    int line = 0;
    for (std::string_view rest = tutorial_text(); !rest.empty();) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      paragraph(std::string(rest.substr(0, end)), colors_of(ui).text);
      note_widget(ui.widgets, "tutorial/" + std::to_string(++line), KeyUse::none);
      ImGui::Dummy({0, 3 * s});
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
}

} // namespace flyball
