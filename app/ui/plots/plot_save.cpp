#include "app/ui/plots/plot_save.hpp"

#include "app/plot/csv.hpp"
#include "app/plot/svg.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/file_list.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/file.hpp"

#include <algorithm>
#include <utility>

namespace flyball {

namespace {

constexpr int smallest_plot = 160, largest_plot = 8192; // pixels

const char* extension_of(PlotFile kind) {
  return kind == PlotFile::png ? ".png" : kind == PlotFile::svg ? ".svg" : ".csv";
}

void number(Ui& ui, const char* name, int& value) {
  ImGui::SetNextItemWidth(84 * ui.scale);
  ImGui::PushID(name);
  ImGui::InputInt("##number", &value, 0);
  ImGui::PopID();
  note_widget(ui.widgets, name, KeyUse::type);
}

bool fits(const PlotSave& save) {
  return save.kind == PlotFile::csv ||
         (std::ranges::min(save.pixels) >= smallest_plot && std::ranges::max(save.pixels) <= largest_plot);
}

void size_fields(Ui& ui, PlotSave& save) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Size");
  ImGui::SameLine(80 * ui.scale);
  number(ui, "save_plot/width", save.pixels[0]);
  ImGui::SameLine();
  ImGui::TextUnformatted("×");
  ImGui::SameLine();
  number(ui, "save_plot/height", save.pixels[1]);
  ImGui::SameLine();
  ImGui::TextDisabled("pixels");
  if (!fits(save)) paragraph("From 160 to 8192 pixels a side.", colors_of(ui).bad);
}

} // namespace

// Returns whether the dialog is done with.
bool PlotDialog::save(Session& session, std::optional<ExportRequest>& picture) {
  const PlotSave& save = *save_;
  const std::filesystem::path file = typed_file(query_, extension_of(save.kind));
  if (!may_write_to(session, query_, file)) return false;
  if (save.kind == PlotFile::png) {
    picture = ExportRequest{.file = file, .width = save.pixels[0], .height = save.pixels[1], .plot = save_};
    return true;
  }
  try {
    replace_file(file,
                 save.kind == PlotFile::csv
                     ? to_csv(save.plot, save.look)
                     : to_svg(save.plot,
                              {.width = save.pixels[0], .height = save.pixels[1], .ground = save.ground},
                              save.look));
    session.notice = "Saved " + file.string();
    return true;
  } catch (const SceneError& error) {
    query_.message = error.what();
    query_.asked.clear();
    return false;
  }
}

void PlotDialog::close() {
  save_.reset();
  close_dialog();
}

void PlotDialog::open(const Session& session, DialogState& dialog, PlotToSave asked) {
  PlotSave& save = asked.save;
  dialog.wanted = Dialog::save_plot;
  // Twice as fine as the screen, for print.
  const double finer = save.kind == PlotFile::png ? 2 : 1;
  const auto pixels = [&](double points) {
    return std::clamp(static_cast<int>(finer * points), smallest_plot, largest_plot);
  };
  save.pixels = {pixels(save.width), pixels(save.height)};
  show_folder(query_, usual_folder(session));
  query_.asked.clear();
  const std::string stem = file_stem(session);
  query_.path = stem + "-" + file_stem(asked.name) + extension_of(save.kind);
  save_ = std::make_shared<PlotSave>(std::move(save));
}

void PlotDialog::refuse(DialogState& dialog, const PlotSave& save, std::string why) {
  dialog.wanted = Dialog::save_plot;
  save_ = std::make_shared<PlotSave>(save);
  query_.message = std::move(why);
  query_.asked.clear();
}

std::optional<ExportRequest> PlotDialog::draw(Session& session, Ui& ui, DialogState& dialog) {
  if (const auto asked = std::exchange(ui.plot_to_save, {})) open(session, dialog, std::move(*asked));
  std::optional<ExportRequest> picture;
  if (!begin_dialog(ui, dialog, Dialog::save_plot, "Save the plot", 560)) return picture;
  if (!save_) { // nothing to be saved
    close();
    end_dialog();
    return picture;
  }
  PlotSave& save = *save_;
  const char* extension = extension_of(save.kind);
  bool accepted = path_field(ui, query_, "save_plot", "Name");
  folder_line(ui, query_, "save_plot");
  if (const auto clicked = file_list(ui, query_, "save_plot", extension, false, 160 * ui.scale))
    query_.path = clicked->filename().string();
  if (save.kind != PlotFile::csv) size_fields(ui, save);
  const std::filesystem::path file = typed_file(query_, extension);
  const char* asked = asked_before_writing(ui, query_, file);
  if (!asked && !query_.message.empty()) paragraph(query_.message, colors_of(ui).bad);
  ImGui::Dummy({0, 2 * ui.scale});
  const bool usable = fits(save) && !query_.path.empty();
  ImGui::BeginDisabled(!usable);
  accepted = text_button(ui, "save_plot/save", asked ? asked : "Save", true) || accepted;
  ImGui::EndDisabled();
  ImGui::SameLine();
  const bool cancelled = text_button(ui, "save_plot/cancel", "Cancel") || escape_pressed();
  std::error_code ignored;
  if (cancelled)
    close();
  else if (accepted && usable && std::filesystem::is_directory(typed_path(query_), ignored))
    entered_file(query_, false); // goes there
  else if (accepted && usable && this->save(session, picture))
    close();
  end_dialog();
  return picture;
}

} // namespace flyball
