#include "app/report/numbers.hpp"
#include "app/report/sections.hpp"
#include "engine/mechanism/text.hpp"

#include <cmath>

namespace flyball {
namespace {

Html percent(double part) {
  return std::isfinite(part) ? quantity(100 * part, "%", 4) : Html("without bound");
}

Html band_table(const FrictionBand& band) {
  if (!band.found) return {};
  HtmlTable table({{"Of", false}, {"From"}, {"To"}, {"Width"}, {"Error"}});
  for (const BandExtent& extent : band.extents) {
    const auto bound = [&](double value) {
      return !std::isfinite(value) ? Html("no bound")
             : extent.error        ? quantity_within(value, *extent.error, extent.unit)
                                   : quantity(value, extent.unit, 9);
    };
    const double wide = extent.high - extent.low;
    table.row({extent.name, bound(extent.low), bound(extent.high),
               std::isfinite(wide) ? quantity(wide, extent.unit) : Html("no bound"),
               extent.error ? magnitude(*extent.error, extent.unit) : Html()});
  }
  return heading_of("The band within which it stands") +
         paragraph_of("At rest friction gives whatever holds, up to its limits: the steady state may stand "
                      "anywhere between these values" +
                      std::string(band.at_least ? ", and perhaps beyond." : ".")) +
         table.html();
}

Html holding_table(const Holding& drawn) {
  HtmlTable table({{"Joint", false}, {"Limit"}, {"Needed"}, {"Of the limit"}});
  for (const HeldJoint& joint : drawn.joints) {
    const std::string_view unit = force_unit_of(joint.angle);
    table.row({coordinate_label(joint), quantity(joint.limit, unit),
               joint.force ? quantity(*joint.force, unit) : Html(),
               joint.force && joint.limit > 0 ? percent(std::abs(*joint.force) / joint.limit) : Html()});
  }
  HtmlTerms terms;
  if (drawn.takes) terms.term("Takes", percent(*drawn.takes));
  if (drawn.takes && *drawn.takes < 1) terms.term("Margin", percent(1 - *drawn.takes));
  if (!drawn.first.empty()) terms.term("First to slip", drawn.first);
  return heading_of("Holding the drawn pose") + paragraph_of(drawn.message) + terms.html() + table.html();
}

Html speeds_table(const std::vector<HeldSpeeds>& all) {
  if (all.empty()) return {};
  HtmlTable table({{"Drive", false}, {"From"}, {"To"}, {"Insensitivity"}});
  for (const HeldSpeeds& held : all) {
    const std::string_view unit = held.angle ? "rad/s" : "m/s";
    const auto part = held.insensitivity();
    table.row({coordinate_label(held), held.lower ? quantity(*held.lower, unit, 9) : Html("rest"),
               held.upper ? quantity(*held.upper, unit, 9) : Html("any"), part ? percent(*part) : Html()});
  }
  return heading_of("Speeds that do not move it") +
         paragraph_of("Between these speeds friction holds the steady state where it stands; the "
                      "insensitivity is their difference over their mean.") +
         table.html();
}

} // namespace

OptionalSection friction_section(const ReportContents& contents) {
  if (!contents.friction) return std::nullopt;
  const FrictionReport& f = *contents.friction;
  Html body = band_table(f.band);
  if (!f.band.message.empty()) body += paragraph_of(f.band.message);
  if (f.band.found)
    body += paragraph_of("Stability is told of the motion once the joints slip: within the band they stand "
                         "still.");
  return ReportSection{"friction", "Dry friction", body + holding_table(f.drawn) + speeds_table(f.speeds)};
}

} // namespace flyball
