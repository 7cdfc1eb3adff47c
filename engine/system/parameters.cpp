#include "engine/system/parameters.hpp"

#include "engine/mechanism/bearing_axes.hpp"
#include "engine/mechanism/error.hpp"
#include "engine/mechanism/gear_ratio.hpp"
#include "engine/system/air_force.hpp"
#include "engine/system/implied_rates.hpp"
#include "engine/system/joint_coordinates.hpp"
#include "engine/system/kept_momentum.hpp"
#include "engine/system/law_phase.hpp"
#include "engine/system/point_motion.hpp"
#include "engine/system/rotation_vector.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flyball {
namespace {

template <class N>
class Binder {
 public:
  using Vector = Vec3T<N>;
  using Tensor = Mat3T<N>;
  using Rotation = Eigen::Quaternion<N>;

  Binder(const System& s, const Mechanism& m, const NumberReader<N>& read, BasicParameters<N>& p)
      : s_(s), m_(m), read_(read), p_(p) {}

  void run() {
    p_.gravity = read_(m_.gravity);
    p_.dampers_drive = false;
    p_.origin = s_.tree_joints.empty() ? Vector(Vector::Zero()) : joint_point(s_.tree_joints.front());
    p_.links.resize(s_.links.size());
    for (std::size_t l = 0; l < s_.links.size(); ++l)
      bind_link(l);
    for (const ForceLawElement& e : s_.coordinate_laws)
      bind_coordinate_law(e);
    bind_speeds();
    bind_elements();
  }

 private:
  const Joint& joint(int j) const { return m_.joints[static_cast<std::size_t>(j)]; }

  // See Link::axis.
  Vector axis_of(const Joint* joint, int axis) const {
    switch (axis) {
    case 0: return joint ? Vector(read_(joint->axis).normalized()) : Vector(Vector::UnitX());
    case 1:
      if (joint->type == JointType::planar) {
        const Vector n = read_(joint->axis).normalized(), x = read_(joint->axis2);
        return (x - n * n.dot(x)).normalized();
      }
      return read_(joint->axis2).normalized();
    case 2: return read_(joint->axis).normalized().cross(axis_of(joint, 1));
    default: return Vector::Unit(axis - 3);
    }
  }

  Vector joint_point(const TreeJoint& t) const {
    return t.joint >= 0 ? read_(joint(t.joint).at)
                        : read_(m_.bodies[static_cast<std::size_t>(t.child_body)].position);
  }

  void bind_link(std::size_t l) {
    const Link& link = s_.links[l];
    const TreeJoint& tree = s_.tree_joints[static_cast<std::size_t>(link.tree_joint)];
    const Joint* j = tree.joint >= 0 ? &joint(tree.joint) : nullptr;
    BasicLinkParameters<N>& out = p_.links[l];
    BasicCoordinateForces<N> force = std::move(out.force); // for its memory
    force.clear();
    out = {};
    out.force = std::move(force);
    out.origin = joint_point(tree) - p_.origin;
    out.offset = link.parent >= 0
                     ? Vector(out.origin - p_.links[static_cast<std::size_t>(link.parent)].origin)
                     : out.origin;
    if (link.type == LinkType::revolute || link.type == LinkType::prismatic)
      out.axis = axis_of(j, link.axis) * N(link.reversed ? -1. : 1.);
    if (link.type == LinkType::spherical) {
      Vector r = Vector::Zero();
      if (j)
        for (int k = 0; k < 3; ++k)
          r[k] = read_(j->coordinates[static_cast<std::size_t>(link.coordinate + k)].drawn);
      out.drawn_rotation = exp_rotation<N>(r);
    }
    if (j && link.type != LinkType::fixed) {
      const int n = link.type == LinkType::spherical ? 3 : 1;
      for (int k = 0; k < n; ++k)
        bind_coordinate(j->coordinates[static_cast<std::size_t>(link.coordinate + k)], out, k);
      out.drawn = read_(j->coordinates[static_cast<std::size_t>(link.coordinate)].drawn);
    }
    if (link.body >= 0) {
      const Body& b = m_.bodies[static_cast<std::size_t>(link.body)];
      out.mass = read_(b.mass);
      out.com = read_(b.position) - p_.origin - out.origin;
      std::array<N, 6> tensor;
      std::ranges::transform(b.inertia, tensor.begin(), [&](const double& x) { return read_(x); });
      Tensor i;
      i << tensor[0], tensor[3], tensor[4], tensor[3], tensor[1], tensor[5], tensor[4], tensor[5], tensor[2];
      out.has_inertia = std::ranges::any_of(tensor, [](const N& x) { return x != N(0); });
      const Rotation rotation = read_(b.rotation).normalized();
      const Tensor r = rotation.toRotationMatrix();
      out.inertia = rotation.coeffs() == Rotation::Identity().coeffs() ? i : Tensor(r * i * r.transpose());
    }
  }

  void bind_coordinate(const Coordinate& c, BasicLinkParameters<N>& out, int k) const {
    const N damping = read_(c.damping);
    if (!c.spring && !c.stop && !c.friction && damping == N(0)) return;
    BasicCoordinateForce<N>& f = out.force.hold(static_cast<std::size_t>(k));
    f.damping = damping;
    if (c.friction) f.friction = read_(c.friction->share) * limit_of(*c.friction);
    if (c.spring) {
      f.stiffness = read_(c.spring->stiffness);
      f.free = read_(c.spring->free);
    }
    if (c.stop) {
      f.stop_stiffness = read_(c.stop->stiffness);
      f.has_lower = c.stop->lower.has_value();
      f.has_upper = c.stop->upper.has_value();
      if (c.stop->lower) f.lower = read_(*c.stop->lower);
      if (c.stop->upper) f.upper = read_(*c.stop->upper);
    }
    out.elastic = out.elastic || c.friction || f.elastic();
  }

  void bind_coordinate_law(const ForceLawElement& e) const {
    const Link& link = s_.links[static_cast<std::size_t>(e.at)];
    const Coordinate& c = joint(s_.tree_joints[static_cast<std::size_t>(link.tree_joint)].joint)
                              .coordinates[static_cast<std::size_t>(link.coordinate + e.component)];
    BasicLinkParameters<N>& out = p_.links[static_cast<std::size_t>(e.at)];
    BasicCoordinateForce<N>& f = out.force.hold(static_cast<std::size_t>(e.component));
    BasicForceLaws<N> laws;
    if (e.has_spring) {
      laws.spring = bind_law(m_, e.spring, c.spring->force, read_);
      laws.free = read_(c.spring->free);
    }
    if (e.has_damper) {
      laws.damper = bind_law(m_, e.damper, c.damping_force, read_);
      f.damping = laws.damper.slope(0);
      note_damper(laws.damper);
    }
    f.laws = std::make_shared<const BasicForceLaws<N>>(std::move(laws));
    out.elastic = out.elastic || e.has_spring;
  }

  void note_damper(const BoundLaw& law) const {
    p_.dampers_drive = p_.dampers_drive || !law.resists_at_rest();
  }

  N limit_of(const Friction& x) const { // see friction_limit
    if (x.limit) return read_(*x.limit);
    N limit = 1;
    for (const std::optional<double>* factor : {&x.mu, &x.preload, &x.radius})
      if (*factor) limit *= read_(**factor);
    return limit;
  }

  N gear_offset(const Joint& g) const {
    const auto drawn = [&](int end) {
      const CoordinateReference r = find_coordinate(m_, g.joints[static_cast<std::size_t>(end)]);
      return read_(joint(r.joint).coordinates[static_cast<std::size_t>(r.coordinate)].drawn);
    };
    return read_(g.offset, drawn(1) - gear_ratio(g, read_) * drawn(0));
  }

  bool is_end(const Joint& g, int end, const DrivenCoordinate& d) const {
    return reference_to(s_, s_.links[static_cast<std::size_t>(d.link)]) ==
           find_coordinate(m_, g.joints[static_cast<std::size_t>(end)]);
  }

  void bind_speeds() {
    p_.moving = false;
    for (const DrivenCoordinate& d : s_.drives) {
      const DrivenCoordinate& motor = s_.drives[static_cast<std::size_t>(d.motor)];
      const Link& m = s_.links[static_cast<std::size_t>(motor.link)];
      const Coordinate& c = joint(s_.tree_joints[static_cast<std::size_t>(m.tree_joint)].joint)
                                .coordinates[static_cast<std::size_t>(m.coordinate)];
      if (!c.drive) { // implied: it goes on from where it is drawn, see implied_rates.hpp
        p_.moving = true;
        continue;
      }
      N ratio = 1, value = read_(c.drawn);
      CoordinateReference at = reference_to(s_, m);
      for (int gear : d.gears) {
        const Joint& g = joint(gear);
        const CoordinateReference a = find_coordinate(m_, g.joints[0]), b = find_coordinate(m_, g.joints[1]);
        if (a == at) {
          ratio *= gear_ratio(g, read_);
          value = gear_ratio(g, read_) * value + gear_offset(g);
          at = b;
        } else {
          ratio /= gear_ratio(g, read_);
          value = (value - gear_offset(g)) / gear_ratio(g, read_);
          at = a;
        }
      }
      BasicLinkParameters<N>& l = p_.links[static_cast<std::size_t>(d.link)];
      l.gear_ratio = ratio;
      l.speed = ratio * read_(c.drive->speed);
      l.start = value - l.drawn;
      bind_friction_at_given_speed(s_.links[static_cast<std::size_t>(d.link)], l);
      p_.moving = p_.moving || l.speed != N(0) || finds_speed(s_.links[static_cast<std::size_t>(d.link)]);
    }
  }

  // Its limit against the way it goes; nothing where that is none.
  void bind_friction_at_given_speed(const Link& link, BasicLinkParameters<N>& out) const {
    const Coordinate& c = joint(s_.tree_joints[static_cast<std::size_t>(link.tree_joint)].joint)
                              .coordinates[static_cast<std::size_t>(link.coordinate)];
    if (!c.friction || finds_speed(link)) return;
    const double against = out.speed > N(0) ? -1 : out.speed < N(0) ? 1 : 0;
    out.force.hold(0).friction = N(against) * limit_of(*c.friction);
  }

  // Of a world point of the drawn pose, in a link.
  BasicOffset<N> in_link(const Vector& drawn, int link) const {
    const Vector p = drawn - p_.origin;
    return link >= 0 ? Vector(p - p_.links[static_cast<std::size_t>(link)].origin) : p;
  }

  void bind_body_force(const Force& f, int link, const PolarElement& polar,
                       BasicBodyForceParameters<N>& out) const {
    const int b = link >= 0 ? s_.links[static_cast<std::size_t>(link)].body : -1;
    const Vector centre =
        b >= 0 ? Vector(read_(m_.bodies[static_cast<std::size_t>(b)].position)) : Vector(Vector::Zero());
    Vector vector = read_(f.vector);
    if (f.frame == ForceFrame::body && b >= 0)
      vector = read_(m_.bodies[static_cast<std::size_t>(b)].rotation).normalized() * vector;
    out = {};
    out.type = f.type;
    out.frame = f.frame;
    out.at = in_link(read_(f.at, centre), link);
    out.vector = vector;
    if (is_of_air(f.type)) set_air_force(f, m_.air, read_, out);
    if (has_polar(f))
      out.polar = std::make_shared<const Polar>(
          Polar{bind_law(m_, polar.lift, f.lift, read_), bind_law(m_, polar.drag, f.drag, read_)});
  }

  void bind_elements() {
    p_.springs.resize(s_.springs.size());
    for (std::size_t i = 0; i < s_.springs.size(); ++i) {
      const PointSpringElement& e = s_.springs[i];
      const Force& f = m_.forces[static_cast<std::size_t>(e.force)];
      const Vector a = read_(f.points[0]), b = read_(f.points[1]);
      p_.springs[i] = {{read_(f.stiffness), read_(f.damping), nullptr},
                       in_link(a, e.ends.a),
                       in_link(b, e.ends.b),
                       read_(f.free_length, (b - a).norm())};
    }
    for (const ForceLawElement& e : s_.spring_laws) {
      BasicPointSpringParameters<N>& out = p_.springs[static_cast<std::size_t>(e.at)];
      const Force& f = m_.forces[static_cast<std::size_t>(s_.springs[static_cast<std::size_t>(e.at)].force)];
      BasicForceLaws<N> laws;
      if (e.has_spring) laws.spring = bind_law(m_, e.spring, f.force, read_);
      if (e.has_damper) {
        laws.damper = bind_law(m_, e.damper, f.damping_force, read_);
        out.damping = laws.damper.slope(0);
        note_damper(laws.damper);
      }
      out.laws = std::make_shared<const BasicForceLaws<N>>(std::move(laws));
    }
    p_.bearings.resize(s_.bearings.size());
    for (std::size_t i = 0; i < s_.bearings.size(); ++i)
      bind_bearing(s_.bearings[i], p_.bearings[i]);
    p_.body_forces.resize(s_.body_forces.size());
    for (std::size_t i = 0; i < s_.body_forces.size(); ++i) {
      const BodyForceElement& e = s_.body_forces[i];
      bind_body_force(m_.forces[static_cast<std::size_t>(e.force)], e.link, e.polar, p_.body_forces[i]);
    }
    p_.turning_air.resize(s_.turning_air.size());
    for (std::size_t i = 0; i < s_.turning_air.size(); ++i) {
      const TurningAirElement& e = s_.turning_air[i];
      bind_body_force(m_.forces[static_cast<std::size_t>(e.force)], e.ends.b, e.polar, p_.turning_air[i]);
    }
    p_.cut_dampers.resize(s_.cut_dampers.size());
    for (std::size_t i = 0; i < s_.cut_dampers.size(); ++i) {
      const CutDamperElement& e = s_.cut_dampers[i];
      const Joint& j = joint(e.joint);
      p_.cut_dampers[i] = {{0, read_(j.coordinates[static_cast<std::size_t>(e.coordinate)].damping), nullptr},
                           in_link(read_(j.at), e.ends.b),
                           read_(j.axis).normalized()};
    }
    for (const ForceLawElement& e : s_.cut_damper_laws) {
      BasicCutDamperParameters<N>& out = p_.cut_dampers[static_cast<std::size_t>(e.at)];
      const CutDamperElement& damper = s_.cut_dampers[static_cast<std::size_t>(e.at)];
      BasicForceLaws<N> laws;
      laws.damper = bind_law(
          m_, e.damper,
          joint(damper.joint).coordinates[static_cast<std::size_t>(damper.coordinate)].damping_force, read_);
      out.damping = laws.damper.slope(0);
      note_damper(laws.damper);
      out.laws = std::make_shared<const BasicForceLaws<N>>(std::move(laws));
    }
    p_.torques.resize(s_.torques.size());
    for (std::size_t i = 0; i < s_.torques.size(); ++i) {
      if (s_.torques[i].implied) continue;
      const Link& l = s_.links[static_cast<std::size_t>(s_.torques[i].link)];
      const Drive& drive = *joint(s_.tree_joints[static_cast<std::size_t>(l.tree_joint)].joint)
                                .coordinates[static_cast<std::size_t>(l.coordinate)]
                                .drive;
      N& speed = p_.links[static_cast<std::size_t>(s_.torques[i].link)].speed;
      if (s_.torques[i].keeps_momentum)
        speed = read_(drive.speed);
      else
        speed = drive.speed; // no number of the balance
      bind_drive_law(s_.torques[i].torque, drive.torque, p_.torques[i].torque);
      bind_drive_law(s_.torques[i].load, drive.load, p_.torques[i].load);
    }
    for (std::size_t i = 0; i < s_.torques.size(); ++i)
      if (s_.torques[i].keeps_momentum) p_.torques[i].momentum = drawn_momentum(s_, p_, s_.torques[i].link);
    p_.cuts.resize(s_.cuts.size());
    for (std::size_t i = 0; i < s_.cuts.size(); ++i)
      bind_cut(s_.cuts[i], p_.cuts[i]);
  }

  void bind_bearing(const BearingElement& e, BasicBearingParameters<N>& out) const {
    const Force& f = m_.forces[static_cast<std::size_t>(e.force)];
    const Vector at = read_(f.at, Vector(Vector::Zero()));
    const auto matrix = [&](const BearingMatrix& entries, Eigen::Matrix<N, 6, 6>& to) {
      to.setZero();
      const int size = entries.size() > 4 ? 6 : 2;
      for (int i = 0; i < static_cast<int>(entries.size()); ++i)
        to(i / size, i % size) = read_(entries[static_cast<std::size_t>(i)]);
    };
    out.a = in_link(at, e.ends.a);
    out.b = in_link(at, e.ends.b);
    out.axes = bearing_axes(f, read_);
    matrix(f.bearing_stiffness, out.stiffness);
    matrix(f.bearing_damping, out.damping);
    if (e.turning >= 0 && out.resists_turns()) refuse_turning(e, f);
  }

  // A rotation vector ends at half a turn, where it jumps.
  [[noreturn]] void refuse_turning(const BearingElement& e, const Force& bearing) const {
    const Link& link = s_.links[static_cast<std::size_t>(e.turning)];
    throw SceneError(
        "forces." + bearing.name + (bearing.bearing_stiffness.empty() ? ".damping" : ".stiffness"),
        "expected zero in the rows and columns of turns, or bodies that do not turn against each "
        "other: " +
            s_.tree_joints[static_cast<std::size_t>(link.tree_joint)].name +
            " turns one of them on and on, and a rotation vector ends at half a turn");
  }

  void bind_drive_law(const DriveLaw& law, const std::optional<double>& value,
                      BasicDriveLawParameters<N>& out) const {
    out.value = value ? read_(*value) : N(0);
    out.numbers.clear();
    out.points.assign(law.inputs.size(), {});
    if (!law.expression) return;
    read_named(m_, law.expression->names(), read_, out.numbers);
    for (std::size_t i = 0; i < law.inputs.size(); ++i) {
      const DriveLaw::Input& input = law.inputs[i];
      if (input.spring >= 0) {
        const auto s = static_cast<std::size_t>(input.spring);
        const PairEnds& ends = s_.springs[s].ends;
        out.points[i] = {{{ends.a, p_.springs[s].a}, {ends.b, p_.springs[s].b}, {}}};
      } else if (input.coordinate < 0 && input.bearing < 0) {
        for (std::size_t n = 0; n < static_cast<std::size_t>(input.quantity.count); ++n)
          out.points[i][n] = tracked_point(s_, p_, m_, input.quantity.of[n], read_);
      }
    }
  }

  void bind_cut(const CutJoint& cut, BasicCutParameters<N>& out) const {
    const Joint& j = joint(cut.joint);
    out = {};
    if (cut.type == JointType::gear) {
      out.ratio = gear_ratio(j, read_);
      out.offset = gear_offset(j);
      return;
    }
    if (cut.type == JointType::distance) {
      const Vector a = read_(j.points[0]), b = read_(j.points[1]);
      out.a = in_link(a, cut.ends.a);
      out.b = in_link(b, cut.ends.b);
      out.length = read_(j.length, (b - a).norm());
      return;
    }
    const Vector at = read_(j.at);
    out.a = in_link(at, cut.ends.a);
    out.b = in_link(at, cut.ends.b);
    // Where a twin is welded the cut is a fixed joint, whatever the scene's is.
    static const Joint fixed;
    const BasicJointFrame<N> frame = joint_frame<N>(cut.type == JointType::fixed ? fixed : j, read_);
    out.frame = frame.axes;
    out.drawn = frame.drawn;
    if (cut.type == JointType::universal) out.constant = out.frame[2].dot(out.frame[3]);
  }

  const System& s_;
  const Mechanism& m_;
  const NumberReader<N>& read_;
  BasicParameters<N>& p_;
};

// How far free slides are from where their springs are slack and their stops touch, and how long springs are.
double free_lengths(const System& system, const Parameters& p) {
  double far = 0;
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    const Link& link = system.links[l];
    if (link.type != LinkType::prismatic || link.v < 0 || finds_speed(link)) continue;
    const CoordinateForce& force = p.links[l].force[0];
    const double drawn = p.links[l].drawn;
    if (force.has_spring()) far = std::max(far, std::abs(force.slack() - drawn));
    if (force.has_lower) far = std::max(far, std::abs(force.lower - drawn));
    if (force.has_upper) far = std::max(far, std::abs(force.upper - drawn));
  }
  for (const PointSpringParameters& spring : p.springs)
    far = std::max(far, std::abs(spring.free_length));
  return far;
}

// Of what is drawn at one point: these lengths, where its coordinates are counted from, and how far loads
// deflect the softest spring; where no place tells the largest radius of gyration counts, too, or what
// bearings tell by their stiffnesses. Zero where nothing does.
double reach_from_one_point(const System& system, const Parameters& p) {
  double far = free_lengths(system, p), load = 0, softest = std::numeric_limits<double>::infinity();
  const auto spring_of = [&](double stiffness) {
    if (stiffness != 0) softest = std::min(softest, std::abs(stiffness));
  };
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    const LinkParameters& link = p.links[l];
    load += std::abs(link.mass) * p.gravity.norm();
    if (system.links[l].type != LinkType::prismatic) continue;
    far = std::max(far, std::abs(link.drawn));
    load += std::abs(link.force[0].friction);
    spring_of(link.force[0].stiffness);
  }
  for (const PointSpringParameters& spring : p.springs)
    spring_of(spring.stiffness);
  for (const BodyForceParameters& force : p.body_forces)
    if (force.type == ForceType::force) load += force.vector.norm();
  double out = std::max(far, load / softest);
  for (const LinkParameters& l : p.links)
    if (far == 0 && l.mass > 0) out = std::max(out, std::sqrt(l.inertia.norm() / l.mass));
  for (std::size_t i = 0; i < system.bearings.size() && out == 0; ++i) {
    const auto& stiffness = p.bearings[i].stiffness;
    const double shifts = stiffness.topLeftCorner<3, 3>().norm(),
                 turns = stiffness.bottomRightCorner<3, 3>().norm();
    if (shifts > 0) out = std::sqrt(turns / shifts);
  }
  return out;
}

// Half the largest distance from the middle of all points that matter. Of what has none 1 m.
double reach(const System& system, const Parameters& p) {
  Eigen::AlignedBox3d box;
  for (const LinkParameters& l : p.links) {
    box.extend(l.origin);
    box.extend(Vec3(l.origin + l.com));
  }
  const auto add = [&](const Offset& at, int link) {
    box.extend(link >= 0 ? Vec3(at + p.links[static_cast<std::size_t>(link)].origin) : at);
  };
  for (std::size_t i = 0; i < system.springs.size(); ++i) {
    add(p.springs[i].a, system.springs[i].ends.a);
    add(p.springs[i].b, system.springs[i].ends.b);
  }
  for (std::size_t i = 0; i < system.cuts.size(); ++i) {
    if (system.cuts[i].type == JointType::gear) continue;
    add(p.cuts[i].a, system.cuts[i].ends.a);
    add(p.cuts[i].b, system.cuts[i].ends.b);
  }
  double half = box.isEmpty() ? 0 : box.diagonal().norm() / 2;
  // Places that differ by rounding are one point, and what goes much farther than they lie apart goes by
  // that.
  constexpr double rounding = 1e-12, little = 1. / 30;
  if (box.isEmpty() || half <= rounding * (box.min().cwiseAbs() + box.max().cwiseAbs()).maxCoeff() ||
      half < little * free_lengths(system, p))
    half = std::max(half, reach_from_one_point(system, p));
  return half > 0 && std::isfinite(half) ? half : 1;
}

bool phase_free(const System& system, const Parameters& p) {
  if (!p.moving) return true;
  if (system.drives.size() != 1) return false;
  const int d = system.drives.front().link;
  const Link& link = system.links[static_cast<std::size_t>(d)];
  if (link.parent >= 0) return false;
  if (link.type == LinkType::revolute &&
      p.gravity.cross(p.links[static_cast<std::size_t>(d)].axis).norm() > 1e-14 * p.gravity.norm())
    return false;
  const auto turns = [&](int l) { return l >= 0 && system.links[static_cast<std::size_t>(l)].frame == d; };
  const auto apart = [&](const PairEnds& e) { return turns(e.a) != turns(e.b); };
  for (const PointSpringElement& e : system.springs)
    if (apart(e.ends)) return false;
  for (const CutJoint& c : system.cuts)
    if (c.type != JointType::gear && apart(c.ends)) return false;
  for (const CutDamperElement& e : system.cut_dampers)
    if (apart(e.ends)) return false;
  for (const BearingElement& e : system.bearings)
    if (apart(e.ends)) return false;
  // Air that turns with a body looks the same at every phase; a wind does along the axis alone.
  const Vec3& axis = p.links[static_cast<std::size_t>(d)].axis;
  for (std::size_t i = 0; i < system.body_forces.size(); ++i) {
    if (!turns(system.body_forces[i].link)) continue;
    const BodyForceParameters& f = p.body_forces[i];
    if (is_of_air(f.type) ? f.wind.cross(axis).norm() > 1e-14 * f.wind.norm() : f.frame == ForceFrame::world)
      return false;
  }
  return true;
}

} // namespace

void bind(const System& system, const Mechanism& mechanism, Parameters& parameters) {
  Binder<double>(system, mechanism, {}, parameters).run();
  parameters.length = reach(system, parameters);
  set_implied_rates(system, parameters);
  parameters.phase_free = phase_free(system, parameters);
  refuse_turning_laws(system, mechanism, parameters);
}

void bind(const System& system, const Mechanism& mechanism, const NumberRates& rates, const Parameters& of,
          BasicParameters<Dual>& parameters) {
  const NumberReader<Dual> read(rates);
  Binder<Dual>(system, mechanism, read, parameters).run();
  parameters.speed_scale = of.speed_scale;
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
