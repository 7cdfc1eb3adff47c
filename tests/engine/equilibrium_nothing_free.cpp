// Mechanisms whose coordinates are all driven, or that have none: every analysis answers or says why not.
#include "tests/engine/equilibrium_mechanisms.hpp"

#include "engine/continuation/branches.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

// A body welded to a turning one and strung to it: closed where the string is as long as the way it spans.
Mechanism welded_arm(double string) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  m.bodies = {spindle(), body("arm", 1, {0.2, 0, 0})};
  m.joints = {spin(5), joint(JointType::fixed, "weld", "spindle", "arm", {0.1, 0, 0}),
              distance("string", "spindle", "arm", {0, 0.1, 0}, {0.2, 0, 0}, string)};
  return m;
}

// Two driven joints that a third closes to a loop.
Mechanism driven_loop(double offset) {
  Mechanism m;
  m.bodies = {body("a", 1, {0.5, 0, 0}), body("b", 1, {0.5, 1, 0})};
  m.joints = {driven(revolute("first", "ground", "a", {0, 0, 0}, {0, 0, 1}), 1),
              driven(revolute("second", "ground", "b", {0, 1, 0}, {0, 0, 1}), 1),
              distance("rod", "a", "b", {1, 0, 0}, {1, 1, 0}, 1 + offset)};
  return m;
}

void check_answers(const Mechanism& m, bool closed) {
  Analysis analysis(m);
  for (const bool nearest : {false, true}) {
    SolveOptions options;
    options.nearest = nearest;
    const Solution s = analysis.solve(options);
    INFO(s.message);
    CHECK((s.status == Status::converged) == closed);
    CHECK_FALSE(s.message.empty());
    CHECK(analysis.modes().empty());
    if (closed) CHECK(s.stable == true);
  }
  const AllSolutions all = analysis.solve_all();
  INFO(all.message);
  CHECK(all.equilibria.size() == (closed ? 1 : 0));
  CHECK_FALSE(all.message.empty());
}

void check_branches(const Mechanism& m, const std::string& address, double from, double to) {
  for (const bool all : {false, true}) {
    BranchOptions options;
    options.all = all;
    const ResponseDiagram d = follow_branches(m, address, from, to, options);
    CHECK_FALSE(d.message.empty());
    for (const ResponseBranch& b : d.branches)
      CHECK_FALSE(b.points.empty());
  }
}

} // namespace

TEST_CASE("a mechanism without free coordinates is solved, or refused in words", "[nothing_free]") {
  check_answers(stored_case("brace_of_wrong_length"), false);
  check_answers(stored_case("welded_and_strung"), false);
  check_answers(stored_case("turned_and_strung"), false);
  check_answers(welded_arm(std::hypot(0.1, 0.2)), true);
  check_answers(welded_arm(0.5), false);
  check_answers(driven_loop(0), true);
  check_answers(driven_loop(0.1), false);
  // No joint at all to count, and one that is driven.
  Mechanism m = welded_arm(0.5);
  m.joints.pop_back();
  check_answers(m, true);
  m.joints[0] = joint(JointType::fixed, "base", "ground", "spindle", {0, 0, 0});
  check_answers(m, true);
}

TEST_CASE("branches of a mechanism without free coordinates", "[nothing_free]") {
  check_branches(stored_case("brace_of_wrong_length"), "joints.spin.drive.speed", 0, 10);
  check_branches(stored_case("turned_and_strung"), "bodies.b.mass", 1, 2);
  check_branches(welded_arm(std::hypot(0.1, 0.2)), "joints.spin.drive.speed", 0, 10);
  check_branches(welded_arm(0.5), "bodies.arm.mass", 2, 1);
  check_branches(driven_loop(0), "bodies.a.mass", 1, 3);
}
