// The numbers of a mechanism, laid out for the system's passes. Rewritten when a slider moves; a change of
// numbers never recompiles. N: double, or Dual for the numbers with their rates.
#pragma once

#include "engine/mechanism/number_rates.hpp"
#include "engine/system/bound_law.hpp"
#include "engine/system/spatial.hpp"
#include "engine/system/system.hpp"

namespace flyball {

// A spring and a damper along one coordinate or length.
template <class N>
struct BasicSpringDamper {
  N stiffness = 0, damping = 0;
  // In place of stiffness and damping, which then are 0 and that at rest; null: none.
  std::shared_ptr<const BasicForceLaws<N>> laws;
  bool has_spring() const { return stiffness != 0 || (laws && laws->spring); }
  bool damped() const { return damping != 0 || (laws && laws->damper); }

  // What the damper resists a rate with, and how fast that changes with it.
  template <class S>
  S resistance(S rate) const {
    return laws && laws->damper ? laws->damper.value(rate) : S(damping) * rate;
  }
  N resistance_slope(N rate) const { return laws && laws->damper ? laws->damper.slope(rate) : damping; }
  void remove_damper() {
    damping = 0;
    if (laws)
      laws = std::make_shared<BasicForceLaws<N>>(BasicForceLaws<N>{laws->spring, BoundLaw(), laws->free});
  }
};

// Spring, damper, stop and friction of one coordinate. In a steady state friction is a constant force, with
// the potential of one; at a given speed one against it, which the drive bears.
template <class N>
struct BasicCoordinateForce : BasicSpringDamper<N> {
  using BasicSpringDamper<N>::stiffness, BasicSpringDamper<N>::laws;
  N free = 0;
  N lower = 0, upper = 0, stop_stiffness = 0; // stop_stiffness 0: no stop
  bool has_lower = false, has_upper = false;
  N friction = 0; // what friction gives, N m or N, positive along the coordinate
  // Where the spring is slack.
  N slack() const { return laws && laws->spring ? laws->free : free; }
  bool elastic() const { return this->has_spring() || stop_stiffness != 0; }

  // Torque or force of the spring, stop and friction on the coordinate's own side: dV/dq at q.
  template <class S>
  S gradient(S q) const {
    S g = S(stiffness) * (q - S(free)) - S(friction);
    if (laws) g += laws->spring.value(S(q - S(laws->free)));
    if (has_lower && q < S(lower)) g += S(stop_stiffness) * (q - S(lower));
    if (has_upper && q > S(upper)) g += S(stop_stiffness) * (q - S(upper));
    return g;
  }
  bool touched(N q) const { return (has_lower && q < lower) || (has_upper && q > upper); }
  N curvature(N q) const {
    const N k = stiffness + (touched(q) ? stop_stiffness : N(0));
    return laws ? k + laws->spring.slope(q - laws->free) : k;
  }
  template <class S>
  S energy(S q) const {
    S v = S(stiffness) * (q - S(free)) * (q - S(free));
    if (has_lower && q < S(lower)) v += S(stop_stiffness) * (q - S(lower)) * (q - S(lower));
    if (has_upper && q > S(upper)) v += S(stop_stiffness) * (q - S(upper)) * (q - S(upper));
    v = v / 2 - S(friction) * q;
    return laws ? v + laws->spring.energy(q - laws->free) : v;
  }
};

// Those of a link, one each or three for a spherical one; most links have none and hold none.
template <class N>
class BasicCoordinateForces {
 public:
  using Force = BasicCoordinateForce<N>;
  const Force& operator[](std::size_t i) const { return i < held_.size() ? held_[i] : none; }
  Force& hold(std::size_t i) {
    if (i >= held_.size()) held_.resize(i + 1);
    return held_[i];
  }
  void clear() { held_.clear(); }
  auto begin() { return held_.begin(); }
  auto end() { return held_.end(); }
  auto begin() const { return held_.begin(); }
  auto end() const { return held_.end(); }

 private:
  static inline const Force none{};
  std::vector<Force> held_;
};

// What every pass over the links reads comes first.
template <class N>
struct BasicLinkParameters {
  Vec3T<N> offset = Vec3T<N>::Zero(); // m, p of this link's origin in its parent's, drawn pose
  Vec3T<N> axis = Vec3T<N>::UnitZ();  // unit, drawn pose; turned round where the tree runs against the joint
  N drawn = 0;                        // label of the drawn pose
  N mass = 0;                         // kg
  bool has_inertia = false;
  bool elastic = false;                // any of `force` is a spring, stop or friction
  Vec3T<N> com = Vec3T<N>::Zero();     // m, mass centre from the link's origin, drawn pose
  Mat3T<N> inertia = Mat3T<N>::Zero(); // kg m^2, about the mass centre, drawn-pose world axes
  N speed = 0;      // driven: rad/s or m/s, before Parameters::speed_scale; by a torque: at first
  N start = 0;      // driven: displacement from the drawn pose at phase zero (a gear may ask for one)
  N gear_ratio = 1; // driven: speed per speed of its motor
  Vec3T<N> origin = Vec3T<N>::Zero(); // m, this link's origin in the drawn pose, from Parameters::origin
  Eigen::Quaternion<N> drawn_rotation =
      Eigen::Quaternion<N>::Identity(); // spherical: exp of the drawn rotation vector
  BasicCoordinateForces<N> force;
};

// A point fixed in a link, from the link's origin at the drawn pose.
template <class N>
using BasicOffset = Vec3T<N>;

// A point of a body as the passes see it.
template <class N>
struct BasicTrackedPoint {
  int link = -1; // -1 is ground
  BasicOffset<N> at = BasicOffset<N>::Zero();
};

template <class N>
struct BasicPointSpringParameters : BasicSpringDamper<N> {
  using BasicSpringDamper<N>::stiffness, BasicSpringDamper<N>::damping, BasicSpringDamper<N>::laws;
  BasicOffset<N> a, b;
  N free_length = 0;
  // No force but k d between its points, which may meet.
  bool without_length() const { return free_length == N(0) && damping == N(0) && !laws; }

  template <class S>
  S pull(S length) const {
    const S stretch = length - S(free_length);
    return laws && laws->spring ? laws->spring.value(stretch) : S(stiffness) * stretch;
  }
  N pull_slope(N length) const {
    return laws && laws->spring ? laws->spring.slope(length - free_length) : stiffness;
  }
  N energy(N length) const {
    const N stretch = length - free_length;
    return laws && laws->spring ? laws->spring.energy(stretch) : stiffness * stretch * stretch / 2;
  }
  void remove() {
    stiffness = damping = 0;
    laws.reset();
  }
};

template <class N>
struct BasicBearingParameters {
  BasicOffset<N> a, b;                       // the bearing's point in either
  Mat3T<N> axes;                             // x, y, z as columns, drawn pose
  Eigen::Matrix<N, 6, 6> stiffness, damping; // of two rows: those of x and y, else zero

  // Whether it does more than resist shifts.
  bool resists_turns() const {
    // By values alone: an entry of zero may well have a rate.
    const auto acts = [](const N& entry) { return entry < N(0) || entry > N(0); };
    const auto beyond_shifts = [&](const Eigen::Matrix<N, 6, 6>& m) {
      return m.template bottomRows<3>().unaryExpr(acts).any() ||
             m.template rightCols<3>().unaryExpr(acts).any();
    };
    return beyond_shifts(stiffness) || beyond_shifts(damping);
  }
};

template <class N>
struct BasicBodyForceParameters {
  ForceType type = ForceType::force;
  ForceFrame frame = ForceFrame::world;
  BasicOffset<N> at = BasicOffset<N>::Zero();
  Vec3T<N> vector = Vec3T<N>::Zero(); // drawn-pose world axes
  N linear = 0, quadratic = 0;
  // Of the air, see air_force.hpp: N s^2/m^2; units, drawn-pose world axes, the span zero but for a blade;
  // m/s of the air where it does not turn.
  N normal_quadratic = 0;
  Vec3T<N> normal = Vec3T<N>::Zero(), span = Vec3T<N>::Zero(), wind = Vec3T<N>::Zero();
  std::shared_ptr<const Polar> polar{}; // in place of normal_quadratic, its coefficients times quadratic
};

// Without a spring, which would need the joint's own coordinate.
template <class N>
struct BasicCutDamperParameters : BasicSpringDamper<N> {
  BasicOffset<N> b; // the joint's point on the second end
  Vec3T<N> axis;    // fixed in end a
};

template <class N>
struct BasicDriveLawParameters {
  N value = 0;               // N m or N, where no expression gives it
  std::vector<Dual> numbers; // by name of the expression
  // By input: of those that are of points.
  std::vector<std::array<BasicTrackedPoint<N>, 3>> points{};
  // On one side of a kink: the derivatives with the inputs, in place of the expression's; empty elsewhere.
  std::vector<double> slopes{};
};

template <class N>
struct BasicDriveTorqueParameters {
  BasicDriveLawParameters<N> torque, load;
  N momentum = 0; // kg m^2/s or kg m/s, where it is kept: in the drawn pose at the given speed
};

template <class N>
struct BasicCutParameters {
  BasicOffset<N> a, b;           // the joint's point on either end; a distance joint's points
  std::array<Vec3T<N>, 4> frame; // x, y, z (axis), second axis; drawn pose
  std::array<N, 6> drawn{};      // labels of the drawn pose, rad or m
  N constant = 0;                // direction rows of a universal joint
  N length = 0;                  // distance
  N ratio = 0, offset = 0;       // gear
};

template <class N>
struct BasicParameters {
  Vec3T<N> origin = Vec3T<N>::Zero(); // m: the world point that positions are taken from, to keep digits far
                                      // from the world's origin
  Vec3T<N> gravity = Vec3T<N>::Zero();
  N speed_scale = 1;   // all drive speeds times this: homotopy from rest
  N length = 1;        // m, characteristic: the mechanism's reach
  bool moving = false; // any drive turns
  std::vector<BasicLinkParameters<N>> links;
  std::vector<BasicPointSpringParameters<N>> springs;
  std::vector<BasicBearingParameters<N>> bearings;
  std::vector<BasicBodyForceParameters<N>> body_forces, turning_air;
  std::vector<BasicCutDamperParameters<N>> cut_dampers;
  std::vector<BasicDriveTorqueParameters<N>> torques;
  std::vector<BasicCutParameters<N>> cuts;
  // The whole balance is the same at every phase of the drives, by the shape of the mechanism alone: one
  // frame turns about an axis along gravity and nothing acts between it and the ground.
  bool phase_free = false;
  // Some damper's law gives energy where it hardly moves. The balance of a steady state does not know it, but
  // a minimum of the potential need not be stable.
  bool dampers_drive = false;
};

using CoordinateForce = BasicCoordinateForce<double>;
using LinkParameters = BasicLinkParameters<double>;
using Offset = BasicOffset<double>;
using PointSpringParameters = BasicPointSpringParameters<double>;
using BearingParameters = BasicBearingParameters<double>;
using BodyForceParameters = BasicBodyForceParameters<double>;
using CutDamperParameters = BasicCutDamperParameters<double>;
using DriveLawParameters = BasicDriveLawParameters<double>;
using DriveTorqueParameters = BasicDriveTorqueParameters<double>;
using CutParameters = BasicCutParameters<double>;
using Parameters = BasicParameters<double>;

// Those that calculations with S take.
template <class S>
using LinkParametersOf = BasicLinkParameters<NumberOf<S>>;
template <class S>
using OffsetOf = BasicOffset<NumberOf<S>>;
template <class S>
using PointSpringParametersOf = BasicPointSpringParameters<NumberOf<S>>;
template <class S>
using BearingParametersOf = BasicBearingParameters<NumberOf<S>>;
template <class S>
using BodyForceParametersOf = BasicBodyForceParameters<NumberOf<S>>;
template <class S>
using CutDamperParametersOf = BasicCutDamperParameters<NumberOf<S>>;
template <class S>
using CutParametersOf = BasicCutParameters<NumberOf<S>>;
template <class S>
using ParametersOf = BasicParameters<NumberOf<S>>;

// Rewrites `parameters` (no allocation after the first time). The mechanism must have the parts the system
// was compiled from.
void bind(const System& system, const Mechanism& mechanism, Parameters& parameters);
// With rates, of the mechanism's numbers; all that the balance is made of, so neither the characteristic
// length nor what holds at all phases. The scale of speeds is that of `of`.
void bind(const System& system, const Mechanism& mechanism, const NumberRates& rates, const Parameters& of,
          BasicParameters<Dual>& parameters);

// The drawn pose as a configuration of q_R, one entry a coordinate, four a rotation.
void drawn_configuration(const System& system, const Parameters& parameters, Eigen::VectorXd& q);

} // namespace flyball
