// How a mode moves the bodies in space, and whether it whirls about a drive's axis.
#pragma once

#include "engine/stability/modes.hpp"

#include <array>
#include <optional>
#include <string_view>

namespace flyball {

// Of one body: it moves as Re(value e^(s t)) from where the steady state has it. World axes at the drawn
// phase; what drives carry turns with them.
struct BodyAmplitude {
  Eigen::Vector3cd displacement = Eigen::Vector3cd::Zero(); // m, of the mass centre
  Eigen::Vector3cd rotation = Eigen::Vector3cd::Zero();     // rad, as a small rotation's vector
};

// By body of the mechanism, of a mode about the configuration q; leaves `w.kinematics` there.
std::vector<BodyAmplitude> body_amplitudes(const Problem& problem, const Eigen::VectorXd& q,
                                           const VibrationMode& mode, Workspace& w);

enum class WhirlDirection { forward, backward, straight };
std::string_view word(WhirlDirection direction);

// The sense in which the mass centres and the bodies' axes go round a drive's axis.
struct Whirl {
  // 1: all in circles the way the drive turns, -1: against it, 0: to and fro in planes. Of ellipses with half
  // axes a and b, 2ab / (a^2 + b^2), weighted with masses and inertias: that of the forward circle less that
  // of the backward circle of which such a motion is made.
  double value = 0;
  bool turning = false; // as seen from the frame that turns with the drive, which carries what moves
  double speed = 0;     // rad/s, of the drive
  // Straight where the circles differ by less than a thousandth.
  WhirlDirection direction() const;
};
// Of a whirl seen from the frame that turns, as seen from the ground: the frequencies (rad/s) of the forward
// and the backward circle. |speed + f|, |speed - f|.
std::array<double, 2> standing_frequencies(const Whirl& whirl, double frequency);

// About the axis of `drive`, a link that a drive turns. Nothing where the mode does not swing, nothing moves
// across the axis, or both what the drive carries and what it does not carry does: that is the same motion in
// no frame.
std::optional<Whirl> find_whirl(const Problem& problem, const Eigen::VectorXd& q, const VibrationMode& mode,
                                int drive, Workspace& w);

// The modal assurance criterion |a^H b|^2 / (a^H a b^H b) of two modes of one mechanism, over its free
// coordinates in radians and reaches: 1 for the same shape, 0 for orthogonal ones (Allemang and Brown, A
// correlation coefficient for modal vector analysis, 1982). 0 where either has no shape.
double modal_assurance(const VibrationMode& a, const VibrationMode& b);

} // namespace flyball
