#include "engine/study/sweep.hpp"
#include "app/cli/command.hpp"
#include "app/cli/output.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/solution_json.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/file.hpp"
#include "engine/mechanism/safe_text.hpp"
#include "engine/mechanism/text.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>

namespace flyball::cli {
namespace {

struct ColumnName {
  std::string joint;
  int index;
  std::string text() const { return index < 0 ? joint : joint + "." + std::to_string(index); }
};

// The free coordinates; the same at every point, whether it has an answer or not.
std::vector<ColumnName> coordinate_columns(const Mechanism& mechanism) {
  std::vector<ColumnName> columns;
  for (const CoordinateSolution& c : Analysis(mechanism).summary().coordinates)
    if (!c.driven) columns.push_back({c.joint, c.count == 1 ? -1 : c.index});
  return columns;
}

// Empty where there is no value.
std::string measure_cell(const Solution& solution, std::size_t i) {
  if (i >= solution.measures.size() || !solution.measures[i].value) return "";
  return csv_number(*solution.measures[i].value);
}

std::string to_csv(const Mechanism& m, const std::vector<Variation>& variations,
                   const std::vector<SweepPoint>& points) {
  const std::vector<ColumnName> columns = coordinate_columns(m);
  std::string out;
  for (const Variation& v : variations)
    out += csv_field(v.address) + ",";
  out += "status";
  for (const ColumnName& c : columns)
    out += "," + csv_field(c.text());
  for (const NamedMeasure& measure : m.measures)
    out += "," + csv_field(measure.name);
  out += ",stable,residual,run_time_s\n";
  for (const SweepPoint& p : points) {
    for (double value : p.parameters)
      out += csv_number(value) + ",";
    out += word(p.solution.status);
    std::size_t at = 0;
    for (const CoordinateSolution& c : p.solution.coordinates)
      if (!c.driven) {
        out += "," + csv_number(c.value);
        ++at;
      }
    for (; at < columns.size(); ++at)
      out += ",";
    for (std::size_t i = 0; i < m.measures.size(); ++i)
      out += "," + measure_cell(p.solution, i);
    out += p.solution.stable ? (*p.solution.stable ? ",true," : ",false,") : ",,";
    out += csv_number(p.solution.residual) + "," + csv_number(p.solution.run_time_s) + "\n";
  }
  return out;
}

nlohmann::ordered_json to_json(const std::vector<Variation>& variations,
                               const std::vector<SweepPoint>& points) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const SweepPoint& p : points) {
    nlohmann::ordered_json row;
    for (std::size_t v = 0; v < variations.size(); ++v)
      row["parameters"][variations[v].address] = p.parameters[v];
    row["status"] = word(p.solution.status);
    row["message"] = p.solution.message;
    row["coordinates"] = nlohmann::ordered_json::object();
    for (const CoordinateSolution& c : p.solution.coordinates)
      if (!c.driven) row["coordinates"][ColumnName{c.joint, c.count == 1 ? -1 : c.index}.text()] = c.value;
    if (!p.solution.measures.empty()) row["measures"] = measures_json(p.solution.measures);
    row["stable"] =
        p.solution.stable ? nlohmann::ordered_json(*p.solution.stable) : nlohmann::ordered_json(nullptr);
    row["stability_reason"] = p.solution.stability_reason
                                  ? nlohmann::ordered_json(word(*p.solution.stability_reason))
                                  : nlohmann::ordered_json(nullptr);
    if (p.solution.floquet) row["floquet"] = floquet_json(*p.solution.floquet);
    row["residual"] = std::isfinite(p.solution.residual) ? nlohmann::ordered_json(p.solution.residual)
                                                         : nlohmann::ordered_json(nullptr);
    row["run_time_s"] = p.solution.run_time_s;
    rows.push_back(std::move(row));
  }
  return {{"points", std::move(rows)}};
}

std::string to_table(const Mechanism& m, const std::vector<Variation>& variations,
                     const std::vector<SweepPoint>& points) {
  const std::vector<ColumnName> columns = coordinate_columns(m);
  std::vector<std::vector<std::string>> rows(1);
  for (const Variation& v : variations) {
    const std::string unit = parameter_unit(m, v.address);
    const std::string name = printable(v.address);
    rows[0].push_back(unit.empty() ? name : fmt::format("{} [{}]", name, unit));
  }
  rows[0].push_back("status");
  for (const ColumnName& c : columns) {
    const int j = joint_index(m, c.joint);
    const bool angle = j >= 0 ? is_angle(m.joints[static_cast<std::size_t>(j)].type, std::max(0, c.index))
                              : is_angle(JointType::free, c.index);
    rows[0].push_back(fmt::format("{} [{}]", printable(c.text()), angle ? "rad" : "m"));
  }
  for (const NamedMeasure& measure : m.measures)
    rows[0].push_back(measure.unit.empty() ? measure.name
                                           : fmt::format("{} [{}]", measure.name, measure.unit));
  rows[0].insert(rows[0].end(), {"stable", "residual", "time [µs]"});
  for (const SweepPoint& p : points) {
    auto& row = rows.emplace_back();
    for (double value : p.parameters)
      row.push_back(fmt::format("{:.8g}", value));
    row.emplace_back(word(p.solution.status));
    for (const CoordinateSolution& c : p.solution.coordinates)
      if (!c.driven) row.push_back(fmt::format("{:.10f}", c.value));
    row.resize(variations.size() + 1 + columns.size());
    for (std::size_t i = 0; i < m.measures.size(); ++i) {
      const bool known = i < p.solution.measures.size() && p.solution.measures[i].value;
      row.push_back(known ? fmt::format("{:.10g}", *p.solution.measures[i].value) : "-");
    }
    row.push_back(p.solution.stable ? (*p.solution.stable ? "yes" : "no") : "-");
    row.push_back(std::isfinite(p.solution.residual) ? fmt::format("{:.1e}", p.solution.residual) : "-");
    row.push_back(fmt::format("{:.1f}", p.solution.run_time_s * 1e6));
  }
  std::vector<std::size_t> widths(rows[0].size());
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i)
      widths[i] = std::max(widths[i], row[i].size());
  std::string out;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i)
      out += fmt::format("{}{:>{}}", i ? "  " : "", row[i], widths[i]);
    out += "\n";
  }
  return out;
}

// Why no point has an answer: what is said of the first.
std::string reason_of(const std::vector<SweepPoint>& points) {
  return fmt::format("no steady state at any of the {} points; at the first: {}", points.size(),
                     points.empty() ? "" : points.front().solution.message);
}

} // namespace

void add_sweep(CLI::App& app, Ending& ending) {
  struct Options {
    SceneArgument scene;
    std::vector<std::string> vary;
    std::string csv;
    bool json = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("sweep", "Find the steady state over a range of one or more parameters");
  options->scene.add_to(*command);
  command
      ->add_option("--vary", options->vary,
                   "Vary a number: address=from:to:count; given again, all combinations")
      ->required()
      ->take_all()
      ->allow_extra_args(false);
  CLI::Option* csv =
      command->add_option("--csv", options->csv, "Write a table to a file (-: standard output)");
  command->add_flag("--json", options->json, "Print a JSON object")->excludes(csv);
  command->footer(
      "Example: flyball sweep governor.json --vary joints.spin.drive.speed=5:20:31 --csv curve.csv");
  command->callback([options, &ending] {
    check_outputs(options->scene.file, {{"--csv", options->csv}});
    const Mechanism mechanism = options->scene.load();
    std::vector<Variation> variations;
    double total = 1;
    for (const std::string& text : options->vary) {
      const Range range = parse_range("--vary", text, true);
      variations.push_back({range.address, range.from, range.to, range.count});
      total *= variations.back().count;
    }
    if (total > 1e7) throw SceneError("--vary", "expected at most 10000000 combinations");
    std::vector<SweepPoint> points;
    try {
      ProgressBar progress("solving");
      points = sweep(mechanism, variations, 0,
                     [&](std::size_t done, std::size_t all) { progress.show("solving", done, all); });
    } catch (const SceneError& error) {
      throw SceneError(options->scene.file.string() + ": " + error.where(), error.expected());
    }
    if (!options->csv.empty())
      write_bytes(options->csv, to_csv(mechanism, variations, points));
    else if (options->json)
      print_json(with_warnings(to_json(variations, points), mechanism));
    else
      print_text(to_table(mechanism, variations, points));
    const bool any = std::ranges::any_of(
        points, [](const SweepPoint& p) { return p.solution.status == Status::converged; });
    ending = end_with(any, options->scene.file, reason_of(points));
  });
}

} // namespace flyball::cli
