// Which dialog is open: one at a time.
#pragma once

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

struct DialogState {
  Dialog wanted = Dialog::none; // to be opened by the next frame
  bool showing = false;
};

} // namespace flyball
