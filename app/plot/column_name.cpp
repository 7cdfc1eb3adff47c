#include "app/plot/column_name.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace flyball {

std::string column_name(const std::string& name) {
  constexpr std::array<std::string_view, 13> own{
      "t",        "branch", "fate", "status",  "equilibria", "equilibrium", "rests_on_friction",
      "period_s", "stable", "note", "special", "residual",   "run_time_s"};
  // Also of "stable_", so that it is not the column of a joint "stable".
  const std::string_view bare = std::string_view(name).substr(0, name.find_last_not_of('_') + 1);
  return std::ranges::find(own, bare) == own.end() ? name : name + "_";
}

} // namespace flyball
