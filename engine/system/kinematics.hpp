// Where every link is and how it moves when only the drives turn: q_D = q_D(t), q_D' constant, q_R' = 0.
#pragma once

#include "engine/mechanism/pose.hpp"
#include "engine/system/parameters.hpp"
#include "engine/system/spatial.hpp"

namespace flyball {

// Of one link, world axes, positions from Parameters::origin. Gravity is carried as a fictitious acceleration
// of the ground, -g, so that a body's weight needs no term of its own.
template <class S>
struct LinkState {
  Mat3T<S> R;      // displacement from the drawn pose
  Vec3T<S> o;      // m, origin
  Vec3T<S> axis;   // unit
  Vec3T<S> w, v;   // rad/s; m/s, of the material point at o
  Vec3T<S> dw, dv; // rad/s^2; m/s^2, of the material point at o, less gravity
};

// The joint axis of one coordinate of q_R: a rotation about `axis` through `o`, or a translation along it.
template <class S>
struct Column {
  Vec3T<S> axis; // unit
  Vec3T<S> o;    // m
  bool angular = true;
  // Velocity of a point carried at unit speed; angular velocity.
  Vec3T<S> at(const Vec3T<S>& p) const { return angular ? Vec3T<S>(axis.cross(p - o)) : axis; }
  Vec3T<S> turn() const { return angular ? axis : Vec3T<S>(Vec3T<S>::Zero()); }
};

template <class S>
using Configuration = Eigen::Matrix<S, Eigen::Dynamic, 1>;

template <class S>
struct Kinematics {
  std::vector<LinkState<S>> links;
  std::vector<Column<S>> columns; // by coordinate of q_R
  LinkState<S> ground;
  const LinkState<S>& at(int link) const { return link < 0 ? ground : links[static_cast<std::size_t>(link)]; }
  Vec3T<S> point(int link, const OffsetOf<S>& offset) const {
    const LinkState<S>& l = at(link);
    return l.o + l.R * offset.template cast<S>();
  }
  // Velocity of the material point of `link` at `p` (m/s).
  Vec3T<S> velocity(int link, const Vec3T<S>& p) const {
    const LinkState<S>& l = at(link);
    return l.v + l.w.cross(p - l.o);
  }
};

// Phase `t`: seconds of driving since the drawn pose, at the full drive speeds of `parameters`, whatever
// Parameters::speed_scale, and at those speeds that q has. Instantiated for double, Extended and Dual.
template <class S>
void forward(const System& system, const ParametersOf<S>& parameters, const Configuration<S>& q, double t,
             Kinematics<S>& out);

// q moved by a tangent step: rotations as exp(step) D, in the axes of the link's parent.
template <class S>
void retract(const System& system, const Configuration<S>& step, Configuration<S>& q);

// The value of a coordinate as its joint labels it: rad or m. Component k of a spherical link's rotation
// vector. Instantiated for double and Dual.
template <class S>
S coordinate_value(const System& system, const ParametersOf<S>& parameters, const Configuration<S>& q,
                   const CoordinateInfo& coordinate);
// Whether whole turns of a link's angle change forces: something springs back or stops, or the law of a drive
// asks for it.
bool turns_matter(const System& system, const Parameters& parameters, int link);
// Whether whole turns of a link's coordinate do not matter, nor do gears or drives turn it. Such an angle is
// reported in (-pi, pi].
bool turns_freely(const System& system, const Parameters& parameters, int link);

// The rotation vector of a spherical link, in the joint's own order.
template <class S>
Vec3T<S> rotation_vector(const Link& link, const LinkParametersOf<S>& parameters, const Configuration<S>& q);

// r' = J u: its rate when the link's coordinates move with u, in the joint's own order.
Mat3 rotation_vector_rate(const Link& link, const LinkParameters& parameters, const Eigen::VectorXd& q);

// Sets a coordinate by label; of a rotation vector one component.
void set_coordinate(const System& system, const Parameters& parameters, const CoordinateInfo& coordinate,
                    double value, Eigen::VectorXd& q);
void set_rotation_vector(const Link& link, const LinkParameters& parameters, const Vec3& r,
                         Eigen::VectorXd& q);

// Poses of the mechanism's bodies, in its order.
void body_poses(const System& system, const Mechanism& mechanism, const Parameters& parameters,
                const Kinematics<double>& kinematics, std::vector<Pose>& poses);

} // namespace flyball
