#include "engine/system/kinematics.hpp"

#include "engine/system/extended.hpp"
#include "engine/system/law_phase.hpp"
#include "engine/system/rotation_vector.hpp"

namespace flyball {
namespace {

// Axes of double precision are of unit length to double precision only. Wider numbers would see that turning
// about one stretches what it turns, and loops held by large forces feel it.
template <class S>
Vec3T<S> unit_axis(const LinkParametersOf<S>& p) {
  if constexpr (std::is_same_v<S, double>)
    return p.axis;
  else
    return p.axis.template cast<S>().normalized();
}

// Some links, in order, after those that they hang from.
template <class S>
void place_links(const System& system, const ParametersOf<S>& p, const Configuration<S>& q, double t,
                 std::size_t first, std::size_t last, Kinematics<S>& out) {
  for (std::size_t i = first; i < last; ++i) {
    const Link& link = system.links[i];
    const LinkParametersOf<S>& lp = p.links[i];
    const LinkState<S>& parent = out.at(link.parent);
    LinkState<S>& x = out.links[i];
    S displacement = 0;
    if (link.drive >= 0)
      displacement = S(lp.start) + (finds_speed(link) ? q[link.q] : S(lp.speed)) * S(t);
    else if (link.type == LinkType::revolute || link.type == LinkType::prismatic)
      displacement = q[link.q] - S(lp.drawn);
    x.o = parent.o + parent.R * lp.offset.template cast<S>();
    switch (link.type) {
    case LinkType::fixed: x.R = parent.R; break;
    case LinkType::revolute: {
      const Vec3T<S> axis = unit_axis<S>(lp);
      x.axis = parent.R * axis;
      if (link.drive >= 0 && displacement == S(0)) // at the drawn phase
        x.R = parent.R;
      else
        x.R = parent.R * rotation_about<S>(axis, displacement);
      break;
    }
    case LinkType::prismatic:
      x.axis = parent.R * unit_axis<S>(lp);
      x.R = parent.R;
      x.o += x.axis * displacement;
      break;
    case LinkType::spherical: {
      const Eigen::Quaternion<S> d(q[link.q], q[link.q + 1], q[link.q + 2], q[link.q + 3]);
      x.R = parent.R * d.toRotationMatrix();
      break;
    }
    }
    if (link.v >= 0) {
      Column<S>* column = &out.columns[static_cast<std::size_t>(link.v)];
      if (link.type == LinkType::spherical)
        for (int k = 0; k < 3; ++k)
          column[k] = {parent.R.col(k), x.o, true};
      else
        *column = {x.axis, x.o, link.type == LinkType::revolute};
    }
    if (!p.moving) {
      x.w.setZero();
      x.v.setZero();
      x.dw.setZero();
      x.dv = out.ground.dv;
      continue;
    }
    const Vec3T<S> arm = x.o - parent.o;
    const Vec3T<S> swing = parent.w.cross(arm);
    x.w = parent.w;
    x.dw = parent.dw;
    x.v = parent.v + swing;
    x.dv = parent.dv + parent.dw.cross(arm) + parent.w.cross(swing);
    if (link.drive >= 0) {
      const S speed = finds_speed(link) ? q[link.q] : S(lp.speed) * S(p.speed_scale);
      if (link.type == LinkType::revolute) {
        x.w += x.axis * speed;
        x.dw += parent.w.cross(x.axis) * speed;
      } else {
        x.v += x.axis * speed;
        x.dv += parent.w.cross(x.axis) * (2 * speed);
      }
    }
  }
}

} // namespace

template <class S>
void forward(const System& system, const ParametersOf<S>& p, const Configuration<S>& q, double t,
             Kinematics<S>& out) {
  out.links.resize(system.links.size());
  out.columns.resize(static_cast<std::size_t>(system.nv));
  out.ground.R.setIdentity();
  out.ground.o.setZero();
  out.ground.axis.setZero();
  out.ground.w.setZero();
  out.ground.v.setZero();
  out.ground.dw.setZero();
  out.ground.dv = -p.gravity.template cast<S>();
  if (system.division.spine > 0) place_links(system, p, q, t, 0, system.division.spine, out);
  for_parts(system.division, [&](const SystemPart& part, std::size_t) {
    place_links(system, p, q, t, part.first, part.last, out);
  });
}

template <class S>
void retract(const System& system, const Configuration<S>& step, Configuration<S>& q) {
  for (const Link& link : system.links) {
    if (link.v < 0) continue;
    if (link.type != LinkType::spherical) {
      q[link.q] += step[link.v];
      continue;
    }
    const Eigen::Quaternion<S> d(q[link.q], q[link.q + 1], q[link.q + 2], q[link.q + 3]);
    const Eigen::Quaternion<S> moved =
        (exp_rotation<S>(Vec3T<S>(step.template segment<3>(link.v))) * d).normalized();
    q[link.q] = moved.w();
    q.template segment<3>(link.q + 1) = moved.vec();
  }
}

template <class S>
Vec3T<S> rotation_vector(const Link& link, const LinkParametersOf<S>& p, const Configuration<S>& q) {
  const Eigen::Quaternion<S> d(q[link.q], q[link.q + 1], q[link.q + 2], q[link.q + 3]);
  return log_rotation<S>((link.reversed ? d.conjugate() : d) * p.drawn_rotation.template cast<S>());
}

template <class S>
S coordinate_value(const System& system, const ParametersOf<S>& parameters, const Configuration<S>& q,
                   const CoordinateInfo& c) {
  const Link& link = system.links[static_cast<std::size_t>(c.link)];
  const LinkParametersOf<S>& p = parameters.links[static_cast<std::size_t>(c.link)];
  if (link.drive >= 0) return p.drawn + p.start;
  if (link.type == LinkType::spherical) return rotation_vector<S>(link, p, q)[c.index - link.coordinate];
  return q[link.q];
}

bool turns_matter(const System& system, const Parameters& p, int l) {
  if (p.links[static_cast<std::size_t>(l)].elastic) return true;
  if (system.torques.empty()) return false;
  const auto own = [l](const CoordinateInfo& c) { return c.link == l; };
  const auto coordinate = std::ranges::find_if(system.coordinates, own) - system.coordinates.begin();
  for (std::size_t i = 0; i < system.torques.size(); ++i)
    for (const auto& [law, numbers] : {std::pair{&system.torques[i].torque, &p.torques[i].torque},
                                       std::pair{&system.torques[i].load, &p.torques[i].load}})
      if (tells_turns_apart(*law, *numbers, static_cast<int>(coordinate))) return true;
  return false;
}

bool turns_freely(const System& system, const Parameters& p, int l) {
  const Link& link = system.links[static_cast<std::size_t>(l)];
  return link.type == LinkType::revolute && link.drive < 0 && !turns_matter(system, p, l) &&
         std::ranges::none_of(system.cuts, [&](const CutJoint& cut) {
           return cut.type == JointType::gear && (cut.gear_va == link.v || cut.gear_vb == link.v);
         });
}

void set_coordinate(const System& system, const Parameters& parameters, const CoordinateInfo& c, double value,
                    Eigen::VectorXd& q) {
  const Link& link = system.links[static_cast<std::size_t>(c.link)];
  if (link.q < 0) return;
  if (link.type != LinkType::spherical) {
    q[link.q] = value;
    return;
  }
  const LinkParameters& p = parameters.links[static_cast<std::size_t>(c.link)];
  Vec3 r = rotation_vector(link, p, q);
  r[c.index - link.coordinate] = value;
  set_rotation_vector(link, p, r, q);
}

Mat3 rotation_vector_rate(const Link& link, const LinkParameters& p, const Eigen::VectorXd& q) {
  const Mat3 j = inverse_left_jacobian(rotation_vector(link, p, q));
  // Run against the joint, a step turns the joint's parent in the axes of its child.
  return link.reversed ? Mat3(-j.transpose() * p.drawn_rotation.toRotationMatrix().transpose()) : j;
}

void set_rotation_vector(const Link& link, const LinkParameters& p, const Vec3& r, Eigen::VectorXd& q) {
  Quat d = exp_rotation(r) * p.drawn_rotation.conjugate();
  if (link.reversed) d = d.conjugate();
  q.segment<4>(link.q) << d.w(), d.x(), d.y(), d.z();
}

void body_poses(const System& system, const Mechanism& mechanism, const Parameters& parameters,
                const Kinematics<double>& kinematics, std::vector<Pose>& poses) {
  poses.resize(mechanism.bodies.size());
  for (std::size_t b = 0; b < poses.size(); ++b) {
    const int l = system.body_link[b];
    const LinkState<double>& x = kinematics.at(l);
    poses[b].position = parameters.origin + x.o + x.R * parameters.links[static_cast<std::size_t>(l)].com;
    poses[b].rotation = (Quat(x.R) * mechanism.bodies[b].rotation.normalized()).normalized();
    if (poses[b].rotation.w() < 0) poses[b].rotation.coeffs() *= -1;
  }
}

template void forward<double>(const System&, const Parameters&, const Configuration<double>&, double,
                              Kinematics<double>&);
template void forward<Extended>(const System&, const Parameters&, const Configuration<Extended>&, double,
                                Kinematics<Extended>&);
template void forward<Dual>(const System&, const BasicParameters<Dual>&, const Configuration<Dual>&, double,
                            Kinematics<Dual>&);
template void retract<double>(const System&, const Configuration<double>&, Configuration<double>&);
template void retract<Extended>(const System&, const Configuration<Extended>&, Configuration<Extended>&);
template double coordinate_value<double>(const System&, const Parameters&, const Eigen::VectorXd&,
                                         const CoordinateInfo&);
template Dual coordinate_value<Dual>(const System&, const BasicParameters<Dual>&, const Configuration<Dual>&,
                                     const CoordinateInfo&);
template Vec3T<double> rotation_vector<double>(const Link&, const LinkParameters&,
                                               const Configuration<double>&);
template Vec3T<Extended> rotation_vector<Extended>(const Link&, const LinkParameters&,
                                                   const Configuration<Extended>&);
template Vec3T<Dual> rotation_vector<Dual>(const Link&, const BasicLinkParameters<Dual>&,
                                           const Configuration<Dual>&);

} // namespace flyball
