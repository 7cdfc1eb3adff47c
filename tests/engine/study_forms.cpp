// Studies of mechanisms whose KKT matrix is eliminated, along a tree or as sparse equations of loops: the
// same answers as by dense matrices.
#include "tests/bench/large_scenes.hpp"
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/continuation/branch_follower.hpp"
#include "engine/continuation/extended_balance.hpp"
#include "engine/kkt/configuration_difference.hpp"
#include "engine/kkt/coordinate_gradient.hpp"
#include "engine/mechanism/address.hpp"
#include "engine/search/all_equilibria.hpp"
#include "engine/search/find_equilibrium.hpp"
#include "engine/study/compare.hpp"
#include "engine/study/fold_curve.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

const std::string speed = "joints.spin.drive.speed", gravity = "gravity.1";

// The springy chain, its tip on a rod from the hub: a loop.
Mechanism held_chain(int links) {
  Mechanism m = bench::springy_chain(links, 6, 0.3, 0);
  const Body& tip = m.bodies.back();
  Joint stay;
  stay.name = "stay";
  stay.type = JointType::distance;
  stay.bodies = {"hub", tip.name};
  stay.points = {Vec3(0.5, -1, 0), tip.position};
  m.joints.push_back(stay);
  return m;
}

// The steady state by matrices.
Unknowns answer(const Mechanism& m, const System& system) {
  Parameters parameters;
  Scaling scaling;
  bind(system, m, parameters);
  set_scaling(system, parameters, scaling);
  const Problem problem{system, parameters, scaling};
  Eigen::VectorXd start;
  drawn_configuration(system, parameters, start);
  Workspace w;
  Found found;
  std::vector<double> history;
  find_equilibrium(problem, start, false, false, w, history, found);
  REQUIRE(found.status == Status::converged);
  return found.z;
}

struct Corrected {
  ExtendedState state;
  ExtendedOutcome outcome;
  Eigen::VectorXd tangent;
};

// From the steady state of `m`, gravity and speed free, to where the first hinge is `by` further.
Corrected correct(const Mechanism& m, System& system, KktForm form, const Unknowns& z, double by) {
  system.kkt_form = form;
  const CoordinateInfo& hinge = free_coordinate(system, "hinge0");
  ExtendedBalance balance(
      system, m, {speed, gravity}, Eigen::Vector2d(4, 10),
      {coordinate_is(hinge, z.q[system.links[static_cast<std::size_t>(hinge.link)].q] + by)});
  Corrected out;
  out.state = {z, Eigen::Vector2d(6, -standard_gravity)};
  const Eigen::VectorXd fixed = Eigen::VectorXd::Unit(balance.unknowns(), balance.unknowns() - 1);
  out.outcome = balance.correct(out.state, fixed);
  REQUIRE(out.outcome.converged);
  out.tangent = balance.tangent(out.state, fixed);
  REQUIRE(out.tangent.size() == balance.unknowns());
  return out;
}

Corrected expect_same(const Mechanism& m, KktForm form, double by) {
  System system = compile(m);
  const Unknowns z = answer(m, system);
  const Corrected dense = correct(m, system, KktForm::dense, z, by),
                  eliminated = correct(m, system, form, z, by);
  CHECK((dense.state.parameters - eliminated.state.parameters).norm() < 1e-12);
  CHECK((dense.state.z.q - eliminated.state.z.q).lpNorm<Eigen::Infinity>() < 1e-12);
  CHECK((dense.tangent - eliminated.tangent).norm() < 1e-7);
  CHECK(eliminated.outcome.residual < 1e-13);
  return eliminated;
}

EquilibriumList search(const Mechanism& m, KktForm form, int starts) {
  const System system = compile(m);
  Parameters parameters;
  Scaling scaling;
  bind(system, m, parameters);
  set_scaling(system, parameters, scaling);
  const Problem problem{system, parameters, scaling, nullptr, form};
  Eigen::VectorXd drawn;
  drawn_configuration(system, parameters, drawn);
  Workspace w;
  EquilibriumList list = find_all_equilibria(problem, drawn, {.seconds = 1e3, .starts = starts}, w);
  // Whatever found them, each is one by matrices.
  const Problem whole{system, parameters, scaling};
  for (const Unknowns& found : list.states) {
    Unknowns z = found;
    factor_with_multipliers(whole, z, w);
    CHECK(scaled_residual(whole, w) < 1e-11);
  }
  return list;
}

// How many of `some` are among `others`.
int shared(const Mechanism& m, const EquilibriumList& some, const EquilibriumList& others) {
  const System system = compile(m);
  Parameters parameters;
  Scaling scaling;
  bind(system, m, parameters);
  set_scaling(system, parameters, scaling);
  const Problem problem{system, parameters, scaling};
  return static_cast<int>(std::ranges::count_if(some.states, [&](const Unknowns& a) {
    return std::ranges::any_of(others.states,
                               [&](const Unknowns& b) { return same_pose(problem, a.q, b.q, 1e-6); });
  }));
}

} // namespace

TEST_CASE("a coordinate is brought to its value by elimination as by matrices", "[forms]") {
  for (const double by : {0.01, -0.01}) {
    CAPTURE(by);
    const Corrected chain = expect_same(bench::springy_chain(30, 6, 0.3, 0), KktForm::tree, by);
    CHECK(chain.state.parameters[1] == -standard_gravity);
    expect_same(bench::binary_tree(15, 6), KktForm::tree, by / 5);
    expect_same(held_chain(20), KktForm::sparse, by);
  }
}

TEST_CASE("all equilibria of a chain on a shaft by elimination as by matrices", "[forms]") {
  // Rods on hinges without springs: every one of them stands up or hangs, so that the list is complete at 2^n
  // at rest.
  const Mechanism m = bench::chain(4, 0, 0);
  const EquilibriumList dense = search(m, KktForm::dense, 400), tree = search(m, KktForm::tree, 400),
                        sparse = search(m, KktForm::sparse, 400);
  CHECK(dense.states.size() == 16);
  CHECK(tree.states.size() == 16);
  CHECK(sparse.states.size() == 16);
  CHECK(shared(m, dense, tree) == 16);
  CHECK(shared(m, dense, sparse) == 16);
}

TEST_CASE("a search in a tree that is eliminated finds what matrices find", "[forms]") {
  const Mechanism m = bench::springy_chain(4, 8, 0.3, 0);
  const EquilibriumList dense = search(m, KktForm::dense, 600), tree = search(m, KktForm::tree, 600);
  CAPTURE(dense.states.size(), tree.states.size());
  CHECK(dense.states.size() >= 3);
  CHECK(shared(m, dense, tree) == static_cast<int>(dense.states.size()));
  CHECK(shared(m, tree, dense) == static_cast<int>(tree.states.size()));
}

TEST_CASE("a comparison's reference is known to rounding where the KKT matrix is eliminated", "[forms]") {
  const Mechanism m = bench::springy_chain(30, 3, 0.3, 1e-3);
  CompareOptions options;
  options.repeats = 1;
  options.durations = {1e-3};
  options.tolerances = {1e-3};
  const Comparison c = compare(m, options);
  CHECK(c.status == Status::converged);
  CHECK(c.reference_error < 1e-17);
  CHECK(c.reference_residual < 1e-16);
  CHECK(c.answer.error < 1e-13);
  // By matrices.
  const System system = compile(m);
  const Unknowns z = answer(m, system);
  REQUIRE(c.reference.size() > 30);
  for (const CoordinateInfo& info : system.coordinates) {
    const Link& link = system.links[static_cast<std::size_t>(info.link)];
    if (link.v < 0) continue;
    const std::string& name = system.tree_joints[static_cast<std::size_t>(info.tree_joint)].name;
    const auto x = std::ranges::find(c.reference, name, &CoordinateSolution::joint);
    REQUIRE(x != c.reference.end());
    CHECK(std::abs(x->value - z.q[link.q]) < 1e-12);
  }
}

namespace {

// The fold near a speed with these coordinates, at this gravity, and the direction of its curve over both.
Corrected fold(const Mechanism& m, System& system, KktForm form, double at, double pull,
               const std::vector<CoordinateSolution>& coordinates) {
  system.kkt_form = form;
  ExtendedBalance balance(system, m, {speed, gravity}, Eigen::Vector2d(4, 10), {balance_is_singular()});
  Corrected out;
  out.state.parameters = Eigen::Vector2d(at, pull);
  balance.set(out.state);
  out.state.z.q = configuration_of(balance.problem(), coordinates);
  balance.set_borders(out.state);
  const Eigen::VectorXd fixed = Eigen::VectorXd::Unit(balance.unknowns(), balance.unknowns() - 1);
  out.outcome = balance.correct(out.state, fixed);
  REQUIRE(out.outcome.converged);
  out.tangent = balance.tangent(out.state, fixed);
  REQUIRE(out.tangent.size() == balance.unknowns());
  return out;
}

// Of the branch of the drawn pose, and of those of what is found at `to` where it is `all`.
int folds_agree(const Mechanism& m, KktForm form, double from, double to, bool all) {
  BranchOptions options;
  options.all = all;
  options.all_at = {to};
  options.eigenvalues = false;
  const ResponseDiagram d = follow_branches(m, speed, from, to, options);
  REQUIRE(d.status == Status::converged);
  System system = compile(m);
  int folds = 0;
  for (const SpecialPoint& point : d.special) {
    if (point.type != SpecialPointType::fold || folds == 4) continue;
    CAPTURE(point.at.parameter);
    const auto by = [&](KktForm which) {
      return fold(m, system, which, point.at.parameter, -standard_gravity, point.at.coordinates);
    };
    const Corrected dense = by(KktForm::dense), other = by(form);
    CHECK(std::abs(dense.state.parameters[0] - point.at.parameter) < 1e-6);
    CHECK((dense.state.parameters - other.state.parameters).norm() < 1e-10);
    CHECK((dense.state.z.q - other.state.z.q).lpNorm<Eigen::Infinity>() < 1e-8);
    CHECK((dense.tangent - other.tangent).norm() < 1e-5);
    ++folds;
  }
  return folds;
}

} // namespace

TEST_CASE("ExtendedBalance: folds by elimination are those by matrices", "[forms]") {
  CHECK(folds_agree(bench::springy_chain(12, 6, 0.1, 0), KktForm::tree, 7, 10, true) >= 2);
  CHECK(folds_agree(held_chain(9), KktForm::sparse, 3, 12, false) > 0);
}

TEST_CASE("fold_curves: a chain's, along a tree, end where matrices have the fold", "[forms]") {
  // Of the short one more branches than are followed are found at 7 rad/s already; the fold is of one that is
  // not there yet.
  const bool is_short = GENERATE(false, true);
  const Mechanism m = bench::springy_chain(is_short ? 12 : 40, 6, 0.1, 0);
  PlaneOptions options;
  options.max_curves = 1;
  options.all = true;
  options.at = {-standard_gravity};
  const PlaneCurves plane = fold_curves(m, is_short ? PlaneAxis{speed, 7, 10} : PlaneAxis{speed, 4, 5},
                                        {gravity, -10, -9}, options);
  INFO(plane.message);
  REQUIRE(plane.curves.size() == 1);
  System system = compile(m);
  REQUIRE(system.kkt_form == KktForm::tree);
  for (const PlanePoint* end : {&plane.curves[0].points.front(), &plane.curves[0].points.back()}) {
    CAPTURE(end->x, end->y);
    const Corrected there = fold(m, system, KktForm::dense, end->x, end->y, end->coordinates);
    CHECK(std::abs(there.state.parameters[0] - end->x) < 1e-9);
  }
}
