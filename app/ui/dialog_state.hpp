// Which dialog is open, and what is chosen in it.
#pragma once

#include <memory>

namespace flyball {

enum class Dialog {
  none,
  open,
  save,
  gallery,
  unsaved,
  recover,
  export_picture,
  export_report,
  export_model,
  save_plot,
  export_run,
  mirror,
  circular
};

struct PlotSave; // see plot_save.hpp

struct DialogState {
  Dialog wanted = Dialog::none; // to be opened by the next frame
  bool showing = false;
  int width = 1920, height = 1080; // pixels
  bool panels = false, loads = false;
  std::shared_ptr<PlotSave> plot; // while one is being saved
};

} // namespace flyball
