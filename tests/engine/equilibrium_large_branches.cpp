// Branches of mechanisms that are eliminated: the same as by dense matrices, and closed forms at sizes that
// dense matrices do not reach.
#include "tests/bench/large_scenes.hpp"
#include "tests/engine/equilibrium_mechanisms.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/support/campaign.hpp"

#include "engine/continuation/branches.hpp"
#include "engine/continuation/continuation.hpp"
#include "engine/kkt/configuration_difference.hpp"
#include "engine/search/find_equilibrium.hpp"
#include "engine/solve/existence.hpp"

using namespace flyball;
using namespace flyball::test;
namespace ref = flyball::reference;

namespace {

const std::string speed = "joints.spin.drive.speed";

std::vector<const SpecialPoint*> of_type(const ResponseDiagram& d, SpecialPointType type) {
  std::vector<const SpecialPoint*> out;
  for (const SpecialPoint& s : d.special)
    if (s.type == type) out.push_back(&s);
  return out;
}

BranchOptions forced(bool eliminated) {
  BranchOptions o;
  o.dense_up_to = eliminated ? 0 : std::numeric_limits<int>::max();
  return o;
}

// Largest difference of two points in the parameter (over its range) and the coordinates.
double apart(const ResponsePoint& a, const ResponsePoint& b, double range) {
  double most = std::abs(a.parameter - b.parameter) / range;
  REQUIRE(a.coordinates.size() == b.coordinates.size());
  for (std::size_t i = 0; i < a.coordinates.size(); ++i)
    most = std::max(most, std::abs(a.coordinates[i].value - b.coordinates[i].value));
  return most;
}

struct Compared {
  int branches = 0, folds = 0, crossings = 0, told = 0, untold = 0;
};

// Follows one branch both ways and expects the same, but for points where a stability is not told at all.
Compared expect_same_branch(const Mechanism& m, const std::string& address, double from, double to) {
  ResponseDiagram by[2];
  for (const bool eliminated : {false, true}) {
    BranchOptions options = forced(eliminated);
    options.switch_branches = false;
    options.max_points = 400;
    by[eliminated] = follow_branches(m, address, from, to, options);
  }
  Compared out;
  INFO(by[0].message << " " << by[1].message);
  CHECK(by[0].status == by[1].status);
  REQUIRE(by[0].branches.size() == by[1].branches.size());
  const double range = std::abs(to - from);
  for (std::size_t b = 0; b < by[0].branches.size(); ++b) {
    const auto &dense = by[0].branches[b].points, &eliminated = by[1].branches[b].points;
    CHECK(by[0].branches[b].end == by[1].branches[b].end);
    REQUIRE(dense.size() == eliminated.size());
    ++out.branches;
    for (std::size_t i = 0; i < dense.size(); ++i) {
      CAPTURE(b, i, dense[i].parameter);
      CHECK(apart(dense[i], eliminated[i], range) < 1e-7);
      if (eliminated[i].stable) CHECK(eliminated[i].stable == dense[i].stable);
      ++(eliminated[i].stable ? out.told : out.untold);
      CHECK(eliminated[i].eigenvalues.empty());
    }
  }
  for (const SpecialPointType type : {SpecialPointType::fold, SpecialPointType::branch_point}) {
    const auto dense = of_type(by[0], type), eliminated = of_type(by[1], type);
    REQUIRE(dense.size() == eliminated.size());
    // Beside a crossing states are known to the root of rounding, where the null direction is not exact.
    const double known = (type == SpecialPointType::fold ? 1e-9 : 1e-6) * range;
    for (std::size_t i = 0; i < dense.size(); ++i) {
      CHECK(std::abs(dense[i]->at.parameter - eliminated[i]->at.parameter) < known);
      // Half the digits of the parameter at a fold.
      CHECK(apart(dense[i]->at, eliminated[i]->at, range) < 1e-4);
      ++(type == SpecialPointType::fold ? out.folds : out.crossings);
    }
  }
  return out;
}

// A hub with arms of two rods each, `fanned` of them leaning in at first: each has a fold of its own.
Mechanism arms(int count, int leaning, double spring) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {spindle()};
  m.joints = {spin(10)};
  for (int i = 0; i < count; ++i) {
    const std::string upper = "upper" + std::to_string(i), lower = "lower" + std::to_string(i);
    const double offset = 0.1 + 0.01 * i, lean = i < leaning ? -1.2 : 1.2, length = 0.35;
    const Vec3 at{offset, 0, 0}, way = length * Vec3(std::sin(lean), -std::cos(lean), 0);
    m.bodies.push_back(body(upper, 0.2, at + way));
    m.bodies.push_back(body(lower, 1, at + 2 * way));
    m.joints.push_back(joint(JointType::revolute, "hinge" + upper, "spindle", upper, at));
    m.joints.push_back(sprung(joint(JointType::revolute, "hinge" + lower, upper, lower, at + way), spring));
  }
  return m;
}

// Two chains side by side that hang from a hub, the first `offset` off its axis, with rungs between them:
// distance joints or springs.
Mechanism ladder(int rungs, double offset, bool loops) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {spindle()};
  m.joints = {spin(0)};
  const double length = 1. / rungs, mass = length, inertia = mass * length * length / 12, width = 0.1;
  for (int i = 0; i < rungs; ++i) {
    std::array<Vec3, 2> ends;
    for (int side : {0, 1}) {
      const std::string name = (side == 0 ? "left" : "right") + std::to_string(i);
      const double x = offset - width / 2 + side * width;
      m.bodies.push_back(body(name, mass, {x, -(i + 0.5) * length, 0}, {inertia, 0, inertia}));
      m.joints.push_back(sprung(
          joint(JointType::revolute, "hinge" + name,
                i == 0 ? "spindle" : name.substr(0, name.find(std::to_string(i))) + std::to_string(i - 1),
                name, {x, -i * length, 0}),
          0.02));
      ends[static_cast<std::size_t>(side)] = {x, -(i + 1) * length, 0};
    }
    const std::array<std::string, 2> between{"left" + std::to_string(i), "right" + std::to_string(i)};
    if (loops) {
      Joint rung;
      rung.name = "rung" + std::to_string(i);
      rung.type = JointType::distance;
      rung.bodies = between;
      rung.points = ends;
      m.joints.push_back(rung);
    } else {
      Force rung;
      rung.name = "rung" + std::to_string(i);
      rung.type = ForceType::spring;
      rung.bodies = between;
      rung.points = ends;
      rung.stiffness = 50;
      rung.free_length = width;
      m.forces.push_back(rung);
    }
  }
  return m;
}

// One system's steady state continued with its equations solved both ways.
struct BothWays {
  Mechanism mechanism;
  System system;
  std::string address;
  Family dense, eliminated;

  BothWays(Mechanism m, KktForm form, std::string parameter, double scale)
      : mechanism(std::move(m)), system(compile(mechanism)), address(std::move(parameter)),
        dense(system, mechanism, address, scale, KktForm::dense),
        eliminated(forced_system(form), mechanism, address, scale, form) {}

 private:
  const System& forced_system(KktForm form) {
    system.kkt_form = form;
    return system;
  }
};

struct Followed {
  int steps = 0, turned = 0, refused = 0;
};

// Steps from a state both ways along the same lengths, and compares states, tangents and the determinant.
Followed follow_both(BothWays& x, const Unknowns& z, double parameter) {
  Followed out;
  Continuation dense(x.dense), eliminated(x.eliminated);
  BranchState a{z, parameter, {}, 0, 0}, b = a;
  const bool started = dense.start(a, 1);
  // Trees without row exchanges may meet a pivot of zero in a regular balance, and redundant loops may be
  // taken for stiffness: better no step than a wrong one.
  if (started && !eliminated.start(b, 1)) {
    out.refused = 1;
    return out;
  }
  for (int i = 0; i < 12 && started; ++i) {
    CAPTURE(i, a.determinant, b.determinant, x.system.nv, x.system.rows);
    CHECK((a.tangent - b.tangent).norm() < 1e-6);
    // Neither is known near zero.
    if (std::abs(a.determinant) > 1e-9) CHECK((a.determinant > 0) == (b.determinant > 0));
    BranchState next, other;
    int iterations[2];
    const bool arrives = dense.step(a, 0.02, next, iterations[0]);
    if (!arrives || std::abs(a.determinant) < 1e-9) break;
    if (!(next.tangent.dot(a.tangent) > 0.97)) break;
    if (!eliminated.step(b, 0.02, other, iterations[1])) {
      out.refused = 1;
      break;
    }
    if (next.turning * a.turning < 0) ++out.turned;
    CHECK(std::abs(next.parameter - other.parameter) < 1e-7 * x.dense.scale());
    CHECK(same_pose(x.dense.problem(), next.z.q, other.z.q, 1e-7));
    CHECK(std::abs(iterations[0] - iterations[1]) <= 2);
    a = std::move(next);
    b = std::move(other);
    ++out.steps;
  }
  return out;
}

Followed follow_random(const ref::RandomOptions& options, std::uint32_t seeds, KktForm form) {
  Followed all;
  for (std::uint32_t seed = 1; seed <= seeds; ++seed) {
    CAPTURE(seed);
    Mechanism m = ref::random_mechanism(seed, options);
    const auto drive = std::ranges::find_if(m.joints, [](const Joint& j) {
      return std::ranges::any_of(j.coordinates, [](const Coordinate& c) { return c.drive.has_value(); });
    });
    if (drive == m.joints.end() || drive->coordinates.size() != 1) continue;
    const double rate = drive->coordinates[0].drive->speed;
    BothWays x(m, form, "joints." + drive->name + ".drive.speed", 10);
    if (x.system.nv < 2 || !no_drive_rides(x.system)) continue;
    if (form == KktForm::tree && !is_plain_tree(x.system)) continue;
    const Problem problem = x.dense.problem();
    Workspace w;
    Found found;
    std::vector<double> history;
    Eigen::VectorXd start;
    drawn_configuration(problem.system, problem.parameters, start);
    find_equilibrium(problem, start, false, false, w, history, found);
    if (found.status != Status::converged ||
        !check_existence(problem, found.z.q, sample_phases(problem.system, problem.parameters, found.z.q), w)
             .holds)
      continue;
    evaluate(problem, found.z, 0, w);
    factor(problem, found.z, w);
    // Where nothing resists a direction there is no single tangent.
    if (w.kkt(problem).singular() || w.dense.hessian().condition() > 1e9) continue;
    const Followed one = follow_both(x, found.z, rate);
    all.steps += one.steps;
    all.turned += one.turned;
    all.refused += one.refused;
  }
  CHECK(50 * all.refused < all.steps);
  return all;
}

} // namespace

TEST_CASE("eliminated along the tree, random branches go where the dense equations lead", "[branches]") {
  ref::RandomOptions options;
  options.bodies = 6;
  options.conservative = true;
  options.stops = false;
  const Followed f = follow_random(options, 150, KktForm::tree);
  CHECK(f.steps > 200);
}

TEST_CASE("as sparse equations of loops, random branches go where the dense ones lead", "[branches]") {
  ref::RandomOptions options;
  options.bodies = 6;
  options.loops = 2;
  options.conservative = true;
  options.stops = false;
  const std::uint32_t seeds = few_or_all(60u, 200u);
  const Followed f = follow_random(options, seeds, KktForm::sparse);
  options.parallel_axes = true; // redundant loops
  const Followed redundant = follow_random(options, seeds, KktForm::sparse);
  CHECK(f.steps > static_cast<int>(seeds / 2));
  CHECK(redundant.steps > static_cast<int>(seeds / 4));
}

TEST_CASE("a branch of a chain or a tree is the same by elimination", "[branches]") {
  Compared all;
  const auto add = [&](const Compared& c) {
    all.folds += c.folds;
    all.crossings += c.crossings;
    all.told += c.told;
    all.untold += c.untold;
  };
  add(expect_same_branch(bench::chain(20, 0, 0), speed, 0, 15));
  add(expect_same_branch(bench::springy_chain(25, 0, 0.3, 0), speed, 0.5, 3.5));
  add(expect_same_branch(bench::springy_chain(15, 0, 0.3, 1e-3), speed, 0.5, 3.5));
  add(expect_same_branch(bench::binary_tree(15, 0), speed, 0, 8));
  add(expect_same_branch(arms(5, 1, 2), speed, 10, 1));
  add(expect_same_branch(arms(6, 3, 20), speed, 10, 1));
  CHECK(all.folds >= 2);
  CHECK(all.crossings >= 3);
  CHECK(all.told > 10 * all.untold);
}

TEST_CASE("a branch of a ladder of loops or springs is the same by elimination", "[branches]") {
  Compared all;
  for (const auto& [loops, offset] : {std::pair(true, 0.), {false, 0.15}, {true, 0.15}, {false, 0.}}) {
    if (!in_campaign() && loops != (offset == 0)) continue;
    const Compared c = expect_same_branch(ladder(32, offset, loops), speed, 0.5, 9);
    all.crossings += c.crossings;
    all.told += c.told;
  }
  CHECK(all.crossings >= few_or_all(1, 2));
  CHECK(all.told > 100);
}

TEST_CASE("branches off a crossing of an eliminated mechanism", "[branches]") {
  ResponseDiagram by[2];
  for (const bool eliminated : {false, true})
    by[eliminated] = follow_branches(bench::chain(12, 0, 0), speed, 0, 10, forced(eliminated));
  INFO(by[1].message);
  CHECK(by[1].branches.size() == by[0].branches.size());
  CHECK(by[1].branches.size() == 5);
  CHECK_THAT(by[1].message, ContainsSubstring("was not looked for"));
  // Either end first.
  for (const ResponseBranch& b : by[1].branches)
    CHECK(std::ranges::any_of(by[0].branches, [&](const ResponseBranch& other) {
      return apart(b.points.back(), other.points.back(), 10) < 1e-7 &&
             b.points.back().stable == other.points.back().stable;
    }));
}

TEST_CASE("a hanging chain of a thousand rods leaves the vertical where it should", "[branches]") {
  // Of rods of length l and mass m whose ends are x_i off the axis: half of m g l sum (n - i - 1/2) a_i^2
  // less half of w^2 m / 3 sum (x_i^2 + x_i x_i+1 + x_i+1^2), a_i = (x_i+1 - x_i) / l, is singular. Both
  // matrices have three diagonals; the number of negative pivots counts the crossings below w (Sturm).
  constexpr int n = 1000;
  const auto crossings_below = [&](double w) {
    const double l = 1. / n;
    int negative = 0;
    double pivot = 1, off = 0;
    for (int i = 1; i <= n; ++i) { // ends; rod i - 1 is above end i
      const auto tension = [&](int rod) { return standard_gravity * (n - rod - 0.5) / l; };
      const bool last = i == n;
      const double diagonal = tension(i - 1) + (last ? 0 : tension(i)) - w * w / 3 * (last ? 1 : 2);
      pivot = diagonal - (i == 1 ? 0 : off * off / pivot);
      if (pivot < 0) ++negative;
      if (!last) off = -tension(i) - w * w / 6;
    }
    return negative;
  };
  BranchOptions options;
  options.switch_branches = false;
  const ResponseDiagram d = follow_branches(bench::chain(n, 0, 0), speed, 0, 15, options);
  const auto found = of_type(d, SpecialPointType::branch_point);
  REQUIRE(found.size() == 3);
  CHECK(crossings_below(15) == 3);
  for (int k = 0; k < 3; ++k) {
    double low = 0, high = 15;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      (crossings_below(middle) > k ? high : low) = middle;
    }
    CHECK(std::abs(found[static_cast<std::size_t>(k)]->at.parameter - low) < 1e-8);
  }
  // One way to fall, two, three: the chain moves in the plane, in which there are no Coriolis forces.
  for (const ResponsePoint& p : d.branches[0].points)
    CHECK(p.stable == (p.parameter < found[0]->at.parameter));
}

TEST_CASE("one pendulum of three hundred folds where it does alone", "[branches]") {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {spindle()};
  m.joints = {spin(10)};
  for (int i = 0; i < 300; ++i) {
    const double offset = 0.1 + 0.001 * i, lean = i == 0 ? -1.3 : 1.3;
    const std::string name = "bob" + std::to_string(i);
    m.bodies.push_back(body(name, 1, {offset + 0.7 * std::sin(lean), -0.7 * std::cos(lean), 0}));
    m.joints.push_back(
        joint(JointType::revolute, "swing" + std::to_string(i), "spindle", name, {offset, 0, 0}));
  }
  BranchOptions options;
  options.switch_branches = false;
  const ResponseDiagram d = follow_branches(m, speed, 10, 0, options);
  INFO(d.message);
  const auto folds = of_type(d, SpecialPointType::fold);
  REQUIRE(folds.size() == 1);
  CHECK(std::abs(folds[0]->at.parameter - 4.75536807929276) < 1e-8);
  CHECK(of_type(d, SpecialPointType::branch_point).empty());
  CHECK(std::abs(d.branches[0].points.back().parameter - 10) < 1e-12);
  CHECK(d.branches[0].points.front().stable == true);
  CHECK(d.branches[0].points.back().stable == false);
}
