// What `branch` tells of a diagram, as JSON and as rows: of one by itself, and of each place of a grid.
#pragma once

#include "app/cli/row_output.hpp"
#include "app/cli/value_columns.hpp"
#include "engine/study/branch_grid.hpp"
#include "engine/study/friction_ribbon.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace flyball::cli {

// Of each branch, where there is friction.
using Ribbons = std::vector<std::vector<RibbonPoint>>;

// Without its run time. With ribbons points have a "band": {name: [low, high]}, and where there is none a
// "band_message"; special points of which `hunting` tells have that as "hunting".
nlohmann::ordered_json diagram_json(const ResponseDiagram& diagram, const Ribbons& ribbons,
                                    const HopfPoints& hunting);
// Of each the points from beside a fold outwards: {`parameter`, `band`}.
nlohmann::ordered_json tips_json(const Ribbons& tips);
// All of a table: branch, parameter, values, `stable`, `special`; with ribbons then
// `rests_on_friction` (see friction_word()), and `NAME.low` and `NAME.high` of each value.
std::string diagram_csv(const Mechanism& mechanism, const std::string& address,
                        const ResponseDiagram& diagram, const Ribbons& ribbons);

struct BranchColumns {
  std::vector<Variation> over;
  std::string address; // of the number that is varied along branches
  std::vector<ValueColumn> values;
  bool bands = false; // there is dry friction: whether a state rests on it, and its band of each value

  std::vector<Column> columns() const;
};

// Of one place, as row_output.hpp wants them. A row each point and special point, or one that says why there
// is none. `note`: why a branch begins or ends, in words, at its ends; at Hopf points "soft", "hard" or
// "undecided". With bands then as of diagram_csv().
std::string csv_rows(const BranchColumns& columns, const GridBranches& place);
std::string json_rows(const BranchColumns& columns, const GridBranches& place);
// One row, with how many branches there are and how many special points of each kind.
std::string table_rows(const BranchColumns& columns, const GridBranches& place);
std::vector<std::string> table_head(const BranchColumns& columns, const Mechanism& mechanism);

} // namespace flyball::cli
