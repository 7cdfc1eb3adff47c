#include "engine/stability/linear_motion.hpp"

#include "engine/kkt/tied_angles.hpp"
#include "engine/linear/large.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/stability/phase_stiffness.hpp"
#include "engine/system/drive_rates.hpp"

#include <algorithm>

namespace flyball {
namespace {

constexpr double same = 1e-9;            // relative difference of entries that counts as none
constexpr double entry_rounding = 1e-13; // of the terms that an entry is made of

// |a - b| entry by entry, against the sizes of both rows and columns and the rounding of what they are made
// of.
bool same_entries(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, const Eigen::VectorXd& terms,
                  double alike) {
  if (a.rows() == 0) return true;
  const Eigen::VectorXd rows = a.cwiseAbs().rowwise().maxCoeff().cwiseMax(b.cwiseAbs().rowwise().maxCoeff());
  const Eigen::VectorXd columns =
      a.cwiseAbs().colwise().maxCoeff().transpose().cwiseMax(b.cwiseAbs().colwise().maxCoeff().transpose());
  for (Eigen::Index j = 0; j < a.cols(); ++j)
    for (Eigen::Index i = 0; i < a.rows(); ++i)
      if (!(std::abs(a(i, j) - b(i, j)) <=
            alike * std::sqrt(rows[i] * columns[j]) + entry_rounding * std::sqrt(terms[i] * terms[j])))
        return false;
  return true;
}

// From the balance's Jacobian, whose columns are for the speeds that are found and whose rows for the momenta
// that are kept.
void make_stiffness_of_motion(const System& system, Eigen::MatrixXd& jacobian) {
  for (const DriveTorqueElement& torque : system.torques) {
    const int v = system.links[static_cast<std::size_t>(torque.link)].v;
    jacobian.col(v).setZero();
    if (torque.keeps_momentum) jacobian.row(v).setZero(); // nothing acts along it, whatever the state
  }
}

// Whether the constraints of the balance ask anything of the speeds that are found.
bool loops_hold_speeds(const System& system, const Eigen::MatrixXd& constraint) {
  return std::ranges::any_of(system.torques, [&](const DriveTorqueElement& torque) {
    return !constraint.col(system.links[static_cast<std::size_t>(torque.link)].v).isZero(0);
  });
}

} // namespace

LinearMotion linear_motion(const Problem& problem, const Eigen::VectorXd& q, double t, Workspace& w) {
  const System& system = problem.system;
  const Scaling scaling = motion_scaling(problem);
  const Problem dense{system, problem.parameters, scaling, problem.cancel};
  Unknowns z{q, Eigen::VectorXd::Zero(system.rows)};
  evaluate(dense, z, t, w);
  LinearMotion out;
  if (system.rows > 0) {
    factor_constraints(dense, w);
    best_multipliers(dense, w, z.lambda);
    evaluate_forces(dense, z, w);
    out.basis = w.dense.constraints().basis();
  } else {
    out.basis.setIdentity(system.nv, system.nv);
  }
  linearize(system, problem.parameters, z.q, z.lambda, w.kinematics, w.residual, w.dense.linearization);
  make_stiffness_of_motion(system, w.dense.linearization.stiffness);
  linearize_motion(system, problem.parameters, z.q, w.kinematics, w.dense.linearization);
  const auto s = scaling.column.asDiagonal();
  out.mass = s * w.dense.linearization.mass * s;
  out.velocity = s * w.dense.linearization.velocity * s;
  out.stiffness = s * w.dense.linearization.stiffness * s;
  out.force = w.magnitudes.force.cwiseProduct(scaling.column);
  return out;
}

ReducedMotion reduced_motion(const Problem& problem, const Unknowns& z, Workspace& w) {
  const System& system = problem.system;
  Linearization& l = w.dense.linearization;
  linearize_motion(system, problem.parameters, z.q, w.kinematics, l);
  ReducedMotion out;
  if (system.torques.empty()) {
    out.basis = w.dense.constraints().basis();
    out.unit = problem.scaling.column;
    out.stiffness = w.dense.reduced();
    out.noise = w.dense.noise();
  } else {
    const Scaling scaling = motion_scaling(problem);
    out.unit = scaling.column;
    const Eigen::VectorXd terms = w.magnitudes.force.cwiseProduct(out.unit);
    const bool tied = loops_tie_angles(problem, w.kinematics);
    if (tied || loops_hold_speeds(system, l.constraint)) {
      const Eigen::MatrixXd jacobian =
          scaling.row.asDiagonal() *
          constraints_of_motion(system, problem.parameters, w.kinematics, l.constraint) *
          scaling.column.asDiagonal();
      ConstraintSpace space;
      space.factor(jacobian, rank_tolerance(problem, w.residual.phi), row_rounding);
      out.basis = space.basis();
    } else { // in either unit of the speeds
      out.basis = w.dense.constraints().basis();
    }
    const Eigen::VectorXd change = scaling.column.cwiseQuotient(problem.scaling.column);
    Eigen::MatrixXd stiffness = change.asDiagonal() * w.dense.stiffness() * change.asDiagonal();
    make_stiffness_of_motion(system, stiffness);
    const PhaseStiffness phases = phase_stiffness(problem, z, w.elsewhere());
    out.of_angles = !phases.entries.empty() || tied;
    for (std::size_t i = 0; i < phases.entries.size(); ++i) {
      const int v = phases.entries[i];
      stiffness.col(v) =
          out.unit[v] * phases.columns.col(static_cast<Eigen::Index>(i)).cwiseProduct(out.unit);
    }
    out.stiffness_terms = stiffness.norm();
    out.stiffness = large::projected(stiffness, out.basis);
    out.noise = KktSystem::rounding * out.basis.cwiseAbs2().transpose() * terms;
  }
  const auto s = out.unit.asDiagonal();
  const Eigen::MatrixXd mass = s * l.mass * s;
  out.inertia = out.basis.cwiseAbs2().transpose() * own_inertia(system, mass);
  out.mass = large::projected(mass, out.basis);
  out.velocity = large::projected(s * l.velocity * s, out.basis);
  return out;
}

Eigen::VectorXd own_inertia(const System& system, const Eigen::MatrixXd& mass) {
  if (system.nv == 0) return Eigen::VectorXd(0);
  Eigen::VectorXd out = mass.diagonal().head(system.nv).cwiseMax(0);
  for (const Link& link : system.links)
    if (link.type == LinkType::spherical && link.v >= 0)
      out.segment<3>(link.v).setConstant(out.segment<3>(link.v).maxCoeff());
  return out;
}

Eigen::MatrixXd cyclic_directions(const System& system, const Eigen::MatrixXd& basis, bool keep_momentum) {
  Eigen::MatrixXd all(basis.cols(), 0);
  for (const DriveTorqueElement& torque : system.torques) {
    if (torque.keeps_momentum != keep_momentum) continue;
    all.conservativeResize(Eigen::NoChange, all.cols() + 1);
    all.rightCols<1>() = basis.row(system.links[static_cast<std::size_t>(torque.link)].v).transpose();
  }
  PivotedQr qr;
  if (all.size() == 0 || !(all.cwiseAbs().maxCoeff() > 1e-12) || !qr.compute(all))
    return Eigen::MatrixXd(basis.cols(), 0);
  Eigen::MatrixXd out(basis.cols(), qr.rank(1e-9)); // loops and gears tie some together
  for (Eigen::Index i = 0; i < out.cols(); ++i) {
    Eigen::VectorXd column = Eigen::VectorXd::Unit(basis.cols(), i);
    qr.apply_q(column, std::min(all.rows(), all.cols()));
    out.col(i) = column;
  }
  return out;
}

std::optional<Eigen::MatrixXd> basis_beside(const LinearMotion& motion, const Eigen::MatrixXd& reference) {
  if (motion.basis.cols() != reference.cols()) return {};
  // Without constraints, or with none but these, there is nothing to mix.
  if (reference.rows() == reference.cols() || reference.cols() == 0) return reference;
  const auto mixing = least_squares_columns(reference.transpose() * motion.basis,
                                            Eigen::MatrixXd::Identity(reference.cols(), reference.cols()));
  if (!mixing || mixing->cwiseAbs().maxCoeff() > 1e6) return {};
  return Eigen::MatrixXd(motion.basis * *mixing);
}

bool same_motion(const Problem& problem, const LinearMotion& a, const LinearMotion& b, double time) {
  const std::vector<DriveRate> rates = drive_rates(problem.system, problem.parameters);
  const double alike = same + 4 * angle_rounding(rates, time);
  const auto turned = basis_beside(b, a.basis);
  if (!turned) return false;
  const Eigen::MatrixXd& n = a.basis;
  if (n.cols() == 0) return true;
  if ((n - *turned).cwiseAbs().maxCoeff() > alike) return false;
  const Eigen::MatrixXd share = n.cwiseAbs2();
  const Eigen::VectorXd mass = share.transpose() * a.mass.diagonal().cwiseMax(b.mass.diagonal()).cwiseMax(0);
  const Eigen::VectorXd force = share.transpose() * a.force.cwiseMax(b.force);
  const bool whole = n.rows() == n.cols(); // no constraints: the basis is the identity
  const auto agree = [&](const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, const Eigen::VectorXd& terms) {
    if (whole) return same_entries(x, y, terms, alike);
    return same_entries(n.transpose() * x * n, n.transpose() * y * n, terms, alike);
  };
  // What gyroscopic terms are made of, and a stiffness that no motion of this speed would feel.
  const double speed = fastest_rate(rates);
  return agree(a.mass, b.mass, mass) && agree(a.velocity, b.velocity, speed * mass) &&
         agree(a.stiffness, b.stiffness, force + speed * speed * mass);
}

bool motion_varies(const Problem& problem, const Eigen::VectorXd& q, const std::vector<double>& phases,
                   Workspace& w) {
  if (phases.empty() || problem.system.nv == 0) return false;
  const LinearMotion drawn = linear_motion(problem, q, 0, w);
  return std::ranges::any_of(
      phases, [&](double t) { return !same_motion(problem, drawn, linear_motion(problem, q, t, w), t); });
}

} // namespace flyball
