#include "app/cli/command.hpp"
#include "app/cli/movie.hpp"
#include "app/cli/output.hpp"
#include "app/cli/picture.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/solution_json.hpp"
#include "app/cli/solution_text.hpp"
#include "app/cli/time_limit.hpp"
#include "app/live/motion.hpp"
#include "app/plot/column_name.hpp"
#include "app/render/movie.hpp"
#include "app/ui/studies/motion/run_movie.hpp"
#include "engine/dynamics/settled.hpp"
#include "engine/dynamics/simulator.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/safe_text.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/report/analysis.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <string_view>

namespace flyball::cli {
namespace {

using Json = nlohmann::ordered_json;

struct RunColumn {
  std::string name;
  std::function<double(std::size_t sample)> value;
};

void add_vector(std::vector<RunColumn>& columns, const std::string& name, const std::vector<Vec3>& values) {
  for (int i = 0; i < 3; ++i)
    columns.push_back(
        {name + "." + "xyz"[i], [&values, i](std::size_t sample) { return values[sample][i]; }});
}

// What was recorded of the drives' powers and of what joints, bearings, gears and springs exert.
void add_loads(std::vector<RunColumn>& columns, const Run& run) {
  const auto add = [&](std::string name, const std::vector<double>& values) {
    columns.push_back({std::move(name), [&values](std::size_t i) { return values[i]; }});
  };
  for (const DriveTrack& d : run.drives)
    for (const CoordinateTrack& c : run.coordinates)
      if (c.joint == d.joint && c.index == d.index)
        columns.push_back(
            {coordinate_label(d) + ".power", [&d, &c](std::size_t i) { return d.torque[i] * c.rate[i]; }});
  for (const ReactionTrack& r : run.reactions) {
    add_vector(columns, r.joint + ".reaction", r.force);
    add_vector(columns, r.joint + ".moment", r.torque);
  }
  for (const GearTrack& g : run.gears) {
    add(g.joint + ".a", g.a);
    add(g.joint + ".b", g.b);
  }
  for (const BearingTrack& b : run.bearings) {
    add_vector(columns, b.bearing + ".force", b.force);
    add_vector(columns, b.bearing + ".couple", b.torque);
  }
  for (const SpringTrack& s : run.springs) {
    add(coordinate_label(s) + ".spring", s.spring);
    add(coordinate_label(s) + ".damper", s.damper);
    if (!s.between_points) add(coordinate_label(s) + ".stop", s.stop);
  }
}

// Time, coordinates (driven ones too), their rates, drive torques, energies, measures, points, and loads
// where they were recorded.
std::vector<RunColumn> columns_of(const Run& run) {
  std::vector<RunColumn> columns;
  const auto add = [&](std::string name, const std::vector<double>& values) {
    columns.push_back({std::move(name), [&values](std::size_t i) { return values[i]; }});
  };
  add("t", run.time);
  for (const CoordinateTrack& c : run.coordinates)
    add(column_name(coordinate_label(c)), c.value);
  for (const CoordinateTrack& c : run.coordinates)
    add(coordinate_label(c) + ".rate", c.rate);
  for (const DriveTrack& d : run.drives) {
    add(coordinate_label(d) + ".torque", d.torque);
    if (d.load.empty()) continue;
    columns.push_back(
        {coordinate_label(d) + ".given", [&d](std::size_t i) { return d.torque[i] + d.load[i]; }});
    add(coordinate_label(d) + ".load", d.load);
  }
  const EnergyTracks& e = run.energy;
  for (const auto& [name, values] : std::initializer_list<std::pair<const char*, const std::vector<double>*>>{
           {"energy.kinetic", &e.kinetic},
           {"energy.potential", &e.potential},
           {"energy.jacobi", &e.jacobi},
           {"energy.dissipated", &e.dissipated},
           {"energy.delivered", &e.delivered},
           {"energy.balance", &e.balance}})
    if (values->size() == run.time.size()) add(name, *values);
  for (const MeasureTrack& m : run.measures)
    add(column_name(m.name), m.value);
  for (const PointTrack& p : run.points)
    for (const auto& [prefix, track] :
         std::initializer_list<std::pair<const char*, const std::vector<Vec3>*>>{
             {".", &p.position}, {".v", &p.velocity}, {".a", &p.acceleration}})
      for (int i = 0; i < 3 && track->size() == run.time.size(); ++i)
        columns.push_back({point_label(p.point) + prefix + "xyz"[i],
                           [values = track, i](std::size_t sample) { return (*values)[sample][i]; }});
  if (!run.reactions.empty() || !run.bearings.empty() || !run.springs.empty()) add_loads(columns, run);
  return columns;
}

std::string to_csv(const Run& run) {
  const std::vector<RunColumn> columns = columns_of(run);
  std::string out;
  for (std::size_t c = 0; c < columns.size(); ++c)
    out += (c ? "," : "") + csv_field(columns[c].name);
  out += "\n";
  for (std::size_t i = 0; i < run.time.size(); ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      if (c) out += ",";
      out += csv_number(columns[c].value(i));
    }
    out += "\n";
  }
  return out;
}

// The last sample; its acceleration is zero where none is known.
PointMotion last_motion(const PointTrack& track) {
  PointMotion motion{track.position.back(), track.velocity.back(), Vec3::Zero()};
  if (!track.acceleration.empty()) motion.acceleration = track.acceleration.back();
  return motion;
}

double greatest(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.,
                         [](double most, double v) { return std::max(most, std::abs(v)); });
}

// What the integrator's honesty is judged by.
double energy_error(const Run& run) {
  return greatest(run.energy.balance);
}
double energy_at_play(const Run& run) {
  return std::max(
      {greatest(run.energy.kinetic), greatest(run.energy.dissipated), greatest(run.energy.delivered)});
}
// Largest change of T_2 + V - T_0, J; nothing where it is not defined or the dampers take from it.
std::optional<double> jacobi_drift(const Run& run) {
  if (run.damped || run.energy.jacobi.empty()) return std::nullopt;
  const auto [least, most] = std::ranges::minmax(run.energy.jacobi);
  return most - least;
}

Json state_json(const SimulationState& state) {
  Json coordinates = Json::array();
  for (const StateCoordinate& c : state.coordinates)
    coordinates.push_back({{"joint", c.joint}, {"index", c.index}, {"value", c.value}, {"rate", c.rate}});
  return {{"time", state.time}, {"coordinates", std::move(coordinates)}};
}

// Throws SceneError naming the file.
SimulationState read_state(const std::filesystem::path& file) {
  try {
    const Json json = Json::parse(read_bytes(file));
    SimulationState state;
    state.time = json.at("time").get<double>();
    for (const Json& c : json.at("coordinates"))
      state.coordinates.push_back({c.at("joint").get<std::string>(), c.at("index").get<int>(),
                                   c.at("value").get<double>(), c.at("rate").get<double>()});
    return state;
  } catch (const nlohmann::json::exception& error) {
    const std::string_view said = error.what(); // begins with the library's name of it, in brackets
    const std::size_t name = said.find("] ");
    throw SceneError(file.string(), fmt::format("expected a state as --save-state writes it: {}",
                                                said.substr(name == said.npos ? 0 : name + 2)));
  }
}

Json run_json(const Mechanism& mechanism, const Run& run, const std::optional<Settled>& settled) {
  Json out = {{"status", word(run.status)},
              {"message", run.message},
              {"method", word(run.method)},
              {"method_reason", run.method_reason},
              {"damped", run.damped}};
  out["time"] = run.time.empty() ? Json(nullptr) : Json(run.time.back());
  out["settled"] = nullptr;
  if (settled)
    out["settled"] = {{"time", settled->time ? Json(*settled->time) : Json(nullptr)},
                      {"distance", number_json(settled->distance)},
                      {"message", settled->message}};
  out["coordinates"] = out["rates"] = Json::object();
  for (const CoordinateTrack& c : run.coordinates) {
    out["coordinates"][coordinate_label(c)] = c.value.empty() ? Json(nullptr) : Json(c.value.back());
    out["rates"][coordinate_label(c)] = c.rate.empty() ? Json(nullptr) : Json(c.rate.back());
  }
  out["points"] = Json::object();
  for (const PointTrack& p : run.points) {
    Json& point = out["points"][point_label(p.point)] = to_json(last_motion(p));
    if (p.acceleration.empty()) point["acceleration"] = nullptr;
  }
  out["measures"] = Json::object();
  for (const MeasureTrack& m : run.measures) {
    const bool known = !m.value.empty() && std::isfinite(m.value.back());
    out["measures"][m.name] = {{"value", known ? Json(m.value.back()) : Json(nullptr)}, {"unit", m.unit}};
  }
  const auto drift = jacobi_drift(run);
  out["energy"] = {{"balance_error", energy_error(run)},
                   {"at_play", energy_at_play(run)},
                   {"jacobi_drift", drift ? Json(*drift) : Json(nullptr)}};
  const RunStatistics& s = run.statistics;
  out["statistics"] = {{"samples", run.time.size()},
                       {"steps", s.steps},
                       {"evaluations", s.evaluations},
                       {"jacobians", s.jacobians},
                       {"rejected", s.rejected},
                       {"restarts", s.restarts},
                       {"position_drift", s.position_drift},
                       {"velocity_drift", s.velocity_drift}};
  out["stops"] = Json::array();
  for (const StopEvent& stop : run.stops)
    out["stops"].push_back({{"time", stop.time},
                            {"joint", stop.joint},
                            {"index", stop.index},
                            {"upper", stop.upper},
                            {"touching", stop.touching}});
  if (has_friction(mechanism)) {
    out["frictions"] = Json::array();
    for (const FrictionEvent& event : run.frictions)
      out["frictions"].push_back(
          {{"time", event.time}, {"joint", event.joint}, {"index", event.index}, {"slips", event.slips}});
  }
  out["notes"] = run.notes;
  out["run_time_s"] = s.run_time_s;
  return out;
}

std::string run_text(const Mechanism& mechanism, const Run& run, const std::optional<Settled>& settled) {
  std::string out = fmt::format("{}: {}\n", printable(mechanism.name), printable(run.message));
  if (run.time.empty()) return out;
  if (settled) out += "  " + printable(settled->message) + "\n";
  out += "  " + printable(run.method_reason) + "\n";
  for (const std::string& note : run.notes)
    out += "  " + printable(note) + "\n";
  out += fmt::format("\nat {:.6g} s\n", run.time.back());
  std::size_t width = 10;
  for (const CoordinateTrack& c : run.coordinates)
    width = std::max(width, shown_label(c).size());
  for (const CoordinateTrack& c : run.coordinates)
    out += fmt::format("  {:{}}  {:>18.12g} {:3}  {:>14.6g} {}/s{}\n", shown_label(c), width, c.value.back(),
                       c.angle ? "rad" : "m", c.rate.back(), c.angle ? "rad" : "m",
                       c.driven      ? "  driven"
                       : c.dependent ? "  closes a loop"
                                     : "");
  for (const MeasureTrack& m : run.measures)
    out += std::isfinite(m.value.back())
               ? fmt::format("  {:{}}  {:>18.12g} {}\n", m.name, width, m.value.back(), m.unit)
               : fmt::format("  {:{}}  {:>18}\n", m.name, width, "not known");
  for (const PointTrack& p : run.points) {
    out += motion_text(printable(point_label(p.point)), width, last_motion(p), !p.acceleration.empty());
    if (p.acceleration.empty())
      out += "  Accelerations are left out: bodies without mass have velocities that are no states.\n";
  }
  out += fmt::format("\nenergy balance within {:.1e} J of {:.3g} J at play", energy_error(run),
                     energy_at_play(run));
  if (const auto drift = jacobi_drift(run)) out += fmt::format("; Jacobi integral within {:.1e} J", *drift);
  const RunStatistics& s = run.statistics;
  if (s.position_drift > 0 || s.velocity_drift > 0)
    out += fmt::format("\nloops open by at most {:.1e}, opening at most at {:.1e} 1/s (scaled)",
                       s.position_drift, s.velocity_drift);
  if (!run.stops.empty()) out += fmt::format("\n{} times at a stop or off it", run.stops.size());
  if (!run.frictions.empty()) {
    const FrictionEvent& last = run.frictions.back();
    out += fmt::format("\n{} times friction came to hold or gave way, last at {:.9g} s: {} {}",
                       run.frictions.size(), last.time, printable(last.joint),
                       last.slips == 0 ? "sticks" : "slips");
  }
  return out +
         fmt::format("\n{} steps, {} evaluations, {:.1f} ms\n", s.steps, s.evaluations, s.run_time_s * 1e3);
}

struct SimulateCommand {
  SceneArgument scene;
  std::optional<double> duration;
  double rate = 100, tolerance = 1e-10, step = 0;
  std::string start = "rest", method = "automatic", csv, from_state, save_state;
  std::vector<std::string> at, kick, points;
  bool undamped = false, json = false, loads = false;
  double time_limit = usual_time_limit;
  MovieOptions movie; // without a file: none
  double factor = 1;  // seconds of the motion that a second of it shows
  std::string size = "1280x720";
};

const std::map<std::string, Start> starts{
    {"rest", Start::rest}, {"drawn", Start::drawn}, {"equilibrium", Start::equilibrium}};
const std::map<std::string, Integrator> methods{{"automatic", Integrator::automatic},
                                                {"bdf", Integrator::bdf},
                                                {"adams", Integrator::adams},
                                                {"runge_kutta", Integrator::runge_kutta}};

template <class T>
std::vector<std::string> keys_of(const std::map<std::string, T>& map) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : map)
    keys.push_back(key);
  return keys;
}

SimulationOptions simulation_of(const SimulateCommand& options, const Mechanism& mechanism) {
  SimulationOptions wanted;
  wanted.duration = options.duration.value_or(mechanism.simulation.duration);
  wanted.rate = options.rate;
  wanted.tolerance = options.tolerance;
  wanted.fixed_step = options.step;
  wanted.method = methods.at(options.method);
  wanted.time_limit = options.time_limit;
  wanted.damped = mechanism.simulation.damped && !options.undamped;
  wanted.reactions = options.loads;
  wanted.start = starts.at(options.start);
  for (const std::string& text : options.at)
    wanted.at.push_back(parse_assignment("--at", text));
  for (const std::string& text : options.kick)
    wanted.kick.push_back(parse_assignment("--kick", text));
  for (const std::string& text : options.points)
    wanted.points.push_back(parse_point("--point", text));
  if (!options.from_state.empty()) {
    wanted.start = Start::state;
    wanted.state = read_state(options.from_state);
    constexpr double farthest = 1e9; // durations: beyond, steps are lost in the rounding of the time
    if (!(std::abs(wanted.state.time) <= farthest * wanted.duration))
      throw SceneError(options.from_state, fmt::format("expected a time of at most {} s for a motion of {} s",
                                                       rounded_text(farthest * wanted.duration, 4),
                                                       rounded_text(wanted.duration, 4)));
  }
  if (wanted.duration * wanted.rate > 2e7)
    throw SceneError("--duration", "expected at most 20000000 samples; lower --rate");
  return wanted;
}

// Bad film options are told before anything is computed.
MovieOptions movie_of(const SimulateCommand& options, double duration) {
  MovieOptions movie = options.movie;
  if (movie.file.empty()) return movie;
  read_size(options.size, largest_movie, movie.width, movie.height);
  check_movie(movie, duration / options.factor * movie.rate + 1);
  return movie;
}

Ending run_simulate(const SimulateCommand& options) {
  if (options.csv == "-" && options.json) throw SceneError("--csv -", "expected no --json beside it");
  check_outputs(
      options.scene.file,
      {{"--csv", options.csv}, {"--save-state", options.save_state}, {"--movie", options.movie.file}});
  std::optional<ProgressBar> progress(std::in_place, "reading");
  const Mechanism mechanism = options.scene.load();
  SimulationOptions wanted = simulation_of(options, mechanism);
  const MovieOptions movie = movie_of(options, wanted.duration);
  Run run;
  std::optional<Solution> steady;
  std::optional<Settled> settled;
  try {
    // What looks at no clock of its own is cancelled, a moment later than what does.
    const TimeLimit limit(options.time_limit + 0.2);
    progress->show({"finding the start"});
    const double begin = wanted.start == Start::state ? wanted.state.time : 0;
    wanted.progress = [&](double t) {
      progress->show({"simulating", std::clamp((t - begin) / wanted.duration, 0., 1.)});
    };
    wanted.cancel = &limit.over();
    run = simulate(mechanism, wanted);
    if (run.status == RunStatus::cancelled) {
      run.status = RunStatus::time_limit;
      run.message = fmt::format("The motion stopped: the time limit of {} s was reached.",
                                rounded_text(options.time_limit, 4));
    }
    SolveOptions quick;
    quick.details = false;
    quick.progress = progress->reporter();
    quick.cancel = &limit.over();
    if (!run.time.empty()) steady = Analysis(mechanism).solve(quick);
    if (steady && steady->status == Status::converged) {
      settled = find_settled(run, *steady);
      if (const auto other = resting_state(run, std::make_shared<const Mechanism>(mechanism), &limit.over());
          other && runs_into(run, *steady, *other))
        settled->message += " It runs into another steady state, as its coordinates below tell.";
    } else {
      steady.reset();
    }
  } catch (const SceneError& error) {
    if (!error.where().empty()) throw options.scene.in_file(error);
    run = {}; // nothing is wrong with the scene as it is written: it has no such motion
    run.status = RunStatus::diverged;
    run.message = "There is no motion: " + error.expected();
  }
  progress.reset();
  const bool any = !run.time.empty();
  if (any && !options.save_state.empty())
    write_bytes(options.save_state, state_json(state_at(run, run.time.size() - 1)).dump(2) + "\n");
  if (any && !options.csv.empty()) write_bytes(options.csv, to_csv(run));
  if (any && !movie.file.empty()) {
    const auto shown = std::make_shared<const Mechanism>(mechanism);
    draw_movie(mechanism, std::make_unique<RunScene>(shown, std::make_shared<const Run>(run), steady),
               movie_times(run, {run.time.front(), run.time.back(), movie.rate, options.factor}), movie);
  }
  if (options.json)
    print_json(with_warnings(run_json(mechanism, run, settled), mechanism));
  else if (any && options.csv != "-") // then standard output is the table's
    print_text(run_text(mechanism, run, settled));
  std::string message = run.message;
  if (run.status != RunStatus::completed && run.time.size() > 1)
    message += " What was computed until then, " + std::to_string(run.time.size()) + " samples, is kept.";
  return end_with(run.status == RunStatus::completed, options.scene.file, message);
}

} // namespace

void add_simulate(CLI::App& app, Ending& ending) {
  auto options = std::make_shared<SimulateCommand>();
  CLI::App* command = app.add_subcommand("simulate", "Integrate the damped motion");
  options->scene.add_to(*command);
  command->add_option("--duration", options->duration, "Seconds (default: as the scene says)")
      ->check(above_zero());
  command->add_option("--rate", options->rate, "Samples a second")
      ->check(above_zero())
      ->capture_default_str();
  CLI::Option* start =
      command
          ->add_option(
              "--start", options->start,
              "rest: the drawn pose carried along by the drives; drawn: standing still in the world, but for "
              "shafts left to themselves, which have their momentum; equilibrium: the steady state")
          ->check(CLI::IsMember(keys_of(starts)))
          ->capture_default_str();
  command->add_option("--at", options->at, "Start elsewhere than drawn: joint=value (rad, m)")
      ->take_all()
      ->allow_extra_args(false);
  command->add_option("--kick", options->kick, "A rate over the start's: joint=rate (rad/s, m/s)")
      ->take_all()
      ->allow_extra_args(false);
  add_points(*command, options->points);
  command->add_option("--from-state", options->from_state, "Go on from a state that --save-state wrote")
      ->excludes(start);
  command->add_option("--save-state", options->save_state, "Write the last state to a JSON file");
  command->add_flag("--undamped", options->undamped, "Without the dampers");
  command
      ->add_option("--method", options->method,
                   "bdf: implicit, for stiff scenes; adams; runge_kutta: explicit, of order 8")
      ->check(CLI::IsMember(keys_of(methods)))
      ->capture_default_str();
  CLI::Option* tolerance =
      command->add_option("--tolerance", options->tolerance, "Of the error of a step, relative")
          ->check(CLI::Range(1e-14, 0.1))
          ->capture_default_str();
  command->add_option("--step", options->step, "Runge-Kutta steps of this many seconds instead")
      ->check(above_zero())
      ->excludes(tolerance);
  add_time_limit(*command, options->time_limit);
  CLI::Option* csv =
      command->add_option("--csv", options->csv, "Write all samples to a file (-: standard output)");
  command
      ->add_flag("--loads", options->loads,
                 "In the table also what joints, gears, bearings, springs and dampers exert, and the drives' "
                 "powers (W)")
      ->needs(csv);
  command->add_flag("--json", options->json, "Print a JSON object of the outcome");
  CLI::Option* movie = command->add_option("--movie", options->movie.file,
                                           "Draw a film of it, the steady state solid and the motion in "
                                           "amber: .mp4 or .gif by ffmpeg, or .png for "
                                           "numbered frames");
  add_movie_look(*command, movie, options->size, options->movie);
  command->add_option("--slow-motion", options->factor, "Seconds of the motion that a second of it shows")
      ->check(above_zero())
      ->needs(movie)
      ->capture_default_str();
  command->footer("Examples: flyball simulate governor.json --duration 5 --csv run.csv\n"
                  "          flyball simulate governor.json --movie run.mp4 --slow-motion 0.2");
  command->callback([options, &ending] { ending = run_simulate(*options); });
}

} // namespace flyball::cli
