#include "app/panels/panels.hpp"

namespace flyball {

void build_gui(App& app) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const Layout layout = layout_of(app, size.x, size.y);
  app.widgets.clear();
  handle_shortcuts(app);
  // ImGui puts windows that never come to the front behind those it has: the first is the topmost.
  drag_splitters(app, layout, size.y);
  viewport_panel(app, layout.view);
  parameters_panel(app, layout.parameters);
  results_panel(app, layout.results);
  toolbar_panel(app, layout.toolbar);
  app.dialog.showing = false;
  open_dialog(app);
  export_dialog(app);
}

} // namespace flyball
