#include "app/ui/choices.hpp"

#include "app/session/settings.hpp"
#include "app/ui/app.hpp"

namespace flyball {

namespace {

Settings settings_of(const App& app) {
  return {.units = app.units, .legend = app.panels.legend, .navigation = app.navigation};
}

} // namespace

void choose_units(App& app, const DisplayUnits& units) {
  if (app.units == units) return;
  app.units = units;
  keep_settings(app.options.state, settings_of(app));
  // Plots are in these units; how a person has looked at them was in others.
  app.plots.response.plotted = 0;
  fit_plot(app.plots.response.view);
  app.plots.map.made_version = 0;
  fit_plot(app.plots.map.view);
  app.plots.campbell.made_result = 0;
  fit_plot(app.plots.campbell.view);
  ++app.motion.version;
  for (MotionPlot& plot : app.plots.motion)
    fit_plot(plot.view);
}

void choose_navigation(App& app, Navigation navigation) {
  app.navigation = navigation;
  keep_settings(app.options.state, settings_of(app));
}

void open_legend(App& app, bool open) {
  app.panels.legend = open;
  keep_settings(app.options.state, settings_of(app));
}

} // namespace flyball
