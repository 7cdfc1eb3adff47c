#include "app/cli/command.hpp"
#include "app/cli/mode_told.hpp"
#include "app/cli/movie.hpp"
#include "app/cli/output.hpp"
#include "app/cli/picture.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/solution_json.hpp"
#include "app/ui/studies/modes/mode_movie.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/report/analysis.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

namespace flyball::cli {
namespace {

using Json = nlohmann::ordered_json;

struct ModesArguments {
  SceneArgument scene;
  std::vector<std::string> start;
  int count = 20;
  bool nearest = false, json = false;
  MovieOptions movie; // without a file: none
  std::string size = "1280x720";
  int mode = 1, swings = 1;
  double amplitude = 0.15;
};

struct ToldMode {
  VibrationMode mode;
  std::optional<Whirl> whirl;
  std::vector<BodyAmplitude> bodies; // by body of the mechanism
};

Json vector_json(const Eigen::Vector3cd& v) {
  Json out = Json::array();
  for (const std::complex<double> part : v)
    out.push_back({part.real(), part.imag()});
  return out;
}

Json modes_json(const Mechanism& mechanism, const Solution& solution, const std::vector<ToldMode>& modes) {
  Json out = {{"status", word(solution.status)}, {"message", solution.message}};
  out["modes"] = Json::array();
  for (const ToldMode& told : modes) {
    Json mode = mode_json(told.mode, told.whirl);
    mode["natural_frequency_hz"] = hertz(told.mode.natural_frequency);
    mode["residual"] = number_json(told.mode.residual);
    Json& bodies = mode["bodies"] = Json::object();
    for (std::size_t b = 0; b < told.bodies.size(); ++b)
      bodies[mechanism.bodies[b].name] = {{"displacement", vector_json(told.bodies[b].displacement)},
                                          {"rotation", vector_json(told.bodies[b].rotation)}};
    out["modes"].push_back(std::move(mode));
  }
  return out;
}

// "slide 1 m at 0°, arm1 0.4 rad at 180°": what moves most, in radians and parts of the mechanism's reach.
std::string shape_text(const VibrationMode& mode) {
  constexpr std::size_t most_told = 4;
  constexpr double least_told = 1e-3;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < mode.amplitudes.size(); ++i)
    if (std::abs(mode.measured(i)) > least_told) order.push_back(i);
  std::ranges::stable_sort(order, std::greater<>(),
                           [&](std::size_t i) { return std::abs(mode.measured(i)); });
  std::string out;
  for (std::size_t k = 0; k < std::min(order.size(), most_told); ++k) {
    const ModeAmplitude& a = mode.amplitudes[order[k]];
    const double degrees = std::arg(a.value) * 180 / std::numbers::pi;
    out += fmt::format("{}{} {:.4g} {} at {:.4g}°", k ? ", " : "", shown_label(a), std::abs(a.value),
                       a.angle ? "rad" : "m", std::abs(degrees) < 1e-6 ? 0. : degrees);
  }
  return out + (order.size() > most_told ? ", …" : "");
}

std::string modes_text(const Mechanism& mechanism, const Solution& solution,
                       const std::vector<ToldMode>& modes) {
  std::string out = fmt::format("{}: {}\n", printable(mechanism.name), printable(solution.message));
  for (std::size_t i = 0; i < modes.size(); ++i) {
    const VibrationMode& m = modes[i].mode;
    const std::string swing =
        m.oscillates() ? fmt::format("{:.9g} Hz, damping ratio {:.4g}", hertz(m.frequency), m.damping_ratio)
                       : "does not swing";
    out += fmt::format("  {}: {}, eigenvalue {:.9g}{} 1/s{}\n     {}\n", i + 1, swing, m.eigenvalue.real(),
                       m.oscillates() ? fmt::format(" ± {:.9g} i", m.eigenvalue.imag()) : "",
                       whirl_text(modes[i].whirl), shape_text(m));
  }
  return out;
}

// Why there are none, of a steady state that is there.
std::string no_modes(const Solution& solution) {
  if (solution.singular_loops) return std::string(singular_loops_message);
  if (solution.floquet || solution.stability_reason == StabilityReason::varying)
    return "The linearised motion turns with the drives and has no modes of one shape; solve tells its "
           "Floquet "
           "multipliers.";
  if (!solution.stability_reason && !solution.eigenvalues) return solution.message;
  return "No coordinate is free to swing.";
}

} // namespace

void add_modes(CLI::App& app, Ending& ending) {
  auto options = std::make_shared<ModesArguments>();
  CLI::App* command = app.add_subcommand("modes", "Tell the modes of the steady state, or film one");
  options->scene.add_to(*command);
  add_start(*command, options->start);
  command->add_flag("--nearest", options->nearest, "Of the plain Newton-Raphson answer, stable or not");
  command
      ->add_option("--count", options->count,
                   "How many where there are more than 200 coordinates: those nearest to zero")
      ->check(above_zero())
      ->capture_default_str();
  command->add_flag("--json", options->json, "Print a JSON object, with shapes by coordinate and by body");
  CLI::Option* movie = command->add_option(
      "--movie", options->movie.file,
      "Draw a film of one mode in amber about the steady state, which begins again without a jump: .mp4 or "
      ".gif by ffmpeg, or .png for numbered frames");
  command->add_option("--mode", options->mode, "Which one, as they are numbered here")
      ->needs(movie)
      ->check(above_zero())
      ->capture_default_str();
  command
      ->add_option("--amplitude", options->amplitude,
                   "Of the coordinate that moves most: rad, or parts of the mechanism's size")
      ->needs(movie)
      ->check(above_zero())
      ->capture_default_str();
  command->add_option("--swings", options->swings, "How often it swings in the film")
      ->needs(movie)
      ->check(above_zero())
      ->capture_default_str();
  add_movie_look(*command, movie, options->size, options->movie);
  command->footer("Examples: flyball modes governor.json --json\n"
                  "          flyball modes governor.json --movie swing.gif --mode 1");
  command->callback([options, &ending] {
    check_outputs(options->scene.file, {{"--movie", options->movie.file}});
    MovieOptions film = options->movie;
    if (!film.file.empty()) {
      read_size(options->size, largest_movie, film.width, film.height);
      check_movie(film, 1);
    }
    std::optional<ProgressBar> progress(std::in_place, "reading");
    const Mechanism mechanism = options->scene.load();
    SolveOptions solve;
    solve.nearest = options->nearest;
    solve.modes = options->count;
    solve.progress = progress->reporter();
    for (const std::string& text : options->start)
      solve.start.push_back(parse_assignment("--start", text));
    Solution solution;
    std::vector<ToldMode> modes;
    try {
      Analysis analysis(mechanism);
      solution = analysis.solve(solve);
      report_progress(solve.progress, "modes");
      if (solution.status == Status::converged)
        for (VibrationMode& mode : analysis.modes(options->count)) {
          ToldMode& told = modes.emplace_back();
          told.whirl = analysis.whirl(mode);
          told.bodies = analysis.body_amplitudes(mode);
          told.mode = std::move(mode);
        }
    } catch (const SceneError& error) {
      throw options->scene.in_file(error);
    }
    progress.reset();
    const bool solved = solution.status == Status::converged;
    if (options->json)
      print_json(with_warnings(modes_json(mechanism, solution, modes), mechanism));
    else
      print_text(modes_text(mechanism, solution, modes));
    ending = end_with(solved && !modes.empty(), options->scene.file,
                      solved ? no_modes(solution) : solution.message);
    if (modes.empty() || film.file.empty()) return;
    if (options->mode > static_cast<int>(modes.size()))
      throw SceneError("--mode", fmt::format("expected 1 to {}", modes.size()));
    const VibrationMode& mode = modes[static_cast<std::size_t>(options->mode) - 1].mode;
    const std::vector<double> phases = swing_phases(mode, film.rate, options->swings);
    check_movie(film, static_cast<double>(phases.size()));
    draw_movie(mechanism,
               std::make_unique<ModeScene>(std::make_shared<const Mechanism>(mechanism), solution, mode,
                                           options->amplitude, 0),
               phases, film);
  });
}

} // namespace flyball::cli
