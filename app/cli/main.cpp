#include "app/cli/command.hpp"
#include "app/cli/editor.hpp"
#include "app/cli/report_error.hpp"
#include "app/live/worker.hpp"
#include "engine/mechanism/text.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

namespace flyball::cli {

namespace {

// A word that is no file is most likely a subcommand with a slip of the finger.
bool is_slip(const std::string& scene) {
  std::error_code ignored;
  return !scene.empty() && scene.find('.') == std::string::npos && !std::filesystem::exists(scene, ignored);
}

int report_slip(const CLI::App& app, const std::string& scene) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({}))
    names.push_back(command->get_name());
  const std::vector<std::string_view> views(names.begin(), names.end());
  return report_error(fmt::format("there is no file or subcommand {}{}", scene, did_you_mean(scene, views)));
}

int run(int argc, char** argv) {
  CLI::App app(
      "Builds mechanisms, drives some of their joints at constant speeds, given or found from torques "
      "and momenta, and shows at once where everything else settles.\nWithout a subcommand it opens "
      "the window.",
      "flyball");
  app.set_version_flag("--version", "flyball " FLYBALL_VERSION);
  app.footer("Example: flyball governor.json");
  app.require_subcommand(0, 1);

  Ending ending;
  EditorOptions options;
  std::string scene, theme;
  app.add_option("scene", scene, "Scene file to open (default: the governor)");
  app.add_option("--scale", options.scale, "Pixels a point has (default: as the display says)")
      ->check(CLI::Range(0.5, 4.0));
  app.add_option("--theme", theme,
                 "Colours of the window (default: as chosen in it, at first as the system has)")
      ->check(CLI::IsMember({"system", "light", "dark", "high-contrast"}));
  app.add_option("--state-file", options.state_file)->group("");

  add_solve(app, ending);
  add_sweep(app, ending);
  add_merge(app, ending);
  add_branch(app, ending);
  add_modes(app, ending);
  add_hunting(app, ending);
  add_campbell(app, ending);
  add_design(app, ending);
  add_spread(app, ending);
  add_linearize(app, ending);
  add_simulate(app, ending);
  add_compare(app, ending);
  add_render(app, ending);
  add_report(app, ending);
  add_check(app, ending);
  add_completion(app);
  add_manual(app);

  try {
    app.parse(argc, argv);
    options.theme = theme_choice_of(theme);
    if (app.get_subcommands().empty()) {
      if (is_slip(scene)) return report_slip(app, scene);
      ending = run_editor(scene, options);
    }
    return finish(ending);
  } catch (const CLI::ParseError& error) {
    if (app.get_subcommands().empty() && is_slip(scene)) return report_slip(app, scene);
    return report_usage(app, error);
  } catch (const SceneError& error) {
    return report_error(error);
  } catch (const std::exception& error) {
    return report_error(error.what());
  }
}

} // namespace

} // namespace flyball::cli

int main(int argc, char** argv) {
  const int exit_code = flyball::cli::run(argc, argv);
  // A result that could not be written is no result.
  const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  const int code = written ? exit_code : flyball::cli::report_error("cannot write to standard output");
  // Computations that were given up end in a moment; the process does not wait longer for one.
  constexpr double moment = 0.2; // s
  if (!flyball::join_left_behind(moment)) std::_Exit(code);
  return code;
}
