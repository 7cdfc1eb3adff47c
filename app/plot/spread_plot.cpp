#include "app/plot/spread_plot.hpp"

#include "app/plot/column_name.hpp"
#include "engine/mechanism/safe_text.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flyball {

namespace {

constexpr double fewest_bins = 8, most_bins = 60;

// Of values that differ by no more than rounding.
bool are_alike(const SpreadStatistics& s) {
  constexpr double relative = 1e-12, absolute = 1e-15;
  return !(s.most - s.least > std::max(relative * std::max(std::abs(s.least), std::abs(s.most)), absolute));
}

// All of them at one value: a bar without width.
PlotCurve single_bar(const SpreadStatistics& s, std::string name, int color) {
  PlotCurve curve;
  curve.name = std::move(name);
  curve.points = {{s.median, 0}, {s.median, static_cast<double>(s.count)}};
  curve.color = color;
  curve.width = 4;
  return curve;
}

// Of a bin: after Freedman and Diaconis (1981), by the range in which the middle 90 % lie.
double bin_width(const SpreadStatistics& s) {
  if (are_alike(s)) return 0;
  const double range = s.most - s.least, quartiles = (s.high - s.low) / 2.44; // of a normal distribution
  const double wanted = 2 * quartiles / std::cbrt(static_cast<double>(s.count));
  return wanted > 0 ? range / std::clamp(std::ceil(range / wanted), fewest_bins, most_bins)
                    : range / most_bins;
}

// Bars from the least value on.
PlotBand bars(const std::vector<double>& values, double least, double most, double width, std::string name,
              int color) {
  PlotBand band{std::move(name), {}, color};
  const auto bins =
      static_cast<std::size_t>(std::clamp(std::round((most - least) / width), 1., 4 * most_bins));
  std::vector<double> counts(bins);
  for (const double value : values) {
    const double at = std::clamp((value - least) / width, 0., static_cast<double>(bins) - 1);
    ++counts[static_cast<std::size_t>(at)];
  }
  band.points.push_back({least, 0, 0});
  for (std::size_t i = 0; i < bins; ++i)
    for (const std::size_t end : {i, i + 1})
      band.points.push_back({least + static_cast<double>(end) * width, 0, counts[i]});
  band.points.push_back({least + static_cast<double>(bins) * width, 0, 0});
  return band;
}

PlotCurve normal_curve(const SpreadOutput& output, double width) {
  PlotCurve curve;
  curve.name = "normal, by the rates";
  curve.line = PlotLine::dashed;
  curve.color = plot_color::vermillion;
  curve.width = 1.6;
  const double top = static_cast<double>(output.followed.count) * width /
                     (output.linear_deviation * std::sqrt(2 * std::numbers::pi));
  for (int i = -80; i <= 80; ++i) {
    const double at = i / 20.;
    curve.points.push_back({output.nominal + at * output.linear_deviation, top * std::exp(-at * at / 2)});
  }
  return curve;
}

} // namespace

Plot histogram_plot(const SpreadAnswer& answer, std::size_t output) {
  const SpreadOutput& shown = answer.outputs[output];
  Plot plot;
  plot.x.label = shown.name;
  plot.x.unit = shown.unit;
  plot.y.label = "samples";
  plot.y.whole = true;
  std::vector<double> followed, elsewhere;
  for (std::size_t i = 0; i < answer.samples; ++i) {
    const double value = answer.values[output][i];
    if (!std::isfinite(value)) continue;
    (answer.fate[i] == SampleFate::elsewhere ? elsewhere : followed).push_back(value);
  }
  const SpreadStatistics &f = shown.followed, &e = shown.elsewhere;
  double width = bin_width(f), others = bin_width(e);
  // Bars of one width, so that heights compare, unless the others would be very many.
  if (others <= 0 || (width > 0 && (e.most - e.least) / width <= 2 * most_bins)) others = width;
  if (f.most - f.least < others) width = others; // which all fit in one
  if (f.count > 0 && !(width > 0)) {
    plot.curves.push_back(single_bar(f, "samples", plot_color::blue));
  } else if (f.count > 0) {
    const double spare = std::max(0., width - (f.most - f.least)) / 2;
    plot.bands.push_back(bars(followed, f.least - spare, f.most + spare, width, "samples", plot_color::blue));
  }
  if (e.count > 0 && !(others > 0)) {
    plot.curves.push_back(single_bar(e, "in another steady state", plot_color::orange));
  } else if (e.count > 0) {
    const double reach = others > 0 ? std::max(1., std::ceil((e.most - e.least) / others)) * others : 0;
    plot.bands.push_back(
        bars(elsewhere, e.least, e.least + reach, others, "in another steady state", plot_color::orange));
  }
  if (width > 0 && shown.linear_deviation > width / 4) plot.curves.push_back(normal_curve(shown, width));
  double highest = 0;
  for (const PlotBand& band : plot.bands)
    for (const auto& point : band.points)
      highest = std::max(highest, point[2]);
  for (const PlotCurve& curve : plot.curves)
    for (const auto& point : curve.points)
      highest = std::max(highest, point[1]);
  plot.y.range = PlotRange{0, highest > 0 ? 1.06 * highest : 1};
  plot.references.push_back({.axis = 0, .at = shown.nominal, .label = "nominal", .line = PlotLine::solid});
  if (f.count > 1 && !are_alike(f)) {
    plot.references.push_back({.axis = 0, .at = f.lowest, .label = "2.5 %", .line = PlotLine::dotted});
    plot.references.push_back({.axis = 0, .at = f.highest, .label = "97.5 %", .line = PlotLine::dotted});
  }
  return plot;
}

std::string spread_row(const SpreadAnswer& answer, std::span<const Tolerance> tolerances, std::uint64_t seed,
                       std::size_t i, SampleFate fate, std::span<const double> values) {
  std::string out;
  for (const double number : sampled_numbers(answer.nominal, tolerances, seed, i))
    out += csv_number(number) + ",";
  out += word(fate);
  for (const double value : values)
    out += "," + csv_number(value);
  return out + "\n";
}

std::string spread_csv(const SpreadAnswer& answer, std::span<const Tolerance> tolerances,
                       std::uint64_t seed) {
  std::string out;
  for (const Tolerance& tolerance : tolerances)
    out += csv_field(tolerance.address) + ",";
  out += "fate";
  for (const SpreadOutput& output : answer.outputs)
    out += "," + csv_field(column_name(output.name));
  out += "\n";
  std::vector<double> values(answer.outputs.size());
  for (std::size_t i = 0; i < answer.samples; ++i) {
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] = answer.values[k][i];
    out += spread_row(answer, tolerances, seed, i, answer.fate[i], values);
  }
  return out;
}

} // namespace flyball
