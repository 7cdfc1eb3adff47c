#include "engine/study/branch_grid.hpp"

#include "engine/mechanism/address.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/frictions.hpp"
#include "engine/mechanism/validate.hpp"
#include "engine/study/friction_branches.hpp"

namespace flyball {

GridFollower::GridFollower(const Mechanism& mechanism, std::span<const Variation> over, std::string address,
                           double from, double to, const BranchOptions& options)
    : mechanism_(mechanism), over_(over.begin(), over.end()), address_(std::move(address)), from_(from),
      to_(to), options_(options) {
  expect_no_found_speed(mechanism, address_);
  std::vector<std::string> taken{address_};
  for (const Variation& v : over_)
    taken.push_back(v.address);
  expect_each_once(taken);
  Mechanism trial = mechanism;
  for (const std::string& each : taken)
    set_parameter(trial, each, get_parameter(mechanism, each));
}

GridBranches GridFollower::follow(std::size_t i) const {
  GridBranches out;
  out.parameters = grid_values(over_, i);
  std::vector<ParameterValue> numbers;
  for (std::size_t v = 0; v < over_.size(); ++v)
    numbers.push_back({over_[v].address, out.parameters[v]});
  try {
    Mechanism there = mechanism_;
    set_parameters(there, numbers);
    validate(there);
    out.diagram = follow_response(there, address_, from_, to_, options_);
    out.hunting = describe_hopf_points(there, address_, out.diagram);
    if (has_friction(there)) out.ribbons = friction_ribbons(there, address_, out.diagram);
  } catch (const SceneError& error) {
    out.diagram.status = Status::infeasible;
    out.diagram.message = error.what();
  }
  return out;
}

} // namespace flyball
