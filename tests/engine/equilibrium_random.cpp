// Random mechanisms of all types, held to the reference: whatever is called a steady state must be one.
#include "tests/engine/equilibrium_mechanisms.hpp"
#include "tests/engine/reference/b_matrix.hpp"
#include "tests/engine/reference/random_mechanism.hpp"
#include "tests/support/campaign.hpp"

#include <map>
#include <random>

using namespace flyball;
using namespace flyball::test;
namespace ref = flyball::reference;

namespace {

// The solution as a state of the reference on the tree that the engine used, the drives turned on by t
// seconds.
struct Checked {
  std::vector<std::string> cuts;
  ref::ReferenceState state;
};

ref::ReferenceState at_phase(const ref::Tree& tree, const Mechanism& m, ref::ReferenceState state,
                             ref::Real t) {
  for (const ref::TreeCoordinate& c : tree.coordinates)
    if (c.driven)
      state.coordinates.at(
          m.joints[static_cast<std::size_t>(c.joint)].name)[static_cast<std::size_t>(c.index)] += c.speed * t;
  return state;
}

Checked as_reference(const Mechanism& m, const Analysis& analysis, const Solution& s) {
  Checked out{analysis.summary().cut_joints, {}};
  for (const CoordinateSolution& c : s.coordinates) {
    std::vector<ref::Real>& values = out.state.coordinates[c.joint];
    values.resize(static_cast<std::size_t>(c.count));
    values[static_cast<std::size_t>(c.index)] = c.value;
  }
  // A joint may close a loop and have coordinates; the reference reads those off the bodies.
  for (const std::string& name : out.cuts)
    out.state.coordinates.erase(name);
  // Gears between two driven coordinates have no equation left, but the reference cuts all gears.
  for (const Joint& j : m.joints)
    if ((j.type == JointType::gear || j.type == JointType::distance) &&
        std::ranges::find(out.cuts, j.name) == out.cuts.end())
      out.cuts.push_back(j.name);
  return out;
}

double largest(const ref::VectorR& v) {
  return v.size() == 0 ? 0 : static_cast<double>(v.cwiseAbs().maxCoeff());
}

// How far the loops are open. Angles that no spring acts on are reported within a turn, so a gear may be
// whole turns away.
double opening(const ref::Evaluation& e, const Mechanism& m) {
  double worst = 0;
  for (Eigen::Index i = 0; i < e.constraints.size(); ++i) {
    const Joint& j = m.joints[static_cast<std::size_t>(e.constraint_joint[static_cast<std::size_t>(i)])];
    double open = std::abs(static_cast<double>(e.constraints[i]));
    if (j.type == JointType::gear)
      for (int a = -8; a <= 8; ++a) {
        const double turn = 2 * std::numbers::pi;
        const double rest = static_cast<double>(e.constraints[i]) + a * j.ratio * turn;
        open = std::min({open, std::abs(rest), std::abs(std::remainder(rest, turn))});
      }
    worst = std::max(worst, open);
  }
  return worst;
}

// How large the forces on the coordinates are before they cancel.
double force_scale(const ref::Evaluation& e, const Mechanism& m) {
  double size = 1;
  for (std::size_t b = 0; b < e.bodies.size(); ++b) {
    const ref::ReferenceBody& x = e.bodies[b];
    size += static_cast<double>(x.inertial.force.norm() + x.applied.force.norm() + x.inertial.torque.norm() +
                                x.applied.torque.norm());
  }
  for (const Joint& j : m.joints)
    for (const Coordinate& c : j.coordinates)
      size += c.spring ? c.spring->stiffness : 0;
  return size;
}

ref::RandomOptions options_for(std::uint32_t seed) {
  ref::RandomOptions o;
  o.loops = static_cast<int>(seed % 4);
  o.drives = static_cast<ref::RandomDrives>(seed / 4 % 3);
  o.steady = seed / 12 % 4 != 3;
  o.conservative = seed % 3 == 0;
  o.spring_share = seed / 2 % 2 == 0 ? 1 : 0.6;
  o.parallel_axes = seed % 7 == 0;
  o.skew_universals = seed % 2 == 0;
  o.mark_cuts = seed % 11 == 0;
  return o;
}

bool finite(const Solution& s) {
  bool ok = std::isfinite(s.residual) && std::isfinite(s.run_time_s);
  for (const CoordinateSolution& c : s.coordinates)
    ok = ok && std::isfinite(c.value) && std::isfinite(c.error) && c.error >= 0;
  for (const Pose& p : s.poses)
    ok = ok && p.position.allFinite() && p.rotation.coeffs().allFinite();
  for (const JointMultipliers& x : s.multipliers)
    for (const double v : x.values)
      ok = ok && std::isfinite(v);
  for (const DriveTorque& x : s.drive_torques)
    ok = ok && std::isfinite(x.value);
  for (const Reaction& x : s.reactions)
    ok = ok && x.force.allFinite() && x.torque.allFinite();
  if (s.eigenvalues)
    for (const std::complex<double> x : *s.eigenvalues)
      ok = ok && std::isfinite(x.real()) && std::isfinite(x.imag());
  return ok && (!s.condition || *s.condition >= 1);
}

// Small moves that keep the loops closed do not lower the amended potential of a strict minimum.
void check_minimum(const Mechanism& m, const Checked& c, std::uint32_t seed) {
  const ref::Evaluation e = ref::evaluate(m, c.cuts, c.state);
  const ref::Real u0 = ref::potential(m, c.cuts, c.state);
  std::mt19937 engine(seed);
  for (int i = 0; i < 6; ++i) {
    ref::VectorR step = ref::VectorR::Zero(static_cast<Eigen::Index>(e.tree.coordinates.size()));
    for (const int k : e.free)
      step[k] = 2e-3L * (2 * static_cast<ref::Real>(engine()) / 4294967296.0L - 1);
    ref::ReferenceState moved = ref::advance(m, e.tree, c.state, step);
    try {
      moved = ref::assemble(m, c.cuts, moved);
    } catch (const std::runtime_error&) {
      continue; // locked loops
    }
    CHECK(static_cast<double>(ref::potential(m, c.cuts, moved) - u0) >= -1e-9);
  }
}

} // namespace

TEST_CASE("random mechanisms: what is called a steady state is one") {
  // Each way of making them, with every number of loops and kind of drives, comes twice among 96.
  const std::uint32_t count = few_or_all(96u, 480u);
  std::map<std::string, int> shares, sprung; // by status; of those that springs keep in place
  int converged = 0, minima = 0, phases = 0;
  double worst = 0;
  for (std::uint32_t seed = 1000; seed < 1000 + count; ++seed) {
    const ref::RandomOptions options = options_for(seed);
    const Mechanism m = ref::random_mechanism(seed, options);
    CAPTURE(seed);
    Analysis analysis(m);
    const Solution s = analysis.solve();
    CAPTURE(word(s.status), s.message, s.iterations);
    ++shares[std::string(word(s.status))];
    sprung[std::string(word(s.status))] += options.spring_share == 1;
    CHECK(finite(s));
    CHECK_FALSE(s.message.empty());
    // They are made closed, and those with a root drive the same at every phase.
    CHECK(s.status != Status::infeasible);
    if (options.steady && options.drives == ref::RandomDrives::root)
      CHECK(s.status != Status::no_steady_state);
    if (options.drives == ref::RandomDrives::none) CHECK(s.status != Status::no_steady_state);
    if (s.status != Status::converged) {
      CHECK(s.coordinates.empty());
      continue;
    }
    ++converged;
    const Checked c = as_reference(m, analysis, s);
    const ref::Evaluation drawn = ref::evaluate(m, c.cuts, c.state);
    for (const ref::Real t : {0.0L, 0.37L, 1.9L}) {
      const ref::Evaluation e =
          t == 0 ? drawn : ref::evaluate(m, c.cuts, at_phase(drawn.tree, m, c.state, t));
      const double scale = force_scale(e, m), left = largest(e.unbalanced()), open = opening(e, m);
      CAPTURE(static_cast<double>(t), scale, left, open);
      CHECK(left <= 1e-9 * scale);
      CHECK(open <= 1e-9);
      worst = std::max(worst, left / scale);
      ++phases;
    }
    if (options.conservative) {
      CHECK((s.stable.has_value() || s.stability_reason.has_value()));
      if (s.stable == false) CHECK(s.stability_reason == StabilityReason::unstable);
      if (s.stability_reason == StabilityReason::minimum && options.drives != ref::RandomDrives::several) {
        check_minimum(m, c, seed);
        ++minima;
      }
    }
    // The answer is its own neighbour.
    SolveOptions warm;
    warm.warm = true;
    warm.details = false;
    const Solution again = analysis.solve(warm);
    CHECK(again.status == Status::converged);
    // And from the drawn pose it is the same to the last bit, whatever was solved before.
    if (seed % 8 != 0) continue;
    const Solution same = analysis.solve();
    REQUIRE(same.coordinates.size() == s.coordinates.size());
    for (std::size_t i = 0; i < s.coordinates.size(); ++i)
      CHECK(same.coordinates[i].value == s.coordinates[i].value);
  }
  CAPTURE(shares, sprung, converged, minima, phases, worst);
  // Without springs many fall for ever; with springs nearly all have somewhere to stay, unless the drives
  // turn it away.
  CHECK(converged >= static_cast<int>(count / 2));
  CHECK(sprung["not_converged"] <= static_cast<int>(count / 2 / 20));
  CHECK(minima >= static_cast<int>(count / 12));
}

TEST_CASE("random mechanisms from random starts and plain Newton never break") {
  for (std::uint32_t seed = 5000; seed < few_or_all(5048u, 5240u); ++seed) {
    CAPTURE(seed);
    const Mechanism m = ref::random_mechanism(seed, options_for(seed));
    Analysis analysis(m);
    std::mt19937 engine(seed);
    SolveOptions options;
    options.nearest = true;
    const Solution first = analysis.solve(options);
    CHECK(finite(first));
    options.nearest = seed % 2 == 0;
    for (const CoordinateSolution& c : first.coordinates)
      if (!c.driven && !c.dependent)
        options.start.emplace_back(c.joint + "." + std::to_string(c.index),
                                   2 * static_cast<double>(engine()) / 4294967296. - 1);
    const Solution s = analysis.solve(options);
    CAPTURE(s.message);
    CHECK(finite(s));
    if (s.status != Status::converged) continue;
    const Checked c = as_reference(m, analysis, s);
    const ref::Evaluation e = ref::evaluate(m, c.cuts, c.state);
    CHECK(largest(e.unbalanced()) <= 1e-9 * force_scale(e, m));
    CHECK(opening(e, m) <= 1e-9);
  }
}
