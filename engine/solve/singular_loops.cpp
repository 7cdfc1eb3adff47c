#include "engine/solve/singular_loops.hpp"

#include "engine/kkt/configuration_difference.hpp"
#include "engine/linear/interruption.hpp"
#include "engine/linear/largest.hpp"
#include "engine/linear/spectral.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/system/constraint_row.hpp"
#include "engine/system/released.hpp"

#include <algorithm>

namespace flyball {

bool at_singular_loops(const Problem& problem, const Unknowns& z, Workspace& w) {
  constexpr double near =
      1e-8; // least pivot: half the digits, to which a pose beside a singular one is known
  constexpr double aside = 1e-4, grows = 10;
  const DenseKkt* dense = w.matrices(problem);
  if (!dense || problem.system.rows == 0 || problem.system.nv == 0) return false;
  const ConstraintSpace& here = dense->constraints();
  const int rank = here.rank();
  const double least = here.least_pivot();
  if (rank == std::min(problem.system.rows, problem.system.nv) && least > near) return false;
  Workspace& beside = w.elsewhere();
  beside.trial = z;
  beside.step = aside * here.basis().rowwise().sum().cwiseProduct(problem.scaling.column);
  retract<double>(problem.system, beside.step, beside.trial.q);
  evaluate(problem, beside.trial, 0, beside);
  factor_constraints(problem, beside);
  const ConstraintSpace& there = beside.dense.constraints();
  return there.rank() > rank || (there.rank() == rank && least < near && there.least_pivot() > grows * least);
}

bool passes_singular_loops(const Problem& problem, const Unknowns& z, Workspace& w) {
  constexpr double grown = 1e4;               // multipliers, beside the forces they are to balance
  constexpr double lost = 1e-6;               // beside the largest singular value
  constexpr double aside = 1e-3, left = 0.25; // of the step aside, once loops are closed again
  constexpr double balanced = 1e-3;           // of all that acts
  constexpr double level = 1e-5;              // of the terms
  if (!w.matrices(problem) || problem.system.rows == 0 || problem.system.nv == 0) return false;
  const Eigen::VectorXd& column = problem.scaling.column;
  Workspace& beside = w.elsewhere();
  evaluate(problem, {z.q, Eigen::VectorXd::Zero(problem.system.rows)}, 0, beside);
  const Eigen::VectorXd force = beside.residual.f.cwiseProduct(column); // without multipliers
  const double size = force.norm();
  // Nothing is left to hold, as of links that hang straight.
  if (!(size > level * beside.magnitudes.force.cwiseProduct(column).norm())) return false;
  if (!(largest_size(z.lambda.cwiseQuotient(problem.scaling.row)) > grown * size)) return false;
  factor_constraints(problem, beside);
  const auto loops = singular_vectors(beside.dense.jacobian());
  if (!loops || loops->values.size() == 0) return false;
  const Eigen::Index rank = (loops->values.array() > lost * loops->values[0]).count();
  const Eigen::MatrixXd free = loops->right.rightCols(loops->right.cols() - rank);
  const Eigen::VectorXd push = free * (free.transpose() * force);
  if (!(push.norm() > balanced * size)) return false;
  // Where loops are closed beside it is not known: near the push, or between it and another free direction.
  const auto leads_on = [&](const Eigen::VectorXd& direction) {
    if (!(direction.norm() > 0)) return false;
    for (const double side : {aside, -aside}) {
      Eigen::VectorXd q = z.q;
      const Eigen::VectorXd step = side / direction.norm() * direction.cwiseProduct(column);
      retract<double>(problem.system, step, q);
      if (!assemble(problem, q, 0, beside)) continue;
      const Eigen::VectorXd moved = scaled_difference(problem, z.q, q);
      if (moved.norm() > left * aside && std::abs(force.dot(moved)) > balanced * size * moved.norm())
        return true;
    }
    return false;
  };
  if (leads_on(push)) return true;
  for (Eigen::Index i = 0; i < free.cols(); ++i)
    for (const double side : {push.norm(), -push.norm()})
      if (leads_on(push + side * free.col(i))) return true;
  return false;
}

namespace {

// The mechanism as drawn, with places where the steady state has rates, and the drives free: at a dead point
// they lead off the loop.
class DrawnLoops {
 public:
  DrawnLoops(const Mechanism& mechanism, const System& steady)
      : driven_(compile_for_motion(mechanism, steady)), system_(released(driven_)) {
    bind(driven_, mechanism, p_);
    set_scaling(system_, p_, scaling_);
    Eigen::VectorXd speeds = Eigen::VectorXd::Zero(system_.nv);
    drawn_configuration(driven_, p_, drawn_);
    drawn_.conservativeResize(system_.nq);
    set_drives(driven_, p_, 0, drawn_, speeds);
    forward<double>(system_, p_, drawn_, 0, as_drawn_);
  }

  bool at_change_point(int cut) {
    constexpr std::size_t few = 200;
    constexpr double near = 1e-8;                // beside the largest singular value: lost
    constexpr double aside = 1e-4, found = 1e-6; // ... and there again, beyond what leads off the loop
    const CutJoint& joint = system_.cuts[static_cast<std::size_t>(cut)];
    if (joint.ends.support.empty() || joint.ends.support.size() > few) return false; // gears have none
    const auto here = singular_vectors(equations(cut, as_drawn_));
    if (!here || here->values.size() == 0) return false;
    const Eigen::Index rank = (here->values.array() > near * here->values[0]).count();
    if (rank == here->values.size()) return false;
    for (Eigen::Index i = rank; i < here->right.cols(); ++i) {
      interruption_point();
      Eigen::VectorXd step = Eigen::VectorXd::Zero(system_.nv);
      for (std::size_t c = 0; c < joint.ends.support.size(); ++c) {
        const int v = joint.ends.support[c].v;
        step[v] = aside * here->right(static_cast<Eigen::Index>(c), i) * scaling_.column[v];
      }
      Eigen::VectorXd q = drawn_;
      retract<double>(system_, step, q);
      forward<double>(system_, p_, q, 0, beside_);
      const auto there = singular_values(equations(cut, beside_));
      if (there && (*there)[rank] > found * (*there)[0]) return true;
    }
    return false;
  }

 private:
  // Scaled, by the coordinates on the loop, which alone move it: (rows, support).
  Eigen::MatrixXd equations(int cut, const Kinematics<double>& k) const {
    const CutJoint& joint = system_.cuts[static_cast<std::size_t>(cut)];
    const auto rows = static_cast<Eigen::Index>(joint.rows.size());
    Eigen::MatrixXd out(rows, static_cast<Eigen::Index>(joint.ends.support.size()));
    for (Eigen::Index r = 0; r < rows; ++r) {
      Eigen::Index c = 0;
      row_gradient(
          joint, p_.cuts[static_cast<std::size_t>(cut)], joint.rows[static_cast<std::size_t>(r)], k,
          [&](int v, double g) { out(r, c++) = scaling_.row[joint.first_row + r] * g * scaling_.column[v]; });
    }
    return out;
  }

  System driven_, system_;
  Parameters p_;
  Scaling scaling_;
  Eigen::VectorXd drawn_;
  Kinematics<double> as_drawn_, beside_;
};

} // namespace

std::optional<int> find_change_point(const Mechanism& mechanism, const System& steady,
                                     std::span<const int> cuts) {
  if (cuts.empty()) return {};
  DrawnLoops loops(mechanism, steady);
  for (const int cut : cuts) {
    interruption_point();
    if (loops.at_change_point(cut)) return cut;
  }
  return {};
}

} // namespace flyball
