// Where a simulation starts.
#pragma once

#include "engine/dynamics/motion_model.hpp"

namespace flyball {

// Finds the configuration and velocity of the free coordinates at the start, loops closed. Where the drives
// stand may go into the model. Throws SceneError where there is no such start.
void find_start(const SimulationOptions& options, MotionModel& model, Eigen::VectorXd& q, Eigen::VectorXd& u);

} // namespace flyball
