#include "app/cli/command.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/solution_json.hpp"
#include "app/cli/solution_text.hpp"
#include "engine/equilibrium/analysis.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/validate.hpp"

#include <fmt/format.h>

#include <memory>

namespace flyball::cli {

void add_solve(CLI::App& app, int& exit_code) {
  struct Options {
    SceneArgument scene;
    std::vector<std::string> start, points;
    int modes = 0;
    bool all = false, nearest = false, json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("solve", "Find the steady state");
  options->scene.add_to(*command);
  CLI::Option* start =
      command
          ->add_option("--start", options->start,
                       "Start elsewhere than drawn: joint=value, or joint.index=value (rad, m)")
          ->take_all()
          ->allow_extra_args(false);
  CLI::Option* nearest =
      command->add_flag("--nearest", options->nearest, "The plain Newton-Raphson answer, stable or not");
  command->add_flag("--all", options->all, "All equilibria that a bounded search finds, stable or not")
      ->excludes(nearest)
      ->excludes(start);
  command
      ->add_option("--modes", options->modes,
                   "Eigenvalues to print where there are more than 200 coordinates")
      ->check(above_zero());
  add_points(*command, options->points);
  command->add_flag("--json", options->json, "Print a JSON object");
  command->footer("Example: flyball solve governor.json --set joints.spin.drive.speed=12 --json");
  command->callback([options, &exit_code] {
    std::optional<ProgressBar> progress(std::in_place, "reading");
    const Mechanism mechanism = options->scene.load();
    const auto with_warnings = [&](nlohmann::ordered_json json) {
      json["warnings"] = warnings_json(find_warnings(mechanism));
      return json;
    };
    SolveOptions solve;
    solve.nearest = options->nearest;
    solve.modes = options->modes;
    solve.progress = progress->reporter();
    for (const std::string& text : options->start)
      solve.start.push_back(parse_assignment("--start", text));
    for (const std::string& text : options->points)
      solve.points.push_back(parse_point("--point", text));
    Solution solution;
    try {
      if (options->all) {
        const AllSolutions all = Analysis(mechanism).solve_all(solve);
        progress.reset();
        fmt::print("{}\n",
                   options->json ? with_warnings(to_json(mechanism, all)).dump(2) : to_text(mechanism, all));
        exit_code = all.equilibria.empty() ? exit_no_result : exit_done;
        return;
      }
      solution = Analysis(mechanism).solve(solve);
    } catch (const SceneError& error) {
      throw SceneError(options->scene.file.string() + ": " + error.where(), error.expected());
    }
    progress.reset();
    if (options->json)
      fmt::print("{}\n", with_warnings(to_json(mechanism, solution)).dump(2));
    else
      fmt::print("{}", to_text(mechanism, solution));
    exit_code = solution.status == Status::converged ? exit_done : exit_no_result;
  });
}

} // namespace flyball::cli
