// `branch --over`: branches at each place of a grid, which threads, processes or shards share.
#pragma once

#include "app/cli/command.hpp"
#include "app/cli/scene_argument.hpp"

#include <string>
#include <vector>

namespace flyball::cli {

struct BranchOver {
  std::string vary;              // "address=from:to"
  std::vector<std::string> over; // "address=from:to:count"
  bool all = false, json = false;
  std::string csv, shard;
};

void branch_over(const SceneArgument& scene, const BranchOver& wanted, Ending& ending);

} // namespace flyball::cli
