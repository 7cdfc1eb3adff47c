// A mechanism compiled for motion. Immutable once made, so runs and threads share it.
#pragma once

#include "engine/dynamics/simulation.hpp"
#include "engine/kkt/problem.hpp"
#include "engine/system/released.hpp"

namespace flyball {

struct MotionModel {
  Mechanism mechanism;
  System system;             // cut where the direct solution cuts
  System released;           // the same with drives as coordinates
  Parameters parameters;     // of both; dampers zero where the motion is to be undamped
  Scaling scaling;           // of the free coordinates and the constraint rows
  bool finds_speeds = false; // in the steady state: by torques, momenta that are kept, or loops
  // The equations of motion are solved along the tree (tree_motion.hpp), as far as all that moves has mass.
  bool along_tree = false;
  // They are as sparse equations of the bodies (sparse_motion.hpp), as far as the same holds.
  bool sparse = false;

  Problem problem() const { return {system, parameters, scaling}; }
};

// Springs or dampers act between two bodies, beside what is in tree joints.
bool has_pairs(const System& system);

// Compiles. Throws SceneError.
MotionModel make_motion_model(const Mechanism& mechanism, bool damped);

// Of the model's system, by the numbers of a mechanism that differs from its own in nothing else.
void bind_motion(const System& system, const Mechanism& mechanism, Parameters& out);

// "joint" or "joint.index" as `name`; -1 where there is none.
int coordinate_called(const System& system, std::string_view name);
// The name of the coordinate that entry v of a tangent vector (driven ones after the free) belongs to.
std::string name_of_coordinate(const MotionModel& model, int v);

// A configuration and velocity of the free coordinates to and from names. Where drives stand goes into the
// parameters.
SimulationState name_state(const MotionModel& model, double time, const Eigen::VectorXd& q,
                           const Eigen::VectorXd& u);
// Throws SceneError where the state does not fit the mechanism.
void take_state(const SimulationState& state, MotionModel& model, Eigen::VectorXd& q, Eigen::VectorXd& u);

} // namespace flyball
