#include "app/cli/command.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/solution_json.hpp"
#include "engine/equilibrium/branches.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/text.hpp"

#include <fmt/format.h>

#include <memory>

namespace flyball::cli {
namespace {

using Json = nlohmann::ordered_json;

Json point_json(const ResponsePoint& p) {
  Json out = {{"parameter", p.parameter}, {"coordinates", coordinates_json(p.coordinates)}};
  out["stable"] = p.stable ? Json(*p.stable) : Json(nullptr);
  out["eigenvalues"] = Json::array();
  for (const auto& e : p.eigenvalues)
    out["eigenvalues"].push_back({e.real(), e.imag()});
  return out;
}

Json diagram_json(const ResponseDiagram& d) {
  Json out = {{"status", word(d.status)},
              {"message", d.message},
              {"branches", Json::array()},
              {"special", Json::array()}};
  for (const ResponseBranch& b : d.branches) {
    Json points = Json::array();
    for (const ResponsePoint& p : b.points)
      points.push_back(point_json(p));
    out["branches"].push_back({{"points", std::move(points)}, {"end", b.end}});
  }
  for (const SpecialPoint& s : d.special) {
    Json entry = {{"type", word(s.type)}, {"branch", s.branch}};
    entry.update(point_json(s.at));
    out["special"].push_back(std::move(entry));
  }
  out["run_time_s"] = d.run_time_s;
  return out;
}

std::string diagram_csv(const std::string& address, const ResponseDiagram& d) {
  std::string out = "branch," + csv_field(address);
  if (!d.branches.empty() && !d.branches.front().points.empty())
    for (const CoordinateSolution& c : d.branches.front().points.front().coordinates)
      if (!c.driven) out += "," + csv_field(c.count == 1 ? c.joint : fmt::format("{}.{}", c.joint, c.index));
  out += ",stable,special\n";
  const auto row = [&](int branch, const ResponsePoint& p, std::string_view special) {
    out += fmt::format("{},{}", branch, number_text(p.parameter));
    for (const CoordinateSolution& c : p.coordinates)
      if (!c.driven) out += "," + number_text(c.value);
    out += fmt::format(",{},{}\n", p.stable ? (*p.stable ? "true" : "false") : "", special);
  };
  for (std::size_t b = 0; b < d.branches.size(); ++b)
    for (const ResponsePoint& p : d.branches[b].points)
      row(static_cast<int>(b), p, "");
  for (const SpecialPoint& s : d.special)
    row(s.branch, s.at, word(s.type));
  return out;
}

std::string diagram_text(const Mechanism& m, const std::string& address, const ResponseDiagram& d) {
  std::string out = fmt::format("{}: {}\n", m.name, d.message);
  const std::string unit = parameter_unit(m, address);
  for (std::size_t b = 0; b < d.branches.size(); ++b) {
    const auto& points = d.branches[b].points;
    out += fmt::format("  branch {}: {} points from {:.6g} to {:.6g} {}, ends at {}\n", b, points.size(),
                       points.front().parameter, points.back().parameter, unit, d.branches[b].end);
  }
  for (const SpecialPoint& s : d.special) {
    out += fmt::format("  {} on branch {} at {:.12g} {}:", word(s.type), s.branch, s.at.parameter, unit);
    for (const CoordinateSolution& c : s.at.coordinates)
      if (!c.driven)
        out +=
            fmt::format("  {} = {:.9g} {}", c.count == 1 ? c.joint : fmt::format("{}.{}", c.joint, c.index),
                        c.value, c.angle ? "rad" : "m");
    out += "\n";
  }
  return out + fmt::format("  {:.1f} ms\n", d.run_time_s * 1e3);
}

} // namespace

void add_branch(CLI::App& app, int& exit_code) {
  struct Options {
    SceneArgument scene;
    std::string vary, csv;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("branch", "Follow the equilibria through folds and crossings as a parameter moves");
  options->scene.add_to(*command);
  command->add_option("--vary", options->vary, "The parameter: address=from:to")->required();
  CLI::Option* csv =
      command->add_option("--csv", options->csv, "Write a table to a file (-: standard output)");
  command->add_flag("--json", options->json, "Print a JSON object")->excludes(csv);
  command->footer("Example: flyball branch conical_pendulum.json --vary joints.spin.drive.speed=0:10 --json");
  command->callback([options, &exit_code] {
    const Mechanism mechanism = options->scene.load();
    const Range range = parse_range("--vary", options->vary);
    if (range.from == range.to) throw SceneError("--vary " + range.address, "expected two different ends");
    ResponseDiagram diagram;
    try {
      Progress progress("following");
      BranchOptions follow;
      follow.progress = [&](double part) {
        progress.show(static_cast<std::size_t>(100 * std::max(0., part)), 100);
      };
      diagram = follow_branches(mechanism, range.address, range.from, range.to, follow);
    } catch (const SceneError& error) {
      throw SceneError(options->scene.file.string() + ": " + error.where(), error.expected());
    }
    if (!options->csv.empty())
      write_bytes(options->csv, diagram_csv(range.address, diagram));
    else if (options->json)
      fmt::print("{}\n", diagram_json(diagram).dump(2));
    else
      fmt::print("{}", diagram_text(mechanism, range.address, diagram));
    exit_code = diagram.status == Status::converged ? exit_done : exit_no_result;
  });
}

} // namespace flyball::cli
