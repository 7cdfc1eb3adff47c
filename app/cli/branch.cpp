#include "app/cli/branch_over.hpp"
#include "app/cli/branch_rows.hpp"
#include "app/cli/command.hpp"
#include "app/cli/hunting_told.hpp"
#include "app/cli/output.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/solution_json.hpp"
#include "app/cli/study_part.hpp"
#include "app/plot/branch_plot.hpp"
#include "app/plot/ribbon_plot.hpp"
#include "app/plot/svg.hpp"
#include "app/render/offscreen.hpp"
#include "app/ui/plots/plot_picture.hpp"
#include "engine/continuation/branch_follower.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/safe_text.hpp"
#include "engine/mechanism/text.hpp"
#include "engine/study/friction_branches.hpp"
#include "engine/study/ribbon_meetings.hpp"
#include "engine/study/ribbon_tips.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>

namespace flyball::cli {
namespace {

// What to draw: what is named, else the first free coordinate. Throws SceneError naming those there are.
PlottedQuantity plotted_quantity(const Mechanism& m, const ResponseDiagram& d, const std::string& name) {
  const std::vector<CoordinateSolution>& all = d.branches.front().points.front().coordinates;
  const auto free = std::ranges::find_if(all, is_found);
  if (name.empty() && free != all.end())
    return {static_cast<std::size_t>(free - all.begin()), false,
            free->speed || slips_somewhere(d, static_cast<std::size_t>(free - all.begin()))};
  if (const auto found = find_plotted(m, d, name)) return *found;
  const std::string known = plotted_names(m, all);
  throw SceneError("--plot " + name,
                   known.empty() ? "there is no free coordinate to draw" : "expected one of " + known);
}

struct Bands {
  Ribbons ribbons, tips; // of each branch at all its points; beyond its folds
};

// Their time is the diagram's, too.
Bands find_bands(const Mechanism& mechanism, const Range& range, ResponseDiagram& diagram,
                 const ReportProgress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  Bands out;
  out.ribbons =
      friction_ribbons(mechanism, range.address, diagram, nullptr, [&](std::size_t done, std::size_t all) {
        report_progress(progress, "friction", static_cast<double>(done) / static_cast<double>(all));
      });
  out.tips = ribbon_tips(mechanism, range.address, range.from, range.to, diagram);
  diagram.run_time_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

HopfPoints describe_hunting(const Mechanism& mechanism, const std::string& address,
                            ResponseDiagram& diagram) {
  const auto begin = std::chrono::steady_clock::now();
  HopfPoints out = describe_hopf_points(mechanism, address, diagram);
  diagram.run_time_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

std::string diagram_text(const Mechanism& m, const std::string& address, const ResponseDiagram& d,
                         const HopfPoints& hunting) {
  std::string out = fmt::format("{}: {}\n", printable(m.name), printable(d.message));
  const std::string unit = parameter_unit(m, address);
  for (std::size_t b = 0; b < d.branches.size(); ++b) {
    const auto& points = d.branches[b].points;
    const std::string_view friction = friction_word(points.front().frictions);
    out += fmt::format("  branch {}: {} points from {:.6g} to {:.6g} {}{}, ends at {}{}\n", b, points.size(),
                       points.front().parameter, points.back().parameter, unit,
                       friction.empty()     ? ""
                       : friction == "held" ? ", held by friction"
                                            : ", slips",
                       d.branches[b].end, d.branches[b].connected ? "" : ", not connected");
  }
  for (std::size_t i = 0; i < d.special.size(); ++i) {
    const SpecialPoint& s = d.special[i];
    const std::string error =
        s.at.parameter_error ? fmt::format(" +- {:.1g}", *s.at.parameter_error) : std::string();
    out += fmt::format("  {} on branch {} at {:.12g}{} {}:", word(s.type), s.branch, s.at.parameter, error,
                       unit);
    for (const CoordinateSolution& c : s.at.coordinates)
      if (const auto found = found_number(c))
        out += fmt::format("  {} = {:.9g} {}", printable(found->name), found->value, found->unit);
    out += "\n";
    if (hunting[i]) out += "    " + hunting_text(*hunting[i]) + "\n";
  }
  return out + fmt::format("  {:.1f} ms\n", d.run_time_s * 1e3);
}

} // namespace

void add_branch(CLI::App& app, Ending& ending) {
  struct Options {
    SceneArgument scene;
    std::string vary, csv, svg, png, plot, shard;
    std::vector<std::string> over;
    bool all = false, json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("branch", "Follow the equilibria through folds and crossings as a parameter moves");
  options->scene.add_to(*command);
  command->add_option("--vary", options->vary, "The parameter: address=from:to")->required();
  command->add_flag("--all", options->all,
                    "Also the branches that nothing connects with the drawn pose's, from a bounded search "
                    "for all equilibria at both ends and at the present value");
  CLI::Option* over =
      command
          ->add_option("--over", options->over,
                       "Follow them at each value of another number: address=from:to:count; given again, at "
                       "all combinations")
          ->take_all()
          ->allow_extra_args(false);
  CLI::Option* csv =
      command->add_option("--csv", options->csv, "Write a table to a file (-: standard output)");
  command->add_option("--svg", options->svg, "Draw the curve into a file (-: standard output)")
      ->excludes(over);
  command
      ->add_option("--png", options->png,
                   "Draw the curve into a picture, without a display (-: standard output)")
      ->excludes(over);
  command
      ->add_option("--plot", options->plot,
                   "The coordinate or measure that --svg and --png draw: joint, joint.index or the measure's "
                   "name (default: the first coordinate)")
      ->excludes(over);
  command->add_flag("--json", options->json, "Print a JSON object")->excludes(csv);
  add_shard(*command, options->shard, csv)->needs(over);
  command->footer("Example: flyball branch conical_pendulum.json --vary joints.spin.drive.speed=0:10 --json");
  command->callback([options, &ending] {
    check_outputs(options->scene.file,
                  {{"--csv", options->csv}, {"--svg", options->svg}, {"--png", options->png}});
    if (!options->over.empty())
      return branch_over(
          options->scene,
          {options->vary, options->over, options->all, options->json, options->csv, options->shard}, ending);
    std::optional<ProgressBar> progress(std::in_place, "reading");
    const Mechanism mechanism = options->scene.load();
    const Range range = parse_range(mechanism, "--vary", options->vary);
    ResponseDiagram diagram;
    Bands bands;
    HopfPoints hunting;
    try {
      BranchOptions follow;
      follow.all = options->all;
      follow.progress = progress->reporter();
      diagram = follow_response(mechanism, range.address, range.from, range.to, follow);
      if (has_friction(mechanism)) bands = find_bands(mechanism, range, diagram, follow.progress);
      hunting = describe_hunting(mechanism, range.address, diagram);
    } catch (const SceneError& error) {
      throw options->scene.in_file(error);
    }
    progress.reset();
    const bool any = diagram.status == Status::converged && !diagram.branches.empty();
    if ((!options->svg.empty() || !options->png.empty()) && any) {
      const PlottedQuantity shown = plotted_quantity(mechanism, diagram, options->plot);
      Plot plot = branch_plot(mechanism, range.address, diagram, shown);
      const std::string name = plotted_name(diagram.branches.front().points.front(), shown);
      for (std::size_t k = 0; k < bands.ribbons.size(); ++k) {
        std::vector<RibbonPoint> ribbon = bands.ribbons[k];
        add_meetings(mechanism, range.address, ribbon_places(diagram.branches[k]), ribbon);
        add_ribbon(plot, ribbon, name);
      }
      for (const std::vector<RibbonPoint>& tip : bands.tips)
        add_ribbon(plot, tip, name);
      if (!options->svg.empty()) write_bytes(options->svg, to_svg(plot));
      if (!options->png.empty()) {
        const OffscreenContext context;
        write_bytes(options->png, encode_png(draw_plot_picture(plot, {})));
      }
    }
    // Files of earlier runs are not replaced by empty ones.
    if (!options->csv.empty() && !diagram.branches.empty())
      write_bytes(options->csv, diagram_csv(mechanism, range.address, diagram, bands.ribbons));
    if (options->json) {
      nlohmann::ordered_json told = diagram_json(diagram, bands.ribbons, hunting);
      if (!bands.tips.empty()) told["bands_beyond_folds"] = tips_json(bands.tips);
      told["run_time_s"] = diagram.run_time_s;
      print_json(with_warnings(std::move(told), mechanism));
    } else if (options->csv.empty() && options->svg != "-" && options->png != "-") // else it is theirs
      print_text(diagram_text(mechanism, range.address, diagram, hunting));
    ending = end_with(any, options->scene.file, diagram.message);
  });
}

} // namespace flyball::cli
