#include "app/panels/dialog.hpp"
#include "app/panels/file_commands.hpp"
#include "app/panels/file_list.hpp"
#include "app/panels/panels.hpp"
#include "app/panels/widgets.hpp"

#include <algorithm>
#include <array>

namespace flyball {

namespace {

constexpr int smallest = 16, largest = 8192; // pixels

struct Size {
  const char* name;
  const char* text;
  int width, height;
};
constexpr std::array sizes{Size{"export/720p", "1280 × 720", 1280, 720},
                           Size{"export/1080p", "1920 × 1080", 1920, 1080},
                           Size{"export/4k", "3840 × 2160", 3840, 2160}};

void number(App& app, const char* name, int& value) {
  ImGui::SetNextItemWidth(84 * app.scale);
  ImGui::PushID(name);
  ImGui::InputInt("##number", &value, 0);
  ImGui::PopID();
  note_widget(app.widgets, name);
}

void save(App& app) {
  DialogState& dialog = app.dialog;
  const std::filesystem::path file = typed_file(app, ".png");
  if (!may_replace(app, file)) return;
  app.export_request = ExportRequest{file, std::clamp(dialog.width, smallest, largest),
                                     std::clamp(dialog.height, smallest, largest), dialog.panels};
  close_dialog();
}

} // namespace

void show_export_dialog(App& app) {
  app.dialog.wanted = Dialog::export_picture;
  std::error_code ignored;
  show_folder(app, std::filesystem::current_path(ignored));
  app.files.replacing.clear();
  const std::filesystem::path& file = app.document.file();
  const std::string stem = file.empty() ? file_stem(app.mechanism().name) : file.stem().string();
  app.dialog.path = (app.files.list.shown / ("flyball-" + stem + ".png")).string();
}

void export_dialog(App& app) {
  if (!begin_dialog(app, Dialog::export_picture, "Save a picture", 480)) return;
  DialogState& dialog = app.dialog;
  bool accepted = path_field(app, "export", "Name");

  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Size");
  ImGui::SameLine(80 * app.scale);
  number(app, "export/width", dialog.width);
  ImGui::SameLine();
  ImGui::TextUnformatted("×");
  ImGui::SameLine();
  number(app, "export/height", dialog.height);
  ImGui::SameLine();
  ImGui::TextDisabled("pixels");
  ImGui::SetCursorPosX(80 * app.scale);
  for (const Size& size : sizes) {
    if (text_button(app, size.name, size.text)) {
      dialog.width = size.width;
      dialog.height = size.height;
    }
    ImGui::SameLine();
  }
  ImGui::NewLine();
  ImGui::SetCursorPosX(80 * app.scale);
  ImGui::Checkbox("With the panels", &dialog.panels);
  note_widget(app.widgets, "export/panels");

  const bool fits =
      std::min(dialog.width, dialog.height) >= smallest && std::max(dialog.width, dialog.height) <= largest;
  if (!fits) paragraph("From 16 to 8192 pixels a side.", colors_of(app).bad);
  const std::filesystem::path file = typed_file(app, ".png");
  const bool replaces = file == app.files.replacing;
  if (replaces) paragraph(file.filename().string() + " is there already. Replace it?", colors_of(app).warn);
  ImGui::Dummy({0, 2 * app.scale});
  ImGui::BeginDisabled(!fits || dialog.path.empty());
  accepted = text_button(app, "export/save", replaces ? "Replace" : "Save", true) || accepted;
  ImGui::EndDisabled();
  if (accepted && fits && !dialog.path.empty()) save(app);
  ImGui::SameLine();
  if (text_button(app, "export/cancel", "Cancel") || escape_pressed()) close_dialog();
  end_dialog();
}

} // namespace flyball
