#include "app/session/map.hpp"

#include "app/session/session.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/study/sweep.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace flyball {

namespace {

constexpr double no_time = 0.3; // s

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// What the cells depend on, and what the curves do.
MapChoice of_cells(MapChoice choice) {
  choice.folds = false;
  choice.level.reset();
  return choice;
}
MapChoice of_curves(MapChoice choice) {
  for (MapAxis& axis : choice.axes)
    axis.count = 0;
  if (!choice.level) choice.coordinate.clear();
  return choice;
}

// The mechanism but for the two numbers along the axes.
Mechanism without_place(Mechanism mechanism, const MapChoice& choice) {
  for (const MapAxis& axis : choice.axes)
    set_parameter(mechanism, axis.address, 0);
  return mechanism;
}

MapCell cell_of(const Solution& solution, const std::string& coordinate) {
  MapCell cell{std::numeric_limits<double>::quiet_NaN(), std::nullopt};
  if (solution.status != Status::converged) return cell;
  for (const CoordinateSolution& c : solution.coordinates)
    if (coordinate_label(c) == coordinate) cell = {c.value, solution.stable};
  return cell;
}

FoundCells find_cells(const Mechanism& mechanism, const MapChoice& choice,
                      const TaskContext<FoundCells>& context) {
  const auto begin = std::chrono::steady_clock::now();
  FoundCells found{.choice = choice, .cells = {}};
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
  found.cancelled = context.cancel;
  found.cells.reserve(points.size());
  for (const SweepPoint& point : points)
    found.cells.push_back(cell_of(point.solution, choice.coordinate));
  found.run_time_s = seconds_since(begin);
  return found;
}

FoundCurves find_curves(const Mechanism& mechanism, const MapChoice& choice,
                        const TaskContext<FoundCurves>& context) {
  const auto begin = std::chrono::steady_clock::now();
  FoundCurves found;
  std::array<PlaneAxis, 2> axes;
  for (std::size_t i = 0; i < 2; ++i)
    axes[i] = {choice.axes[i].address, choice.axes[i].from, choice.axes[i].to};
  const double share = choice.folds && choice.level ? 0.5 : 1;
  PlaneOptions options;
  options.cancel = &context.cancel;
  options.progress = [&](const Progress& now) { context.progress({now.phase, share * now.part}); };
  if (choice.folds) found.folds = fold_curves(mechanism, axes[0], axes[1], options);
  options.progress = [&](const Progress& now) {
    context.progress({now.phase, 1 - share + share * std::max(0., now.part)});
  };
  if (choice.level)
    found.level = coordinate_curves(mechanism, axes[0], axes[1], choice.coordinate, *choice.level, options);
  found.cancelled = context.cancel;
  found.run_time_s = seconds_since(begin);
  return found;
}

void compute_cells(Session& session) {
  MapState& map = session.study.map;
  if (!map.cells_task)
    map.cells_task = std::make_unique<Background<FoundCells>>(session.options.mode, session.options.on_news);
  map.asked_cells = of_cells(map.choice);
  map.cells_of = without_place(session.mechanism(), map.choice);
  map.problem.clear();
  map.cells_task->start([mechanism = session.document.shared(),
                         choice = map.asked_cells](const TaskContext<FoundCells>& context) {
    return find_cells(*mechanism, choice, context);
  });
}

void compute_curves(Session& session) {
  MapState& map = session.study.map;
  map.asked_curves = of_curves(map.choice);
  map.curves_of = without_place(session.mechanism(), map.choice);
  if (!map.choice.folds && !map.choice.level) {
    map.curves_task.reset();
    map.curves.reset();
    ++map.version;
    return;
  }
  if (!map.curves_task)
    map.curves_task =
        std::make_unique<Background<FoundCurves>>(session.options.mode, session.options.on_news);
  map.curves_task->start([mechanism = session.document.shared(),
                          choice = map.asked_curves](const TaskContext<FoundCurves>& context) {
    return find_curves(*mechanism, choice, context);
  });
}

bool known(const Mechanism& mechanism, const std::string& address) {
  try {
    get_parameter(mechanism, address);
    return !address.empty();
  } catch (const SceneError&) {
    return false;
  }
}

// What an axis is at first: across a drive's speed; up another slider, or else gravity or a mass.
std::string first_address(const Session& session, std::size_t axis) {
  const std::string& other = session.study.map.choice.axes[1 - axis].address;
  std::string found;
  for (const ParameterControl& control : session.parameters) {
    if (control.group == ParameterGroup::dampers || control.address == other) continue;
    if (axis == 0 && control.address.ends_with("speed")) return control.address;
    if (found.empty()) found = control.address;
  }
  if (!found.empty()) return found;
  const Mechanism& mechanism = session.mechanism();
  for (int i = 0; i < 3; ++i)
    if (const std::string g = "gravity." + std::to_string(i); mechanism.gravity[i] != 0 && g != other)
      return g;
  for (const Body& body : mechanism.bodies)
    if (const std::string mass = "bodies." + body.name + ".mass"; mass != other) found = mass;
  return found;
}

// What is chosen at first, and instead of what is not there any more. False where there is nothing to vary or
// to show.
bool choose(Session& session) {
  MapChoice& choice = session.study.map.choice;
  for (std::size_t i = 0; i < 2; ++i) {
    if (known(session.mechanism(), choice.axes[i].address)) continue;
    choice.axes[i].address.clear();
    const std::string address = first_address(session, i);
    if (address.empty()) return false;
    choice.axes[i] = map_axis(session, address);
  }
  if (map_coordinate(session)) return true;
  for (const CoordinateSolution& c : session.answer.summary.coordinates)
    if (!c.driven) {
      choice.coordinate = coordinate_label(c);
      choice.level.reset();
      return true;
    }
  return false;
}

void take(Session& session) {
  MapState& map = session.study.map;
  if (map.cells_task)
    if (auto news = map.cells_task->take()) {
      if (!news->problem.empty()) map.problem = news->problem;
      if (news->result && news->result->cancelled) {
        map.problem = "Computing the map was stopped.";
      } else if (news->result) {
        map.cells = std::move(*news->result);
        ++map.version;
      }
    }
  if (map.curves_task)
    if (auto news = map.curves_task->take()) {
      if (!news->problem.empty()) map.problem = news->problem;
      if (news->result) {
        map.curves = std::move(*news->result);
        ++map.version;
      }
    }
}

} // namespace

std::vector<std::string> map_addresses(const Session& session) {
  constexpr std::size_t many = 60; // bodies
  std::vector<std::string> all;
  for (const ParameterControl& control : session.parameters)
    if (control.group != ParameterGroup::dampers) all.push_back(control.address);
  if (session.mechanism().bodies.size() > many) return all;
  for (const std::string& address : parameter_addresses(session.mechanism()))
    if (!address.starts_with("simulation.") && address.find(".damping") == std::string::npos &&
        std::ranges::find(all, address) == all.end())
      all.push_back(address);
  return all;
}

MapAxis map_axis(const Session& session, const std::string& address) {
  Slider slider = slider_for(session.mechanism(), address);
  for (const ParameterControl& control : session.parameters)
    if (control.address == address) {
      slider.from = control.from;
      slider.to = control.to;
      slider.scale = control.log ? SliderScale::log : SliderScale::linear;
    }
  MapAxis axis{
      .address = address, .from = std::min(slider.from, slider.to), .to = std::max(slider.from, slider.to)};
  // Decades do not show on an even axis.
  const double value = get_parameter(session.mechanism(), address);
  if (slider.scale == SliderScale::log && value > 0) {
    axis.from = value / 4;
    axis.to = value * 2;
  }
  return axis;
}

const CoordinateSolution* map_coordinate(const Session& session) {
  const auto& shown =
      converged(session) ? session.answer.solution.coordinates : session.answer.summary.coordinates;
  for (const CoordinateSolution& c : shown)
    if (!c.driven && coordinate_label(c) == session.study.map.choice.coordinate) return &c;
  return nullptr;
}

void compute_map(Session& session) {
  compute_cells(session);
  compute_curves(session);
}

void cancel_map(Session& session) {
  if (session.study.map.cells_task) session.study.map.cells_task->cancel();
  if (session.study.map.curves_task) session.study.map.curves_task->cancel();
}

void close_map(Session& session) {
  MapState fresh;
  fresh.choice = session.study.map.choice;
  fresh.version = session.study.map.version + 1;
  session.study.map = std::move(fresh);
}

bool computing_map(const Session& session) {
  const MapState& map = session.study.map;
  return (map.cells_task && map.cells_task->running()) || (map.curves_task && map.curves_task->running());
}

Progress map_progress(const Session& session) {
  const MapState& map = session.study.map;
  double all = 0, done = 0;
  const char* phase = "";
  const auto add = [&](const auto& task) {
    if (!task) return;
    const bool running = task->running();
    all += 1;
    done += running ? task->progress().part : 1;
    if (running) phase = task->progress().phase;
  };
  add(map.curves_task);
  add(map.cells_task);
  return {phase, all > 0 ? done / all : 1};
}

double map_seconds(const Session& session) {
  const MapState& map = session.study.map;
  double longest = 0;
  const auto add = [&](const auto& task) {
    if (task && task->running()) longest = std::max(longest, task->seconds());
  };
  add(map.curves_task);
  add(map.cells_task);
  return longest;
}

void update_map(Session& session) {
  if (session.study.open != Study::map) return;
  MapState& map = session.study.map;
  take(session);
  if (session.mode != Mode::explore || !session.mistakes.empty() || !session.answer.ticket) return;
  if (!choose(session)) {
    map.problem = "A map is over two numbers and shows a free coordinate, and there are not as many here.";
    return;
  }
  // What is shown may be over numbers that are there no more.
  if (map.cells && !std::ranges::all_of(map.cells->choice.axes, [&](const MapAxis& axis) {
        return known(session.mechanism(), axis.address);
      }))
    map.cells.reset();
  if (!map.cells_task || of_cells(map.choice) != map.asked_cells) compute_cells(session);
  if (of_curves(map.choice) != map.asked_curves) compute_curves(session);
  if (map.revision == session.document.revision() || computing_map(session)) return;
  map.revision = session.document.revision();
  const Mechanism now = without_place(session.mechanism(), map.choice);
  map.stale = !(map.cells_of == now);
  const bool quick =
      map.cells && map.cells->run_time_s < no_time && (!map.curves || map.curves->run_time_s < no_time);
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
