#include "tests/engine/reference/tree.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

namespace flyball::reference {

namespace {

std::size_t number_of(int i) {
  return static_cast<std::size_t>(i);
}

int index_of(const Mechanism& mechanism, const std::string& body) {
  if (body == ground_name) return -1;
  const int i = body_index(mechanism, body);
  if (i < 0) throw std::invalid_argument("no body " + body);
  return i;
}

const RigidMotion& motion_of(const Mechanism& mechanism, const std::string& body,
                             std::span<const RigidMotion> motions) {
  static const RigidMotion ground;
  const int i = index_of(mechanism, body);
  return i < 0 ? ground : motions[number_of(i)];
}

// The joint's unit axes as drawn: `axis`, and two directions that complete it to a right-handed frame, the
// first along `axis2` where that means something (planar).
struct Axes {
  Vec3R a, u, v;
};

Axes axes_of(const Joint& joint) {
  Axes r;
  r.a = joint.axis.cast<Real>().normalized();
  Vec3R along = joint.axis2.cast<Real>();
  if (joint.type != JointType::planar) {
    Eigen::Index smallest = 0;
    r.a.cwiseAbs().minCoeff(&smallest);
    along = Vec3R::Unit(smallest);
  }
  r.u = (along - r.a * r.a.dot(along)).normalized();
  r.v = r.a.cross(r.u);
  return r;
}

Vec3R three(std::span<const Real> values, std::size_t first) {
  return {values[first], values[first + 1], values[first + 2]};
}

Vec3R drawn_rotation(const Joint& joint, std::size_t first) {
  Vec3R r;
  for (int i = 0; i < 3; ++i)
    r[i] = joint.coordinates[first + number_of(i)].drawn;
  return r;
}

// exp(r) = D exp(r_drawn), turning with angular velocity w.
RigidMotion rotation_displacement(const Joint& joint, std::size_t first, std::span<const Real> q,
                                  std::span<const Real> w) {
  const Mat3R d = rotation_exp(three(q, first)) * rotation_exp(drawn_rotation(joint, first)).transpose();
  const Vec3R velocity = three(w, first);
  const Real rate = velocity.norm();
  const RigidMotion turn = rate > 0 ? rotation(velocity / rate, 0, rate) : RigidMotion();
  return turn * rotation(d);
}

// J(q), see the head of tree.hpp.
RigidMotion joint_displacement(const Joint& joint, std::span<const Real> q, std::span<const Real> rate) {
  const Vec3R p = joint.at.cast<Real>();
  const Axes axes = axes_of(joint);
  const auto offset = [&](std::size_t i) { return q[i] - joint.coordinates[i].drawn; };
  const auto turn = [&](const Vec3R& axis, std::size_t i) {
    return about(p, rotation(axis, offset(i), rate[i]));
  };
  const auto shift = [&](const Vec3R& axis, std::size_t i) {
    return translation(axis * offset(i), axis * rate[i]);
  };
  switch (joint.type) {
  case JointType::revolute: return turn(axes.a, 0);
  case JointType::prismatic: return shift(axes.a, 0);
  case JointType::cylindrical: return turn(axes.a, 0) * shift(axes.a, 1);
  case JointType::universal: return turn(axes.a, 0) * turn(joint.axis2.cast<Real>().normalized(), 1);
  case JointType::spherical: return about(p, rotation_displacement(joint, 0, q, rate));
  case JointType::planar: return shift(axes.u, 0) * shift(axes.v, 1) * turn(axes.a, 2);
  case JointType::free:
    return shift(Vec3R::UnitX(), 0) * shift(Vec3R::UnitY(), 1) * shift(Vec3R::UnitZ(), 2) *
           about(p, rotation_displacement(joint, 3, q, rate));
  case JointType::fixed: return {};
  case JointType::distance:
  case JointType::gear: break;
  }
  throw std::invalid_argument("joint " + joint.name + " cannot be in a tree");
}

// Which bodies hang together so far; ground is the last.
struct Groups {
  std::vector<int> parent;

  explicit Groups(std::size_t bodies) : parent(bodies + 1) { std::iota(parent.begin(), parent.end(), 0); }
  int root(int body) {
    std::size_t i = body < 0 ? parent.size() - 1 : number_of(body);
    while (parent[i] != static_cast<int>(i))
      i = number_of(parent[i]);
    return static_cast<int>(i);
  }
  bool join(int a, int b) {
    const int ra = root(a), rb = root(b);
    parent[number_of(ra)] = rb;
    return ra != rb;
  }
};

// A gear from a driven coordinate drives the other (design: "A gear to a driven coordinate ...").
void spread_drives(const Mechanism& mechanism, Tree& tree) {
  const auto coordinate = [&](const std::string& name) -> TreeCoordinate* {
    const CoordinateReference r = find_coordinate(mechanism, name);
    if (r.joint < 0) throw std::invalid_argument("no coordinate " + name);
    const int first = tree.first[number_of(r.joint)];
    return first < 0 ? nullptr : &tree.coordinates[number_of(first + r.coordinate)];
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (const Joint& joint : mechanism.joints) {
      if (joint.type != JointType::gear) continue;
      TreeCoordinate *a = coordinate(joint.joints[0]), *b = coordinate(joint.joints[1]);
      if (!a || !b || a->driven == b->driven) continue;
      if (a->driven)
        b->speed = joint.ratio * a->speed;
      else
        a->speed = b->speed / joint.ratio;
      a->driven = b->driven = changed = true;
    }
  }
}

} // namespace

Tree span_tree(const Mechanism& mechanism, const std::vector<std::string>& cut_joints) {
  Tree tree;
  std::vector<int> waiting;
  for (int j = 0; j < static_cast<int>(mechanism.joints.size()); ++j) {
    const Joint& joint = mechanism.joints[number_of(j)];
    const bool cut = joint.type == JointType::distance || joint.type == JointType::gear ||
                     std::find(cut_joints.begin(), cut_joints.end(), joint.name) != cut_joints.end();
    tree.first.push_back(cut ? -1 : static_cast<int>(tree.coordinates.size()));
    (cut ? tree.cut : waiting).push_back(j);
    if (cut) continue;
    for (int i = 0; i < coordinate_count(joint.type); ++i) {
      const auto& drive = joint.coordinates[number_of(i)].drive;
      tree.coordinates.push_back(
          {j, i, is_rotation_vector(joint.type, i), drive.has_value(), drive ? drive->speed : 0});
    }
  }
  std::vector<bool> placed(mechanism.bodies.size(), false);
  const auto is_placed = [&](int body) { return body < 0 || placed[number_of(body)]; };
  for (bool progress = true; progress && !waiting.empty();) {
    progress = false;
    std::vector<int> later;
    for (const int j : waiting) {
      const Joint& joint = mechanism.joints[number_of(j)];
      const int parent = index_of(mechanism, joint.bodies[0]), child = index_of(mechanism, joint.bodies[1]);
      if (is_placed(parent) && is_placed(child))
        throw std::invalid_argument("joint " + joint.name + " closes a loop and is not cut");
      if (!is_placed(parent) && !is_placed(child)) {
        later.push_back(j);
        continue;
      }
      const bool reversed = is_placed(child);
      tree.links.push_back({j, reversed ? child : parent, reversed ? parent : child, reversed});
      placed[number_of(tree.links.back().to)] = true;
      progress = true;
    }
    waiting = later;
  }
  for (std::size_t b = 0; b < placed.size(); ++b)
    if (!placed[b]) throw std::invalid_argument("body " + mechanism.bodies[b].name + " is not in the tree");
  spread_drives(mechanism, tree);
  return tree;
}

std::vector<std::string> default_cuts(const Mechanism& mechanism) {
  std::vector<std::string> cuts;
  Groups groups(mechanism.bodies.size());
  for (const bool driven : {true, false})
    for (const Joint& joint : mechanism.joints) {
      const bool has_drive = std::any_of(joint.coordinates.begin(), joint.coordinates.end(),
                                         [](const Coordinate& c) { return c.drive.has_value(); });
      if (has_drive != driven) continue;
      if (joint.type == JointType::distance || joint.type == JointType::gear || joint.cut.value_or(false) ||
          !groups.join(index_of(mechanism, joint.bodies[0]), index_of(mechanism, joint.bodies[1])))
        cuts.push_back(joint.name);
    }
  return cuts;
}

std::vector<Real> joint_values(const Joint& joint, const ReferenceState& state) {
  const auto found = state.coordinates.find(joint.name);
  if (found != state.coordinates.end()) {
    if (found->second.size() != number_of(coordinate_count(joint.type)))
      throw std::invalid_argument("wrong number of coordinates for " + joint.name);
    return found->second;
  }
  std::vector<Real> values;
  for (const Coordinate& c : joint.coordinates)
    values.push_back(c.drawn);
  return values;
}

std::vector<RigidMotion> move_bodies(const Mechanism& mechanism, const Tree& tree,
                                     const ReferenceState& state, const VectorR& rates) {
  std::vector<RigidMotion> motions(mechanism.bodies.size());
  for (const Tree::Link& link : tree.links) {
    const Joint& joint = mechanism.joints[number_of(link.joint)];
    std::vector<Real> rate;
    for (int i = 0; i < coordinate_count(joint.type); ++i)
      rate.push_back(rates[tree.first[number_of(link.joint)] + i]);
    const RigidMotion displacement = joint_displacement(joint, joint_values(joint, state), rate);
    const RigidMotion base = link.from < 0 ? RigidMotion() : motions[number_of(link.from)];
    motions[number_of(link.to)] = base * (link.reversed ? displacement.inverse() : displacement);
  }
  return motions;
}

ReferenceState advance(const Mechanism& mechanism, const Tree& tree, const ReferenceState& state,
                       const VectorR& step) {
  ReferenceState result = state;
  for (const Tree::Link& link : tree.links) {
    const Joint& joint = mechanism.joints[number_of(link.joint)];
    const int first = tree.first[number_of(link.joint)];
    std::vector<Real> values = joint_values(joint, state);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!is_rotation_vector(joint.type, static_cast<int>(i))) {
        values[i] += step[first + static_cast<int>(i)];
        continue;
      }
      const Vec3R delta = step.segment<3>(first + static_cast<int>(i));
      const Vec3R r = rotation_log(rotation_exp(delta) * rotation_exp(three(values, i)));
      std::copy(r.begin(), r.end(), values.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
    result.coordinates[joint.name] = values;
  }
  return result;
}

std::vector<MovingReal> coordinates_of_motion(const Mechanism& mechanism, const Joint& joint,
                                              std::span<const RigidMotion> motions) {
  const RigidMotion& parent = motion_of(mechanism, joint.bodies[0], motions);
  const RigidMotion& child = motion_of(mechanism, joint.bodies[1], motions);
  const Axes axes = axes_of(joint);
  const MovingVector e =
      moving_point(child, joint.at.cast<Real>()) - moving_point(parent, joint.at.cast<Real>());
  const auto on_parent = [&](const Vec3R& d) { return moving_direction(parent, d); };
  const auto on_child = [&](const Vec3R& d) { return moving_direction(child, d); };
  const auto label = [&](std::size_t i, MovingReal q) {
    q.x += joint.coordinates[i].drawn;
    return q;
  };
  const auto angle = [&](std::size_t i) {
    const MovingVector u = on_child(axes.u);
    return label(i, atan2(dot(u, on_parent(axes.v)), dot(u, on_parent(axes.u))));
  };
  const auto slide = [&](std::size_t i, const Vec3R& d) { return label(i, dot(e, on_parent(d))); };
  const auto rotation_vector = [&](std::size_t first, std::vector<MovingReal>& q) {
    const Mat3R d = parent.rotation().transpose() * child.rotation();
    const Vec3R r = rotation_log(d * rotation_exp(drawn_rotation(joint, first)));
    const Vec3R v = left_jacobian_inverse(r) * parent.rotation().transpose() *
                    (child.angular_velocity() - parent.angular_velocity());
    for (int i = 0; i < 3; ++i)
      q.push_back({r[i], v[i]});
  };
  std::vector<MovingReal> q;
  switch (joint.type) {
  case JointType::revolute: q = {angle(0)}; break;
  case JointType::prismatic: q = {slide(0, axes.a)}; break;
  case JointType::cylindrical: q = {angle(0), slide(1, axes.a)}; break;
  case JointType::universal: {
    // The child's axis2 seen from the parent turns about axis by q0; the parent's axis seen from the child
    // turns about axis2 by -q1.
    const Vec3R a2 = joint.axis2.cast<Real>().normalized();
    const Vec3R w = (a2 - axes.a * axes.a.dot(a2)).normalized(),
                w2 = (axes.a - a2 * axes.a.dot(a2)).normalized();
    const MovingVector second = on_child(a2), primary = on_parent(axes.a);
    q.push_back(label(0, atan2(dot(second, on_parent(axes.a.cross(w))), dot(second, on_parent(w)))));
    q.push_back(label(1, -1 * atan2(dot(primary, on_child(a2.cross(w2))), dot(primary, on_child(w2)))));
    break;
  }
  case JointType::spherical: rotation_vector(0, q); break;
  case JointType::planar: q = {slide(0, axes.u), slide(1, axes.v), angle(2)}; break;
  case JointType::free:
    q = {slide(0, Vec3R::UnitX()), slide(1, Vec3R::UnitY()), slide(2, Vec3R::UnitZ())};
    rotation_vector(3, q);
    break;
  case JointType::fixed:
  case JointType::distance:
  case JointType::gear: break;
  }
  return q;
}

std::vector<MovingReal> constraints_of_motion(const Mechanism& mechanism, const Joint& joint,
                                              std::span<const RigidMotion> motions) {
  const RigidMotion& parent = motion_of(mechanism, joint.bodies[0], motions);
  const RigidMotion& child = motion_of(mechanism, joint.bodies[1], motions);
  if (joint.type == JointType::distance) {
    const Real length = joint.length ? Real(*joint.length)
                                     : (joint.points[1].cast<Real>() - joint.points[0].cast<Real>()).norm();
    MovingReal gap = norm(moving_point(child, joint.points[1].cast<Real>()) -
                          moving_point(parent, joint.points[0].cast<Real>()));
    gap.x -= length;
    return {gap};
  }
  const Axes axes = axes_of(joint);
  const MovingVector e =
      moving_point(child, joint.at.cast<Real>()) - moving_point(parent, joint.at.cast<Real>());
  std::vector<MovingReal> phi;
  const auto no_shift = [&](const Vec3R& d) { phi.push_back(dot(e, moving_direction(parent, d))); };
  // A direction of the child and one of the parent keep the angle between them that they were drawn with.
  const auto keep = [&](const Vec3R& on_child, const Vec3R& on_parent) {
    MovingReal change = dot(moving_direction(child, on_child), moving_direction(parent, on_parent));
    change.x -= on_child.dot(on_parent);
    phi.push_back(change);
  };
  const auto same_point = [&] {
    for (int i = 0; i < 3; ++i)
      no_shift(Vec3R::Unit(i));
  };
  const auto parallel = [&] {
    keep(axes.a, axes.u);
    keep(axes.a, axes.v);
  };
  switch (joint.type) {
  case JointType::revolute:
    same_point();
    parallel();
    break;
  case JointType::prismatic:
    no_shift(axes.u);
    no_shift(axes.v);
    parallel();
    keep(axes.u, axes.v);
    break;
  case JointType::cylindrical:
    no_shift(axes.u);
    no_shift(axes.v);
    parallel();
    break;
  case JointType::universal:
    same_point();
    keep(joint.axis2.cast<Real>().normalized(), axes.a);
    break;
  case JointType::spherical: same_point(); break;
  case JointType::planar:
    no_shift(axes.a);
    parallel();
    break;
  case JointType::fixed:
    same_point();
    parallel();
    keep(axes.u, axes.v);
    break;
  case JointType::free:
  case JointType::distance:
  case JointType::gear: break;
  }
  return phi;
}

ReferenceState state_of_motion(const Mechanism& mechanism, std::span<const RigidMotion> motions) {
  ReferenceState state;
  for (const Joint& joint : mechanism.joints) {
    if (coordinate_count(joint.type) == 0) continue;
    std::vector<Real>& values = state.coordinates[joint.name];
    for (const MovingReal& q : coordinates_of_motion(mechanism, joint, motions))
      values.push_back(q.x);
  }
  return state;
}

} // namespace flyball::reference
