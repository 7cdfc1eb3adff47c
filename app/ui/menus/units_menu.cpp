#include "app/ui/menus/menu_commands.hpp"

#include "app/ui/choices.hpp"

#include <array>

namespace flyball::menus {

namespace {

template <auto which, auto unit>
void show_in(App& app) {
  DisplayUnits units = app.session.units;
  units.*which = unit;
  // How a person has looked at the plots was in other units.
  if (choose_units(app.session, app.ui, app.view, units)) app.panels->studies.fit();
}
template <auto which, auto unit>
bool shown_in(const App& app) {
  return app.session.units.*which == unit;
}

const std::array units_commands{
    Command{.id = "units.degrees",
            .title = "Angles in degrees",
            .help = "Angles in fields, results and plots; any unit can be typed.",
            .run = show_in<&DisplayUnits::angle, AngleUnit::degree>,
            .checked = shown_in<&DisplayUnits::angle, AngleUnit::degree>},
    Command{.id = "units.radians",
            .title = "Angles in radians",
            .help = "Angles in fields, results and plots; any unit can be typed.",
            .run = show_in<&DisplayUnits::angle, AngleUnit::radian>,
            .checked = shown_in<&DisplayUnits::angle, AngleUnit::radian>},
    Command{.id = "units.metres",
            .title = "Lengths in metres",
            .help = "Lengths in fields, results and plots; stiffness in N/m.",
            .run = show_in<&DisplayUnits::length, LengthUnit::metre>,
            .checked = shown_in<&DisplayUnits::length, LengthUnit::metre>,
            .separated = true},
    Command{.id = "units.millimetres",
            .title = "Lengths in millimetres",
            .help = "Lengths in fields, results and plots; stiffness in N/mm.",
            .run = show_in<&DisplayUnits::length, LengthUnit::millimetre>,
            .checked = shown_in<&DisplayUnits::length, LengthUnit::millimetre>},
    Command{.id = "units.radians_per_second",
            .title = "Speeds of turning in rad/s",
            .help = "Drive speeds and rates of angles, everywhere.",
            .run = show_in<&DisplayUnits::speed, SpeedUnit::radian>,
            .checked = shown_in<&DisplayUnits::speed, SpeedUnit::radian>,
            .separated = true},
    Command{.id = "units.rpm",
            .title = "Speeds of turning in rpm",
            .help = "Drive speeds and rates of angles, everywhere.",
            .run = show_in<&DisplayUnits::speed, SpeedUnit::rpm>,
            .checked = shown_in<&DisplayUnits::speed, SpeedUnit::rpm>},
    Command{.id = "units.degrees_per_second",
            .title = "Speeds of turning in °/s",
            .help = "Drive speeds and rates of angles, everywhere.",
            .run = show_in<&DisplayUnits::speed, SpeedUnit::degree>,
            .checked = shown_in<&DisplayUnits::speed, SpeedUnit::degree>},
};

} // namespace

std::span<const Command> units() {
  return units_commands;
}

} // namespace flyball::menus
