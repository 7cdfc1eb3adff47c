// The numbers of a mechanism, laid out for the system's passes. Rewritten when a slider moves; a change of
// numbers never recompiles.
#pragma once

#include "engine/system/system.hpp"

namespace flyball {

// Spring, damper and stop of one coordinate.
struct CoordinateForce {
  double stiffness = 0, free = 0, damping = 0;
  double lower = 0, upper = 0, stop_stiffness = 0; // stop_stiffness 0: no stop
  bool has_lower = false, has_upper = false;
  bool elastic() const { return stiffness != 0 || stop_stiffness != 0; }

  // Torque or force of the spring and stop on the coordinate's own side: dV/dq at q.
  template <class S>
  S gradient(S q) const {
    S g = S(stiffness) * (q - S(free));
    if (has_lower && q < S(lower)) g += S(stop_stiffness) * (q - S(lower));
    if (has_upper && q > S(upper)) g += S(stop_stiffness) * (q - S(upper));
    return g;
  }
  double curvature(double q) const {
    return stiffness + ((has_lower && q < lower) || (has_upper && q > upper) ? stop_stiffness : 0);
  }
  template <class S>
  S energy(S q) const {
    S v = S(stiffness) * (q - S(free)) * (q - S(free));
    if (has_lower && q < S(lower)) v += S(stop_stiffness) * (q - S(lower)) * (q - S(lower));
    if (has_upper && q > S(upper)) v += S(stop_stiffness) * (q - S(upper)) * (q - S(upper));
    return v / 2;
  }
};

// Those of a link, one each or three for a spherical one; most links have none and hold none.
class CoordinateForces {
 public:
  const CoordinateForce& operator[](std::size_t i) const { return i < held_.size() ? held_[i] : none; }
  CoordinateForce& hold(std::size_t i) {
    if (i >= held_.size()) held_.resize(i + 1);
    return held_[i];
  }
  void clear() { held_.clear(); }
  auto begin() { return held_.begin(); }
  auto end() { return held_.end(); }
  auto begin() const { return held_.begin(); }
  auto end() const { return held_.end(); }

 private:
  static constexpr CoordinateForce none{};
  std::vector<CoordinateForce> held_;
};

// What every pass over the links reads comes first.
struct LinkParameters {
  Vec3 offset = Vec3::Zero(); // m, p of this link's origin in its parent's, drawn pose
  Vec3 axis = Vec3::UnitZ();  // unit, drawn pose; turned round where the tree runs against the joint
  double drawn = 0;           // label of the drawn pose
  double mass = 0;            // kg
  bool has_inertia = false;
  bool elastic = false;        // any of `force` is a spring or stop
  Vec3 com = Vec3::Zero();     // m, mass centre from the link's origin, drawn pose
  Mat3 inertia = Mat3::Zero(); // kg m^2, about the mass centre, drawn-pose world axes
  double speed = 0;            // driven: rad/s or m/s, before Parameters::speed_scale; by a torque: at first
  double start = 0;      // driven: displacement from the drawn pose at phase zero (a gear may ask for one)
  double gear_ratio = 1; // driven: speed per speed of its motor
  Vec3 origin = Vec3::Zero();             // m, this link's origin in the drawn pose, from Parameters::origin
  Quat drawn_rotation = Quat::Identity(); // spherical: exp of the drawn rotation vector
  CoordinateForces force;
};

// A point fixed in a link, from the link's origin at the drawn pose.
using Offset = Vec3;

struct PointSpringParameters {
  Offset a, b;
  double stiffness = 0, free_length = 0, damping = 0;
};

struct BodyForceParameters {
  ForceType type = ForceType::force;
  ForceFrame frame = ForceFrame::world;
  Offset at;
  Vec3 vector; // drawn-pose world axes
  double linear = 0, quadratic = 0;
};

struct CutDamperParameters {
  Offset a, b;
  Vec3 axis; // fixed in end a
  double damping = 0;
};

struct DriveLawParameters {
  double value = 0;          // N m or N, where no expression gives it
  std::vector<Dual> numbers; // by name of the expression
};

struct DriveTorqueParameters {
  DriveLawParameters torque, load;
};

struct CutParameters {
  Offset a, b;                   // the joint's point on either end; a distance joint's points
  std::array<Vec3, 4> frame;     // x, y, z (axis), second axis; drawn pose
  std::array<double, 6> drawn{}; // labels of the drawn pose, rad or m
  double constant = 0;           // direction rows of a universal joint
  double length = 0;             // distance
  double ratio = 0, offset = 0;  // gear
};

struct Parameters {
  Vec3 origin = Vec3::Zero(); // m: the world point that positions are taken from, to keep digits far from the
                              // world's origin
  Vec3 gravity = Vec3::Zero();
  double speed_scale = 1; // all drive speeds times this: homotopy from rest
  double length = 1;      // m, characteristic: the mechanism's reach
  bool moving = false;    // any drive turns
  std::vector<LinkParameters> links;
  std::vector<PointSpringParameters> springs;
  std::vector<BodyForceParameters> body_forces;
  std::vector<CutDamperParameters> cut_dampers;
  std::vector<DriveTorqueParameters> torques;
  std::vector<CutParameters> cuts;
  // The whole balance is the same at every phase of the drives, by the shape of the mechanism alone: one
  // frame turns about an axis along gravity and nothing acts between it and the ground.
  bool phase_free = false;
};

// Rewrites `parameters` (no allocation after the first time). The mechanism must have the parts the system
// was compiled from.
void bind(const System& system, const Mechanism& mechanism, Parameters& parameters);

// The drawn pose as a configuration of q_R, one entry a coordinate, four a rotation.
void drawn_configuration(const System& system, const Parameters& parameters, Eigen::VectorXd& q);

} // namespace flyball
