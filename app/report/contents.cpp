#include "app/report/contents.hpp"

#include "app/plot/branch_plot.hpp"
#include "app/plot/resonance_plot.hpp"
#include "app/plot/ribbon_plot.hpp"
#include "app/session/parameter_list.hpp"
#include "app/session/response_quantity.hpp"
#include "engine/continuation/branches.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/periodic/limit_cycle.hpp"
#include "engine/report/friction_ways.hpp"
#include "engine/stability/stability.hpp"
#include "engine/study/friction_branches.hpp"
#include "engine/study/resonance_curve.hpp"
#include "engine/study/ribbon_meetings.hpp"
#include "engine/study/ribbon_tips.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace flyball {
namespace {

constexpr std::size_t most_curves = 12; // sliders that are followed
constexpr std::size_t most_unasked = 4; // numbers, where there are no sliders
constexpr int most_modes = 20;
constexpr int motions_in_order = 25, most_motions = 65; // points of a curve of periodic motions
constexpr long most_evaluations = 2'500'000;            // of the equations of motion, for such a curve

// Over what curves are drawn: the sliders, or else the speeds of the drives from standstill to twice, torques
// and loads, and named parameters, as the window has sliders for of its own accord.
std::vector<Slider> curve_parameters(const Mechanism& m) {
  std::vector<Slider> out(m.sliders.begin(), m.sliders.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                     m.sliders.size(), most_curves)));
  if (!out.empty()) return out;
  for (const Joint& joint : m.joints) {
    for (std::size_t i = 0; i < joint.coordinates.size() && out.size() < most_curves; ++i) {
      const auto& drive = joint.coordinates[i].drive;
      if (!drive || finds_speed(*drive) || drive->speed == 0) continue;
      out.push_back(
          {.parameter = drive_speed_address(joint, i), .from = 0, .to = 2 * drive->speed, .description = ""});
    }
  }
  const std::vector<ParameterControl> controls = parameter_controls(m, m);
  for (const ParameterGroup group : {ParameterGroup::drives, ParameterGroup::named})
    for (const ParameterControl& control : controls)
      if (control.group == group && out.size() < most_unasked &&
          std::ranges::find(out, control.address, &Slider::parameter) == out.end())
        out.push_back(
            {.parameter = control.address, .from = control.from, .to = control.to, .description = ""});
  return out;
}

// Throws SceneError for a name that is none's.
void expect_plotted(const Mechanism& m, const std::vector<CoordinateSolution>& all,
                    const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (find_plotted(m, all, name)) continue;
    const std::vector<std::string> slip = slipping_coordinates(m);
    const bool slips = std::ranges::any_of(
        slip, [&](const std::string& each) { return name == each || name == each + ".speed"; });
    if (slips) continue;
    throw SceneError("--plot " + name,
                     "expected a coordinate that is not driven, or a measure" +
                         (plotted_names(m, all).empty() ? "" : ": " + plotted_names(m, all)));
  }
}

// What is to be drawn: what is named and is there, else the first speed that is found, the first angle and
// the first length.
std::vector<PlottedQuantity> plotted_quantities(const Mechanism& m, const ResponseDiagram& d,
                                                const std::vector<std::string>& names) {
  std::vector<PlottedQuantity> out;
  for (const std::string& name : names)
    if (const auto found = find_plotted(m, d, name)) out.push_back(*found);
  if (!names.empty()) return out;
  const std::vector<CoordinateSolution>& all = d.branches.front().points.front().coordinates;
  const auto turning = std::ranges::find_if(
      all, [](const CoordinateSolution& c) { return c.driven && c.speed && !c.dependent; });
  if (turning != all.end()) out.push_back({static_cast<std::size_t>(turning - all.begin()), false, true});
  for (const bool angle : {true, false})
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].driven || all[i].dependent || all[i].angle != angle) continue;
      out.push_back({i, false, all[i].speed.has_value() || slips_somewhere(d, i)});
      break;
    }
  return out;
}

ReportCurve follow(const ReportContents& contents, const Slider& over, const ReportOptions& options) {
  const Mechanism& m = *contents.mechanism;
  ReportCurve out;
  out.over = over;
  out.present = get_parameter(m, over.parameter);
  BranchOptions follow;
  follow.cancel = options.cancel;
  follow.progress = options.progress;
  if (over.scale == SliderScale::log) follow.largest_step /= 10; // its beginning is drawn as wide as its end
  // The branch of the state that is reported; where that lies outside, the one that the range begins with.
  const double low = std::min(over.from, over.to), high = std::max(over.from, over.to);
  const bool within =
      contents.solution.status == Status::converged && low <= out.present && out.present <= high;
  std::optional<ResponseDiagram> diagram;
  if (within && contents.solution.frictions.empty())
    diagram = follow_branches_through(m, over.parameter, over.from, over.to,
                                      response_point(contents.solution, out.present), follow);
  if (!diagram) diagram = follow_branches(m, over.parameter, over.from, over.to, follow);
  add_friction_branches(m, over.parameter, over.from, over.to, follow, *diagram);
  out.message = diagram->message;
  if (diagram->branches.empty() || diagram->branches.front().points.empty()) return out;
  std::vector<std::vector<RibbonPoint>> ribbons;
  if (has_friction(m)) ribbons = friction_ribbons(m, over.parameter, *diagram, options.cancel);
  for (std::size_t k = 0; k < ribbons.size(); ++k)
    add_meetings(m, over.parameter, ribbon_places(diagram->branches[k]), ribbons[k], options.cancel);
  for (std::vector<RibbonPoint>& tip :
       ribbon_tips(m, over.parameter, over.from, over.to, *diagram, options.cancel))
    ribbons.push_back(std::move(tip));
  for (const PlottedQuantity& shown : plotted_quantities(m, *diagram, options.plotted)) {
    Plot plot = branch_plot(m, over.parameter, *diagram, shown);
    const ResponsePoint& first = diagram->branches.front().points.front();
    const std::string name = plotted_name(first, shown);
    if (shown.speed) plot.y.label = "speed of " + coordinate_label(first.coordinates[shown.index]);
    for (const std::vector<RibbonPoint>& ribbon : ribbons)
      add_ribbon(plot, ribbon, name);
    plot.title.clear(); // the page has words for it
    plot.x.logarithmic = over.scale == SliderScale::log;
    const double now = within ? plotted_value(response_point(contents.solution, out.present), shown) : 0;
    if (within && std::isfinite(now)) plot.marker = PlotMarker{out.present, now, ""};
    out.plots.push_back(std::move(plot));
  }
  return out;
}

// What is named, else the first angle and the first length, else the first that there is.
std::vector<ResonanceOutput> plotted_outputs(const ResonancePoint& point,
                                             const std::vector<std::string>& names) {
  std::vector<ResonanceOutput> out;
  for (const std::string& name : names)
    for (const OutputKind kind : {OutputKind::coordinate, OutputKind::measure})
      if (const auto found = std::ranges::find_if(
              point.outputs, [&](const ResonanceOutput& each) { return each.is(kind, name); });
          found != point.outputs.end())
        out.push_back(*found);
  if (!names.empty()) return out;
  for (const char* unit : {"rad", "m"})
    if (const auto found = std::ranges::find_if(point.outputs,
                                                [&](const ResonanceOutput& each) {
                                                  return each.kind == OutputKind::coordinate &&
                                                         each.unit == unit;
                                                });
        found != point.outputs.end())
      out.push_back(*found);
  if (out.empty()) out.push_back(point.outputs.front());
  return out;
}

// "33 motions, each found on its own. None from 20 to 22 rad/s: ..."
std::string resonance_message(const ResonanceCurve& curve, const std::string& unit) {
  std::string out = std::to_string(curve.points.size()) + " motions, each found on its own.";
  const std::string after = unit.empty() ? "" : " " + unit;
  for (const ResonanceGap& gap : resonance_gaps(curve))
    out +=
        (gap.from == gap.to ? " None at " + rounded_text(gap.from, 5)
                            : " None from " + rounded_text(gap.from, 5) + " to " + rounded_text(gap.to, 5)) +
        after + ": " + gap.why;
  return out;
}

// Of a mechanism that moves periodically.
ReportCurve follow_motions(const ReportContents& contents, const Slider& over, const ReportOptions& options) {
  const Mechanism& m = *contents.mechanism;
  ReportCurve out;
  out.over = over;
  out.present = get_parameter(m, over.parameter);
  ResonanceOptions follow;
  follow.logarithmic = over.scale == SliderScale::log;
  follow.coarse = motions_in_order;
  follow.most = most_motions;
  follow.most_evaluations = most_evaluations;
  follow.cancel = options.cancel;
  follow.progress = options.progress;
  const ResonanceCurve curve = resonance_curve(m, over.parameter, over.from, over.to, follow);
  const std::string unit = parameter_unit(m, over.parameter);
  out.message = resonance_message(curve, unit);
  const ResonancePoint now = resonance_point(*contents.periodic, out.present);
  if (std::ranges::none_of(curve.points, [](const auto& point) { return point->found(); })) return out;
  for (const ResonanceOutput& shown : plotted_outputs(now, options.plotted)) {
    Plot plot;
    plot.x = {.label = over.parameter, .unit = unit, .logarithmic = follow.logarithmic};
    plot.y.label = shown.name;
    plot.y.unit = shown.unit;
    add_resonance(plot, curve, shown.kind, shown.name);
    const double low = std::min(over.from, over.to), high = std::max(over.from, over.to);
    if (low <= out.present && out.present <= high && std::isfinite(shown.range.mean))
      plot.marker = PlotMarker{out.present, shown.range.mean, ""};
    out.plots.push_back(std::move(plot));
  }
  return out;
}

// Of all curves together, each of which counts alike: it only grows, as parts of one tell less than before.
ReportProgress curve_progress(const ReportProgress& progress, std::size_t done, std::size_t all) {
  return [&progress, done, all, most = 0.](const Progress& now) mutable {
    most = std::max(most, std::clamp(now.part, 0., 1.));
    report_progress(progress, "response curves",
                    (static_cast<double>(done) + most) / static_cast<double>(all));
  };
}

void add_curves(ReportContents& out, const ReportOptions& options) {
  const std::vector<Slider> all = curve_parameters(*out.mechanism);
  ReportOptions of_one = options;
  for (const Slider& over : all) {
    if (options.cancel && *options.cancel) return;
    of_one.progress = curve_progress(options.progress, out.curves.size(), all.size());
    of_one.progress({});
    out.curves.push_back(moves(out) ? follow_motions(out, over, of_one) : follow(out, over, of_one));
  }
}

} // namespace

bool moves(const ReportContents& contents) {
  return contents.periodic && contents.periodic->status == PeriodicStatus::found;
}

ReportContents report_contents(std::shared_ptr<const Mechanism> mechanism, const ReportOptions& options) {
  ReportContents out;
  out.mechanism = std::move(mechanism);
  out.warnings = find_warnings(*out.mechanism);
  Analysis analysis(out.mechanism);
  out.system = analysis.summary();
  expect_plotted(*out.mechanism, out.system.coordinates, options.plotted); // before anything takes its time
  SolveOptions solve;
  solve.start = options.start;
  solve.nearest = options.nearest;
  solve.modes = most_modes;
  solve.cancel = options.cancel;
  solve.progress = options.progress;
  out.solution = analysis.solve(solve);
  const auto cancelled = [&] { return options.cancel && *options.cancel; };
  if (has_friction(*out.mechanism) && !cancelled())
    out.friction = report_friction(*out.mechanism, out.solution, options.cancel);
  if (out.solution.status == Status::converged) {
    out.modes = analysis.modes(most_modes);
    if (out.system.free_coordinates <= largest_for_eigenvalues) out.evidence = analysis.stability_evidence();
    out.springs = spring_loads(*out.mechanism, out.solution);
  }
  if (out.solution.status == Status::no_steady_state) {
    PeriodicOptions periodic;
    periodic.nearest = options.nearest;
    periodic.cancel = options.cancel;
    periodic.progress = options.progress;
    out.periodic = find_periodic_state(*out.mechanism, periodic);
  }
  if (hunts(out.solution) && !cancelled())
    out.cycle = find_limit_cycle(*out.mechanism, options.cancel, options.progress);
  add_curves(out, options);
  out.cut_short = cancelled();
  return out;
}

std::string report_date() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  if (!localtime_r(&now, &local)) return "";
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M", &local)};
}

} // namespace flyball
