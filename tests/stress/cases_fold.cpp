// Parameters exactly at folds and branch points, and a hair beside them.
#include "tests/stress/numbers.hpp"
#include "tests/stress/scenes.hpp"
#include "tests/stress/verdict.hpp"

#include "tests/support/mechanisms.hpp"

#include "engine/continuation/branches.hpp"
#include "engine/mechanism/address.hpp"

#include <limits>

namespace flyball::stress {
namespace {

using namespace flyball::test;

// A change of the parameter that cannot be told from none at a branch point, where the stiffness goes with
// it.
constexpr double hair = 1e-14;

const std::vector<double>& asides() {
  static const std::vector<double> values{0,    1e-16, -1e-16, 1e-14, -1e-14, 1e-12, -1e-12,
                                          1e-9, -1e-9, 1e-6,   -1e-6, 1e-3,   -1e-3};
  return values;
}

void add_conical(Cases& cases) {
  for (const double length : {0.7, 1e-6, 1e6}) {
    const double critical = std::sqrt(standard_gravity / length);
    for (const double aside : asides())
      for (const double start : {0., 1e-3, 0.5}) {
        SolveOptions from;
        from.start = {{"swing", start}};
        cases.push_back(
            solve_case("folds and branch points",
                       "conical " + digits(length) + " aside " + digits(aside) + " from " + digits(start),
                       conical(length, 0, critical * (1 + aside)),
                       {.must = true, .half_digits = std::abs(aside) < hair}, from));
      }
  }
}

// The far-side states of a pendulum hinged off the axis meet at this speed and angle.
void add_offset_hinge(Cases& cases) {
  const double speed = 4.75536807929276;
  const long double length = 0.7L, offset = 0.1L;
  const auto slope = [&](long double p) {
    return 1 / (std::sin(p) * std::cos(p)) - length * std::cos(p) / (length * std::sin(p) - offset);
  };
  long double low = std::asin(offset / length) + 1e-6L, high = 1.5L;
  for (int i = 0; i < 100; ++i) {
    const long double middle = (low + high) / 2;
    ((slope(middle) > 0) == (slope(high) > 0) ? high : low) = middle;
  }
  const auto at = static_cast<double>(-low);
  for (const double aside : asides()) {
    SolveOptions from;
    from.nearest = true;
    from.start = {{"swing", at}};
    const bool on = std::abs(aside) < 1e-15; // the speed is known to 15 digits
    cases.push_back(solve_case("folds and branch points", "offset hinge aside " + digits(aside),
                               conical(0.7, 0.1, speed * (1 + aside)),
                               {.half_digits = on, .known = {{"swing", at}}}, from));
    from.nearest = false;
    cases.push_back(solve_case("folds and branch points", "offset hinge, stable, aside " + digits(aside),
                               conical(0.7, 0.1, speed * (1 + aside)),
                               {.must = true, .half_digits = on, .known = {{"swing", at}}}, from));
  }
}

// Where the engine's own branches say that two states of a scene meet.
void add_found(const std::string& name, const std::string& address, double from, double to, Cases& cases) {
  const auto scene = std::ranges::find(shipped_scenes(), name, &NamedScene::name);
  const ResponseDiagram diagram = follow_branches(scene->mechanism, address, from, to);
  int number = 0;
  for (const SpecialPoint& point : diagram.special) {
    if (point.type != SpecialPointType::fold && point.type != SpecialPointType::branch_point) continue;
    ++number;
    for (const double aside : {0., 1e-9, -1e-9, 1e-4, -1e-4})
      for (const bool nearest : {true, false}) {
        Mechanism m = scene->mechanism;
        set_parameter(m, address, point.at.parameter * (1 + aside));
        SolveOptions options;
        options.nearest = nearest;
        options.start = start_values(point.at.coordinates);
        Expectation e;
        if (nearest && aside == 0) e = {.half_digits = true, .known = options.start};
        cases.push_back(solve_case("folds and branch points",
                                   name + " " + std::string(word(point.type)) + " " + std::to_string(number) +
                                       " at " + digits(point.at.parameter) + " aside " + digits(aside) +
                                       (nearest ? " nearest" : ""),
                                   m, e, options));
      }
  }
}

} // namespace

void add_fold_cases(const CaseChoice& choice, Cases& cases) {
  add_conical(cases);
  add_offset_hinge(cases);
  add_found("governor", "joints.spin.drive.speed", 0, 30, cases);
  if (choice.thinned) return;
  add_found("pendulum", "joints.spin.drive.speed", 0, 40, cases);
  add_found("watt_governor", "joints.spin.drive.speed", 0, 30, cases);
}

} // namespace flyball::stress
