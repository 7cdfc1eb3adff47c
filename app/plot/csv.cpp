#include "app/plot/csv.hpp"

#include "engine/mechanism/safe_text.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace flyball {

namespace {

// Of an axis or the values of a map.
template <class Scale>
std::string header_of(const Scale& axis, const char* otherwise) {
  const std::string text = axis_text(axis.label, axis.si_unit.empty() ? axis.unit : axis.si_unit);
  return csv_field(text.empty() ? otherwise : text);
}

} // namespace

std::string to_csv(const Plot& plot, const PlotLook& look) {
  const bool heat = plot.heat && plot.heat->values.size() == plot.heat->x.size() * plot.heat->y.size();
  const bool notes = heat && plot.heat->notes.size() == plot.heat->values.size();
  const char* end = notes ? ",,\r\n" : heat ? ",\r\n" : "\r\n";
  std::string out = "curve," + header_of(plot.x, "x") + "," + header_of(plot.y, "y");
  if (heat) out += "," + header_of(*plot.heat, "value");
  if (notes) out += "," + csv_field(plot.heat->notes_label);
  out += "\r\n";
  const auto row = [&](const std::string& name, double x, double y) {
    out += name;
    out += ',';
    out += csv_number(x / plot.x.factor);
    out += ',';
    out += csv_number(y / plot.y.factor);
  };
  const auto nameless = std::ranges::count(plot.curves, std::string(), &PlotCurve::name);
  for (std::size_t i = 0; i < plot.curves.size(); ++i) {
    const PlotCurve& curve = plot.curves[i];
    if (!is_shown(curve, look) || curve.hatching) continue;
    const std::string otherwise =
        plot.y.label.empty() || nameless > 1 ? fmt::format("curve {}", i + 1) : plot.y.label;
    const std::string name = csv_field(curve.name.empty() ? otherwise : curve.name);
    for (const auto& point : curve.points) {
      row(name, point[0], point[1]);
      out += end;
    }
  }
  for (const PlotBand& band : plot.bands)
    for (const std::size_t k : {1U, 2U}) {
      if (!is_shown(band, look)) continue;
      const std::string name = csv_field(band.name + (k == 1 ? ", from" : ", to"));
      for (const auto& point : band.points) {
        row(name, point[0], point[k]);
        out += end;
      }
    }
  for (const PlotMark& mark : plot.marks) {
    row(csv_field(mark.label.empty() ? "mark" : mark.label), mark.at[0], mark.at[1]);
    out += end;
  }
  if (!heat) return out;
  for (std::size_t j = 0; j < plot.heat->y.size(); ++j)
    for (std::size_t i = 0; i < plot.heat->x.size(); ++i) {
      row("map", plot.heat->x[i], plot.heat->y[j]);
      const std::size_t index = j * plot.heat->x.size() + i;
      out += "," + csv_number(plot.heat->values[index] / plot.heat->factor);
      if (notes) out += "," + csv_field(plot.heat->notes[index]);
      out += "\r\n";
    }
  return out;
}

} // namespace flyball
