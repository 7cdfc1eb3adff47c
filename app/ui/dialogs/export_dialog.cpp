#include "app/ui/dialogs/export_dialog.hpp"

#include "app/session/session.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/file_list.hpp"
#include "app/ui/widgets/size_fields.hpp"
#include "app/ui/widgets/widgets.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace flyball {

namespace {

constexpr int smallest_picture = 16, largest_picture = 8192; // pixels

constexpr std::array picture_sizes{PictureSize{"720p", "1280 × 720", 1280, 720},
                                   PictureSize{"1080p", "1920 × 1080", 1920, 1080},
                                   PictureSize{"4k", "3840 × 2160", 3840, 2160}};

} // namespace

void ExportDialog::open(const Session& session, DialogState& dialog, bool loads) {
  dialog.wanted = Dialog::export_picture;
  now_ = saved_;
  loads_ = loads;
  show_folder(query_, usual_folder(session));
  query_.asked.clear();
  const std::string stem = file_stem(session);
  query_.path = (query_.list.shown / ("flyball-" + stem + ".png")).string();
}

void ExportDialog::refuse(DialogState& dialog, std::string why) {
  dialog.wanted = Dialog::export_picture;
  query_.message = std::move(why);
  query_.asked.clear();
}

std::optional<ExportRequest> ExportDialog::draw(Session& session, Ui& ui, DialogState& dialog) {
  std::optional<ExportRequest> picture;
  if (!begin_dialog(ui, dialog, Dialog::export_picture, "Save a picture", 480)) return picture;
  bool accepted = path_field(ui, query_, "export", "Name");

  size_fields(ui, "export", picture_sizes, 80, now_.width, now_.height);
  ImGui::SetCursorPosX(80 * ui.scale);
  ImGui::Checkbox("With the panels", &now_.panels);
  note_widget(ui.widgets, "export/panels");
  ImGui::SameLine(0, 20 * ui.scale);
  ImGui::Checkbox("With forces", &loads_);
  note_widget(ui.widgets, "export/loads");
  help_on_hover("Arrows of what acts, and their legend; with one body selected, its free-body diagram.");

  const bool fits = std::min(now_.width, now_.height) >= smallest_picture &&
                    std::max(now_.width, now_.height) <= largest_picture;
  if (!fits) paragraph("From 16 to 8192 pixels a side.", colors_of(ui).bad);
  const std::filesystem::path file = typed_file(query_, ".png");
  const char* asked = asked_before_writing(ui, query_, file);
  if (!asked && !query_.message.empty()) paragraph(query_.message, colors_of(ui).bad);
  ImGui::Dummy({0, 2 * ui.scale});
  ImGui::BeginDisabled(!fits || query_.path.empty());
  accepted = text_button(ui, "export/save", asked ? asked : "Save", true) || accepted;
  ImGui::EndDisabled();
  if (accepted && fits && !query_.path.empty() && may_write_to(session, query_, file)) {
    picture = ExportRequest{file, std::clamp(now_.width, smallest_picture, largest_picture),
                            std::clamp(now_.height, smallest_picture, largest_picture), now_.panels, loads_};
    saved_ = now_;
    close_dialog();
  }
  ImGui::SameLine();
  if (text_button(ui, "export/cancel", "Cancel") || escape_pressed()) close_dialog();
  end_dialog();
  return picture;
}

} // namespace flyball
