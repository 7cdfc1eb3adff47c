// How the wrench that one body's inertia and loads ask for changes with its pose: the 6 x 6 stiffness K_b of
// tree_kkt.hpp, and the body's inertia as a metric of small motions.
//
// Motions are (turn, shift of the link's origin), wrenches (moment about that origin, force), world axes. K_b
// is the change beyond the turning of the wrench with the body.
#pragma once

#include "engine/kkt/problem.hpp"

namespace flyball {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

struct BodyInertia {
  double mass = 0;    // kg
  double turning = 0; // kg m^2, what the metric adds to the inertia: turning counts as if the body were large
  Vec3 first_moment;  // kg m, about the link's origin
  Mat3 inertia;       // kg m^2, about the link's origin
  bool massless() const { return mass == 0 && inertia.isZero(0); }
};

void set_body_inertia(const Parameters& parameters, std::size_t link, const Kinematics<double>& kinematics,
                      BodyInertia& out);

// The same with K_b of inertia forces and weight.
void set_body_stiffness(const Parameters& parameters, std::size_t link, const Kinematics<double>& kinematics,
                        BodyInertia& out, Mat6& own);

// Adds a force, torque or force of the air on the body.
void add_body_force(const BodyForceElement& element, const BodyForceParameters& force,
                    const Kinematics<double>& kinematics, Mat6& own);

// How the wrench changes with the body's velocity in a frame that turns with w (rad/s): Coriolis forces.
Mat6 coriolis_matrix(const BodyInertia& body, const Vec3& w);
// Adds how a force of the air changes with the body's velocity; and, a part of add_body_force, with its turn
// in a wind, which does not turn with it.
void add_air_damping(const BodyForceElement& element, const BodyForceParameters& air,
                     const Kinematics<double>& kinematics, Mat6& damping);
void add_wind(const BodyForceElement& element, const BodyForceParameters& air,
              const Kinematics<double>& kinematics, Mat6& own);

// The metric as a matrix; and applied to a motion.
Mat6 inertia_matrix(const BodyInertia& body);
Vec6 times_inertia(const BodyInertia& body, const Vec6& motion);

// S x* F: how a wrench changes that is turned and shifted along `s`.
inline Vec6 turned(const Vec6& s, const Vec3& moment, const Vec3& force) {
  Vec6 x;
  x.head<3>() = s.head<3>().cross(moment) + s.tail<3>().cross(force);
  x.tail<3>() = s.head<3>().cross(force);
  return x;
}

// The motion of a body at a point `r` from where it is given.
inline Vec6 carried(const Vec6& motion, const Vec3& r) {
  Vec6 x = motion;
  x.tail<3>() += motion.head<3>().cross(r);
  return x;
}

// A wrench about a point as one about another, from which the first is `r` away.
inline Vec6 about(const Vec6& wrench, const Vec3& r) {
  Vec6 x = wrench;
  x.head<3>() += r.cross(wrench.tail<3>());
  return x;
}

} // namespace flyball
