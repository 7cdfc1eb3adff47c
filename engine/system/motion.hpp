// The mechanism in motion: kinematics at any velocity of any coordinate, the mass matrix, rates of the
// constraints and what the dampers take. With the residual at these kinematics they make eq. 19. Made for the
// released system (released.hpp), whose driven coordinates have columns, too.
//
// A velocity u is a tangent vector: q' of a revolute or prismatic coordinate, the angular velocity of a
// rotation in the axes of its parent (q moves as retract() says).
#pragma once

#include "engine/system/linearization.hpp"

namespace flyball {

// Velocity and acceleration of a link in a second velocity field, see move().
struct LinkRates {
  Vec3 w, v, dw, dv;
};

// The configuration moves with `u`. `s` is a velocity whose momentum is sought: as a rule u itself, else one
// that moves everything that has mass as u does (the integrated velocity of massless bodies means nothing,
// and may be held at zero). The links' accelerations are such that m dv and I dw + w x I w are the rates of
// the momenta of s, for s' = a; with s = u they are simply the accelerations.
struct CoordinateMotion {
  const Eigen::VectorXd& q; // quaternions of any length
  const Eigen::VectorXd& u;
  const Eigen::VectorXd* s = nullptr; // null: u
  const Eigen::VectorXd* a = nullptr; // null: zero
};

// Fills `out`; `carried` gets the field of s where that is not u, else it is emptied.
void move(const System& system, const Parameters& parameters, const CoordinateMotion& state,
          Kinematics<double>& out, std::vector<LinkRates>& carried);

// d/dt Phi along s, by row.
void constraint_rates(const System& system, const Parameters& parameters, const Eigen::VectorXd& s,
                      const Kinematics<double>& kinematics, const std::vector<LinkRates>& carried,
                      Eigen::VectorXd& out);
// Its derivative along u: Phi'' where s = u. Zero for gears, which are linear.
void constraint_accelerations(const System& system, const Parameters& parameters,
                              const Kinematics<double>& kinematics, const std::vector<LinkRates>& carried,
                              Eigen::VectorXd& out);

// M by the composite-body algorithm. `size` gets what the diagonal could be at most in each coordinate (kg,
// or kg m^2: the trace of what moves with it), to tell rounding from mass.
struct MassMatrix {
  Eigen::MatrixXd mass;
  Eigen::VectorXd size;
  std::vector<CompositeBody> composites; // `b` and `momentum` unused
};
void evaluate_mass(const System& system, const Parameters& parameters, const Kinematics<double>& kinematics,
                   MassMatrix& out);

// Adds the forces of dampers on coordinates to f: those between two bodies and drag are in the residual.
void add_coordinate_damping(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                            const Eigen::VectorXd& u, Eigen::VectorXd& f);

// The derivative with q (N m per rad) of a spherical link's damping torque at `rate` (rad/s): its rotation
// vector turns the directions in which its dampers act. The same added for all links.
Mat3 rotation_damping_stiffness(const Link& link, const LinkParameters& parameters, const Eigen::VectorXd& q,
                                const Vec3& rate);
void add_coordinate_damping_stiffness(const System& system, const Parameters& parameters,
                                      const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                                      Eigen::MatrixXd& stiffness);

// W: taken by dampers, friction and drag; given by torques and forces fixed in bodies, which have no
// potential.
struct ForcePowers {
  double dissipated = 0, applied = 0;
};
ForcePowers force_powers(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                         const Eigen::VectorXd& u, const Kinematics<double>& kinematics);

// J. The potential of gravity, springs, stops and forces constant in the world, of all bodies; kinetic energy
// of the whole motion.
double potential_energy(const System& system, const Parameters& parameters, const Eigen::VectorXd& q,
                        const Kinematics<double>& kinematics);
double kinetic_energy(const System& system, const Parameters& parameters,
                      const Kinematics<double>& kinematics);

} // namespace flyball
