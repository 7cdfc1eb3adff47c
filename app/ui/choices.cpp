#include "app/ui/choices.hpp"

#include "app/ui/app.hpp"
#include "app/ui/widgets/ui_style.hpp"

namespace flyball {

namespace {

Settings settings_of(const App& app) {
  return {.units = app.session.units,
          .legend = app.panels.legend,
          .navigation = app.navigation,
          .theme = app.theme_choice};
}

} // namespace

void choose_units(App& app, const DisplayUnits& units) {
  if (app.session.units == units) return;
  app.session.units = units;
  keep_settings(app.session.options.state, settings_of(app));
  // How a person has looked at the plots was in other units.
  fit_plot(app.plots.response.view);
  fit_plot(app.plots.map.view);
  fit_plot(app.plots.campbell.view);
  for (MotionPlot& plot : app.plots.motion)
    fit_plot(plot.view);
}

void choose_navigation(App& app, Navigation navigation) {
  app.navigation = navigation;
  keep_settings(app.session.options.state, settings_of(app));
}

namespace {

void show_theme(Ui& ui, Theme theme) {
  if (ui.theme == theme) return;
  ui.theme = theme;
  apply_style(theme, ui.scale);
}

} // namespace

Theme theme_of(ThemeChoice choice, Theme system) {
  switch (choice) {
  case ThemeChoice::system: return system;
  case ThemeChoice::light: return Theme::light;
  case ThemeChoice::dark: return Theme::dark;
  case ThemeChoice::high_contrast: break;
  }
  return Theme::high_contrast;
}

void choose_theme(App& app, ThemeChoice choice) {
  app.theme_choice = choice;
  keep_settings(app.session.options.state, settings_of(app));
  show_theme(app.ui, theme_of(choice, app.system_theme));
}

void take_system_theme(App& app, Theme theme) {
  app.system_theme = theme;
  if (app.theme_choice == ThemeChoice::system) show_theme(app.ui, theme);
}

void open_legend(App& app, bool open) {
  app.panels.legend = open;
  keep_settings(app.session.options.state, settings_of(app));
}

} // namespace flyball
