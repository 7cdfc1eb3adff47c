#include "app/cli/command.hpp"
#include "app/cli/hunting_told.hpp"
#include "app/cli/output.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/solution_json.hpp"
#include "app/plot/hunting_plot.hpp"
#include "app/plot/svg.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>

namespace flyball::cli {
namespace {

using Json = nlohmann::ordered_json;

struct HuntingArguments {
  SceneArgument scene;
  std::vector<std::string> vary;
  std::string csv, svg;
  bool all = false, json = false;
};
using Axes = std::array<PlaneAxis, 2>;

PlaneAxis plane_axis(const Mechanism& mechanism, const std::string& text) {
  const Range range = parse_range(mechanism, "--vary", text);
  return {range.address, std::min(range.from, range.to), std::max(range.from, range.to)};
}

Json point_json(const PlanePoint& p) {
  Json out = {{"x", p.x}, {"y", p.y}, {"coordinates", coordinates_json(p.coordinates)}};
  if (std::ranges::any_of(p.coordinates, [](const CoordinateSolution& c) { return c.speed.has_value(); }))
    out["speeds"] = speeds_json(p.coordinates);
  out["hunting"] = p.hopf ? hunting_json(*p.hopf) : Json(nullptr);
  return out;
}

Json points_json(const std::vector<PlanePoint>& points) {
  Json out = Json::array();
  for (const PlanePoint& p : points)
    out.push_back(point_json(p));
  return out;
}

Json curves_json(const PlaneCurves& found, const Axes& axes) {
  Json out = {{"status", word(found.status)},
              {"message", found.message},
              {"x", axes[0].address},
              {"y", axes[1].address},
              {"curves", Json::array()}};
  for (const PlaneCurve& curve : found.curves)
    out["curves"].push_back({{"points", points_json(curve.points)},
                             {"bautin", points_json(curve.bautin)},
                             {"bogdanov_takens", points_json(curve.takens)},
                             {"closed", curve.closed},
                             {"begin", curve.begin},
                             {"end", curve.end}});
  out["run_time_s"] = found.run_time_s;
  return out;
}

std::string curves_csv(const PlaneCurves& found, const Axes& axes) {
  std::string out = "curve," + csv_field(axes[0].address) + "," + csv_field(axes[1].address) +
                    ",frequency [rad/s],loss,lyapunov,error_estimate,coordinate,growing,special\n";
  const auto add = [&](std::size_t curve, const PlanePoint& p, const char* special) {
    if (!p.hopf) return;
    const bool any = p.hopf->lyapunov.has_value();
    out += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", curve, csv_number(p.x), csv_number(p.y),
                       csv_number(p.hopf->frequency), word(p.hopf->loss()),
                       any ? csv_number(*p.hopf->lyapunov) : "", any ? csv_number(p.hopf->error) : "",
                       any ? csv_field(printable(coordinate_label(p.hopf->coordinate))) : "", p.hopf->growing,
                       special);
  };
  for (std::size_t i = 0; i < found.curves.size(); ++i) {
    for (const PlanePoint& p : found.curves[i].points)
      add(i, p, "");
    for (const PlanePoint& p : found.curves[i].bautin)
      add(i, p, "bautin");
    for (const PlanePoint& p : found.curves[i].takens)
      add(i, p, "bogdanov_takens");
  }
  return out;
}

std::string curves_text(const Mechanism& mechanism, const PlaneCurves& found, const Axes& axes) {
  std::string out = fmt::format("{}: {}\n", printable(mechanism.name), printable(found.message));
  const std::array units{parameter_unit(mechanism, axes[0].address),
                         parameter_unit(mechanism, axes[1].address)};
  const auto place = [&](const PlanePoint& p) {
    return fmt::format("({:.9g} {}, {:.9g} {}): {}", p.x, units[0], p.y, units[1], hunting_text(*p.hopf));
  };
  for (std::size_t i = 0; i < found.curves.size(); ++i) {
    const PlaneCurve& curve = found.curves[i];
    out += fmt::format("  curve {}: {} points of ({}, {})\n", i, curve.points.size(),
                       printable(axes[0].address), printable(axes[1].address));
    out += fmt::format("    from {}\n      to {}\n", place(curve.points.front()), place(curve.points.back()));
    out += curve.closed ? std::string("    closed\n")
                        : fmt::format("    begins at {}; ends at {}\n", curve.begin, curve.end);
    for (const PlanePoint& p : curve.bautin)
      out += "    soft turns into hard (Bautin) at " + place(p) + "\n";
    for (const PlanePoint& p : curve.takens)
      out += "    the frequency is zero (Bogdanov and Takens) at " + place(p) + "\n";
  }
  return out + fmt::format("  {:.1f} ms\n", found.run_time_s * 1e3);
}

} // namespace

void add_hunting(CLI::App& app, Ending& ending) {
  auto options = std::make_shared<HuntingArguments>();
  CLI::App* command = app.add_subcommand(
      "hunting",
      "Follow the boundary of hunting (Hopf curves) over two numbers; tell where it is soft or hard");
  options->scene.add_to(*command);
  command->add_option("--vary", options->vary, "A number and its range: address=from:to; twice")
      ->required()
      ->take_all()
      ->allow_extra_args(false)
      ->expected(2);
  command->add_flag("--all", options->all, "Also from branches that nothing connects with the drawn pose's");
  CLI::Option* csv =
      command->add_option("--csv", options->csv, "Write the curves to a file (-: standard output)");
  command->add_option("--svg", options->svg, "Draw them into a file (-: standard output)");
  command->add_flag("--json", options->json, "Print a JSON object")->excludes(csv);
  command->footer("Example: flyball hunting governor_engine.json --vary joints.slide.damping=5:60 --vary "
                  "parameters.gain=1000:20000");
  command->callback([options, &ending] {
    if (options->vary.size() != 2) // the parser takes any number of an option with one value each
      throw SceneError("--vary", fmt::format("expected two numbers, address=from:to each, found {}",
                                             options->vary.size()));
    check_outputs(options->scene.file, {{"--csv", options->csv}, {"--svg", options->svg}});
    std::optional<ProgressBar> progress(std::in_place, "reading");
    const Mechanism mechanism = options->scene.load();
    const Axes axes{plane_axis(mechanism, options->vary[0]), plane_axis(mechanism, options->vary[1])};
    if (axes[0].address == axes[1].address)
      throw SceneError("--vary " + axes[0].address, "expected two different numbers");
    PlaneCurves found;
    try {
      PlaneOptions follow;
      follow.all = options->all;
      follow.progress = progress->reporter();
      found = hopf_curves(mechanism, axes[0], axes[1], follow);
    } catch (const SceneError& error) {
      throw options->scene.in_file(error);
    }
    progress.reset();
    const bool any = found.status == Status::converged;
    if (any && !options->svg.empty())
      write_bytes(options->svg, to_svg(hunting_plot(mechanism, axes[0], axes[1], found)));
    if (any && !options->csv.empty()) write_bytes(options->csv, curves_csv(found, axes));
    if (options->json)
      print_json(with_warnings(curves_json(found, axes), mechanism));
    else if (options->csv.empty() && options->svg != "-")
      print_text(curves_text(mechanism, found, axes));
    ending = end_with(any, options->scene.file, found.message);
  });
}

} // namespace flyball::cli
