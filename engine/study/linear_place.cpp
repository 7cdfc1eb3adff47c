#include "engine/study/linear_place.hpp"

#include "engine/dynamics/start.hpp"
#include "engine/kkt/tied_angles.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/stability/phase_stiffness.hpp"
#include "engine/stability/stability.hpp"
#include "engine/study/input_effect.hpp"

namespace flyball {
namespace {

constexpr double stands_still = 1e-9; // of how far a direction moves what does not turn

// Whether the angle of something that turns at a speed that is found is a state like others.
bool angles_matter(const LinearPlace& place) {
  if (place.steady.torques.empty() || place.parameters.phase_free) return false;
  Scaling scaling;
  set_scaling(place.steady, place.parameters, scaling);
  const Problem problem{place.steady, place.parameters, scaling};
  Workspace w;
  Unknowns z{place.balance_q, Eigen::VectorXd::Zero(place.steady.rows)};
  if (place.steady.rows > 0) {
    evaluate(problem, z, 0, w);
    factor_constraints(problem, w);
    best_multipliers(problem, w, z.lambda);
    if (loops_tie_angles(problem, w.kinematics)) return true;
  }
  return !phase_stiffness(problem, z, w).entries.empty();
}

// Whether nothing moves along it but what turns at speeds that are found.
bool stands_alike(const System& steady, const Eigen::VectorXd& turned) {
  const std::vector<bool> driven = turning_entries(steady);
  for (Eigen::Index v = 0; v < turned.size(); ++v)
    if (!driven[static_cast<std::size_t>(v)] && std::abs(turned[v]) > stands_still) return false;
  return true;
}

} // namespace

LinearPlace::LinearPlace(const Mechanism& mechanism, const Mechanism& beside, const Solution& at)
    : model(make_motion_model(beside, true)), steady(compile_for_drives(beside)) {
  model.mechanism = mechanism;
  bind_motion(model.system, mechanism, model.parameters);
  bind(steady, mechanism, parameters);
  SimulationOptions start;
  start.start = Start::state;
  for (const CoordinateSolution& c : at.coordinates) // with a damper more other joints may close loops
    start.state.coordinates.push_back({c.joint, c.index, c.value, c.speed.value_or(0)});
  find_start(start, model, q, u);
  // What the balance takes: speeds in the place of angles.
  balance_q = q;
  for (const DriveTorqueElement& torque : steady.torques) {
    const Link& link = model.system.links[static_cast<std::size_t>(torque.link)];
    balance_q[link.q] = u[link.v];
    LinkParameters& numbers = parameters.links[static_cast<std::size_t>(torque.link)];
    numbers.start = q[link.q] - numbers.drawn; // at the angle where it stands
  }
}

void LinearPlace::choose(const MotionAt& drawn, bool with_phases) {
  angles = angles_matter(*this);
  chosen = choose_coordinates(steady, drawn.basis(), angles && !with_phases);
  const std::vector<bool> driven = turning_entries(steady);
  const Eigen::MatrixXd from = from_chosen(drawn);
  Scaling scaling;
  set_scaling(steady, parameters, scaling);
  const Problem problem{steady, parameters, scaling};
  Workspace w;
  const Unknowns z{balance_q, Eigen::VectorXd::Zero(steady.rows)};
  const Eigen::MatrixXd free = drawn.column().head(steady.nv).asDiagonal() * drawn.basis();
  // Phases are those along which, with the others as they are, nothing changes.
  for (std::size_t i = 0; i < chosen.entries.size() && !with_phases; ++i) {
    if (!driven[static_cast<std::size_t>(chosen.entries[i])]) continue;
    Eigen::VectorXd turned =
        (drawn.basis() * from.col(static_cast<Eigen::Index>(i))).cwiseProduct(drawn.column());
    turned /= turned.lpNorm<Eigen::Infinity>();
    chosen.phase[i] = !angles || (stands_alike(steady, turned) &&
                                  balanced_along(problem, z, turned, w, held.empty() ? nullptr : &free));
  }
  for (std::size_t i = 0; i < chosen.entries.size(); ++i)
    if (driven[static_cast<std::size_t>(chosen.entries[i])] && !chosen.phase[i]) phases = true;
}

Eigen::MatrixXd LinearPlace::from_chosen(const MotionAt& motion) const {
  const auto k = static_cast<Eigen::Index>(chosen.entries.size());
  if (motion.basis().cols() != k)
    throw Refusal{
        "The loops hold other directions at another phase of the drives: no constant matrices tell of it."};
  const Eigen::MatrixXd to = to_chosen(motion);
  Lu lu;
  Eigen::MatrixXd from = Eigen::MatrixXd::Identity(k, k);
  if (k > 0 && !lu.compute(to)) throw Refusal{"The loops' equations overflow."};
  for (Eigen::Index i = 0; i < k; ++i)
    from.col(i) = lu.solve(Eigen::VectorXd::Unit(k, i));
  return from;
}

Eigen::MatrixXd LinearPlace::to_chosen(const MotionAt& motion) const {
  const auto k = static_cast<Eigen::Index>(chosen.entries.size());
  Eigen::MatrixXd to(k, k);
  for (Eigen::Index i = 0; i < k; ++i) {
    const int v = chosen.entries[static_cast<std::size_t>(i)];
    to.row(i) = motion.column()[v] * motion.basis().row(v);
  }
  return to;
}

MotionOfAll LinearPlace::at(double t) const {
  const System& released = model.released;
  MotionOfAll out;
  out.q.setZero(released.nq);
  out.u.setZero(released.nv);
  out.a.setZero(released.nv);
  out.q.head(model.system.nq) = q;
  out.u.head(model.system.nv) = u;
  set_drives(model.system, model.parameters, t, out.q, out.u);
  for (const DriveTorqueElement& torque : steady.torques) {
    const Link& link = model.system.links[static_cast<std::size_t>(torque.link)];
    out.q[link.q] += u[link.v] * t;
  }
  return out;
}

} // namespace flyball
