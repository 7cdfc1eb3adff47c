#include "app/cli/command.hpp"
#include "app/cli/friction_told.hpp"
#include "app/cli/output.hpp"
#include "app/cli/periodic_told.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/solution_json.hpp"
#include "app/cli/solution_text.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace flyball::cli {
namespace {

struct SolveArguments {
  SceneArgument scene;
  std::vector<std::string> start, points;
  int modes = 0, starts = 0;
  double search_time = 1;
  bool all = false, nearest = false, periodic = false, json = false;
};

// Of each state the band about it; of one that rests on friction none.
std::vector<std::optional<FrictionBand>> bands_of(const Mechanism& mechanism, const AllSolutions& all,
                                                  const ReportProgress& progress) {
  std::vector<std::optional<FrictionBand>> out(all.equilibria.size());
  for (std::size_t i = 0; has_friction(mechanism) && i < out.size(); ++i) {
    report_progress(progress, "friction", static_cast<double>(i) / static_cast<double>(out.size()));
    const Solution& state = all.equilibria[i];
    if (state.frictions.empty())
      out[i] = find_friction_band(mechanism, {.start = start_values(state.coordinates)});
  }
  return out;
}

Ending solve_all(const SolveArguments& arguments, const Mechanism& mechanism, const SolveOptions& options,
                 std::optional<ProgressBar>& progress) {
  const AllSolutions all = Analysis(mechanism).solve_all(options);
  const auto bands = bands_of(mechanism, all, options.progress);
  progress.reset();
  if (arguments.json) {
    nlohmann::ordered_json told = to_json(mechanism, all);
    for (std::size_t i = 0; i < bands.size(); ++i)
      if (bands[i]) told["equilibria"][i]["friction"] = to_json(*bands[i]);
    print_json(with_warnings(std::move(told), mechanism));
  } else {
    std::vector<std::string> more;
    for (const auto& band : bands)
      more.push_back(band ? band_lines(*band) : "");
    print_text(to_text(mechanism, all, more) + "\n");
  }
  return end_with(!all.equilibria.empty(), arguments.scene.file, all.message);
}

Ending solve_one(const SolveArguments& arguments, const Mechanism& mechanism, const SolveOptions& options,
                 std::optional<ProgressBar>& progress) {
  const Solution solution = Analysis(mechanism).solve(options);
  std::optional<FrictionReport> friction;
  if (has_friction(mechanism)) {
    report_progress(options.progress, "friction");
    friction = report_friction(mechanism, solution);
  }
  std::optional<PeriodicState> periodic;
  if (arguments.periodic || solution.status == Status::no_steady_state) {
    report_progress(options.progress, "periodic motion");
    PeriodicOptions wanted;
    wanted.nearest = arguments.nearest;
    if (arguments.periodic) wanted.patience = 10;
    wanted.progress = options.progress;
    periodic = find_periodic_state(mechanism, wanted);
  }
  progress.reset();
  if (arguments.json) {
    nlohmann::ordered_json told = to_json(mechanism, solution);
    if (friction) told["friction"] = to_json(*friction);
    if (periodic) told["periodic"] = to_json(*periodic);
    print_json(with_warnings(std::move(told), mechanism));
  } else {
    print_text(to_text(mechanism, solution) + (friction ? to_text(*friction) : "") +
               (periodic ? to_text(*periodic) : ""));
  }
  if (arguments.periodic)
    return end_with(periodic->status == PeriodicStatus::found, arguments.scene.file, periodic->message);
  return end_with(solution.status == Status::converged, arguments.scene.file, solution.message);
}

Ending run_solve(const SolveArguments& arguments) {
  std::optional<ProgressBar> progress(std::in_place, "reading");
  const Mechanism mechanism = arguments.scene.load();
  SolveOptions options;
  options.nearest = arguments.nearest;
  options.modes = arguments.modes;
  options.progress = progress->reporter();
  options.search_time = arguments.search_time;
  options.search_starts = arguments.starts;
  for (const std::string& text : arguments.start)
    options.start.push_back(parse_assignment("--start", text));
  for (const std::string& text : arguments.points)
    options.points.push_back(parse_point("--point", text));
  try {
    return arguments.all ? solve_all(arguments, mechanism, options, progress)
                         : solve_one(arguments, mechanism, options, progress);
  } catch (const SceneError& error) {
    throw arguments.scene.in_file(error);
  }
}

} // namespace

void add_solve(CLI::App& app, Ending& ending) {
  auto options = std::make_shared<SolveArguments>();
  CLI::App* command = app.add_subcommand("solve", "Find the steady state");
  options->scene.add_to(*command);
  CLI::Option* start = add_start(*command, options->start);
  CLI::Option* nearest =
      command->add_flag("--nearest", options->nearest, "The plain Newton-Raphson answer, stable or not");
  CLI::Option* motion = command->add_flag(
      "--periodic", options->periodic,
      "The periodic motion that takes the place of a steady state where drives make the balance turn: the "
      "search may take longer than without, and finding one is what is asked for (exit 0)");
  command->add_flag("--all", options->all, "All equilibria that a bounded search finds, stable or not")
      ->excludes(nearest)
      ->excludes(start)
      ->excludes(motion);
  command
      ->add_option("--starts", options->starts,
                   "With --all: the most Newton-Raphson runs (default: as many as the "
                   "budget allows)")
      ->check(above_zero());
  command
      ->add_option(
          "--search-time", options->search_time,
          "With --all: the budget, in seconds of one core, counted in operations so that every run finds "
          "the same (default 1); it ends earlier where nothing more is expected")
      ->check(above_zero());
  command
      ->add_option("--modes", options->modes,
                   "Eigenvalues to print where there are more than 200 coordinates: those nearest to zero")
      ->check(above_zero());
  add_points(*command, options->points);
  command->add_flag("--json", options->json, "Print a JSON object");
  command->footer("Example: flyball solve governor.json --set joints.spin.drive.speed=12 --json");
  command->callback([options, &ending] { ending = run_solve(*options); });
}

} // namespace flyball::cli
