#include "app/cli/command.hpp"
#include "app/cli/output.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/report_error.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/solution_json.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/scene.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/report/analysis.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace flyball::cli {
namespace {

std::string joined(const std::vector<std::string>& words) {
  return printable(fmt::format("{}", fmt::join(words, ", ")));
}

std::string to_text(const Mechanism& m, const SystemSummary& s, const std::vector<SceneError>& warnings) {
  const auto many = [](int n, const char* one, const char* several) {
    return fmt::format("{} {}", n, n == 1 ? one : several);
  };
  std::string out = fmt::format("{}: a valid scene\n  {}, {}, {}, {}\n", printable(m.name),
                                many(s.bodies, "body", "bodies"),
                                many(s.free_coordinates, "free coordinate", "free coordinates"),
                                many(s.driven_coordinates, "driven", "driven"),
                                many(s.constraint_equations, "constraint equation", "constraint equations"));
  for (const SceneError& warning : warnings)
    out += "  warning: " + printable(warning.what()) + "\n";
  if (!s.tree_joints.empty()) out += "  tree joints: " + joined(s.tree_joints) + "\n";
  if (!s.implicit_joints.empty())
    out += "  joints added to hold bodies on strings and springs: " + joined(s.implicit_joints) + "\n";
  if (!s.cut_joints.empty()) out += "  cut joints: " + joined(s.cut_joints) + "\n";
  for (const std::string& note : s.notes)
    out += "  " + printable(note) + "\n";
  out += "\nin the system\n";
  for (const std::string& pass : s.in)
    out += "  + " + printable(pass) + "\n";
  if (s.in.empty()) out += "  nothing but joints\n";
  out += "left out, because the scene does not need it\n";
  for (const std::string& pass : s.left_out)
    out += "  - " + printable(pass) + "\n";
  return out;
}

} // namespace

void add_check(CLI::App& app, Ending& ending) {
  struct Options {
    std::filesystem::path file;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("check", "Validate a scene; say what its system has and what was left out");
  command->add_option("scene", options->file, "Scene file (-: standard input)")->required();
  command->add_flag("--json", options->json, "Print a JSON object");
  command->footer("Example: flyball check governor.json");
  command->callback([options, &ending] {
    const auto named = [&](const SceneError& error) {
      return SceneError(options->file.string() + (error.where().empty() ? "" : ": " + error.where()),
                        error.expected());
    };
    std::optional<ProgressBar> progress(std::in_place, "reading");
    Mechanism mechanism;
    const std::string text = read_bytes(options->file);
    try {
      mechanism = parse_scene(text);
    } catch (const SceneError& error) {
      throw named(error);
    }
    progress->show({"checking"});
    const std::vector<SceneError> mistakes = find_mistakes(mechanism);
    if (!mistakes.empty()) progress.reset();
    for (const SceneError& mistake : mistakes)
      ending.exit_code = report_error(named(mistake));
    if (!mistakes.empty()) return;
    SystemSummary summary;
    try {
      progress->show({"compiling"});
      summary = Analysis(mechanism).summary();
    } catch (const SceneError& error) {
      throw named(error);
    }
    progress.reset();
    const std::vector<SceneError> warnings = find_warnings(mechanism);
    if (options->json) {
      const nlohmann::ordered_json out = {{"valid", true},
                                          {"in", summary.in},
                                          {"left_out", summary.left_out},
                                          {"bodies", summary.bodies},
                                          {"free_coordinates", summary.free_coordinates},
                                          {"driven_coordinates", summary.driven_coordinates},
                                          {"constraint_equations", summary.constraint_equations},
                                          {"tree_joints", summary.tree_joints},
                                          {"cut_joints", summary.cut_joints},
                                          {"implicit_joints", summary.implicit_joints},
                                          {"notes", summary.notes},
                                          {"warnings", warnings_json(warnings)}};
      print_json(out);
    } else {
      print_text(to_text(mechanism, summary, warnings));
    }
  });
}

} // namespace flyball::cli
