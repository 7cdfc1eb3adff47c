// Springs, dampers, vanes and drives that stand on a kink of their laws (force_law.hpp, drive_law.hpp), where
// the slope jumps; and coordinates just at their stop, which presses on one side alone.
//
// The balance has one derivative on either side there, so eigenvalues tell of one side. Where there is a
// potential the sides can be compared: with the smaller slope of every spring on a kink in place of its law
// the second variation is nowhere larger than that of any side, and with the larger one nowhere smaller. Of
// the torque of a drive each side can be looked at by itself.
#pragma once

#include "engine/kkt/problem.hpp"

#include <array>
#include <vector>

namespace flyball {

struct Kink {
  // Whose law: an entry of System::coordinate_laws, spring_laws, cut_damper_laws, body_forces, turning_air or
  // torques; of a stop of System::links.
  enum class Of { coordinate, spring, cut_damper, vane, vane_in_turning_air, drive, stop };
  enum class Law { spring, damper, lift, drag, torque, load };
  Of of = Of::coordinate;
  std::size_t entry = 0;
  Law law = Law::spring;
  double at = 0;                  // the deflection, rate or incidence; of a stop the coordinate
  std::array<double, 2> slopes{}; // before and after
  // Of a drive: which of the law's inputs crosses the kink, in DriveLaw::inputs, and the derivatives with all
  // of them before and after. `at` is that input. No derivatives where the input itself has none there, as a
  // distance of zero: it grows whichever way it is left. Of a stop `input` is the component of a rotation
  // vector.
  std::size_t input = 0;
  std::array<std::vector<double>, 2> gradients{};
};

// At a configuration, whose kinematics are at the drawn phase.
std::vector<Kink> find_kinks(const Problem& problem, const Eigen::VectorXd& q,
                             const Kinematics<double>& kinematics);

// Whether anything has a law or stop with a kink that a state could stand on.
bool may_have_kinks(const System& system, const Parameters& parameters);

// The numbers with a straight line, of the smaller or larger slope, in place of the law of every spring that
// stands on a kink, and with every stop that is just touched away or pressing on both sides.
enum class KinkSide { softer, stiffer };
Parameters straightened(const Problem& problem, const std::vector<Kink>& kinks, KinkSide side);

// The numbers with the law of a drive as it is on one side of its kink: 0 before, 1 after.
Parameters beside_kink(const Problem& problem, const Kink& of_drive, std::size_t side);

} // namespace flyball
