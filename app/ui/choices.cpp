#include "app/ui/choices.hpp"

#include "app/session/session.hpp"
#include "app/ui/ui.hpp"
#include "app/ui/view_state.hpp"
#include "app/ui/widgets/ui_style.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>

namespace flyball {

namespace {

Settings settings_of(const Session& session, const Ui& ui, const ViewState& view) {
  return {.units = session.units,
          .legend = view.legend,
          .ghost = view.ghost,
          .grid = view.grid,
          .shadow = view.shadow,
          .navigation = view.navigation,
          .theme = ui.theme_kept,
          .zoom = ui.zoom};
}

void keep_choices(const Session& session, const Ui& ui, const ViewState& view) {
  keep_settings(session.options.state, settings_of(session, ui, view));
}

} // namespace

bool choose_units(Session& session, const Ui& ui, const ViewState& view, const DisplayUnits& units) {
  if (session.units == units) return false;
  session.units = units;
  session.parameters = parameter_controls(session.mechanism(), session.document.stored(), units);
  keep_choices(session, ui, view);
  return true;
}

void choose_navigation(const Session& session, const Ui& ui, ViewState& view, Navigation navigation) {
  view.navigation = navigation;
  keep_choices(session, ui, view);
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

void choose_theme(const Session& session, Ui& ui, const ViewState& view, ThemeChoice choice) {
  ui.theme_choice = ui.theme_kept = choice;
  keep_choices(session, ui, view);
  show_theme(ui, theme_of(choice, ui.system_theme));
}

void take_system_theme(Ui& ui, Theme theme) {
  ui.system_theme = theme;
  if (ui.theme_choice == ThemeChoice::system) show_theme(ui, theme);
}

void zoom_interface(const Session& session, Ui& ui, const ViewState& view, int steps) {
  constexpr std::array sizes{least_zoom, 0.8, 0.9, 1., 1.1, 1.25, 1.5, 1.75, 2., 2.5, most_zoom};
  const auto nearest =
      std::ranges::min_element(sizes, {}, [&](double size) { return std::abs(std::log(size / ui.zoom)); });
  const auto at = steps == 0 ? std::ranges::find(sizes, 1.) - sizes.begin() : nearest - sizes.begin() + steps;
  ui.zoom = sizes[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(at, 0, std::ssize(sizes) - 1))];
  keep_choices(session, ui, view);
}

void open_legend(const Session& session, const Ui& ui, ViewState& view, bool open) {
  view.legend = open;
  keep_choices(session, ui, view);
}

void toggle_in_view(const Session& session, const Ui& ui, ViewState& view, bool ViewState::*what) {
  view.*what = !(view.*what);
  keep_choices(session, ui, view);
}

} // namespace flyball
