#include "app/plot/svg.hpp"
#include "app/report/numbers.hpp"
#include "app/report/sections.hpp"
#include "engine/mechanism/address.hpp"

namespace flyball {
namespace {

constexpr int width = 720, height = 400; // points

// The page shows the one that goes with its ground.
Html drawing(const Plot& plot, const std::string& name, PlotGround ground, const char* which) {
  SvgOptions options;
  options.width = width;
  options.height = height;
  options.font = "inherit";
  options.ground = ground;
  options.prefix = name + "-" + which + "-";
  return element("div", Html::markup(to_svg(plot, options)), {{"class", which}});
}

Html figure(const Plot& plot, const std::string& name, const Html& caption) {
  return element("figure", drawing(plot, name, PlotGround::light, "light") +
                               drawing(plot, name, PlotGround::dark, "dark") +
                               element("figcaption", caption)) +
         "\n";
}

} // namespace

OptionalSection curves_section(const ReportContents& contents) {
  if (contents.curves.empty()) return std::nullopt;
  const Mechanism& m = *contents.mechanism;
  Html body = paragraph_of(
      moves(contents)
          ? "Periodic motions as one number moves: the line is the mean over a period, the band reaches from "
            "the least to the most. Solid where the motion is stable, dashed where it is not; the dot is "
            "that "
            "of this report."
          : "Steady states as one number moves, followed through folds and crossings. Solid where they are "
            "stable, dashed elsewhere; the dot is the state of this report.");
  for (std::size_t i = 0; i < contents.curves.size(); ++i) {
    const ReportCurve& curve = contents.curves[i];
    const std::string unit = parameter_unit(m, curve.over.parameter);
    const Html range = quantity(curve.over.from, unit) + " to " + quantity(curve.over.to, unit);
    body += heading_of(curve.over.parameter);
    if (curve.plots.empty())
      body += paragraph_of(Html("Nothing to be drawn from ") + range + ": " + curve.message);
    for (std::size_t k = 0; k < curve.plots.size(); ++k)
      body += figure(curve.plots[k], "curve-" + std::to_string(i + 1) + "-" + std::to_string(k + 1),
                     element("strong", curve.plots[k].y.label) + " over " + curve.over.parameter + " from " +
                         range + ". " + curve.message);
  }
  return ReportSection{"response", "Response curves", body};
}

} // namespace flyball
