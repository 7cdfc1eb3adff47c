// Eq. 20 of the paper, evaluated as written: the velocity transformation B formed explicitly, Bdot_D q_D' by
// differentiating the motion of the drives twice, forces as wrenches in absolute coordinates, constraints as
// functions of absolute placements. Slow and plain, in long double; the tests hold the engine to it.
//
//   balance     f = B^T (M Bdot_D q_D' + gyroscopic terms - Q) + Phi_q^T lambda     (inertia minus applied)
//   rows        all tree coordinates; those without a drive of their own vanish in a steady state, the others
//               are then the drives' forces, positive along the coordinate
//   rotations   where a coordinate is a component of a rotation vector, its row is conjugate to a small
//               rotation exp(delta) on the left of the relative rotation, in the parent's axes (see tree.hpp)
//   x_b         [mass centre; orientation] of body b: v of the mass centre and angular velocity, world axes
#pragma once

#include "tests/engine/reference/tree.hpp"

#include <map>
#include <string>
#include <vector>

namespace flyball::reference {

struct Wrench {
  Vec3R force = Vec3R::Zero();  // N, world axes
  Vec3R torque = Vec3R::Zero(); // N m, about the mass centre, world axes
};

struct ReferenceBody {
  Vec3R position = Vec3R::Zero();                                           // m, mass centre
  Mat3R rotation = Mat3R::Identity();                                       // R_WB
  Vec3R velocity = Vec3R::Zero(), angular_velocity = Vec3R::Zero();         // of the drives' motion
  Vec3R acceleration = Vec3R::Zero(), angular_acceleration = Vec3R::Zero(); // Bdot_D q_D'
  Wrench inertial; // M Bdot_D q_D' and omega x I omega: what all forces on the body must amount to
  Wrench
      applied; // gravity and `forces`; not what acts in joints (springs, stops, dampers, drives, reactions)
};

struct Evaluation {
  Tree tree;
  std::vector<ReferenceBody> bodies; // in the mechanism's order
  MatrixR B;                         // 6 bodies x coordinates, eq. 4
  VectorR balance;                   // f without multipliers, by tree coordinate
  VectorR constraints;               // Phi of the cut joints, eq. 3
  MatrixR constraint_jacobian;       // Phi_q, by tree coordinate (eq. 12)
  std::vector<int> constraint_joint; // by row of Phi: its joint
  std::vector<int> free, driven;     // which tree coordinates are q_R and q_D
  std::vector<int> unpowered;        // those without a drive of their own: q_R, and what gears drive

  // f with these multipliers, by joint name, for all tree joints with coordinates.
  std::map<std::string, VectorR> by_joint(const Mechanism& mechanism, const VectorR& lambda) const;
  // Multipliers that balance the unpowered rows best, the shortest among them where loops are redundant.
  VectorR multipliers() const;
  // The unpowered rows of f with those: what no multipliers can balance. Zero in a steady state at this
  // phase.
  VectorR unbalanced() const;
};

// Throws std::invalid_argument where `cut_joints` do not leave a tree (see span_tree).
Evaluation evaluate(const Mechanism& mechanism, const std::vector<std::string>& cut_joints,
                    const ReferenceState& state);

// f by joint name; lambda may be empty for none, else in the order of Evaluation::constraints.
std::map<std::string, VectorR> generalized_forces(const Mechanism& mechanism,
                                                  const std::vector<std::string>& cut_joints,
                                                  const ReferenceState& state, const VectorR& lambda = {});

// Whether the forces have a potential: no torques, no forces fixed in bodies, no drag, and dampers left out.
bool has_potential(const Mechanism& mechanism);

// The amended potential V - T with T of the drives' motion alone (J). Its stationary points over the free
// coordinates on the constraints are the steady states where T does not depend on the drives' phase.
// Throws std::invalid_argument where there is no potential.
Real potential(const Mechanism& mechanism, const std::vector<std::string>& cut_joints,
               const ReferenceState& state);

// The state nearby whose loops close, moving free coordinates only (Gauss-Newton, shortest steps). Throws
// std::runtime_error where none is found.
ReferenceState assemble(const Mechanism& mechanism, const std::vector<std::string>& cut_joints,
                        const ReferenceState& state);

} // namespace flyball::reference
