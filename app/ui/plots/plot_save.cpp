#include "app/ui/plots/plot_save.hpp"

#include "app/plot/csv.hpp"
#include "app/plot/svg.hpp"
#include "app/ui/app.hpp"
#include "app/ui/file_commands.hpp"
#include "app/ui/widgets/dialog.hpp"
#include "app/ui/widgets/file_list.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/file.hpp"

#include <algorithm>

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

// Returns whether the dialog is done with.
bool save_plot(App& app) {
  const PlotSave& save = *app.dialog.plot;
  const std::filesystem::path file = typed_file(app.file_dialogs, extension_of(save.kind));
  if (!may_replace(app.session, app.file_dialogs, file)) return false;
  if (save.kind == PlotFile::png) {
    app.export_request = ExportRequest{
        .file = file, .width = save.pixels[0], .height = save.pixels[1], .plot = app.dialog.plot};
    return true;
  }
  try {
    replace_file(file,
                 save.kind == PlotFile::csv
                     ? to_csv(save.plot, save.look)
                     : to_svg(save.plot,
                              {.width = save.pixels[0], .height = save.pixels[1], .ground = save.ground},
                              save.look));
    app.session.notice = "Saved " + file.string();
    return true;
  } catch (const SceneError& error) {
    app.file_dialogs.message = error.what();
    app.file_dialogs.replacing.clear();
    return false;
  }
}

void close(DialogState& dialog) {
  dialog.plot.reset();
  close_dialog();
}

} // namespace

void show_plot_dialog(const Session& session, DialogState& dialog, FileDialogState& file_dialogs,
                      const std::string& name, PlotSave save) {
  dialog.wanted = Dialog::save_plot;
  // Twice as fine as the screen, for print.
  const double finer = save.kind == PlotFile::png ? 2 : 1;
  const auto pixels = [&](double points) {
    return std::clamp(static_cast<int>(finer * points), smallest_plot, largest_plot);
  };
  save.pixels = {pixels(save.width), pixels(save.height)};
  show_folder(file_dialogs, usual_folder(session));
  file_dialogs.replacing.clear();
  const std::filesystem::path& file = session.document.file();
  const std::string stem = file.empty() ? file_stem(session.mechanism().name) : file.stem().string();
  file_dialogs.path = stem + "-" + file_stem(name) + extension_of(save.kind);
  dialog.plot = std::make_shared<PlotSave>(std::move(save));
}

void plot_dialog(App& app) {
  if (!begin_dialog(app.ui, app.dialog, Dialog::save_plot, "Save the plot", 560)) return;
  if (!app.dialog.plot) { // nothing to be saved
    close(app.dialog);
    return end_dialog();
  }
  PlotSave& save = *app.dialog.plot;
  const char* extension = extension_of(save.kind);
  bool accepted = path_field(app.ui, app.file_dialogs, "save_plot", "Name");
  folder_line(app.ui, app.file_dialogs, "save_plot");
  if (const auto clicked =
          file_list(app.ui, app.file_dialogs, "save_plot", extension, false, 160 * app.ui.scale))
    app.file_dialogs.path = clicked->filename().string();
  if (save.kind != PlotFile::csv) size_fields(app.ui, save);
  const std::filesystem::path file = typed_file(app.file_dialogs, extension);
  const bool replaces = asks_to_replace(app.ui, app.file_dialogs, file);
  if (!replaces && !app.file_dialogs.message.empty())
    paragraph(app.file_dialogs.message, colors_of(app.ui).bad);
  ImGui::Dummy({0, 2 * app.ui.scale});
  const bool usable = fits(save) && !app.file_dialogs.path.empty();
  ImGui::BeginDisabled(!usable);
  accepted = text_button(app.ui, "save_plot/save", replaces ? "Replace" : "Save", true) || accepted;
  ImGui::EndDisabled();
  ImGui::SameLine();
  const bool cancelled = text_button(app.ui, "save_plot/cancel", "Cancel") || escape_pressed();
  std::error_code ignored;
  if (cancelled)
    close(app.dialog);
  else if (accepted && usable && std::filesystem::is_directory(typed_path(app.file_dialogs), ignored))
    entered_file(app.file_dialogs, false); // goes there
  else if (accepted && usable && save_plot(app))
    close(app.dialog);
  end_dialog();
}

} // namespace flyball
