// Mechanisms in parts against the same as a whole.
#include "tests/catch.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/engine/system_model.hpp"

#include "tests/bench/large_scenes.hpp"

#include <algorithm>
#include <stdexcept>

using namespace flyball;
using namespace flyball::testing;

namespace {

struct Values {
  Kinematics<double> kinematics;
  Residual<double> residual;
  Magnitudes magnitudes;
  Eigen::VectorXd phi;
};

Values values_of(const System& system, const Parameters& p, const Eigen::VectorXd& q,
                 const Eigen::VectorXd& lambda) {
  Values v;
  forward<double>(system, p, q, 0.1, v.kinematics);
  evaluate_residual<double>(system, p, q, lambda, v.kinematics, v.residual);
  evaluate_magnitudes(system, p, q, lambda, v.kinematics, v.magnitudes);
  evaluate_constraints<double>(system, p, q, v.kinematics, v.phi);
  return v;
}

Eigen::VectorXd drawn_of(const System& system, const Parameters& p) {
  Eigen::VectorXd q;
  drawn_configuration(system, p, q);
  return q;
}

// Each link once, behind those it hangs from or on the spine; each element once, where all that it moves is.
void check_cover(const System& system) {
  const Division& division = system.division;
  std::size_t next = division.spine;
  for (std::size_t i = 0; i < next; ++i)
    CHECK_FALSE(system.links[i].mobile);
  std::vector<int> springs(system.springs.size()), cuts(system.cuts.size()),
      forces(system.body_forces.size());
  const auto count = [](std::vector<int>& times, const std::vector<int>& elements) {
    for (const int i : elements)
      ++times[static_cast<std::size_t>(i)];
  };
  const auto moves_within = [](const Support& support, const SystemPart& part) {
    return std::ranges::all_of(support, [&](const SupportColumn& c) {
      return static_cast<std::size_t>(c.link) >= part.first && static_cast<std::size_t>(c.link) < part.last;
    });
  };
  for (const SystemPart& part : division.parts) {
    CHECK(part.first == next);
    next = part.last;
    for (std::size_t i = part.first; i < part.last; ++i)
      if (const int parent = system.links[i].parent; parent >= static_cast<int>(division.spine))
        CHECK(parent >= static_cast<int>(part.first));
    for (const int i : part.springs)
      CHECK(moves_within(system.springs[static_cast<std::size_t>(i)].ends.support, part));
    for (const int i : part.cuts)
      CHECK(moves_within(system.cuts[static_cast<std::size_t>(i)].ends.support, part));
    count(springs, part.springs);
    count(cuts, part.cuts);
    count(forces, part.body_forces);
  }
  CHECK(next == system.links.size());
  count(springs, division.between.springs);
  count(cuts, division.between.cuts);
  count(forces, division.between.body_forces);
  for (const std::vector<int>* times : {&springs, &cuts, &forces})
    CHECK(std::ranges::count(*times, 1) == static_cast<std::ptrdiff_t>(times->size()));
}

} // namespace

TEST_CASE("a mechanism in parts balances as the whole does") {
  int divided = 0, between = 0, on_spine = 0;
  for (std::uint32_t seed = 1; seed <= 1000; ++seed) {
    reference::RandomOptions options;
    options.bodies = 9;
    options.loops = static_cast<int>(seed % 4);
    options.drives = seed % 3 == 0 ? reference::RandomDrives::several : reference::RandomDrives::root;
    const Model model(reference::random_mechanism(seed, options));
    if (model.system.nv == 0) continue;
    System parts = model.system;
    parts.division = divide(parts, 2);
    if (parts.division.parts.size() < 2) continue;
    CAPTURE(seed);
    check_cover(parts);
    ++divided;
    between += !parts.division.between.springs.empty() || !parts.division.between.cuts.empty();
    on_spine += parts.division.spine > 0;

    Dice dice(seed);
    const Eigen::VectorXd q = model.displaced(dice, 0.3);
    Eigen::VectorXd lambda(parts.rows);
    for (double& x : lambda)
      x = dice.between(-100, 100);
    const Values a = values_of(model.system, model.parameters, q, lambda),
                 b = values_of(parts, model.parameters, q, lambda);
    const auto size = a.magnitudes.force.array();
    CHECK(((a.residual.f - b.residual.f).array().abs() <= 1e-13 * size + 1e-300).all());
    CHECK(((b.magnitudes.force.array() - size).abs() <= 1e-13 * size).all());
    CHECK(a.residual.phi == b.residual.phi);
    CHECK(a.phi == b.phi);
    CHECK(a.magnitudes.phi == b.magnitudes.phi);
    for (std::size_t l = 0; l < parts.links.size(); ++l) {
      CHECK((a.residual.force[l] - b.residual.force[l]).norm() <= 1e-13 * a.magnitudes.link_force[l]);
      CHECK((a.residual.moment[l] - b.residual.moment[l]).norm() <= 1e-13 * a.magnitudes.link_moment[l]);
      CHECK(std::abs(b.magnitudes.link_force[l] - a.magnitudes.link_force[l]) <=
            1e-13 * a.magnitudes.link_force[l]);
    }
  }
  CHECK(divided > 100);
  CHECK(between > 80);
  CHECK(on_spine > 80);
}

TEST_CASE("large nets are divided, chains and small mechanisms are not") {
  for (const auto& [mechanism, parts] :
       {std::pair(bench::spring_net(20, 1), 1), std::pair(bench::chain(9000, 1), 1),
        std::pair(bench::spring_net(46, 1), 2), std::pair(bench::cable_net(65, 1), 4)}) {
    const System system = compile(mechanism);
    CHECK(system.division.parts.size() == static_cast<std::size_t>(parts));
    check_cover(system);
    // Crossing elements come one by one: they must be few.
    CHECK(10 * (system.division.between.springs.size() + system.division.between.cuts.size()) <
          system.springs.size() + system.cuts.size() + 1);
  }
}

// Threads take the parts in any order.
TEST_CASE("a mechanism in parts balances to the same bits every time") {
  const Mechanism m = bench::cable_net(65, 3);
  const System system = compile(m);
  Parameters p;
  bind(system, m, p);
  const Eigen::VectorXd q = drawn_of(system, p), lambda = Eigen::VectorXd::LinSpaced(system.rows, -1, 3);
  const Values first = values_of(system, p, q, lambda);
  for (int i = 0; i < 20; ++i) {
    const Values again = values_of(system, p, q, lambda);
    REQUIRE(again.residual.f == first.residual.f);
    REQUIRE(again.residual.force == first.residual.force);
    REQUIRE(again.magnitudes.force == first.magnitudes.force);
  }
}

TEST_CASE("what work on a part throws arrives") {
  for (const std::size_t thrower : {0U, 3U, 7U})
    CHECK_THROWS_AS(side_by_side(8,
                                 [&](std::size_t i) {
                                   if (i == thrower) throw std::runtime_error("here");
                                 }),
                    std::runtime_error);
}
