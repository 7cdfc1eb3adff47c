// What dry friction makes of the steady state: how far it may stand away, whether the drawn pose holds, and
// the speeds between which it does not move.
#include "app/session/coordinate_words.hpp"
#include "app/session/units.hpp"
#include "app/ui/panels/result_sections.hpp"
#include "app/ui/widgets/widgets.hpp"
#include "engine/mechanism/text.hpp"

#include <cmath>

namespace flyball {

namespace {

constexpr int extent_digits = 5; // an extent is looked at, not copied

std::string range_words(const ShownUnit& unit, double low, double high) {
  const auto bound = [&](double value, const char* none) {
    return std::isfinite(value) ? short_text(unit.shown(value), extent_digits) : std::string(none);
  };
  return bound(low, "-∞") + " … " + bound(high, "∞");
}

std::string percent_words(double part) {
  constexpr double plain = 10; // times: from here on whole percents say enough
  if (!std::isfinite(part)) return "∞";
  return part >= plain && part < 1e4 * plain ? std::to_string(std::llround(100 * part))
                                             : short_text(100 * part, 3);
}

void band_rows(const Session& session, Ui& ui, const FrictionBand& band) {
  for (const BandExtent& extent : band.extents) {
    const ShownUnit unit = shown_unit(extent.unit, session.units);
    const bool bounded = std::isfinite(extent.low) || std::isfinite(extent.high);
    const std::string range = range_words(unit, extent.low, extent.high);
    row(ui, extent.name, (band.at_least && bounded ? "at least " : "") + range, unit.text.c_str(),
        ("Between these friction holds it, wherever it came to rest" +
         std::string(band.at_least && bounded ? ", and perhaps beyond." : ".") +
         (extent.error
              ? "\nEach end within " + short_text(unit.shown(*extent.error), 1) + " " + unit.text + "."
              : std::string()))
            .c_str());
    note_widget(ui.widgets, "results/friction/" + extent.name);
  }
  if (!band.message.empty()) paragraph(band.message, colors_of(ui).dim);
}

void drawn_rows(const Session& session, Ui& ui, const Holding& drawn) {
  if (!drawn.takes) return paragraph("Drawn pose: " + drawn.message, colors_of(ui).dim);
  std::string help = drawn.message;
  for (const HeldJoint& joint : drawn.joints) {
    const ShownUnit unit = shown_unit(joint.angle ? "N m" : "N", session.units);
    help += "\n" + coordinate_words(joint) + ": at most " +
            short_text(unit.shown(joint.limit), extent_digits) + " " + unit.text;
    if (joint.force)
      help += ", needed " + short_text(unit.shown(*joint.force), extent_digits) + " " + unit.text;
  }
  constexpr double many = 10; // times: "165 × the friction" is understood sooner than 16528 %
  const bool times = *drawn.takes >= many && std::isfinite(*drawn.takes);
  row(ui, *drawn.takes <= 1 ? "Drawn pose holds, by" : "Drawn pose slips, needs",
      times ? short_text(*drawn.takes, 3) : percent_words(*drawn.takes),
      times ? "× the friction" : "% of friction", help.c_str());
  note_widget(ui.widgets, "results/friction/drawn");
}

void speed_rows(const Session& session, Ui& ui, const std::vector<HeldSpeeds>& all) {
  for (const HeldSpeeds& held : all) {
    const ShownUnit unit = rate_unit(held.angle, session.units);
    const std::string low = held.lower ? short_text(unit.shown(*held.lower), extent_digits) : "rest",
                      high = held.upper ? short_text(unit.shown(*held.upper), extent_digits) : "any";
    row(ui, "Unmoved by " + coordinate_words(held), low + " … " + high, unit.text.c_str(),
        "Between these speeds friction holds it where it stands.");
    if (const auto part = held.insensitivity())
      row(ui, "Insensitivity", percent_words(*part), "%",
          "The difference of these speeds over their mean: what a governor does not answer.");
    note_widget(ui.widgets, "results/friction/" + coordinate_label(held) + "/speeds");
  }
}

} // namespace

void friction_results(const Session& session, Ui& ui) {
  const FrictionReport* friction = friction_report(session);
  if (!friction) return;
  heading(ui, "Held by friction");
  help_on_hover(
      "At rest friction gives whatever holds, up to its limits: the steady state is a band. Above is the "
      "state at the joints' shares; stability is told of the motion once they slip.");
  band_rows(session, ui, friction->band);
  drawn_rows(session, ui, friction->drawn);
  speed_rows(session, ui, friction->speeds);
  if (session.options.numbers.run_times)
    row(ui, "Run time", duration_text(friction->run_time_s, session.options.numbers), "");
}

} // namespace flyball
