// Drives by torque. What they turn does so at a constant speed w, which is not given: it stands in q_R in the
// place of the coordinate, and the balance has a row for it, what turning takes less what the drive gives,
//
//     f_w = f_d(q_R, w) + c w - T(w, q_R) + L(w, q_R) = 0       c: the damper on the coordinate
//
// f_d as of any coordinate. Its column is the derivative with the speed: that of the velocity matrix D =
// df/dq' of the coordinates all set free. In the linearised motion the coordinate itself, the phase, is
// cyclic: no force depends on it, its column of K = df/dq is zero, and so is one eigenvalue, which says
// nothing.
#pragma once

#include "engine/system/kinematics.hpp"
#include "engine/system/point_quantity.hpp"

#include <functional>

namespace flyball {

// Adds the dampers of what turns so, less torques, plus loads, to f. In a system for the motion, where it is
// a coordinate like others, torques and loads alone.
template <class S>
void add_drive_torques(const System& system, const ParametersOf<S>& parameters, const Configuration<S>& q,
                       const Kinematics<S>& kinematics, Configuration<S>& f);

// Adds the sizes of these terms.
void add_drive_torque_sizes(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                            const Kinematics<double>& kinematics, Eigen::VectorXd& force);

// The same of torques and loads that are laws alone.
void add_drive_law_sizes(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                         const Kinematics<double>& kinematics, Eigen::VectorXd& force);

// What a drive gives, by System::torques: torque less load (N m or N).
double drive_torque(const System& system, const Parameters& parameters, std::size_t drive,
                    const Eigen::VectorXd& q, const Kinematics<double>& kinematics);

// The same by themselves.
struct TorqueAndLoad {
  double torque = 0, load = 0;
};
TorqueAndLoad torque_and_load(const System& system, const Parameters& parameters, std::size_t drive,
                              const Eigen::VectorXd& q, const Kinematics<double>& kinematics);

// What the law of a torque or load is given for one of its inputs, what it may be in size, and whether it
// stands where that has no slope: a distance or the speed of a point of zero, an angle of 0 or pi, the size
// of a spring's or bearing's force that vanishes, what a spring exerts whose points meet.
double law_input(const System& system, const Parameters& parameters, const DriveLaw& law,
                 const DriveLawParameters& numbers, std::size_t input, const Eigen::VectorXd& q,
                 const Kinematics<double>& kinematics);
double law_input_size(const System& system, const Parameters& parameters, const DriveLaw& law,
                      const DriveLawParameters& numbers, std::size_t input, const Eigen::VectorXd& q,
                      const Kinematics<double>& kinematics);
bool stands_on_own_kink(const System& system, const Parameters& parameters, const DriveLaw& law,
                        const DriveLawParameters& numbers, std::size_t input, const Eigen::VectorXd& q,
                        const Kinematics<double>& kinematics);

// How an input of points (which are DriveLawParameters::points of it), or of what is between two, changes
// with the coordinates of q_R or with their rates: calls add(v, change), several times for one that moves
// several points. Not a number of an angle of 0 or pi.
void add_input_rates(const System& system, const Parameters& parameters, const DriveLaw::Input& input,
                     const TrackedPoints& points, const Kinematics<double>& kinematics, bool with_rates,
                     const std::function<void(int v, double change)>& add);

// The derivatives of the law of a torque or load with its inputs, where one of them is `by` further on.
std::vector<double> drive_law_slopes(const System& system, const Parameters& parameters, const DriveLaw& law,
                                     const DriveLawParameters& numbers, const Eigen::VectorXd& q,
                                     const Kinematics<double>& kinematics, std::size_t moved, double by);

// Adds the derivatives of torques and loads to df/dq and df/dq', the dampers left out.
void add_drive_torque_stiffness(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                                const Kinematics<double>& kinematics, Eigen::MatrixXd& stiffness);
void add_drive_torque_damping(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                              const Kinematics<double>& kinematics, Eigen::MatrixXd& velocity);

// The same one by one: with coordinates, or with rates.
struct DriveTorqueEntry {
  int row = 0, column = 0; // in q_R
  double value = 0;
};
std::vector<DriveTorqueEntry> drive_torque_entries(const System& system, const Parameters& parameters,
                                                   const Eigen::VectorXd& q,
                                                   const Kinematics<double>& kinematics, bool rates);

// The rate of a coordinate of one axis, from the motion of its link.
double turning_rate(const System& system, int link, const Kinematics<double>& kinematics);

} // namespace flyball
