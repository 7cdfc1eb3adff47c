#include "engine/stability/linear_motion.hpp"

#include "engine/linear/spectral.hpp"

#include <algorithm>

namespace flyball {
namespace {

constexpr double alike = 1e-9;           // relative difference of entries that counts as none
constexpr double entry_rounding = 1e-13; // of the terms that an entry is made of

// |a - b| entry by entry, against the sizes of both rows and columns and the rounding of what they are made
// of.
bool same_entries(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b, const Eigen::VectorXd& terms) {
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

double fastest_drive(const Problem& problem) {
  double fastest = 0;
  for (const DrivenCoordinate& d : problem.system.drives)
    fastest = std::max(fastest, std::abs(problem.parameters.links[static_cast<std::size_t>(d.link)].speed));
  return fastest;
}

} // namespace

LinearMotion linear_motion(const Problem& problem, const Eigen::VectorXd& q, double t, Workspace& w) {
  const System& system = problem.system;
  const Problem dense{system, problem.parameters, problem.scaling, problem.cancel};
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
  const auto s = problem.scaling.column.asDiagonal();
  out.mass = s * w.dense.linearization.mass * s;
  out.velocity = s * w.dense.linearization.velocity * s;
  out.stiffness = s * w.dense.linearization.stiffness * s;
  out.force = w.magnitudes.force.cwiseProduct(problem.scaling.column);
  return out;
}

void make_stiffness_of_motion(const System& system, Eigen::MatrixXd& jacobian) {
  for (const DriveTorqueElement& torque : system.torques) {
    const int v = system.links[static_cast<std::size_t>(torque.link)].v;
    jacobian.col(v).setZero();
    if (torque.keeps_momentum) jacobian.row(v).setZero(); // nothing acts along it, whatever the state
  }
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
  return qr.q().leftCols(qr.rank(1e-9)); // loops and gears tie some together
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

bool same_motion(const Problem& problem, const LinearMotion& a, const LinearMotion& b) {
  const auto turned = basis_beside(b, a.basis);
  if (!turned) return false;
  const Eigen::MatrixXd& n = a.basis;
  if (n.cols() == 0) return true;
  if ((n - *turned).cwiseAbs().maxCoeff() > alike) return false;
  const Eigen::MatrixXd share = n.cwiseAbs2();
  const Eigen::VectorXd mass = share.transpose() * a.mass.diagonal().cwiseMax(b.mass.diagonal()).cwiseMax(0);
  const Eigen::VectorXd force = share.transpose() * a.force.cwiseMax(b.force);
  const bool whole = n.rows() == n.cols(); // no constraints: the basis is the identity
  const auto same = [&](const Eigen::MatrixXd& x, const Eigen::MatrixXd& y, const Eigen::VectorXd& terms) {
    if (whole) return same_entries(x, y, terms);
    return same_entries(n.transpose() * x * n, n.transpose() * y * n, terms);
  };
  // What gyroscopic terms are made of, and a stiffness that no motion of this speed would feel.
  const double speed = fastest_drive(problem);
  return same(a.mass, b.mass, mass) && same(a.velocity, b.velocity, speed * mass) &&
         same(a.stiffness, b.stiffness, force + speed * speed * mass);
}

bool motion_varies(const Problem& problem, const Eigen::VectorXd& q, const std::vector<double>& phases,
                   Workspace& w) {
  if (phases.empty() || problem.system.nv == 0) return false;
  const LinearMotion drawn = linear_motion(problem, q, 0, w);
  return std::ranges::any_of(
      phases, [&](double t) { return !same_motion(problem, drawn, linear_motion(problem, q, t, w)); });
}

} // namespace flyball
