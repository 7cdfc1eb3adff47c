#include "engine/study/sweep.hpp"
#include "app/cli/command.hpp"
#include "app/cli/output.hpp"
#include "app/cli/processes.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/shared_rows.hpp"
#include "app/cli/study_part.hpp"
#include "app/cli/sweep_rows.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace flyball::cli {
namespace {

constexpr double most_points = 1e12, most_in_table = 1e6;

using FormatRows = std::string (*)(const SweepColumns&, std::span<const SweepPoint>);

struct SweepArguments {
  SceneArgument scene;
  std::vector<std::string> vary;
  std::string csv, npz, shard;
  bool all = false, periodic = false, json = false, no_times = false;
  double search_time = 1;
};

bool has_answer(const SweepPoint& p) {
  return p.solution.status == Status::converged ||
         (p.periodic && p.periodic->status == PeriodicStatus::found);
}

std::string why_no_answer(bool periodic, GridSolver solver, std::size_t i) {
  const SweepPoint p = periodic ? solver.solve_periodic(i) : solver.solve(i);
  return p.periodic ? p.periodic->message : p.solution.message;
}

void run(const SweepArguments& options, Ending& ending) {
  check_outputs(options.scene.file, {{"--csv", options.csv}, {"--npz", options.npz}});
  const std::unique_ptr<WorkSharing> sharing = share_work();
  const Mechanism mechanism = options.scene.load();
  std::vector<Variation> variations;
  double total = 1;
  nlohmann::ordered_json asked = nlohmann::ordered_json::array();
  for (const std::string& text : options.vary) {
    const Range range = parse_range(mechanism, "--vary", text, true);
    variations.push_back({range.address, range.from, range.to, range.count});
    asked.push_back({range.address, range.from, range.to, range.count});
    total *= range.count;
  }
  const bool table = options.csv.empty() && options.npz.empty() && !options.json;
  if (total > most_points) throw SceneError("--vary", "expected at most 10^12 combinations");
  if (table && total > most_in_table)
    throw SceneError("--vary",
                     "expected at most 1000000 combinations in a table to read; --csv and --npz take more");

  const bool times = !options.no_times && !options.all && options.shard.empty() && !started_together();
  const SweepColumns columns{variations,       value_columns(mechanism, variations),
                             options.all,      times,
                             options.periodic, has_friction(mechanism)};
  nlohmann::ordered_json request = {{"variations", std::move(asked)}};
  if (options.all) request["all equilibria"] = {{"search time", options.search_time}};
  if (options.periodic) request["periodic"] = true;
  StudyPart part = part_of("sweep", mechanism, std::move(request), columns.columns(), grid_size(variations));
  if (!options.shard.empty()) part.shard = parse_shard("--shard", options.shard);

  std::vector<FormatRows> formats;
  SharedRows rows;
  const auto add = [&](FormatRows format, std::unique_ptr<RowOutput> output) {
    formats.push_back(format);
    rows.outputs.push_back(std::move(output));
  };
  if (!options.csv.empty())
    add(csv_rows, options.shard.empty() ? csv_output(options.csv, csv_head(part.columns))
                                        : part_output(part, options.csv));
  if (!options.npz.empty()) add(npz_rows, npz_output(part.columns, options.npz, part.count));
  if (options.json) add(json_rows, json_output(mechanism));
  if (table) add(table_rows, table_output(table_head(columns, mechanism)));

  SolveOptions search;
  search.search_time = options.search_time;
  rows.count = part.end() - part.begin();
  if (options.all || options.periodic) rows.largest_block = 1; // each takes its time
  rows.maker = [&]() -> RowMaker {
    try {
      return [&, solver = std::make_shared<GridSolver>(mechanism, variations)](std::size_t begin,
                                                                               std::size_t end) {
        RowBlock block;
        std::vector<SweepPoint> points;
        try {
          for (std::size_t i = part.begin() + begin; i < part.begin() + end; ++i) {
            if (options.all)
              std::ranges::move(solver->solve_all(i, search), std::back_inserter(points));
            else
              points.push_back(options.periodic ? solver->solve_periodic(i) : solver->solve(i));
          }
        } catch (const SceneError& error) {
          throw options.scene.in_file(error);
        }
        block.answers = static_cast<std::uint64_t>(
            std::ranges::count(points, true, [](const SweepPoint& p) { return has_answer(p); }));
        for (const FormatRows format : formats)
          block.forms.push_back(format(columns, points));
        return block;
      };
    } catch (const SceneError& error) {
      throw options.scene.in_file(error);
    }
  };
  const std::uint64_t answers = put_out(rows, *sharing);
  if (!sharing->takes() || answers > 0 || rows.count == 0) return;
  // Why no point has an answer: what is said of the first.
  ending =
      end_with(false, options.scene.file,
               fmt::format("no steady state{} at any of the {} points; at the first: {}",
                           options.periodic ? " nor periodic motion" : "", rows.count,
                           why_no_answer(options.periodic, GridSolver(mechanism, variations), part.begin())));
}

} // namespace

void add_sweep(CLI::App& app, Ending& ending) {
  auto options = std::make_shared<SweepArguments>();
  CLI::App* command =
      app.add_subcommand("sweep", "Find the steady state over a range of one or more parameters");
  options->scene.add_to(*command);
  command
      ->add_option("--vary", options->vary,
                   "Vary a number: address=from:to:count; given again, all combinations")
      ->required()
      ->take_all()
      ->allow_extra_args(false);
  CLI::Option* all = command->add_flag(
      "--all", options->all, "All equilibria that a bounded search finds at each point, a row each");
  command
      ->add_option("--search-time", options->search_time,
                   "With --all: the search's budget at each point, in seconds of one core, counted in "
                   "operations so that every run finds the same (default 1)")
      ->check(above_zero())
      ->needs(all);
  command
      ->add_flag(
          "--periodic", options->periodic,
          "Where drives make the balance turn, or the steady state is unstable: the periodic motion in its "
          "place, with the mean, least and most of each value")
      ->excludes(all);
  CLI::Option* csv =
      command->add_option("--csv", options->csv, "Write a table to a file (-: standard output)");
  CLI::Option* npz = command->add_option("--npz", options->npz, "Write columns for NumPy to a file");
  npz->excludes(all); // of how many rows it is, is to be known beforehand: `merge` has counted them
  CLI::Option* json = command->add_flag("--json", options->json, "Print a JSON object")->excludes(csv);
  json->excludes(npz);
  command->add_flag("--no-times", options->no_times, "Leave out run times: the same bytes in every run");
  add_shard(*command, options->shard, csv)->excludes(npz);
  command->footer(
      "Example: flyball sweep governor.json --vary joints.spin.drive.speed=5:20:31 --csv curve.csv");
  command->callback([options, &ending] { run(*options, ending); });
}

} // namespace flyball::cli
