// The view without anything round it, for pictures: with it only what is needed to read it.
#include "app/render/imgui_compat.hpp"
#include "app/ui/app.hpp"
#include "app/ui/panels.hpp"
#include "app/ui/panels/legend.hpp"
#include "app/ui/panels/load_labels.hpp"

namespace flyball {

void view_alone(App& app, const PanelRect& rect) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
  begin_panel("view", rect, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  ImGui::GetWindowDrawList()->AddImage(imgui_compat::texture_id(app.view.texture), {rect.x, rect.y},
                                       {rect.x + rect.width, rect.y + rect.height}, {0, 1}, {1, 0});
  load_labels(app.ui, app.view, rect);
  ImGui::End();
  legend(app, rect, false);
}

} // namespace flyball
