#include "app/session/map.hpp"

#include "app/session/coordinate_words.hpp"
#include "app/session/session.hpp"
#include "app/session/variable_numbers.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/prescribed_speeds.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/study/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {

namespace {

// What the cells depend on, and what the curves do.
MapChoice of_cells(MapChoice choice) {
  choice.folds = choice.hunting = false;
  choice.level.reset();
  return choice;
}
MapChoice of_curves(MapChoice choice) {
  for (MapAxis& axis : choice.axes)
    axis.count = 0;
  if (!choice.level) choice.shown.clear();
  return choice;
}

MapCell cell_of(const Solution& solution, const std::string& shown) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (solution.status != Status::converged) return {none, std::nullopt};
  for (const CoordinateSolution& c : solution.coordinates)
    if (const auto found = found_number(c); found && found->name == shown)
      return {found->value, solution.stable};
  for (const MeasureSolution& m : solution.measures)
    if (m.name == shown) return {m.value.value_or(none), solution.stable};
  return {none, std::nullopt};
}

MapCells find_cells(const Mechanism& mechanism, const MapChoice& choice,
                    const TaskContext<MapCells>& context) {
  // The last moves fastest.
  const std::array variations{
      Variation{choice.axes[1].address, choice.axes[1].from, choice.axes[1].to, choice.axes[1].count},
      Variation{choice.axes[0].address, choice.axes[0].from, choice.axes[0].to, choice.axes[0].count}};
  const std::vector<SweepPoint> points = sweep(
      mechanism, variations, 0,
      [&](std::size_t done, std::size_t all) {
        context.progress({"solving", static_cast<double>(done) / static_cast<double>(all)});
      },
      &context.cancel);
  MapCells cells;
  cells.reserve(points.size());
  for (const SweepPoint& point : points)
    cells.push_back(cell_of(point.solution, choice.shown));
  return cells;
}

MapCurves find_curves(const Mechanism& mechanism, const MapChoice& choice,
                      const TaskContext<MapCurves>& context) {
  MapCurves found;
  std::array<PlaneAxis, 2> axes;
  for (std::size_t i = 0; i < 2; ++i)
    axes[i] = {choice.axes[i].address, choice.axes[i].from, choice.axes[i].to};
  const double share = 1. / std::max(1, choice.folds + choice.hunting + choice.level.has_value());
  double before = 0;
  PlaneOptions options;
  options.cancel = &context.cancel;
  options.progress = [&](const Progress& now) {
    context.progress({now.phase, before + share * std::max(0., now.part)});
  };
  if (choice.folds) {
    found.folds = fold_curves(mechanism, axes[0], axes[1], options);
    before += share;
  }
  if (choice.hunting) {
    found.hunting = hopf_curves(mechanism, axes[0], axes[1], options);
    before += share;
  }
  if (choice.level)
    found.level = value_curves(mechanism, axes[0], axes[1], choice.shown, *choice.level, options);
  return found;
}

// The mechanism but for the two numbers along the axes.
const SharedMechanism& without_place(Session& session) {
  MapState& map = session.study.map;
  return map.varied.of(session.document.shared(),
                       {{map.choice.axes[0].address, 0}, {map.choice.axes[1].address, 0}});
}

void compute_cells(Session& session) {
  MapState& map = session.study.map;
  map.cells.ask(session.options, {of_cells(map.choice), without_place(session)},
                [mechanism = session.document.shared()](const MapRequest& request,
                                                        const TaskContext<MapCells>& context) {
                  return find_cells(*mechanism, request.choice, context);
                });
}

void compute_curves(Session& session) {
  MapState& map = session.study.map;
  MapRequest request{of_curves(map.choice), without_place(session)};
  if (!map.choice.folds && !map.choice.hunting && !map.choice.level) {
    map.curves = {};
    map.curves.asked = std::move(request); // and answered
    return;
  }
  map.curves.ask(
      session.options, std::move(request),
      [mechanism = session.document.shared()](const MapRequest& of, const TaskContext<MapCurves>& context) {
        return find_curves(*mechanism, of.choice, context);
      });
}

// Whether dampers move what a map shows: the speed that a torque gives, or where hunting begins.
Dampers of_dampers(const Session& session) {
  return finds_speeds(session.mechanism()) || session.study.map.choice.hunting ? Dampers::with
                                                                               : Dampers::without;
}

// What an axis is at first: across a drive's speed; up another slider, or else gravity or a mass.
std::string first_address(const Session& session, std::size_t axis) {
  const bool with_dampers = of_dampers(session) == Dampers::with;
  const std::string& other = session.study.map.choice.axes[1 - axis].address;
  std::string found;
  for (const ParameterControl& control : session.parameters) {
    if ((control.group == ParameterGroup::dampers && !with_dampers) || control.address == other) continue;
    if (axis == 0 && sets_speed(session.mechanism(), control.address)) return control.address;
    if (found.empty()) found = control.address;
  }
  if (!found.empty()) return found;
  const Mechanism& mechanism = session.mechanism();
  for (int i = 0; i < 3; ++i)
    if (const std::string g = "gravity." + std::to_string(i);
        mechanism.gravity[i] != 0 && g != other && control_of(session, g))
      return g;
  for (const Body& body : mechanism.bodies)
    if (const std::string mass = "bodies." + body.name + ".mass"; mass != other && control_of(session, mass))
      found = mass;
  return found;
}

// What the response shows; else as there a length, as of a collar, or the first.
std::string first_shown(const Session& session, const std::vector<MapQuantity>& all) {
  const std::string& response = session.study.response.choice.quantity;
  for (const MapQuantity& each : all)
    if (response == "value " + each.name || response == "measure " + each.name) return each.name;
  const auto length = std::ranges::find(all, "m", &MapQuantity::unit);
  return (length == all.end() ? all.front() : *length).name;
}

// What is chosen at first, and instead of what is not there any more. False where there is nothing to vary or
// to show.
bool choose(Session& session) {
  MapChoice& choice = session.study.map.choice;
  for (std::size_t i = 0; i < 2; ++i) {
    if (control_of(session, choice.axes[i].address)) continue; // an expression may have come to give it
    choice.axes[i].address.clear();
    const std::string address = first_address(session, i);
    if (address.empty()) return false;
    choice.axes[i] = map_axis(session, address);
  }
  const std::vector<MapQuantity> all = map_quantities(session);
  if (std::ranges::find(all, choice.shown, &MapQuantity::name) != all.end()) return true;
  if (all.empty()) return false;
  choice.shown = first_shown(session, all);
  choice.level.reset();
  return true;
}

} // namespace

std::vector<std::string> map_addresses(const Session& session) {
  return variable_numbers(session, of_dampers(session));
}

MapAxis map_axis(const Session& session, const std::string& address) {
  const std::optional<ParameterControl> control = control_of(session, address);
  if (!control) return {.address = address};
  MapAxis axis{.address = address,
               .from = std::min(control->from, control->to),
               .to = std::max(control->from, control->to)};
  // Decades do not show on an even axis.
  if (control->log && control->value > 0) {
    axis.from = control->value / 4;
    axis.to = control->value * 2;
  }
  return axis;
}

std::vector<MapQuantity> map_quantities(const Session& session) {
  const bool solved = converged(session);
  std::vector<MapQuantity> all;
  for (const CoordinateSolution& c :
       solved ? session.answer.solution.coordinates : session.answer.summary.coordinates)
    if (const auto found = found_number(c))
      all.push_back({found->name, found_words(c), std::string(found->unit), found->value, !c.dependent});
  for (const NamedMeasure& measure : session.mechanism().measures) {
    MapQuantity& quantity = all.emplace_back(MapQuantity{measure.name, measure.name, measure.unit, {}, true});
    if (!solved) continue;
    for (const MeasureSolution& m : session.answer.solution.measures)
      if (m.name == measure.name) quantity.value = m.value;
  }
  return all;
}

std::optional<MapQuantity> map_quantity(const Session& session) {
  for (MapQuantity& quantity : map_quantities(session))
    if (quantity.name == session.study.map.choice.shown) return std::move(quantity);
  return {};
}

void compute_map(Session& session) {
  compute_cells(session);
  compute_curves(session);
}

void cancel_map(Session& session) {
  session.study.map.cells.stop();
  session.study.map.curves.stop();
}

void close_map(Session& session) {
  MapState fresh;
  fresh.choice = session.study.map.choice;
  session.study.map = std::move(fresh);
}

bool computing_map(const Session& session) {
  return session.study.map.cells.running() || session.study.map.curves.running();
}

std::string map_problem(const Session& session) {
  const MapState& map = session.study.map;
  for (const std::string& problem : {map.refusal, map.cells.problem, map.curves.problem})
    if (!problem.empty()) return problem;
  return "";
}

Progress map_progress(const Session& session) {
  const MapState& map = session.study.map;
  double all = 0, done = 0;
  const char* phase = "";
  const auto add = [&](const auto& study) {
    if (!study.asked) return;
    const bool running = study.running();
    all += 1;
    done += running ? study.progress().part : 1;
    if (running) phase = study.progress().phase;
  };
  add(map.curves);
  add(map.cells);
  return {phase, all > 0 ? done / all : 1};
}

double map_seconds(const Session& session) {
  const MapState& map = session.study.map;
  return std::max(map.curves.running() ? map.curves.seconds() : 0,
                  map.cells.running() ? map.cells.seconds() : 0);
}

void update_map(Session& session) {
  if (session.study.open != StudyKind::map) return;
  MapState& map = session.study.map;
  map.cells.take("Computing the map was stopped.");
  map.curves.take();
  // What is shown may be over numbers that are there no more, also while the document has mistakes.
  const auto drop_lost = [&](auto& found) {
    const auto there = [&](const MapAxis& axis) { return has_number(session.mechanism(), axis.address); };
    if (found && !std::ranges::all_of(found->of.choice.axes, there)) found.reset();
  };
  drop_lost(map.cells.found);
  drop_lost(map.curves.found);
  if (session.mode != Mode::explore || !session.mistakes.empty() || !session.answer.ticket) return;
  map.refusal.clear();
  if (!choose(session)) {
    map.refusal =
        "A map is over two numbers and shows a free coordinate or a measure, and there are not as many here.";
    return;
  }
  if (!map.cells.asked || of_cells(map.choice) != map.cells.asked->choice) compute_cells(session);
  if (!map.curves.asked || of_curves(map.choice) != map.curves.asked->choice) compute_curves(session);
  if (computing_map(session)) return;
  map.stale = map.cells.asked->mechanism != without_place(session);
  const bool quick = map.cells.quick() && (!map.curves.found || map.curves.quick());
  if (!map.stale || !quick) return;
  compute_map(session);
  map.stale = false;
}

void go_to_place(Session& session, const std::array<double, 2>& place) {
  const std::array<MapAxis, 2>& axes = session.study.map.choice.axes;
  change_parameters(session,
                    "Set " + parameter_phrase(axes[0].address) + " and " + parameter_phrase(axes[1].address),
                    {{axes[0].address, place[0]}, {axes[1].address, place[1]}});
}

} // namespace flyball
