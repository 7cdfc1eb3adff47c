// Saving a plot as it is looked at: PNG, SVG or CSV.
#pragma once

#include "app/plot/colors.hpp"
#include "app/ui/plots/plot_view.hpp"

#include <array>

namespace flyball {

struct App;
struct DialogState;
struct FileDialogState;
struct Session;

// What is being saved. The dialog writes SVG and CSV itself; a PNG becomes an ExportRequest for whoever has
// OpenGL.
struct PlotSave {
  Plot plot;
  PlotLook look;
  PlotFile kind = PlotFile::png;
  double width = 0, height = 0; // points that it has on the screen
  std::array<int, 2> pixels{};  // wanted of PNG and SVG
  PlotGround ground = PlotGround::light;
};

// Asks where to. `name` becomes part of the file's name.
void show_plot_dialog(const Session& session, DialogState& dialog, FileDialogState& file_dialogs,
                      const std::string& name, PlotSave save);
void plot_dialog(App& app);

} // namespace flyball
