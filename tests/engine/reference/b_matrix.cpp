#include "tests/engine/reference/b_matrix.hpp"

#include "engine/mechanism/drive_law.hpp"
#include "engine/mechanism/force_law.hpp"

#include <stdexcept>

namespace flyball::reference {

namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

Mat3R inertia_of(const Body& body) {
  const auto& [xx, yy, zz, xy, xz, yz] = body.inertia;
  Mat3R m;
  m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return m;
}

// Coordinates of all joints along one motion, tree and cut joints alike; empty for gears and the like.
using JointCoordinates = std::vector<std::vector<MovingReal>>;

// `rates` are those that made `motions`. Tree joints keep the values they were given (a turn is not lost).
JointCoordinates coordinates_along(const Mechanism& mechanism, const Tree& tree, const ReferenceState& state,
                                   const VectorR& rates, std::span<const RigidMotion> motions) {
  JointCoordinates all;
  for (std::size_t j = 0; j < mechanism.joints.size(); ++j) {
    const Joint& joint = mechanism.joints[j];
    const int first = tree.first[j];
    if (first < 0) {
      all.push_back(coordinate_count(joint.type) > 0 ? coordinates_of_motion(mechanism, joint, motions)
                                                     : std::vector<MovingReal>{});
      continue;
    }
    const std::vector<Real> values = joint_values(joint, state);
    std::vector<MovingReal> q(values.size());
    for (int i = 0; i < static_cast<int>(values.size()); ++i)
      q[at(i)] = {values[at(i)], rates[first + i]};
    const int count = static_cast<int>(values.size());
    if (count > 0 && is_rotation_vector(joint.type, count - 1)) {
      const std::size_t r0 = values.size() - 3;
      const Vec3R r(values[r0], values[r0 + 1], values[r0 + 2]);
      const Vec3R v = left_jacobian_inverse(r) * rates.segment<3>(first + count - 3);
      for (int i = 0; i < 3; ++i)
        q[r0 + at(i)].v = v[i];
    }
    all.push_back(q);
  }
  return all;
}

std::vector<MovingReal> constraints_along(const Mechanism& mechanism, const Tree& tree,
                                          std::span<const RigidMotion> motions,
                                          const JointCoordinates& coordinates,
                                          std::vector<int>* owner = nullptr) {
  std::vector<MovingReal> phi;
  for (const int j : tree.cut) {
    const Joint& joint = mechanism.joints[at(j)];
    std::vector<MovingReal> rows;
    if (joint.type == JointType::gear) {
      const CoordinateReference ra = find_coordinate(mechanism, joint.joints[0]);
      const CoordinateReference rb = find_coordinate(mechanism, joint.joints[1]);
      const double drawn_a = mechanism.joints[at(ra.joint)].coordinates[at(ra.coordinate)].drawn;
      const double drawn_b = mechanism.joints[at(rb.joint)].coordinates[at(rb.coordinate)].drawn;
      MovingReal row = coordinates[at(rb.joint)][at(rb.coordinate)] -
                       Real(joint.ratio) * coordinates[at(ra.joint)][at(ra.coordinate)];
      row.x -= joint.offset ? Real(*joint.offset) : drawn_b - Real(joint.ratio) * drawn_a;
      rows = {row};
    } else {
      rows = constraints_of_motion(mechanism, joint, motions);
    }
    phi.insert(phi.end(), rows.begin(), rows.end());
    if (owner) owner->insert(owner->end(), rows.size(), j);
  }
  return phi;
}

// Of a coordinate's spring, stop and damper, along the coordinate (N, N m).
Real coordinate_force(const Coordinate& c, const MovingReal& q) {
  Real force = -Real(c.damping) * q.v;
  if (c.spring) force -= Real(c.spring->stiffness) * (q.x - Real(c.spring->free));
  if (c.stop && c.stop->lower && q.x < *c.stop->lower)
    force -= Real(c.stop->stiffness) * (q.x - *c.stop->lower);
  if (c.stop && c.stop->upper && q.x > *c.stop->upper)
    force -= Real(c.stop->stiffness) * (q.x - *c.stop->upper);
  return force;
}

Real coordinate_energy(const Coordinate& c, Real q) {
  const auto energy = [q](double stiffness, Real slack) { return stiffness * (q - slack) * (q - slack) / 2; };
  Real sum = 0;
  if (c.spring) sum += energy(c.spring->stiffness, c.spring->free);
  if (c.stop && c.stop->lower && q < *c.stop->lower) sum += energy(c.stop->stiffness, *c.stop->lower);
  if (c.stop && c.stop->upper && q > *c.stop->upper) sum += energy(c.stop->stiffness, *c.stop->upper);
  return sum;
}

// Where forces act, carried by the bodies.
struct Carriers {
  const Mechanism& mechanism;
  std::span<const RigidMotion> motions;

  MovingVector point(const std::string& body, const Vec3& drawn) const {
    const int b = body_index(mechanism, body);
    return b < 0 ? MovingVector{drawn.cast<Real>(), Vec3R::Zero()}
                 : moving_point(motions[at(b)], drawn.cast<Real>());
  }
  // Of a body, as a field at a point of the world.
  Vec3R velocity(const std::string& body, const Vec3R& at_point) const {
    const RigidMotion& motion = motions[at(body_index(mechanism, body))];
    return (motion.x1 * motion.inverse().x * at_point.homogeneous()).head<3>();
  }
  MovingVector attachment(const Force& force) const {
    return point(force.body,
                 force.at.value_or(mechanism.bodies[at(body_index(mechanism, force.body))].position));
  }
  // From the spring's point on the first body to that on the second.
  MovingVector line(const Force& spring) const {
    return point(spring.bodies[1], spring.points[1]) - point(spring.bodies[0], spring.points[0]);
  }
};

Real free_length(const Force& spring) {
  return spring.free_length ? Real(*spring.free_length)
                            : (spring.points[1].cast<Real>() - spring.points[0].cast<Real>()).norm();
}

void push(const Mechanism& mechanism, std::vector<ReferenceBody>& bodies, const std::string& name,
          const Vec3R& point, const Vec3R& force) {
  const int b = body_index(mechanism, name);
  if (b < 0) return;
  bodies[at(b)].applied.force += force;
  bodies[at(b)].applied.torque += (point - bodies[at(b)].position).cross(force);
}

// Of a vane, by its law or number.
Real coefficient(const Mechanism& mechanism, const Formula* formula, const std::optional<double>& number,
                 Real attack) {
  if (!formula) return number.value_or(0);
  const ForceLaw law(formula->text, air_variable);
  std::vector<Dual> numbers;
  for (const std::string& name : law.names())
    numbers.emplace_back(named_number(mechanism, name));
  const auto rounded = static_cast<double>(attack);
  const Dual there = law(numbers, {rounded, 1});
  return Real(there.value) + Real(there.rate) * (attack - Real(rounded));
}

// Lift and drag by the angle of attack of the flow in the plane of normal and chord, or of normal and flow.
Vec3R vane_force(const Mechanism& mechanism, const Force& vane, const Mat3R& displacement,
                 const Vec3R& flow) {
  const Vec3R normal = displacement * vane.normal.cast<Real>().normalized();
  Vec3R along = flow - normal * normal.dot(flow);
  if (vane.chord) {
    const Vec3R chord = displacement * vane.chord->cast<Real>(),
                in_plate = chord - normal * normal.dot(chord);
    along = in_plate.normalized();
  } else if (along.norm() > 0) {
    along.normalize();
  }
  const Real across = flow.dot(normal), past = flow.dot(along), speed = std::hypot(across, past);
  if (speed == 0) return Vec3R::Zero();
  const Real attack = std::atan2(across, past), pressure = Real(mechanism.air.density) / 2 * speed * speed;
  const bool polar = vane.lift || vane.drag;
  const Real lift = polar ? coefficient(mechanism, lift_law(vane), vane.lift, attack)
                          : Real(vane.cn) * std::sin(attack) * std::cos(attack),
             drag = polar ? coefficient(mechanism, drag_law(vane), vane.drag, attack)
                          : Real(vane.cn) * std::sin(attack) * std::sin(attack) + Real(vane.cd);
  const Vec3R downstream = (across * normal + past * along) / speed,
              lifting = (past * normal - across * along) / speed;
  return pressure * Real(vane.area) * (lift * lifting + drag * downstream);
}

void apply(const Mechanism& mechanism, const Force& force, const Carriers& carriers,
           std::vector<ReferenceBody>& bodies) {
  if (force.type == ForceType::spring) {
    const MovingVector line = carriers.line(force);
    const Real slack = free_length(force);
    if (line.x.norm() == 0 && slack == 0) return; // no length, no direction, no force
    const MovingReal length = norm(line);
    const Real tension = Real(force.stiffness) * (length.x - slack) + Real(force.damping) * length.v;
    const Vec3R pull = line.x * (tension / length.x);
    push(mechanism, bodies, force.bodies[0], carriers.point(force.bodies[0], force.points[0]).x, pull);
    push(mechanism, bodies, force.bodies[1], carriers.point(force.bodies[1], force.points[1]).x, -pull);
    return;
  }
  ReferenceBody& body = bodies[at(body_index(mechanism, force.body))];
  const MovingVector point = carriers.attachment(force);
  const Vec3R given = force.vector.cast<Real>();
  const Vec3R vector = force.frame == ForceFrame::body ? Vec3R(body.rotation * given) : given;
  switch (force.type) {
  case ForceType::force: push(mechanism, bodies, force.body, point.x, vector); break;
  case ForceType::torque: body.applied.torque += vector; break;
  case ForceType::drag:
  case ForceType::vane: {
    const std::string& turner = mechanism.air.turns_with;
    const Vec3R air =
        turner.empty() ? Vec3R(mechanism.air.wind.cast<Real>()) : Vec3R(carriers.velocity(turner, point.x));
    const Vec3R flow = air - point.v;
    const Mat3R drawn = mechanism.bodies[at(body_index(mechanism, force.body))]
                            .rotation.cast<Real>()
                            .normalized()
                            .toRotationMatrix();
    const Vec3R push_of_air = force.type == ForceType::vane
                                  ? vane_force(mechanism, force, body.rotation * drawn.transpose(), flow)
                                  : (Real(force.linear) + Real(force.quadratic) * flow.norm()) * flow;
    push(mechanism, bodies, force.body, point.x, push_of_air);
    if (!turner.empty()) push(mechanism, bodies, turner, point.x, -push_of_air);
    break;
  }
  case ForceType::spring:
  case ForceType::bearing: break; // the reference knows none
  }
}

// Placements, velocities, accelerations and inertial wrenches of the drives' motion.
std::vector<ReferenceBody> drive_bodies(const Mechanism& mechanism, std::span<const RigidMotion> motions) {
  std::vector<ReferenceBody> bodies;
  for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
    const Body& body = mechanism.bodies[b];
    const RigidMotion& motion = motions[b];
    const Eigen::Matrix<Real, 4, 1> centre = body.position.cast<Real>().homogeneous();
    ReferenceBody r;
    r.position = (motion.x * centre).head<3>();
    r.rotation = motion.rotation() * body.rotation.cast<Real>().normalized().toRotationMatrix();
    r.velocity = (motion.x1 * centre).head<3>();
    r.angular_velocity = motion.angular_velocity();
    r.acceleration = (motion.x2 * centre).head<3>();
    r.angular_acceleration = motion.angular_acceleration();
    const Mat3R inertia = r.rotation * inertia_of(body) * r.rotation.transpose();
    r.inertial.force = Real(body.mass) * r.acceleration;
    r.inertial.torque =
        inertia * r.angular_acceleration + r.angular_velocity.cross(Vec3R(inertia * r.angular_velocity));
    r.applied.force = Real(body.mass) * mechanism.gravity.cast<Real>();
    bodies.push_back(r);
  }
  return bodies;
}

VectorR drive_rates(const Tree& tree) {
  VectorR rates(static_cast<Eigen::Index>(tree.coordinates.size()));
  for (std::size_t i = 0; i < tree.coordinates.size(); ++i)
    rates[static_cast<Eigen::Index>(i)] = tree.coordinates[i].speed;
  return rates;
}

// The shortest x that solves a x = b best. Redundant rows differ by the round-off of the mechanism's doubles
// and by how far its loops are open; what is smaller than that counts as dependent.
VectorR shortest_solution(const MatrixR& a, const VectorR& b) {
  Eigen::CompleteOrthogonalDecomposition<MatrixR> decomposition;
  decomposition.setThreshold(1e-9L);
  decomposition.compute(a);
  return decomposition.solve(b);
}

} // namespace

Evaluation evaluate(const Mechanism& mechanism, const std::vector<std::string>& cut_joints,
                    const ReferenceState& state) {
  Evaluation e;
  e.tree = span_tree(mechanism, cut_joints);
  const auto count = static_cast<Eigen::Index>(e.tree.coordinates.size());
  const auto rows = static_cast<Eigen::Index>(6 * mechanism.bodies.size());
  for (int i = 0; i < count; ++i) {
    const TreeCoordinate& c = e.tree.coordinates[at(i)];
    (c.driven ? e.driven : e.free).push_back(i);
    if (!mechanism.joints[at(c.joint)].coordinates[at(c.index)].drive) e.unpowered.push_back(i);
  }

  const VectorR speeds = drive_rates(e.tree);
  const std::vector<RigidMotion> drive = move_bodies(mechanism, e.tree, state, speeds);
  const JointCoordinates along_drive = coordinates_along(mechanism, e.tree, state, speeds, drive);
  e.bodies = drive_bodies(mechanism, drive);
  for (const Force& force : mechanism.forces)
    apply(mechanism, force, Carriers{mechanism, drive}, e.bodies);
  const std::vector<MovingReal> phi =
      constraints_along(mechanism, e.tree, drive, along_drive, &e.constraint_joint);
  e.constraints.resize(static_cast<Eigen::Index>(phi.size()));
  for (Eigen::Index i = 0; i < e.constraints.size(); ++i)
    e.constraints[i] = phi[static_cast<std::size_t>(i)].x;

  VectorR net(rows); // M Bdot_D q_D' + gyroscopic - Q
  for (std::size_t b = 0; b < e.bodies.size(); ++b) {
    const auto r = static_cast<Eigen::Index>(6 * b);
    net.segment<3>(r) = e.bodies[b].inertial.force - e.bodies[b].applied.force;
    net.segment<3>(r + 3) = e.bodies[b].inertial.torque - e.bodies[b].applied.torque;
  }
  e.B.resize(rows, count);
  e.balance.resize(count);
  e.constraint_jacobian.resize(e.constraints.size(), count);
  for (Eigen::Index c = 0; c < count; ++c) {
    // The motion of one coordinate at unit rate is a column of B, and its power that coordinate's force.
    const VectorR unit = VectorR::Unit(count, c);
    const std::vector<RigidMotion> motions = move_bodies(mechanism, e.tree, state, unit);
    for (std::size_t b = 0; b < motions.size(); ++b) {
      const auto r = static_cast<Eigen::Index>(6 * b);
      e.B.block<3, 1>(r, c) = moving_point(motions[b], mechanism.bodies[b].position.cast<Real>()).v;
      e.B.block<3, 1>(r + 3, c) = motions[b].angular_velocity();
    }
    const JointCoordinates along = coordinates_along(mechanism, e.tree, state, unit, motions);
    Real joint_power = 0;
    for (std::size_t j = 0; j < along.size(); ++j)
      for (std::size_t i = 0; i < along[j].size(); ++i)
        joint_power +=
            coordinate_force(mechanism.joints[j].coordinates[i], along_drive[j][i]) * along[j][i].v;
    e.balance[c] = e.B.col(c).dot(net) - joint_power;
    const std::vector<MovingReal> moved = constraints_along(mechanism, e.tree, motions, along);
    for (std::size_t i = 0; i < moved.size(); ++i)
      e.constraint_jacobian(static_cast<Eigen::Index>(i), c) = moved[i].v;
  }
  return e;
}

std::map<std::string, VectorR> Evaluation::by_joint(const Mechanism& mechanism, const VectorR& lambda) const {
  const VectorR f =
      lambda.size() == 0 ? balance : VectorR(balance + constraint_jacobian.transpose() * lambda);
  std::map<std::string, VectorR> result;
  for (const Tree::Link& link : tree.links) {
    const Joint& joint = mechanism.joints[at(link.joint)];
    const int count = coordinate_count(joint.type);
    if (count > 0) result[joint.name] = f.segment(tree.first[at(link.joint)], count);
  }
  return result;
}

VectorR Evaluation::multipliers() const {
  if (constraints.size() == 0 || unpowered.empty()) return VectorR::Zero(constraints.size());
  return shortest_solution(constraint_jacobian(Eigen::all, unpowered).transpose(), -balance(unpowered));
}

VectorR Evaluation::unbalanced() const {
  const VectorR f = balance + constraint_jacobian.transpose() * multipliers();
  return f(unpowered);
}

std::map<std::string, VectorR> generalized_forces(const Mechanism& mechanism,
                                                  const std::vector<std::string>& cut_joints,
                                                  const ReferenceState& state, const VectorR& lambda) {
  return evaluate(mechanism, cut_joints, state).by_joint(mechanism, lambda);
}

bool has_potential(const Mechanism& mechanism) {
  for (const Force& force : mechanism.forces) {
    if (force.type == ForceType::torque || is_of_air(force.type)) return false;
    if (force.type == ForceType::force && force.frame == ForceFrame::body) return false;
  }
  return true;
}

Real potential(const Mechanism& mechanism, const std::vector<std::string>& cut_joints,
               const ReferenceState& state) {
  if (!has_potential(mechanism)) throw std::invalid_argument("the forces have no potential");
  const Tree tree = span_tree(mechanism, cut_joints);
  const VectorR speeds = drive_rates(tree);
  const std::vector<RigidMotion> motions = move_bodies(mechanism, tree, state, speeds);
  const std::vector<ReferenceBody> bodies = drive_bodies(mechanism, motions);
  Real sum = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const ReferenceBody& body = bodies[b];
    const Vec3R w = body.rotation.transpose() * body.angular_velocity;
    sum -= Real(mechanism.bodies[b].mass) *
           (mechanism.gravity.cast<Real>().dot(body.position) + body.velocity.squaredNorm() / 2);
    sum -= w.dot(inertia_of(mechanism.bodies[b]) * w) / 2;
  }
  const JointCoordinates coordinates = coordinates_along(mechanism, tree, state, speeds, motions);
  for (std::size_t j = 0; j < coordinates.size(); ++j)
    for (std::size_t i = 0; i < coordinates[j].size(); ++i)
      sum += coordinate_energy(mechanism.joints[j].coordinates[i], coordinates[j][i].x);
  const Carriers carriers{mechanism, motions};
  for (const Force& force : mechanism.forces) {
    if (force.type == ForceType::force) {
      sum -= force.vector.cast<Real>().dot(carriers.attachment(force).x);
    } else {
      const Real stretch = carriers.line(force).x.norm() - free_length(force);
      sum += Real(force.stiffness) * stretch * stretch / 2;
    }
  }
  return sum;
}

ReferenceState assemble(const Mechanism& mechanism, const std::vector<std::string>& cut_joints,
                        const ReferenceState& state) {
  ReferenceState result = state;
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Evaluation e = evaluate(mechanism, cut_joints, result);
    if (e.constraints.size() == 0 || e.constraints.cwiseAbs().maxCoeff() < 1e-17L) return result;
    if (e.free.empty()) break;
    VectorR step = VectorR::Zero(static_cast<Eigen::Index>(e.tree.coordinates.size()));
    step(e.free) = shortest_solution(e.constraint_jacobian(Eigen::all, e.free), -e.constraints);
    if (step.norm() < 1e-17L) break;
    result = advance(mechanism, e.tree, result, step * std::min(Real(1), Real(0.5) / step.norm()));
  }
  if (evaluate(mechanism, cut_joints, result).constraints.cwiseAbs().maxCoeff() > 1e-12L)
    throw std::runtime_error("the loops do not close");
  return result;
}

} // namespace flyball::reference
