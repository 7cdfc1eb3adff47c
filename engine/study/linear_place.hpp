// Where a linear model is made: the motion of a mechanism in a steady state, and the coordinates that tell of
// it.
#pragma once

#include "engine/dynamics/motion_model.hpp"
#include "engine/study/model_coordinates.hpp"

namespace flyball {

class MotionAt;
struct MotionOfAll;

struct LinearPlace {
  // Compiled with those dampers of joints, too, that are none now and not beside it (`beside`): the numbers
  // are those of the mechanism. Throws SceneError.
  LinearPlace(const Mechanism& mechanism, const Mechanism& beside, const Solution& steady);

  // Which coordinates tell of the motion: `drawn`, of at(0) and `held`. `with_phases`: angles of what turns
  // at speeds that are found are states in any case. Throws Refusal.
  void choose(const MotionAt& drawn, bool with_phases);

  // All at time t (s) after the drawn phase.
  MotionOfAll at(double t) const;
  // Coordinates on the basis from those of the model, and these from those: (k, k). Throws Refusal.
  Eigen::MatrixXd from_chosen(const MotionAt& motion) const;
  Eigen::MatrixXd to_chosen(const MotionAt& motion) const;

  MotionModel model;
  System steady;             // what turns at speeds that are found does so steadily
  Parameters parameters;     // of `steady`
  Eigen::VectorXd q, u;      // of the motion
  Eigen::VectorXd balance_q; // what the balance takes: speeds in the place of angles
  std::vector<int> held; // entries of q_R, by dry friction; whoever knows of any sets them before choosing
  ModelCoordinates chosen;
  bool angles = false; // some of what turns at found speeds matter
  bool phases = false; // these angles are states
};

} // namespace flyball
