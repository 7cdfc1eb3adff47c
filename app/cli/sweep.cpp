#include "engine/study/sweep.hpp"
#include "app/cli/command.hpp"
#include "app/cli/output.hpp"
#include "app/cli/processes.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/row_output.hpp"
#include "app/cli/scene_argument.hpp"
#include "app/cli/sweep_part.hpp"
#include "engine/mechanism/error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>

namespace flyball::cli {
namespace {

constexpr double most_points = 1e12, most_in_table = 1e6;

using Outputs = std::vector<std::unique_ptr<RowOutput>>;

// A block of rows in all forms: how many have an answer, then each form's bytes after their number.
std::string pack(const std::vector<SweepPoint>& points, const Outputs& outputs) {
  std::string out;
  const auto add_count = [&](std::uint64_t n) { out.append(reinterpret_cast<const char*>(&n), sizeof n); };
  add_count(static_cast<std::uint64_t>(
      std::ranges::count(points, Status::converged, [](const SweepPoint& p) { return p.solution.status; })));
  for (const auto& output : outputs) {
    const std::string rows = output->format(points);
    add_count(rows.size());
    out += rows;
  }
  return out;
}

// Returns how many have an answer.
std::uint64_t unpack(std::size_t begin, std::size_t end, std::string_view block, const Outputs& outputs) {
  const auto take_count = [&] {
    std::uint64_t n = 0;
    std::memcpy(&n, block.data(), sizeof n);
    block.remove_prefix(sizeof n);
    return n;
  };
  const std::uint64_t answers = take_count();
  for (const auto& output : outputs) {
    const std::uint64_t size = take_count();
    output->take(begin, end, block.substr(0, size));
    block.remove_prefix(size);
  }
  return answers;
}

struct SweepOptions {
  SceneArgument scene;
  std::vector<std::string> vary;
  std::string csv, npz, shard;
  bool json = false, no_times = false;
};

void run(const SweepOptions& options, Ending& ending) {
  check_outputs(options.scene.file, {{"--csv", options.csv}, {"--npz", options.npz}});
  const std::unique_ptr<WorkSharing> sharing = share_work();
  const Mechanism mechanism = options.scene.load();
  std::vector<Variation> variations;
  double total = 1;
  for (const std::string& text : options.vary) {
    const Range range = parse_range("--vary", text, true);
    variations.push_back({range.address, range.from, range.to, range.count});
    total *= range.count;
  }
  const bool table = options.csv.empty() && options.npz.empty() && !options.json;
  if (total > most_points) throw SceneError("--vary", "expected at most 10^12 combinations");
  if (table && total > most_in_table)
    throw SceneError("--vary",
                     "expected at most 1000000 combinations in a table to read; --csv and --npz take more");

  const bool times = !options.no_times && options.shard.empty() && !started_together();
  const SweepColumns columns(mechanism, variations, times);
  const Shard shard = options.shard.empty() ? Shard() : parse_shard("--shard", options.shard);
  const SweepPart part(mechanism, columns, shard);
  Outputs outputs;
  if (!options.csv.empty())
    outputs.push_back(
        csv_output(columns, options.csv, options.shard.empty() ? csv_head(columns.names()) : part.head()));
  if (!options.npz.empty()) outputs.push_back(npz_output(columns, options.npz, part.rows));
  if (options.json) outputs.push_back(json_output(columns, mechanism));
  if (table) outputs.push_back(table_output(columns, mechanism));

  const auto in_scene = [&options](const SceneError& error) {
    return SceneError(options.scene.file.string() + ": " + error.where(), error.expected());
  };
  std::uint64_t answers = 0;
  SharedWork work;
  work.count = part.end() - part.begin();
  work.maker = [&]() -> BlockMaker {
    try {
      return [&, solver = std::make_shared<GridSolver>(mechanism, variations)](std::size_t begin,
                                                                               std::size_t end) {
        std::vector<SweepPoint> points;
        try {
          for (std::size_t i = begin; i < end; ++i)
            points.push_back(solver->solve(part.begin() + i));
        } catch (const SceneError& error) {
          throw in_scene(error);
        }
        return pack(points, outputs);
      };
    } catch (const SceneError& error) {
      throw in_scene(error);
    }
  };
  work.take = [&](std::size_t begin, std::size_t end, std::string_view block) {
    answers += unpack(begin, end, block, outputs);
  };
  if (!sharing->takes()) return sharing->run(work);
  for (const auto& output : outputs)
    output->begin();
  {
    ProgressBar progress("solving");
    work.progress = [&](std::size_t done, std::size_t all) { progress.show("solving", done, all); };
    sharing->run(work);
  }
  for (const auto& output : outputs)
    output->finish();
  if (answers > 0 || work.count == 0) return;
  // Why no point has an answer: what is said of the first.
  ending = end_with(false, options.scene.file,
                    fmt::format("no steady state at any of the {} points; at the first: {}", work.count,
                                GridSolver(mechanism, variations).solve(part.begin()).solution.message));
}

} // namespace

void add_sweep(CLI::App& app, Ending& ending) {
  auto options = std::make_shared<SweepOptions>();
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
  CLI::Option* npz = command->add_option("--npz", options->npz, "Write columns for NumPy to a file");
  CLI::Option* json = command->add_flag("--json", options->json, "Print a JSON object")->excludes(csv);
  json->excludes(npz);
  command->add_flag("--no-times", options->no_times, "Leave out run times: the same bytes in every run");
  command
      ->add_option("--shard", options->shard,
                   "Compute part K of N alone, K/N, and write it to --csv for `flyball merge`; without times")
      ->needs(csv)
      ->excludes(npz);
  command->footer(
      "Example: flyball sweep governor.json --vary joints.spin.drive.speed=5:20:31 --csv curve.csv");
  command->callback([options, &ending] { run(*options, ending); });
}

} // namespace flyball::cli
