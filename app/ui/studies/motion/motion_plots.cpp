// What plots over time can show, and how it becomes one.
#include "app/session/coordinate_words.hpp"
#include "app/ui/plots/shown_plot.hpp"
#include "app/ui/studies/study_panels.hpp"
#include "engine/mechanism/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace flyball {

namespace {

struct ShownRun {
  std::string title, unit; // in SI units
  // One curve for each of these, by name in the legend.
  struct Line {
    std::string name;
    std::vector<double> values;
  };
  std::vector<Line> lines;
};

std::vector<double> norms(const std::vector<Vec3>& vectors) {
  std::vector<double> out;
  out.reserve(vectors.size());
  for (const Vec3& v : vectors)
    out.push_back(v.norm());
  return out;
}

// What is told of a point of a body: three tracks, each by component and in size.
struct PointQuantity {
  const char* name;
  std::vector<Vec3> PointTrack::*track;
  const char* unit;
};
const std::array<PointQuantity, 3> point_quantities{{{"position", &PointTrack::position, "m"},
                                                     {"velocity", &PointTrack::velocity, "m/s"},
                                                     {"acceleration", &PointTrack::acceleration, "m/s²"}}};
constexpr std::array<const char*, 4> components{"x", "y", "z", "size"};

// The same for every point of a body that is not its mass centre, so that a plot stays with it when it is
// typed anew.
std::string point_key(const PointQuantity& quantity, std::size_t component, const BodyPoint& point) {
  return (point.at ? "point " : "") + std::string(quantity.name) + "." + components[component] + " " +
         point.body;
}

std::string point_title(const PointQuantity& quantity, std::size_t component, const BodyPoint& point) {
  const std::string whose = (point.at ? "the point of " : "") + point.body;
  if (component < 3) return std::string(components[component]) + " " + quantity.name + " of " + whose;
  if (quantity.track == &PointTrack::position) return "distance of " + whose + " from the origin";
  return (quantity.track == &PointTrack::velocity ? "speed of " : "acceleration of ") + whose;
}

ShownRun shown_point(const PointTrack& track, const PointQuantity& quantity, std::size_t component) {
  const std::vector<Vec3>& vectors = track.*quantity.track;
  ShownRun out{point_title(quantity, component, track.point), quantity.unit, {}};
  out.lines.push_back({"", {}});
  std::vector<double>& values = out.lines.front().values;
  values.reserve(vectors.size());
  for (const Vec3& v : vectors)
    values.push_back(component < 3 ? v[static_cast<Eigen::Index>(component)] : v.norm());
  return out;
}

std::vector<double> changes(std::vector<double> values) {
  for (std::size_t i = values.size(); i-- > 0;)
    values[i] -= values.front();
  return values;
}

// Of a drive by torque, whose track tells what it gives less the load.
std::vector<double> given_torque(const DriveTrack& drive) {
  std::vector<double> given = drive.torque;
  for (std::size_t i = 0; i < given.size(); ++i)
    given[i] += drive.load[i];
  return given;
}

// The quantity in one run; no lines where the run has none of that name.
ShownRun shown_quantity(const Run& run, const std::string& key) {
  ShownRun out;
  for (const CoordinateTrack& c : run.coordinates) {
    const std::string name = coordinate_label(c), words = coordinate_words(c);
    if (key == "value " + name) return {words, c.angle ? "rad" : "m", {{"", c.value}}};
    if (key == "rate " + name) return {speed_words(words), c.angle ? "rad/s" : "m/s", {{"", c.rate}}};
  }
  for (const DriveTrack& d : run.drives) {
    const std::string name = coordinate_label(d), words = coordinate_words(d), unit = d.angle ? "N m" : "N",
                      kind = d.angle ? "torque" : "force";
    const bool apart = !d.load.empty(); // as the response has them
    if (key == "drive " + name)
      return {(apart ? kind + " less load of " : "drive " + kind + " of ") + words, unit, {{"", d.torque}}};
    if (apart && key == "given " + name)
      return {"drive " + kind + " of " + words, unit, {{"", given_torque(d)}}};
    if (apart && key == "load " + name) return {"load on " + words, unit, {{"", d.load}}};
  }
  for (const MeasureTrack& m : run.measures)
    if (key == "measure " + m.name) return {m.name, m.unit, {{"", m.value}}};
  for (const ReactionTrack& r : run.reactions) {
    if (key == "force " + r.joint) return {"force through " + r.joint, "N", {{"", norms(r.force)}}};
    if (key == "torque " + r.joint) return {"torque through " + r.joint, "N m", {{"", norms(r.torque)}}};
  }
  for (const PointTrack& p : run.points)
    if (key.ends_with(" " + p.point.body))
      for (const PointQuantity& quantity : point_quantities)
        for (std::size_t i = 0; i < components.size(); ++i)
          if (key == point_key(quantity, i, p.point)) return shown_point(p, quantity, i);
  const EnergyTracks& e = run.energy;
  if (key == "energies") { // less what there was at first, which may be much and says nothing
    out = {"energy since the start",
           "J",
           {{"kinetic", changes(e.kinetic)}, {"potential", changes(e.potential)}}};
    if (!e.jacobi.empty()) out.lines.push_back({"T₂ + V - T₀", changes(e.jacobi)});
    out.lines.push_back({"dissipated", e.dissipated});
    if (!run.drives.empty()) out.lines.push_back({"delivered by the drives", e.delivered});
  } else if (key == "jacobi" && !e.jacobi.empty()) {
    out = {"T₂ + V - T₀", "J", {{"", e.jacobi}}};
  } else if (key == "balance") {
    out = {"energy balance", "J", {{"", e.balance}}};
  }
  return out;
}

// What the quantity is in the steady state, in SI units.
std::optional<double> steady_value(const Session& session, const std::string& key) {
  if (!converged(session)) return std::nullopt;
  const Solution& s = session.answer.solution;
  for (const CoordinateSolution& c : s.coordinates) {
    if (key == "rate " + coordinate_label(c)) return c.speed.value_or(0);
    if (key == "value " + coordinate_label(c) && !c.driven && !c.speed) return c.value;
  }
  for (const MeasureSolution& m : s.measures)
    if (key == "measure " + m.name) return m.value;
  for (const DriveTorque& d : s.drive_torques) {
    if (d.varying) continue;
    const std::string name = coordinate_label(d);
    if (key == "drive " + name) return d.value;
    if (d.given && key == "given " + name) return d.given->torque;
    if (d.given && key == "load " + name) return d.given->load;
  }
  for (const Reaction& r : s.reactions) {
    if (r.varying) continue;
    if (key == "force " + r.joint) return r.force.norm();
    if (key == "torque " + r.joint) return r.torque.norm();
  }
  return std::nullopt;
}

// From the least to the most of the points; nothing where there are none.
std::optional<PlotRange> extent_of(const PlotCurve& curve) {
  if (curve.points.empty()) return std::nullopt;
  const auto [least, most] =
      std::ranges::minmax_element(curve.points, {}, [](const auto& point) { return point[1]; });
  return PlotRange{(*least)[1], (*most)[1]};
}

// Without its dampers a motion may run away: then the axis is that of the damped one, which would be a flat
// line beside it, and the other leaves the frame.
void keep_damped_in_sight(Plot& plot) {
  constexpr double much = 10; // times as far
  if (plot.curves.size() != 2) return;
  const std::optional<PlotRange> damped = extent_of(plot.curves[0]), undamped = extent_of(plot.curves[1]);
  if (!damped || !undamped) return;
  PlotRange wanted = *damped;
  for (const PlotReference& reference : plot.references)
    wanted = {std::min(wanted[0], reference.at), std::max(wanted[1], reference.at)};
  const double span = wanted[1] - wanted[0], all = (*undamped)[1] - (*undamped)[0];
  if (!(span > 0) || !(all > much * span)) return;
  constexpr double room = 0.08; // of the span, at either end
  plot.y.range = PlotRange{wanted[0] - room * span, wanted[1] + room * span};
}

} // namespace

std::vector<MotionQuantity> motion_quantities(const Run& run) {
  std::vector<MotionQuantity> out;
  const auto add = [&](const std::string& key, const char* group) {
    out.push_back({key, shown_quantity(run, key).title, group});
  };
  for (const CoordinateTrack& c : run.coordinates)
    if (!c.driven) add("value " + coordinate_label(c), "Coordinates");
  for (const CoordinateTrack& c : run.coordinates)
    if (!c.driven) add("rate " + coordinate_label(c), "Speeds");
  for (const MeasureTrack& m : run.measures)
    add("measure " + m.name, "Measures");
  for (const DriveTrack& d : run.drives) {
    if (!d.load.empty()) {
      add("given " + coordinate_label(d), "Drives");
      add("load " + coordinate_label(d), "Drives");
    }
    add("drive " + coordinate_label(d), "Drives");
  }
  add("energies", "Energy");
  if (!run.energy.jacobi.empty()) add("jacobi", "Energy");
  add("balance", "Energy");
  for (const ReactionTrack& r : run.reactions)
    add("force " + r.joint, "Reactions");
  for (const ReactionTrack& r : run.reactions)
    add("torque " + r.joint, "Reactions");
  for (const bool centres : {true, false})
    for (const PointQuantity& quantity : point_quantities)
      for (const PointTrack& p : run.points)
        for (std::size_t i = 0; i < components.size() && !(p.*quantity.track).empty(); ++i)
          if (centres == !p.point.at)
            out.push_back({point_key(quantity, i, p.point), point_title(quantity, i, p.point),
                           centres ? "Mass centres" : "Points"});
  return out;
}

Plot motion_plot(const Session& session, const std::string& quantity) {
  Plot plot;
  plot.x = {.label = "time", .unit = "s", .room = 0};
  const bool both =
      std::ranges::all_of(session.motion.runs, [](const MotionRun& r) { return r.wanted && r.run; });
  const bool dampers = has_dampers(session.mechanism());
  for (const MotionRun& motion : session.motion.runs) {
    if (!motion.wanted || !motion.run) continue;
    const Run& run = *motion.run;
    const ShownRun shown = shown_quantity(run, quantity);
    if (!shown.title.empty()) {
      plot.y.label = shown.title;
      plot.y.unit = shown.unit;
    }
    // Several energies of two runs would be too much to look at.
    if (both && !run.damped && shown.lines.size() > 1) continue;
    const char* whose = !dampers ? "motion" : run.damped ? "damped" : "undamped";
    for (std::size_t l = 0; l < shown.lines.size(); ++l) {
      PlotCurve curve;
      const std::string& name = shown.lines[l].name;
      curve.name = name.empty() ? whose : name;
      if (shown.lines.size() == 1) {
        curve.color = run.damped ? plot_color::orange : plot_color::sky_blue;
      } else {
        curve.color = static_cast<int>(l);
      }
      curve.width = run.damped || !both ? 1.8 : 1.2;
      const std::vector<double>& values = shown.lines[l].values;
      curve.points.reserve(values.size());
      for (std::size_t i = 0; i < values.size() && i < run.time.size(); ++i)
        if (std::isfinite(values[i])) curve.points.push_back({run.time[i], values[i]}); // where it is defined
      plot.curves.push_back(std::move(curve));
    }
    if (const auto steady = steady_value(session, quantity); steady && plot.references.empty())
      plot.references.push_back(
          {.axis = 1, .at = *steady, .label = "steady", .color = plot_color::blue, .in_legend = true});
  }
  if (both) keep_damped_in_sight(plot);
  show_axis(plot, 1, plot.y.unit, session.units);
  // The undamped run lies below the damped one.
  std::ranges::stable_sort(plot.curves, {}, [](const PlotCurve& c) { return c.width; });
  return plot;
}

} // namespace flyball
