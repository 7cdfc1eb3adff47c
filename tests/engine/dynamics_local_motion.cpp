// The motion about a steady state in minimal numbers, against the motion of all coordinates and the
// eigenvalues that a solve tells.
#include "tests/engine/dynamics_runs.hpp"

#include "engine/dynamics/local_motion.hpp"
#include "engine/dynamics/start.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/report/analysis.hpp"

using namespace flyball;
using namespace flyball::test;

namespace {

// A lopsided bob in a ball joint with springs, off the axis of a table that turns.
Mechanism ball_on_table() {
  Mechanism m;
  m.gravity = {0, 0, -standard_gravity};
  m.bodies = {body("table", 1, {0, 0, 0}, {0.1, 0.1, 0.1}),
              body("bob", 1.3, {0.3, 0.05, -0.2}, {0.02, 0.03, 0.04})};
  Joint ball = joint(JointType::spherical, "ball", "table", "bob", {0.25, 0, 0}, {0, 0, 1});
  ball.coordinates.resize(3);
  for (Coordinate& c : ball.coordinates) {
    c.spring.emplace().stiffness = 1.5;
    c.damping = 0.05;
  }
  m.joints = {driven(revolute("spin", "ground", "table", {0, 0, 0}, {0, 0, 1}), 3), ball};
  return m;
}

struct Local {
  explicit Local(const Mechanism& mechanism)
      : solution(Analysis(mechanism).solve()), model(make_motion_model(mechanism, true)) {
    REQUIRE(solution.status == Status::converged);
    SimulationOptions start;
    start.start = Start::state;
    for (const CoordinateSolution& c : solution.coordinates)
      if (!c.dependent) start.state.coordinates.push_back({c.joint, c.index, c.value, c.speed.value_or(0)});
    Eigen::VectorXd q, u;
    find_start(start, model, q, u);
    motion.emplace(model, q, u, 5, false);
  }
  Eigen::VectorXd rate(const Eigen::VectorXd& x) {
    Eigen::VectorXd out;
    REQUIRE(motion->evaluate(x, out));
    return out;
  }
  Solution solution;
  MotionModel model;
  std::optional<LocalMotion> motion;
};

} // namespace

TEST_CASE("the motion about a steady state: loops, found speeds, kept momenta, a ball joint",
          "[local-motion]") {
  for (const Mechanism& m : {shipped("governor_engine"), shipped("governor"), shipped("free_top"),
                             shipped("fourbar_turntable"), shipped("rate_gyro"), ball_on_table()}) {
    CAPTURE(m.name);
    Local local(m);
    const Eigen::Index n = local.motion->size();
    CHECK(local.rate(Eigen::VectorXd::Zero(n)).norm() < 1e-9);
    // Its linear part has the eigenvalues that are told.
    Eigen::MatrixXd a(n, n);
    const double h = 1e-4;
    for (Eigen::Index k = 0; k < n; ++k)
      a.col(k) =
          (local.rate(h * Eigen::VectorXd::Unit(n, k)) - local.rate(-h * Eigen::VectorXd::Unit(n, k))) /
          (2 * h);
    const auto values = eigenvalues(a);
    REQUIRE(values);
    REQUIRE(local.solution.eigenvalues);
    CHECK(values->size() == local.solution.eigenvalues->size());
    double largest = 0;
    for (const std::complex<double> s : *values)
      largest = std::max(largest, std::abs(s));
    for (const std::complex<double> s : *local.solution.eigenvalues) {
      double away = 1e9;
      for (const std::complex<double> x : *values)
        away = std::min(away, std::abs(x - s));
      CHECK(away < 1e-4 * largest); // a double zero goes with the root
    }
    // Far from it: the classical Runge-Kutta method beside the simulation.
    Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(n, -0.11, 0.17);
    local.rate(x);
    SimulationOptions options;
    options.start = Start::state;
    options.state = name_state(local.model, 0, local.motion->configuration(), local.motion->velocity());
    options.duration = 0.4;
    options.rate = 10;
    options.tolerance = 1e-12;
    const Run run = simulate(m, options);
    REQUIRE(run.status == RunStatus::completed);
    const double step = 1e-3;
    for (int k = 0; k < 400; ++k) {
      const Eigen::VectorXd k1 = local.rate(x), k2 = local.rate(x + step / 2 * k1),
                            k3 = local.rate(x + step / 2 * k2), k4 = local.rate(x + step * k3);
      x += step / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    local.rate(x);
    const SimulationState end =
        name_state(local.model, 0.4, local.motion->configuration(), local.motion->velocity());
    for (const CoordinateInfo& c : local.model.system.coordinates) {
      const Link& link = local.model.system.links[static_cast<std::size_t>(c.link)];
      if (link.v < 0) continue;
      const std::string& joint = local.model.system.tree_joints[static_cast<std::size_t>(c.tree_joint)].name;
      const auto there = std::ranges::find_if(
          end.coordinates, [&](const StateCoordinate& s) { return s.joint == joint && s.index == c.index; });
      const auto track = std::ranges::find_if(
          run.coordinates, [&](const CoordinateTrack& s) { return s.joint == joint && s.index == c.index; });
      CAPTURE(joint, c.index);
      CHECK(std::abs(there->rate - track->rate.back()) < 1e-7);
      if (local.motion->stands(link.v)) CHECK(std::abs(there->value - track->value.back()) < 1e-8);
    }
  }
}
