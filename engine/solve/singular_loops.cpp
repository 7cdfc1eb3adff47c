#include "engine/solve/singular_loops.hpp"

#include "engine/linear/spectral.hpp"
#include "engine/solve/drive_cuts.hpp"
#include "engine/system/linearization.hpp"
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

bool is_drawn_at_change_point(const Mechanism& mechanism, const System& steady, int cut) {
  constexpr int few = 200;
  constexpr double near = 1e-8;                // beside the largest singular value: lost
  constexpr double aside = 1e-4, found = 1e-6; // ... and there again, beyond what leads off the loop
  // With places where the steady state has rates, and the drives free: at a dead point they lead off the
  // loop.
  const System driven = compile_for_motion(mechanism, steady), system = released(driven);
  const CutJoint& joint = system.cuts[static_cast<std::size_t>(cut)];
  const auto rows = static_cast<Eigen::Index>(joint.rows.size());
  if (system.nv > few) return false;
  Parameters p;
  bind(driven, mechanism, p);
  Scaling scaling;
  set_scaling(system, p, scaling);
  Eigen::VectorXd drawn, speeds = Eigen::VectorXd::Zero(system.nv);
  drawn_configuration(driven, p, drawn);
  drawn.conservativeResize(system.nq);
  set_drives(driven, p, 0, drawn, speeds);
  const auto parts = [&](const Eigen::VectorXd& q) {
    Kinematics<double> k;
    forward<double>(system, p, q, 0, k);
    Linearization l;
    linearize_constraints(system, p, k, l);
    return singular_vectors(scaling.row.segment(joint.first_row, rows).asDiagonal() *
                            l.constraint.middleRows(joint.first_row, rows) * scaling.column.asDiagonal());
  };
  const auto here = parts(drawn);
  if (!here || here->values.size() == 0) return false;
  const Eigen::Index rank = (here->values.array() > near * here->values[0]).count();
  if (rank == here->values.size()) return false;
  for (Eigen::Index i = rank; i < system.nv; ++i) {
    Eigen::VectorXd q = drawn;
    retract<double>(system, (aside * here->right.col(i)).cwiseProduct(scaling.column), q);
    const auto there = parts(q);
    if (there && there->values[rank] > found * there->values[0]) return true;
  }
  return false;
}

} // namespace flyball
