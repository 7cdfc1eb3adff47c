#include "engine/dynamics/friction_modes.hpp"

#include "engine/mechanism/error.hpp"
#include "engine/solve/tied_motions.hpp"
#include "engine/system/joint_parts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace flyball {
namespace {

constexpr double nothing = 1e-9; // of a rate, relative
// How little a coordinate moves as the loops do, scaled, where it is taken to pass a dead point, and how fast
// the loops then move, relative.
constexpr double hardly = 1e-6, passing = 1e-6;

// The constraint q = its value, as a gear that ties the coordinate to none.
void add_hold(MotionModel& model, const Link& link, double value) {
  CutJoint cut;
  cut.joint = model.system.tree_joints[static_cast<std::size_t>(link.tree_joint)].joint;
  cut.type = JointType::gear;
  cut.first_row = model.system.rows;
  cut.rows = rows_of(JointType::gear);
  cut.gear_a = cut.gear_b = link.q;
  cut.gear_va = cut.gear_vb = link.v;
  ++model.system.rows;
  model.system.cuts.push_back(std::move(cut));
  CutParameters& p = model.parameters.cuts.emplace_back();
  p.ratio = 0;
  p.offset = value;
}

} // namespace

std::vector<FrictionElement> list_frictions(const MotionModel& model) {
  std::vector<FrictionElement> out;
  for (std::size_t l = 0; l < model.system.links.size(); ++l) {
    const Link& link = model.system.links[l];
    const int joint = model.system.tree_joints[static_cast<std::size_t>(link.tree_joint)].joint;
    if (link.v < 0 || joint < 0) continue;
    const auto& friction = model.mechanism.joints[static_cast<std::size_t>(joint)]
                               .coordinates[static_cast<std::size_t>(link.coordinate)]
                               .friction;
    if (friction && friction_limit(*friction) > 0)
      out.push_back({static_cast<int>(l), friction_limit(*friction)});
  }
  return out;
}

FrictionModes with_modes(const MotionModel& free, const std::vector<FrictionElement>& frictions,
                         const std::vector<int>& slips, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                         double rate) {
  auto model = std::make_shared<MotionModel>(free);
  FrictionModes out;
  std::vector<std::size_t> stuck;
  std::vector<int> entries;
  for (std::size_t i = 0; i < frictions.size(); ++i) {
    const auto l = static_cast<std::size_t>(frictions[i].link);
    model->parameters.links[l].force.hold(0).friction = -slips[i] * frictions[i].limit;
    if (slips[i] != 0) continue;
    stuck.push_back(i);
    entries.push_back(free.system.links[l].v);
  }
  if (stuck.empty()) {
    out.model = std::move(model);
    return out;
  }
  Workspace w;
  TiedMotions tied = find_tied_motions(free.problem(), q, entries, w);
  if (free.system.rows > 0) {
    const Eigen::MatrixXd& basis = w.dense.constraints().basis();
    const auto passes = [&](std::size_t i) {
      const int v = free.system.links[static_cast<std::size_t>(frictions[i].link)].v;
      const double moves = basis.row(v).norm();
      return moves < hardly && std::abs(u[v]) > passing * rate * free.scaling.column[v] * moves;
    };
    std::ranges::copy_if(stuck, std::back_inserter(out.at_dead_points), passes);
    if (!out.at_dead_points.empty()) {
      std::erase_if(stuck, passes);
      entries.clear();
      for (const std::size_t i : stuck)
        entries.push_back(free.system.links[static_cast<std::size_t>(frictions[i].link)].v);
      tied = find_tied_motions(free.problem(), q, entries, w);
    }
  }
  for (const std::size_t i : tied.independent) {
    const FrictionElement& element = frictions[stuck[i]];
    const Link& link = free.system.links[static_cast<std::size_t>(element.link)];
    out.holds.push_back({stuck[i], model->system.rows, -element.limit, element.limit});
    add_hold(*model, link, q[link.q]);
  }
  for (std::size_t i = 0; i < tied.others.size(); ++i) {
    const std::size_t other = stuck[tied.others[i]];
    const Eigen::VectorXd rates = tied.follow.row(static_cast<Eigen::Index>(i)).transpose();
    const double size = rates.size() > 0 ? rates.lpNorm<Eigen::Infinity>() : 0;
    int found = 0;
    for (Eigen::Index k = 0; k < rates.size(); ++k) {
      if (!(std::abs(rates[k]) > nothing * size) || size < nothing) continue;
      FrictionHold& hold = out.holds[static_cast<std::size_t>(k)];
      const double gives = std::abs(rates[k]) * frictions[other].limit;
      hold.least -= gives;
      hold.most += gives;
      hold.tied.push_back({other, rates[k]});
      ++found;
    }
    if (found == 0) out.at_dead_points.push_back(other);
    if (found > 1)
      throw SceneError(
          "joints." +
              free.system
                  .tree_joints[static_cast<std::size_t>(
                      free.system.links[static_cast<std::size_t>(frictions[other].link)].tree_joint)]
                  .name +
              ".friction",
          "moves with several other joints with friction, so that how they share a load when "
          "they stick is not determined");
  }
  model->along_tree = false;
  model->system.division = divide(model->system);
  model->released = released(model->system);
  set_scaling(model->system, model->parameters, model->scaling);
  out.model = std::move(model);
  return out;
}

} // namespace flyball
