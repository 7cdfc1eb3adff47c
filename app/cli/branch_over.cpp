#include "app/cli/branch_over.hpp"

#include "app/cli/branch_rows.hpp"
#include "app/cli/processes.hpp"
#include "app/cli/shared_rows.hpp"
#include "app/cli/study_part.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>

namespace flyball::cli {

void branch_over(const SceneArgument& scene, const BranchOver& wanted, Ending& ending) {
  using FormatRows = std::string (*)(const BranchColumns&, const GridBranches&);
  constexpr double most_places = 1e9;
  const std::unique_ptr<WorkSharing> sharing = share_work();
  const Mechanism mechanism = scene.load();
  const Range vary = parse_range(mechanism, "--vary", wanted.vary);
  std::vector<Variation> over;
  nlohmann::ordered_json asked = nlohmann::ordered_json::array();
  double total = 1;
  for (const std::string& text : wanted.over) {
    const Range range = parse_range(mechanism, "--over", text, true);
    over.push_back({range.address, range.from, range.to, range.count});
    asked.push_back({range.address, range.from, range.to, range.count});
    total *= range.count;
  }
  if (total > most_places) throw SceneError("--over", "expected at most 10^9 combinations");
  std::optional<GridFollower> follower;
  BranchOptions options;
  options.all = wanted.all;
  try {
    follower.emplace(mechanism, over, vary.address, vary.from, vary.to, options);
  } catch (const SceneError& error) {
    throw scene.in_file(error);
  }

  const BranchColumns columns{over, vary.address, value_columns(mechanism), has_friction(mechanism)};
  StudyPart part = part_of("branch", mechanism,
                           {{"variation", {vary.address, vary.from, vary.to}},
                            {"grid", std::move(asked)},
                            {"choice of branches", wanted.all ? "all" : "connected"}},
                           columns.columns(), grid_size(over));
  if (!wanted.shard.empty()) part.shard = parse_shard("--shard", wanted.shard);

  FormatRows format = table_rows;
  SharedRows rows;
  rows.phase = "following branches";
  rows.count = part.end() - part.begin();
  rows.largest_block = 1; // each takes its time, and says a lot
  if (!wanted.csv.empty()) {
    format = csv_rows;
    rows.outputs.push_back(wanted.shard.empty() ? csv_output(wanted.csv, csv_head(part.columns))
                                                : part_output(part, wanted.csv));
  } else if (wanted.json) {
    format = json_rows;
    rows.outputs.push_back(json_output(mechanism));
  } else {
    rows.outputs.push_back(table_output(table_head(columns, mechanism)));
  }
  rows.maker = [&]() -> RowMaker {
    return [&](std::size_t begin, std::size_t end) {
      RowBlock block{0, {""}};
      for (std::size_t i = begin; i < end; ++i) {
        const GridBranches place = follower->follow(part.begin() + i);
        block.answers += place.diagram.branches.empty() ? 0 : 1;
        block.forms[0] += format(columns, place);
      }
      return block;
    };
  };
  const std::uint64_t answers = put_out(rows, *sharing);
  if (!sharing->takes() || answers > 0 || rows.count == 0) return;
  ending = end_with(false, scene.file,
                    fmt::format("no branch at any of the {} places; at the first: {}", rows.count,
                                follower->follow(part.begin()).diagram.message));
}

} // namespace flyball::cli
