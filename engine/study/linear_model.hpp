// The linear model of a mechanism about its steady state, for control engineers: E x' = A x + B u, y = C x +
// D u in small changes of named inputs and outputs.
//
// Derivation. On the null space N of the constraints, q = N p + G u, and the linearised motion is
//     M p'' + (C + G) p' + K p = b0 u + b1 u',
// b0 = -df/du (balance_rate.hpp). Where u is the speed of a drive its rate enters by the inertia of what the
// drive carries, b1 = -N^T M_FD. Where it is the length of a distance joint or the offset of a gear, G moves
// the coordinates so that the loops stay closed; of all that do G is chosen with N^T M G = 0, so that u''
// does not enter, and b1 = -N^T (C + G) G. With w = p' - M^-1 b1 u no derivative is left (as in Ogata,
// Modern Control Engineering, 5th ed., section 2-5):
//     p' = w + M^-1 b1 u,   M w' = -K p - (C + G) w + (b0 - (C + G) M^-1 b1) u.
// The coordinates p are coordinates of joints, as many as are independent. What turns at a speed that is
// found has a rate, and no angle unless asked for: nothing depends on it. A shaft left to itself is one that
// a torque of nothing drives; other momenta are states of their own, so that it has a pole at zero.
#pragma once

#include "engine/linear/state_space.hpp"
#include "engine/solve/solution.hpp"
#include "engine/study/linear_signals.hpp"

#include <atomic>

namespace flyball {

struct LinearModelOptions {
  // Angles of what turns at found speeds are states, too: they integrate. Where one matters (a shaft that
  // stands, two that turn alike with a spring between them; phase_stiffness.hpp) they are in any case.
  bool phases = false;
  // Of the motion once joints with dry friction slip, as eigenvalues are: their hold is left out, their share
  // stays. Otherwise those that stand are rigid, as friction holds against small motions.
  bool slipping = false;
  std::vector<std::pair<std::string, double>> start{}; // as of SolveOptions
  bool nearest = false;
  const std::atomic<bool>* cancel = nullptr;
};

struct LinearModel {
  // Why there is no model, a sentence; empty where there is one. Then the rest means nothing but `steady`.
  std::string refusal;
  // With eigenvalues, of the mechanism that has the model; of what friction holds those once it slips.
  Solution steady;
  // Names, as of coordinate_label(): dry friction holds these, which are no states; against these, which slip
  // at constant rates, it gives its limit.
  std::vector<std::string> held, slipping;
  std::optional<bool> stable; // of the steady state, or where dry friction holds some by the poles
  // "slide" (m) and "slide.rate" (m/s); of a ball "ball.turn.x" (rad), about its parent's axes. The rate of
  // what an input's rate enters is less M^-1 b1 u: `less_input`.
  struct State : LinearSignal {
    bool less_input = false;
  };
  std::vector<State> states;
  std::vector<LinearSignal> inputs, outputs;
  StateSpace descriptor; // with E; always there
  // Without E: nothing where bodies without mass follow the others at once, or where some are so light that
  // the inverse of E would lose the digits of what is slow.
  std::optional<StateSpace> explicit_form;
  std::vector<std::complex<double>> poles; // 1/s, finite ones
  std::optional<Eigen::MatrixXd> gain; // (outputs, inputs), static; nothing where one feels what integrates
  // (outputs): estimated error of the entries of C and D in a row, relative to its largest by what they are
  // measured by. A and B are exact to rounding.
  Eigen::VectorXd output_error;
  double run_time_s = 0; // after the steady state
};

// Of at most 200 coordinates. Throws SceneError for names that are wrong; refuses with the reason where there
// is no steady state or none that stays the same as the drives turn, inputs that move parts by themselves,
// inputs and outputs that turn with the drives, outputs that feel the rate of an input: no state form has
// these; and dry friction that is at its limit without slipping, which holds to one side only.
LinearModel linearize(const Mechanism& mechanism, std::span<const std::string> inputs,
                      std::span<const std::string> outputs, const LinearModelOptions& options = {});

// The form to compute with: without E where there is one.
const StateSpace& best_form(const LinearModel& model);

} // namespace flyball
