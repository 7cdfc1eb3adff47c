// Loops that hold more than they need to, and fit almost: misaligned by 1e-3 to 1e-15.
#include "tests/stress/numbers.hpp"
#include "tests/stress/verdict.hpp"

#include "tests/support/mechanisms.hpp"

namespace flyball::stress {
namespace {

using namespace flyball::test;

// A four-bar closed by a revolute joint, five equations of which two are needed; one axis askew.
Mechanism four_bar(double askew) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  const Vec3 a{0, 0, 0}, b{0.2, -1, 0}, c{1.3, -0.8, 0}, d{1, 0, 0};
  m.bodies = {body("crank", 1, (a + b) / 2, {0.1, 0.1, 0.1}),
              body("coupler", 2, (b + c) / 2, {0.1, 0.1, 0.1}),
              body("rocker", 1, (c + d) / 2, {0.1, 0.1, 0.1})};
  m.joints = {revolute("crank", "ground", "crank", a, {0, 0, 1}),
              revolute("knee", "crank", "coupler", b, {0, 0, 1}),
              revolute("wrist", "coupler", "rocker", c, {askew, 0, 1}),
              revolute("rocker", "ground", "rocker", d, {0, 0, 1})};
  return m;
}

// A plate on three parallel cranks, one of them longer by `misfit`: two would do.
Mechanism three_cranks(double misfit) {
  Mechanism m;
  m.gravity = {0, -standard_gravity, 0};
  const Vec3 arm{0.6, -0.8, 0};
  m.bodies = {body("plate", 2, Vec3(1, 0, 0) + arm, {0.1, 0.1, 0.1})};
  m.joints.clear();
  for (int i = 0; i < 3; ++i) {
    const std::string name = "crank" + std::to_string(i + 1);
    const Vec3 top{static_cast<double>(i), i == 2 ? misfit : 0, 0};
    const Vec3 foot = Vec3(static_cast<double>(i), 0, 0) + arm;
    m.bodies.push_back(body(name, 1, (top + foot) / 2, {0.05, 0.05, 0.05}));
    m.joints.push_back(revolute(name, "ground", name, top, {0, 0, 1}));
    m.joints.push_back(revolute("foot" + std::to_string(i + 1), name, "plate", foot, {0, 0, 1}));
  }
  return m;
}

// Two strings side by side to nearly the same point.
Mechanism two_strings(double apart) {
  Mechanism m;
  m.gravity = {0.3, -standard_gravity, 0.1};
  m.bodies = {body("ball", 1, {0.3, -0.6, 0.2}, {0.01, 0.02, 0.03})};
  m.joints = {distance("one", "ground", "ball", {0, 0, 0}, {0.3, -0.5, 0.2}),
              distance("two", "ground", "ball", {apart, 0, 0}, {0.3, -0.5, 0.2})};
  return m;
}

} // namespace

void add_redundant_cases(const CaseChoice& choice, Cases& cases) {
  std::vector<double> misfits = decades(-15, -3, 1, choice.thinned);
  misfits.push_back(0);
  for (const double x : misfits) {
    // What is aligned to the last digits is a mechanism to anybody.
    const bool must = x < 1e-14;
    cases.push_back(
        solve_case("nearly redundant", "four-bar askew " + digits(x), four_bar(x), {.must = must}));
    cases.push_back(
        solve_case("nearly redundant", "three cranks misfit " + digits(x), three_cranks(x), {.must = must}));
    cases.push_back(
        solve_case("nearly redundant", "two strings apart " + digits(x), two_strings(x), {.must = must}));
  }
}

} // namespace flyball::stress
