#include "engine/system/parameters.hpp"

#include "engine/mechanism/drive_law.hpp"
#include "engine/system/joint_coordinates.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>

namespace flyball {
namespace {

// See Link::axis.
Vec3 axis_of(const Joint* joint, int axis) {
  switch (axis) {
  case 0: return joint ? joint->axis.normalized() : Vec3(Vec3::UnitX());
  case 1:
    if (joint->type == JointType::planar) {
      const Vec3 n = joint->axis.normalized();
      return (joint->axis2 - n * n.dot(joint->axis2)).normalized();
    }
    return joint->axis2.normalized();
  case 2: return joint->axis.normalized().cross(axis_of(joint, 1));
  default: return Vec3::Unit(axis - 3);
  }
}

Vec3 joint_point(const Mechanism& m, const TreeJoint& t) {
  return t.joint >= 0 ? m.joints[static_cast<std::size_t>(t.joint)].at
                      : m.bodies[static_cast<std::size_t>(t.child_body)].position;
}

class Binder {
 public:
  Binder(const System& s, const Mechanism& m, Parameters& p) : s_(s), m_(m), p_(p) {}

  void run() {
    p_.gravity = m_.gravity;
    p_.origin = s_.tree_joints.empty() ? Vec3(Vec3::Zero()) : joint_point(m_, s_.tree_joints.front());
    p_.links.resize(s_.links.size());
    for (std::size_t l = 0; l < s_.links.size(); ++l)
      bind_link(l);
    bind_speeds();
    bind_elements();
    p_.length = reach();
    p_.phase_free = phase_free();
  }

 private:
  const Joint& joint(int j) const { return m_.joints[static_cast<std::size_t>(j)]; }

  void bind_link(std::size_t l) {
    const Link& link = s_.links[l];
    const TreeJoint& tree = s_.tree_joints[static_cast<std::size_t>(link.tree_joint)];
    const Joint* j = tree.joint >= 0 ? &joint(tree.joint) : nullptr;
    LinkParameters& out = p_.links[l];
    CoordinateForces force = std::move(out.force); // for its memory
    force.clear();
    out = {};
    out.force = std::move(force);
    out.origin = joint_point(m_, tree) - p_.origin;
    out.offset = link.parent >= 0 ? Vec3(out.origin - p_.links[static_cast<std::size_t>(link.parent)].origin)
                                  : out.origin;
    if (link.type == LinkType::revolute || link.type == LinkType::prismatic)
      out.axis = axis_of(j, link.axis) * (link.reversed ? -1. : 1.);
    if (link.type == LinkType::spherical) {
      Vec3 r = Vec3::Zero();
      if (j)
        for (int k = 0; k < 3; ++k)
          r[k] = j->coordinates[static_cast<std::size_t>(link.coordinate + k)].drawn;
      out.drawn_rotation = exp_rotation(r);
    }
    if (j && link.type != LinkType::fixed) {
      const int n = link.type == LinkType::spherical ? 3 : 1;
      for (int k = 0; k < n; ++k)
        bind_coordinate(j->coordinates[static_cast<std::size_t>(link.coordinate + k)], out, k);
      out.drawn = j->coordinates[static_cast<std::size_t>(link.coordinate)].drawn;
    }
    if (link.body >= 0) {
      const Body& b = m_.bodies[static_cast<std::size_t>(link.body)];
      out.mass = b.mass;
      out.com = b.position - p_.origin - out.origin;
      Mat3 i;
      i << b.inertia[0], b.inertia[3], b.inertia[4], b.inertia[3], b.inertia[1], b.inertia[5], b.inertia[4],
          b.inertia[5], b.inertia[2];
      out.has_inertia = !i.isZero(0);
      const Mat3 r = b.rotation.normalized().toRotationMatrix();
      out.inertia = b.rotation.coeffs() == Quat::Identity().coeffs() ? i : Mat3(r * i * r.transpose());
    }
  }

  static void bind_coordinate(const Coordinate& c, LinkParameters& out, int k) {
    if (!c.spring && !c.stop && c.damping == 0) return;
    CoordinateForce& f = out.force.hold(static_cast<std::size_t>(k));
    f.damping = c.damping;
    if (c.spring) {
      f.stiffness = c.spring->stiffness;
      f.free = c.spring->free;
    }
    if (c.stop) {
      f.stop_stiffness = c.stop->stiffness;
      f.has_lower = c.stop->lower.has_value();
      f.has_upper = c.stop->upper.has_value();
      f.lower = c.stop->lower.value_or(0);
      f.upper = c.stop->upper.value_or(0);
    }
    out.elastic = out.elastic || f.elastic();
  }

  double gear_offset(const Joint& g) const {
    if (g.offset) return *g.offset;
    const auto drawn = [&](int end) {
      const CoordinateReference r = find_coordinate(m_, g.joints[static_cast<std::size_t>(end)]);
      return joint(r.joint).coordinates[static_cast<std::size_t>(r.coordinate)].drawn;
    };
    return drawn(1) - g.ratio * drawn(0);
  }

  bool is_end(const Joint& g, int end, const DrivenCoordinate& d) const {
    const Link& l = s_.links[static_cast<std::size_t>(d.link)];
    const CoordinateReference r = find_coordinate(m_, g.joints[static_cast<std::size_t>(end)]);
    return r.joint == s_.tree_joints[static_cast<std::size_t>(l.tree_joint)].joint &&
           r.coordinate == l.coordinate;
  }

  void bind_speeds() {
    p_.moving = false;
    for (const DrivenCoordinate& d : s_.drives) {
      const DrivenCoordinate& motor = s_.drives[static_cast<std::size_t>(d.motor)];
      const Link& m = s_.links[static_cast<std::size_t>(motor.link)];
      const Coordinate& c = joint(s_.tree_joints[static_cast<std::size_t>(m.tree_joint)].joint)
                                .coordinates[static_cast<std::size_t>(m.coordinate)];
      double ratio = 1, value = c.drawn;
      CoordinateReference at{s_.tree_joints[static_cast<std::size_t>(m.tree_joint)].joint, m.coordinate};
      for (int gear : d.gears) {
        const Joint& g = joint(gear);
        const CoordinateReference a = find_coordinate(m_, g.joints[0]), b = find_coordinate(m_, g.joints[1]);
        if (a.joint == at.joint && a.coordinate == at.coordinate) {
          ratio *= g.ratio;
          value = g.ratio * value + gear_offset(g);
          at = b;
        } else {
          ratio /= g.ratio;
          value = (value - gear_offset(g)) / g.ratio;
          at = a;
        }
      }
      LinkParameters& l = p_.links[static_cast<std::size_t>(d.link)];
      l.gear_ratio = ratio;
      l.speed = ratio * c.drive->speed;
      l.start = value - l.drawn;
      p_.moving = p_.moving || l.speed != 0 || finds_speed(s_.links[static_cast<std::size_t>(d.link)]);
    }
  }

  // Of a world point of the drawn pose, in a link.
  Offset in_link(const Vec3& drawn, int link) const {
    const Vec3 p = drawn - p_.origin;
    return link >= 0 ? Vec3(p - p_.links[static_cast<std::size_t>(link)].origin) : p;
  }

  void bind_elements() {
    p_.springs.resize(s_.springs.size());
    for (std::size_t i = 0; i < s_.springs.size(); ++i) {
      const PointSpringElement& e = s_.springs[i];
      const Force& f = m_.forces[static_cast<std::size_t>(e.force)];
      p_.springs[i] = {in_link(f.points[0], e.ends.a), in_link(f.points[1], e.ends.b), f.stiffness,
                       f.free_length.value_or((f.points[1] - f.points[0]).norm()), f.damping};
    }
    p_.body_forces.resize(s_.body_forces.size());
    for (std::size_t i = 0; i < s_.body_forces.size(); ++i) {
      const BodyForceElement& e = s_.body_forces[i];
      const Force& f = m_.forces[static_cast<std::size_t>(e.force)];
      const int b = e.link >= 0 ? s_.links[static_cast<std::size_t>(e.link)].body : -1;
      const Vec3 centre = b >= 0 ? m_.bodies[static_cast<std::size_t>(b)].position : Vec3(Vec3::Zero());
      Vec3 vector = f.vector;
      if (f.frame == ForceFrame::body && b >= 0)
        vector = m_.bodies[static_cast<std::size_t>(b)].rotation.normalized() * vector;
      p_.body_forces[i] = {f.type, f.frame,  in_link(f.at.value_or(centre), e.link),
                           vector, f.linear, f.quadratic};
    }
    p_.cut_dampers.resize(s_.cut_dampers.size());
    for (std::size_t i = 0; i < s_.cut_dampers.size(); ++i) {
      const CutDamperElement& e = s_.cut_dampers[i];
      const Joint& j = joint(e.joint);
      p_.cut_dampers[i] = {in_link(j.at, e.ends.a), in_link(j.at, e.ends.b), j.axis.normalized(),
                           j.coordinates[static_cast<std::size_t>(e.coordinate)].damping};
    }
    p_.torques.resize(s_.torques.size());
    for (std::size_t i = 0; i < s_.torques.size(); ++i) {
      const Link& l = s_.links[static_cast<std::size_t>(s_.torques[i].link)];
      const Drive& drive = *joint(s_.tree_joints[static_cast<std::size_t>(l.tree_joint)].joint)
                                .coordinates[static_cast<std::size_t>(l.coordinate)]
                                .drive;
      p_.links[static_cast<std::size_t>(s_.torques[i].link)].speed = drive.speed;
      bind_law(s_.torques[i].torque, drive.torque.value_or(0), p_.torques[i].torque);
      bind_law(s_.torques[i].load, drive.load.value_or(0), p_.torques[i].load);
    }
    p_.cuts.resize(s_.cuts.size());
    for (std::size_t i = 0; i < s_.cuts.size(); ++i)
      bind_cut(s_.cuts[i], p_.cuts[i]);
  }

  void bind_law(const DriveLaw& law, double value, DriveLawParameters& out) const {
    out.value = value;
    out.numbers.clear();
    if (!law.expression) return;
    for (const std::string& name : law.expression->names())
      out.numbers.push_back({named_value(m_, name), 0});
  }

  void bind_cut(const CutJoint& cut, CutParameters& out) const {
    const Joint& j = joint(cut.joint);
    out = {};
    if (cut.type == JointType::gear) {
      out.ratio = j.ratio;
      out.offset = gear_offset(j);
      return;
    }
    if (cut.type == JointType::distance) {
      out.a = in_link(j.points[0], cut.ends.a);
      out.b = in_link(j.points[1], cut.ends.b);
      out.length = j.length.value_or((j.points[1] - j.points[0]).norm());
      return;
    }
    out.a = in_link(j.at, cut.ends.a);
    out.b = in_link(j.at, cut.ends.b);
    // Where a twin is welded the cut is a fixed joint, whatever the scene's is.
    const JointFrame frame = cut.type == JointType::fixed ? joint_frame({}) : joint_frame(j);
    out.frame = frame.axes;
    out.drawn = frame.drawn;
    if (cut.type == JointType::universal) out.constant = out.frame[2].dot(out.frame[3]);
  }

  // Half the largest distance from the middle of all points that matter.
  double reach() const {
    Eigen::AlignedBox3d box;
    for (const LinkParameters& l : p_.links) {
      box.extend(l.origin);
      box.extend(Vec3(l.origin + l.com));
    }
    const auto add = [&](const Offset& at, int link) {
      box.extend(link >= 0 ? Vec3(at + p_.links[static_cast<std::size_t>(link)].origin) : at);
    };
    for (std::size_t i = 0; i < s_.springs.size(); ++i) {
      add(p_.springs[i].a, s_.springs[i].ends.a);
      add(p_.springs[i].b, s_.springs[i].ends.b);
    }
    for (std::size_t i = 0; i < s_.cuts.size(); ++i) {
      if (s_.cuts[i].type == JointType::gear) continue;
      add(p_.cuts[i].a, s_.cuts[i].ends.a);
      add(p_.cuts[i].b, s_.cuts[i].ends.b);
    }
    const double half = box.isEmpty() ? 0 : box.diagonal().norm() / 2;
    return half > 0 ? half : 1;
  }

  bool phase_free() const {
    if (!p_.moving) return true;
    if (s_.drives.size() != 1) return false;
    const int d = s_.drives.front().link;
    const Link& link = s_.links[static_cast<std::size_t>(d)];
    if (link.parent >= 0) return false;
    if (link.type == LinkType::revolute &&
        p_.gravity.cross(p_.links[static_cast<std::size_t>(d)].axis).norm() > 1e-14 * p_.gravity.norm())
      return false;
    const auto turns = [&](int l) { return l >= 0 && s_.links[static_cast<std::size_t>(l)].frame == d; };
    const auto apart = [&](const PairEnds& e) { return turns(e.a) != turns(e.b); };
    for (const PointSpringElement& e : s_.springs)
      if (apart(e.ends)) return false;
    for (const CutJoint& c : s_.cuts)
      if (c.type != JointType::gear && apart(c.ends)) return false;
    for (const CutDamperElement& e : s_.cut_dampers)
      if (apart(e.ends)) return false;
    for (std::size_t i = 0; i < s_.body_forces.size(); ++i)
      if (turns(s_.body_forces[i].link) && p_.body_forces[i].type != ForceType::drag &&
          p_.body_forces[i].frame == ForceFrame::world)
        return false;
    return true;
  }

  const System& s_;
  const Mechanism& m_;
  Parameters& p_;
};

} // namespace

void bind(const System& system, const Mechanism& mechanism, Parameters& parameters) {
  Binder(system, mechanism, parameters).run();
}

void drawn_configuration(const System& system, const Parameters& parameters, Eigen::VectorXd& q) {
  q.resize(system.nq);
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    const Link& link = system.links[l];
    if (link.q < 0) continue;
    if (link.type == LinkType::spherical)
      q.segment<4>(link.q) << 1, 0, 0, 0;
    else
      q[link.q] = finds_speed(link) ? parameters.links[l].speed : parameters.links[l].drawn;
  }
}

} // namespace flyball
