#include "engine/study/campbell.hpp"
#include "app/cli/command.hpp"
#include "app/cli/mode_told.hpp"
#include "app/cli/output.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/solution_json.hpp"
#include "app/plot/campbell_plot.hpp"
#include "app/plot/svg.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/study/drive_speed.hpp"
#include "engine/study/friction_branches.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <numbers>
#include <optional>

namespace flyball::cli {
namespace {

using Json = nlohmann::ordered_json;

struct CampbellArguments {
  SceneArgument scene;
  std::string vary, csv, svg;
  std::vector<double> orders;
  bool json = false;
};

Json line_json(const VibrationMode& mode, const std::string& name, const std::optional<Whirl>& whirl) {
  Json out = {{"line", name}};
  out.update(mode_json(mode, whirl));
  return out;
}

// Of numbers that set the speed of no drive that turns.
constexpr const char* no_critical_speeds =
    "Critical speeds and whirl are not looked for: the number sets the speed of no drive that turns.";

Json diagram_json(const CampbellDiagram& d, const std::string& unit, DriveSpeed& drive) {
  const bool turns = !drive.joint().empty();
  std::string message = d.response.message;
  if (!turns) message += fmt::format("{}{}", message.empty() ? "" : " ", no_critical_speeds);
  Json out = {{"status", word(d.response.status)}, {"message", message}, {"unit", unit}};
  out["branches"] = Json::array();
  for (std::size_t b = 0; b < d.branches.size(); ++b) {
    const CampbellBranch& branch = d.branches[b];
    Json points = Json::array();
    for (std::size_t i = 0; i < branch.points.size(); ++i) {
      const ResponsePoint& at = d.response.branches[b].points[i];
      Json modes = Json::array();
      for (std::size_t l = 0; l < branch.names.size(); ++l)
        if (const VibrationMode* mode = branch.points[i].on(l); mode && !branch.names[l].empty())
          modes.push_back(
              line_json(*mode, branch.names[l],
                        branch.points[i].whirls[static_cast<std::size_t>(branch.points[i].lines[l])]));
      points.push_back({{"value", at.parameter},
                        {"speed", turns ? Json(drive.at(at.parameter)) : Json(nullptr)},
                        {"stable", at.stable ? Json(*at.stable) : Json(nullptr)},
                        {"modes", std::move(modes)}});
    }
    out["branches"].push_back({{"points", std::move(points)},
                               {"without_modes", left_out(d.response.branches[b], number_text, unit)}});
  }
  out["critical_speeds"] = Json::array();
  for (const CriticalSpeed& c : d.critical)
    out["critical_speeds"].push_back(
        {{"branch", c.branch},
         {"line", d.branches[static_cast<std::size_t>(c.branch)].names[static_cast<std::size_t>(c.line)]},
         {"order", c.order},
         {"value", c.value},
         {"speed_rad_s", c.speed},
         {"until_rad_s", c.until ? Json(*c.until) : Json(nullptr)},
         {"error_estimate", c.error},
         {"frequency_hz", hertz(c.frequency)},
         {"damping_ratio", c.damping_ratio},
         {"touches", c.touches},
         {"stable", c.stable},
         {"whirl", whirl_json(c.whirl, c.frequency)}});
  out["run_time_s"] = d.run_time_s;
  return out;
}

std::string diagram_csv(const CampbellDiagram& d, const std::string& address) {
  std::string out = "branch," + csv_field(address) +
                    ",line,frequency [Hz],damping ratio,real part [1/s],whirl,seen from,stable\n";
  for (std::size_t b = 0; b < d.branches.size(); ++b)
    for (std::size_t i = 0; i < d.branches[b].points.size(); ++i) {
      const CampbellPoint& point = d.branches[b].points[i];
      const ResponsePoint& at = d.response.branches[b].points[i];
      for (std::size_t l = 0; l < point.lines.size(); ++l) {
        const VibrationMode* mode = point.on(l);
        if (!mode || d.branches[b].names[l].empty()) continue;
        const std::optional<Whirl>& whirl = point.whirls[static_cast<std::size_t>(point.lines[l])];
        out += fmt::format("{},{},{},{},{},{},{},{},{}\n", b, csv_number(at.parameter),
                           csv_field(printable(d.branches[b].names[l])), csv_number(hertz(mode->frequency)),
                           csv_number(mode->damping_ratio), csv_number(mode->eigenvalue.real()),
                           whirl ? csv_number(whirl->value) : "",
                           whirl ? (whirl->turning ? "drive" : "ground") : "",
                           at.stable ? (*at.stable ? "true" : "false") : "");
      }
    }
  return out;
}

// `number`: that along the axis with its value, where it is not the drive's speed itself; else empty.
std::string critical_text(const CriticalSpeed& c, const CampbellBranch& branch, const std::string& number) {
  const std::string who = fmt::format("{} of branch {}, damping ratio {:.3g}{}",
                                      printable(branch.names[static_cast<std::size_t>(c.line)]), c.branch,
                                      c.damping_ratio, whirl_text(c.whirl));
  const char* unstable = c.stable ? "" : ", unstable";
  if (c.until)
    return fmt::format("  {} from {:.9g} to {:.9g} rad/s (± {:.1g}), all along the line: {}{}{}\n",
                       order_text(c.order), c.speed, *c.until, c.error, who, number, unstable);
  return fmt::format("  {} at {:.12g} rad/s (± {:.1g}, {:.9g} rpm), {:.9g} Hz: {}{}{}{}\n",
                     order_text(c.order), c.speed, c.error, c.speed * 30 / std::numbers::pi,
                     hertz(c.frequency), who, c.touches ? ", only touches the line" : "", number, unstable);
}

std::string diagram_text(const Mechanism& mechanism, const CampbellDiagram& d, const std::string& address,
                         const std::string& unit, const DriveSpeed& drive) {
  std::string out = fmt::format("{}: {}\n", printable(mechanism.name), printable(d.response.message));
  for (std::size_t b = 0; b < d.branches.size(); ++b) {
    const CampbellBranch& branch = d.branches[b];
    out += fmt::format("  branch {}: {} points\n", b, branch.points.size());
    for (std::size_t l = 0; l < branch.names.size(); ++l) {
      if (branch.names[l].empty()) continue;
      std::size_t first = 0, last = 0;
      bool any = false;
      for (std::size_t i = 0; i < branch.points.size(); ++i)
        if (branch.points[i].on(l)) {
          if (!any) first = i;
          last = i;
          any = true;
        }
      const auto end = [&](std::size_t i) {
        const VibrationMode& mode = *branch.points[i].on(l);
        return fmt::format("{:.6g} Hz at {:.6g} {}", hertz(mode.frequency),
                           d.response.branches[b].points[i].parameter, unit);
      };
      out += fmt::format(
          "    {}: {} to {}{}\n", printable(branch.names[l]), end(first), end(last),
          whirl_text(branch.points[last].whirls[static_cast<std::size_t>(branch.points[last].lines[l])]));
    }
    const auto short_number = [](double speed) { return fmt::format("{:.6g}", speed); };
    if (const std::string without = left_out(d.response.branches[b], short_number, unit); !without.empty())
      out += "    " + printable(without) + "\n";
  }
  for (const CriticalSpeed& c : d.critical)
    out += critical_text(c, d.branches[static_cast<std::size_t>(c.branch)],
                         drive.is_number() ? "" : fmt::format(", {} = {:.12g} {}", address, c.value, unit));
  if (drive.joint().empty()) out += fmt::format("  {}\n", no_critical_speeds);
  return out + fmt::format("  {:.1f} ms\n", d.run_time_s * 1e3);
}

} // namespace

void add_campbell(CLI::App& app, Ending& ending) {
  auto options = std::make_shared<CampbellArguments>();
  CLI::App* command =
      app.add_subcommand("campbell", "Follow modes over a drive's speed; list the critical speeds");
  options->scene.add_to(*command);
  command->add_option("--vary", options->vary, "The speed, or a number that sets it: address=from:to")
      ->required();
  command
      ->add_option("--order", options->orders,
                   "Oscillations a turn that something excites; given again, several (default: 1 and 2)")
      ->take_all()
      ->allow_extra_args(false)
      ->check(above_zero());
  CLI::Option* csv =
      command->add_option("--csv", options->csv, "Write the lines to a file (-: standard output)");
  command->add_option("--svg", options->svg, "Draw the first branch into a file (-: standard output)");
  command->add_flag("--json", options->json, "Print a JSON object, with the shapes")->excludes(csv);
  command->footer("Example: flyball campbell governor.json --vary joints.spin.drive.speed=1:20 --order 1");
  command->callback([options, &ending] {
    check_outputs(options->scene.file, {{"--csv", options->csv}, {"--svg", options->svg}});
    std::optional<ProgressBar> progress(std::in_place, "reading");
    const Mechanism mechanism = options->scene.load();
    const Range range = parse_range(mechanism, "--vary", options->vary);
    std::vector<double> orders = options->orders;
    CampbellDiagram diagram;
    std::string unit;
    try {
      unit = parameter_unit(mechanism, range.address);
      if (DriveSpeed(mechanism, range.address).joint().empty()) {
        if (!orders.empty())
          throw SceneError("--order",
                           "orders count turns: " + range.address + " sets the speed of no drive that turns");
      } else if (orders.empty()) {
        orders = {1, 2};
      }
      BranchOptions follow;
      follow.progress = progress->reporter();
      diagram =
          campbell_diagram(mechanism, range.address,
                           follow_response(mechanism, range.address, range.from, range.to, follow), orders);
    } catch (const SceneError& error) {
      throw options->scene.in_file(error);
    }
    progress.reset();
    DriveSpeed drive(mechanism, range.address);
    const bool any = diagram.response.status == Status::converged && !diagram.branches.empty();
    if (any && !options->svg.empty())
      write_bytes(options->svg,
                  to_svg(campbell_plot(mechanism, range.address, diagram, 0, diagram.branches[0].names,
                                       {std::min(range.from, range.to), std::max(range.from, range.to)},
                                       orders, true)));
    if (any && !options->csv.empty()) write_bytes(options->csv, diagram_csv(diagram, range.address));
    if (options->json)
      print_json(with_warnings(diagram_json(diagram, unit, drive), mechanism));
    else if (options->csv.empty() && options->svg != "-")
      print_text(diagram_text(mechanism, diagram, range.address, unit, drive));
    ending = end_with(any, options->scene.file, diagram.response.message);
  });
}

} // namespace flyball::cli
