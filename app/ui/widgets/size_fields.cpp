#include "app/ui/widgets/size_fields.hpp"

#include "app/ui/widgets/widgets.hpp"

namespace flyball {

namespace {

void number(Ui& ui, const std::string& name, int& value) {
  ImGui::SetNextItemWidth(84 * ui.scale);
  ImGui::PushID(name.c_str());
  ImGui::InputInt("##number", &value, 0);
  ImGui::PopID();
  note_widget(ui.widgets, name, KeyUse::type);
}

} // namespace

void size_fields(Ui& ui, const std::string& name, std::span<const PictureSize> usual, float column,
                 int& width, int& height) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Size");
  ImGui::SameLine(column * ui.scale);
  number(ui, name + "/width", width);
  ImGui::SameLine();
  ImGui::TextUnformatted("×");
  ImGui::SameLine();
  number(ui, name + "/height", height);
  ImGui::SameLine();
  ImGui::TextDisabled("pixels");
  ImGui::SetCursorPosX(column * ui.scale);
  for (const PictureSize& size : usual) {
    if (text_button(ui, name + "/" + size.name, size.text)) {
      width = size.width;
      height = size.height;
    }
    ImGui::SameLine();
  }
  ImGui::NewLine();
}

} // namespace flyball
