// Elimination along the tree: the same equations as the dense ones, at any size.
#include "tests/engine/equilibrium_mechanisms.hpp"
#include "tests/engine/reference/random_mechanism.hpp"

#include "engine/search/find_equilibrium.hpp"
#include "engine/solve/refine.hpp"

#include <Eigen/Eigenvalues>

#include <random>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

using namespace flyball;
using namespace flyball::test;
namespace ref = flyball::reference;

namespace {

// A system at a pose, with the balance factored both ways.
struct BothWays {
  Mechanism mechanism;
  System system;
  Parameters parameters;
  Scaling scaling;
  Unknowns z;
  Workspace tree, dense;

  explicit BothWays(Mechanism m) : mechanism(std::move(m)), system(compile(mechanism)) {
    system.kkt_form = KktForm::tree;
    bind(system, mechanism, parameters);
    set_scaling(system, parameters, scaling);
    drawn_configuration(system, parameters, z.q);
    z.lambda.resize(0);
  }

  Problem problem(bool whole) const {
    return {system, parameters, scaling, nullptr, whole ? KktForm::dense : KktForm::tree};
  }

  void factor_at(const Eigen::VectorXd& step) {
    retract<double>(system, step, z.q);
    for (const bool whole : {false, true}) {
      Workspace& w = whole ? dense : tree;
      evaluate(problem(whole), z, 0, w);
      factor(problem(whole), z, w);
    }
  }
};

ref::RandomOptions open_trees() {
  ref::RandomOptions o;
  o.bodies = 9;
  o.massless = false;
  return o;
}

double size_of(const Eigen::VectorXd& v) {
  return v.size() == 0 ? 0 : v.lpNorm<Eigen::Infinity>();
}

} // namespace

TEST_CASE("a step by elimination along the tree solves the dense equations") {
  int symmetric = 0, unsymmetric = 0, with_drag = 0;
  TreeKkt used; // for one system after the other
  for (std::uint32_t seed = 1; seed <= 800; ++seed) {
    ref::RandomOptions options = open_trees();
    options.conservative = seed % 2 == 0;
    options.air = seed % 4 == 1;
    options.drives = seed % 3 == 0 ? ref::RandomDrives::none : ref::RandomDrives::root;
    BothWays x(ref::random_mechanism(seed, options));
    if (!is_plain_tree(x.system) || x.system.nv == 0) continue;
    CAPTURE(seed, x.system.nv);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-0.3, 0.3);
    Eigen::VectorXd step(x.system.nv), rhs(x.system.nv), solved, by_used;
    for (int i = 0; i < x.system.nv; ++i) {
      step[i] = any(random) * x.scaling.column[i];
      rhs[i] = any(random);
    }
    x.factor_at(step);
    Eigen::MatrixXd k = x.dense.dense.stiffness();
    const bool potential = x.problem(false).symmetric();
    if (potential) k = ((k + k.transpose()) / 2).eval();
    const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(k).singularValues();
    if (values.minCoeff() < 1e-9 * values.maxCoeff() || !x.tree.tree.null_directions().empty()) continue;
    x.tree.tree.solve(rhs, solved);
    used.linearize(x.problem(false), x.z, x.tree);
    used.factor();
    used.solve(rhs, by_used);
    CHECK(by_used == solved);
    // Within the rounding of an elimination without row exchanges.
    CHECK(size_of(k * solved - rhs) <= 1e-9 * (values.maxCoeff() * size_of(solved) + size_of(rhs)));
    CHECK(size_of(solved - k.partialPivLu().solve(rhs)) <=
          1e-12 * values.maxCoeff() / values.minCoeff() * size_of(solved));
    if (potential) {
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(k, Eigen::EigenvaluesOnly);
      CHECK(x.tree.tree.negative_count() == (eigen.eigenvalues().array() < 0).count());
    }
    ++(potential ? symmetric : unsymmetric);
    with_drag +=
        std::ranges::any_of(x.mechanism.forces, [](const Force& f) { return f.type == ForceType::drag; });
  }
  CHECK(symmetric > 30);
  CHECK(unsymmetric > 30);
  CHECK(with_drag > 15);
}

TEST_CASE("the metric of the tree is positive, and its product belongs to its square") {
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    BothWays x(ref::random_mechanism(seed, open_trees()));
    if (!is_plain_tree(x.system) || x.system.nv == 0) continue;
    x.factor_at(Eigen::VectorXd::Zero(x.system.nv));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1, 1);
    Eigen::VectorXd a(x.system.nv), wa, b;
    for (double& v : a)
      v = any(random);
    const double square = x.tree.tree.metric(a, wa);
    CAPTURE(seed);
    CHECK(square > 0);
    CHECK(std::abs(a.dot(wa) - square) <= 1e-12 * square);
    // Beside a large multiple of the metric the stiffness is nothing.
    const double large = 1e14;
    x.tree.tree.factor(large);
    x.tree.tree.solve(wa, b);
    CHECK(size_of(large * b - a) <= 1e-3 * size_of(a));
  }
}

TEST_CASE("bodies are held from turning too far, and the others do as they would") {
  int held = 0;
  for (std::uint32_t seed = 1; seed <= 60; ++seed) {
    BothWays x(ref::random_mechanism(seed, open_trees()));
    if (!is_plain_tree(x.system) || x.system.nv == 0) continue;
    x.factor_at(Eigen::VectorXd::Zero(x.system.nv));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1, 1);
    Eigen::VectorXd rhs(x.system.nv), free;
    for (double& v : rhs)
      v = any(random);
    Eigen::VectorXd step;
    x.tree.tree.solve(rhs, free);
    step = free;
    CAPTURE(seed);
    CHECK_FALSE(x.tree.tree.limit_turns(1e12, step));
    CHECK(step == free);
    const double most = 1e-3 * free.norm();
    if (!x.tree.tree.limit_turns(most, step)) continue;
    ++held;
    std::vector<Vec3> turn(x.system.links.size());
    std::vector<bool> as_solved(turn.size(), true);
    for (std::size_t l = 0; l < turn.size(); ++l) {
      const Link& link = x.system.links[l];
      const auto parent = static_cast<std::size_t>(link.parent);
      turn[l] = link.parent < 0 ? Vec3(Vec3::Zero()) : turn[parent];
      as_solved[l] = link.parent < 0 || as_solved[parent];
      if (link.v < 0) continue;
      const int count = link.type == LinkType::spherical ? 3 : 1;
      for (int v = link.v; v < link.v + count; ++v)
        turn[l] +=
            x.scaling.column[v] * step[v] * x.tree.kinematics.columns[static_cast<std::size_t>(v)].turn();
      if (as_solved[l]) as_solved[l] = step.segment(link.v, count) == free.segment(link.v, count);
      if (link.type == LinkType::prismatic) continue;
      const double size = link.type == LinkType::spherical
                              ? turn[l].norm()
                              : std::abs(x.tree.kinematics.links[l].axis.dot(turn[l]));
      CHECK(size <= most * (1 + 1e-9));
      // Those before it are as solved, so it is held alone because it turns so far.
      if (!as_solved[l] && (link.parent < 0 || as_solved[parent])) CHECK(size > most * (1 - 1e-9));
    }
  }
  CHECK(held > 10);
}

TEST_CASE("a chain goes from straight and tilted to bent and stable, at every size") {
  for (const double speed : {5., 8., 10., 15.}) {
    std::vector<double> tips;
    int fewest = 1000, most = 0;
    for (const int links : {10, 100, 1000, 3000}) {
      Mechanism m = hanging_chain(links, speed);
      for (std::size_t i = 1; i < m.bodies.size(); ++i) { // drawn tilted by a milliradian
        m.bodies[i].position.x() = -1e-3 * m.bodies[i].position.y();
        m.joints[i].at.x() = -1e-3 * m.joints[i].at.y();
      }
      const Solution s = solve(m);
      CAPTURE(speed, links, s.message, s.iterations);
      REQUIRE(s.status == Status::converged);
      CHECK(s.stable == true);
      CHECK(s.stability_reason == StabilityReason::minimum);
      CHECK(s.residual < 1e-12);
      double worst = 0;
      for (const CoordinateSolution& c : s.coordinates)
        worst = std::max(worst, c.error);
      CHECK(worst < 1e-9);
      tips.push_back(std::abs(s.poses.back().position.x()));
      CHECK(tips.back() > 0.3);
      fewest = std::min(fewest, s.iterations);
      most = std::max(most, s.iterations);
    }
    // The bend belongs to the chain and not to its division.
    CHECK(std::abs(tips[2] - tips[1]) < 0.02);
    CHECK(std::abs(tips[2] - tips[1]) < std::abs(tips[1] - tips[0]));
    // And so does the way there: light links at the end are not waited for.
    CHECK(most <= fewest + 4);
  }
}

TEST_CASE("large chains come out as by the dense equations") {
  for (const int links : {30, 120}) {
    BothWays x(hanging_chain(links, 6));
    Eigen::VectorXd start = x.z.q;
    start[0] += 0.4;
    Found by[2];
    ErrorEstimate error[2];
    std::vector<double> history;
    for (const bool whole : {false, true}) {
      Workspace& w = whole ? x.dense : x.tree;
      find_equilibrium(x.problem(whole), start, false, false, w, history, by[whole]);
      REQUIRE(by[whole].status == Status::converged);
      refine(x.problem(whole), by[whole].z, by[whole].newton, w, error[whole]);
    }
    CAPTURE(links);
    CHECK(by[0].minimum);
    CHECK(by[1].minimum);
    const Eigen::VectorXd away = (by[0].z.q.cwiseAbs() - by[1].z.q.cwiseAbs()).cwiseAbs();
    CHECK((away.array() <= (error[0].solution + error[1].solution).array()).all());
  }
}

TEST_CASE("the signs of the pivots agree with the eigenvalues") {
  // Straight above two critical speeds: two directions down.
  for (const double speed : {3., 5., 10., 15.}) {
    BothWays x(hanging_chain(60, speed));
    x.factor_at(Eigen::VectorXd::Zero(x.system.nv));
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(x.dense.dense.stiffness(),
                                                               Eigen::EigenvaluesOnly);
    CAPTURE(speed);
    CHECK(x.tree.tree.negative_count() == (eigen.eigenvalues().array() < 0).count());
    CHECK(x.tree.tree.negative_count() == (speed > 13.69) + (speed > 8.67) + (speed > 3.77));
  }
}

TEST_CASE("rates with a slider come from the elimination, too") {
  Mechanism m = hanging_chain(40, 6);
  Slider slider;
  slider.parameter = "joints.spin.drive.speed";
  slider.to = 10;
  m.sliders.push_back(slider);
  const SolveOptions bent = from("hinge1", 0.4);
  const Solution s = solve(m, bent);
  REQUIRE(s.sensitivities.size() == 1);
  REQUIRE(s.sensitivities[0].rates.size() == 40);
  const auto at = [&](double speed) {
    Mechanism other = m;
    set_parameter(other, "joints.spin.drive.speed", speed);
    return value(solve(other, bent), "hinge1");
  };
  const double h = 1e-4, difference = (at(6 + h) - at(6 - h)) / (2 * h);
  CHECK(std::abs(s.sensitivities[0].rates[0].value - difference) < 1e-5 * std::abs(difference));
}

TEST_CASE("what has many coordinates is eliminated along its tree, and says so") {
  const auto passes = [](int links) {
    const SystemSummary s = Analysis(hanging_chain(links, 1)).summary();
    return std::ranges::any_of(
        s.in, [](const std::string& x) { return x.starts_with("elimination along the tree"); });
  };
  CHECK_FALSE(passes(5));
  CHECK(passes(100));
}

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_CASE("memory grows in proportion to the bodies") {
  const auto in_use = [] {
    const struct mallinfo2 m = mallinfo2();
    return static_cast<double>(m.uordblks + m.hblkhd);
  };
  const auto used_by = [&](int links) {
    const Mechanism m = hanging_chain(links, 5);
    const double before = in_use();
    Analysis a(m);
    const Solution s = a.solve();
    CHECK(s.status == Status::converged);
    return in_use() - before;
  };
  used_by(100);
  CHECK(used_by(4000) < 4.6 * used_by(1000));
}
#endif
