#include "app/ui/widgets/size_fields.hpp"

#include "app/ui/widgets/widgets.hpp"

namespace flyball {

namespace {

void number(App& app, const std::string& name, int& value) {
  ImGui::SetNextItemWidth(84 * app.scale);
  ImGui::PushID(name.c_str());
  ImGui::InputInt("##number", &value, 0);
  ImGui::PopID();
  note_widget(app.widgets, name, KeyUse::type);
}

} // namespace

void size_fields(App& app, const std::string& name, std::span<const PictureSize> usual, float column,
                 int& width, int& height) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Size");
  ImGui::SameLine(column * app.scale);
  number(app, name + "/width", width);
  ImGui::SameLine();
  ImGui::TextUnformatted("×");
  ImGui::SameLine();
  number(app, name + "/height", height);
  ImGui::SameLine();
  ImGui::TextDisabled("pixels");
  ImGui::SetCursorPosX(column * app.scale);
  for (const PictureSize& size : usual) {
    if (text_button(app, name + "/" + size.name, size.text)) {
      width = size.width;
      height = size.height;
    }
    ImGui::SameLine();
  }
  ImGui::NewLine();
}

} // namespace flyball
