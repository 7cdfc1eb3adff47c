#include "engine/kkt/motion_products.hpp"

#include "engine/linear/spectral.hpp"
#include "engine/linear/uniform_random.hpp"
#include "engine/system/constraint_row.hpp"

namespace flyball {
namespace {

// Of a matrix without negative eigenvalues.
Mat3 square_root(const Mat3& a) {
  const auto axes = principal_axes((a + a.transpose()) / 2);
  if (!axes) return Mat3::Constant(std::numeric_limits<double>::quiet_NaN()); // spreads to all that follows
  return axes->vectors * axes->values.cwiseMax(0).cwiseSqrt().asDiagonal() * axes->vectors.transpose();
}

Eigen::VectorXd any_motion(int size) {
  std::mt19937 random(7);
  Eigen::VectorXd x(size);
  for (double& entry : x)
    entry = uniform(random, -1, 1);
  return x;
}

} // namespace

void MotionProducts::linearize(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
                               const Residual<double>& residual) {
  with_momenta_ = with_stiffness_ = true;
  take_in(problem, z, k, residual);
  number_momenta();
  velocity_matters_ = has_dampers_ || (problem.parameters.moving && coriolis_matters());
}

void MotionProducts::linearize_forces(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
                                      const Residual<double>& residual, bool with_stiffness) {
  with_momenta_ = false;
  with_stiffness_ = with_stiffness;
  take_in(problem, z, k, residual);
}

void MotionProducts::take_in(const Problem& problem, const Unknowns& z, const Kinematics<double>& k,
                             const Residual<double>& residual) {
  coordinates_ = problem.system.nv;
  rows_ = problem.system.rows;
  has_dampers_ = false;
  add_links(problem, z.q, k, residual);
  add_body_forces(problem, k);
  if (with_stiffness_) add_pairs(problem, z, k);
  add_dampers(problem, k);
  set_rows(problem, k);
}

void MotionProducts::add_links(const Problem& problem, const Eigen::VectorXd& q, const Kinematics<double>& k,
                               const Residual<double>& residual) {
  const System& system = problem.system;
  nodes_.clear();
  node_of_link_.assign(system.links.size(), -1);
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    const Link& link = system.links[l];
    if (!link.mobile) continue;
    node_of_link_[l] = static_cast<int>(nodes_.size());
    Node& n = nodes_.emplace_back();
    n.link = static_cast<int>(l);
    n.parent = node_at(link.parent);
    n.arm = k.links[l].o - k.at(link.parent).o;
    n.load << residual.moment[l], residual.force[l];
    set_body(problem, k, n);
    set_joint(problem, q, k, n);
  }
}

void MotionProducts::set_body(const Problem& problem, const Kinematics<double>& k, Node& n) {
  const auto l = static_cast<std::size_t>(n.link);
  const LinkParameters& lp = problem.parameters.links[l];
  n.damping.setZero();
  BodyInertia& body = n.body;
  if (with_stiffness_)
    set_body_stiffness(problem.parameters, l, k, body, n.stiffness);
  else
    set_body_inertia(problem.parameters, l, k, body);
  body.turning = 0;
  if (body.massless()) return;
  n.stiff = with_stiffness_;
  n.heavy = true;
  if (with_momenta_) {
    const Mat3& r = k.links[l].R;
    n.root_of_mass = std::sqrt(lp.mass);
    n.centre = r * lp.com;
    n.root_of_inertia = lp.has_inertia ? square_root(r * lp.inertia * r.transpose()) : Mat3(Mat3::Zero());
  }
  if (!problem.parameters.moving) return;
  n.damped = true;
  n.damping = coriolis_matrix(body, k.links[l].w);
}

void MotionProducts::set_joint(const Problem& problem, const Eigen::VectorXd& q, const Kinematics<double>& k,
                               Node& n) {
  const auto l = static_cast<std::size_t>(n.link);
  const Link& link = problem.system.links[l];
  const LinkParameters& lp = problem.parameters.links[l];
  n.v = link.v;
  n.axes.setZero();
  n.joint.setZero();
  n.damper.setZero();
  if (n.v < 0) return;
  n.columns = link.type == LinkType::spherical ? 3 : 1;
  n.angular = k.columns[static_cast<std::size_t>(n.v)].angular;
  for (int c = 0; c < n.columns; ++c)
    n.axes.col(c) = problem.scaling.column[n.v + c] * k.columns[static_cast<std::size_t>(n.v + c)].axis;
  if (n.columns == 3) {
    if (lp.elastic) n.joint = rotation_stiffness(link, lp, q);
    n.damper = rotation_damping(link, lp, q);
  } else {
    const double unit = problem.scaling.column[n.v] * problem.scaling.column[n.v];
    n.joint(0, 0) = lp.elastic ? lp.force[0].curvature(q[link.q]) * unit : 0;
    n.damper(0, 0) = coordinate_damping(problem.system, problem.parameters, n.link, k) * unit;
  }
  has_dampers_ |= !n.damper.isZero(0);
}

void MotionProducts::add_body_forces(const Problem& problem, const Kinematics<double>& k) {
  for (std::size_t i = 0; i < problem.system.body_forces.size(); ++i) {
    const BodyForceElement& e = problem.system.body_forces[i];
    const BodyForceParameters& f = problem.parameters.body_forces[i];
    const int at = node_at(e.link);
    if (at < 0) continue;
    Node& n = node(at);
    if (with_stiffness_) {
      add_body_force(e, f, k, n.stiffness);
      n.stiff = true;
    }
    if (!is_of_air(f.type)) continue;
    add_air_damping(e, f, k, n.damping);
    n.damped = has_dampers_ = true;
  }
}

void MotionProducts::add_pair(const PairEnds& ends, const PairBlocks& blocks) {
  const Pair& x = pairs_.emplace_back(Pair{node_at(ends.a), node_at(ends.b), blocks});
  if (x.a >= 0) node(x.a).wrench += blocks.on_a;
  if (x.b >= 0) node(x.b).wrench += blocks.on_b;
}

void MotionProducts::add_pairs(const Problem& problem, const Unknowns& z, const Kinematics<double>& k) {
  const System& system = problem.system;
  const Parameters& p = problem.parameters;
  pairs_.clear();
  for (Node& n : nodes_)
    n.wrench.setZero();
  for (std::size_t i = 0; i < system.springs.size(); ++i)
    add_pair(system.springs[i].ends,
             spring_blocks(system.springs[i], p.springs[i], k, p.moving, Lines::exact));
  for (std::size_t i = 0; i < system.cut_dampers.size() && p.moving; ++i)
    add_pair(system.cut_dampers[i].ends, damper_blocks(system.cut_dampers[i], p.cut_dampers[i], k));
  for (std::size_t c = 0; c < system.cuts.size(); ++c) {
    const CutJoint& cut = system.cuts[c];
    if (cut.type == JointType::gear) continue;
    PairBlocks sum;
    sum.set_zero();
    for (std::size_t r = 0; r < cut.rows.size(); ++r)
      sum += row_blocks(cut, p.cuts[c], cut.rows[r], z.lambda[cut.first_row + static_cast<int>(r)], k,
                        Lines::exact);
    add_pair(cut.ends, sum);
  }
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& n = nodes_[i];
    n.load += n.wrench;
    if (n.parent >= 0) node(n.parent).wrench += about(n.wrench, n.arm);
  }
}

void MotionProducts::add_damper(const PairEnds& ends, const PairDamping& damping) {
  if (damping.damping == 0) return;
  dampers_.push_back({node_at(ends.a), node_at(ends.b), damping});
  has_dampers_ = true;
}

void MotionProducts::add_dampers(const Problem& problem, const Kinematics<double>& k) {
  const System& system = problem.system;
  const Parameters& p = problem.parameters;
  dampers_.clear();
  for (std::size_t i = 0; i < system.springs.size(); ++i)
    add_damper(system.springs[i].ends, spring_damping(system.springs[i], p.springs[i], k));
  for (std::size_t i = 0; i < system.cut_dampers.size(); ++i)
    add_damper(system.cut_dampers[i].ends, damper_damping(system.cut_dampers[i], p.cut_dampers[i], k));
}

void MotionProducts::set_rows(const Problem& problem, const Kinematics<double>& k) {
  const System& system = problem.system;
  gradients_.clear();
  for (std::size_t c = 0; c < system.cuts.size(); ++c)
    for (std::size_t r = 0; r < system.cuts[c].rows.size(); ++r) {
      const int row = system.cuts[c].first_row + static_cast<int>(r);
      row_gradient(system.cuts[c], problem.parameters.cuts[c], system.cuts[c].rows[r], k,
                   [&](int v, double g) {
                     gradients_.push_back({row, v, g * problem.scaling.row[row] * problem.scaling.column[v]});
                   });
    }
}

// What a random motion of all coordinates lacks no motion has: in a plane a body has three of six, and a
// particle three of its own.
void MotionProducts::number_momenta() {
  constexpr double rounding = 1e-13;
  outwards(any_motion(coordinates_));
  momentum_count_ = 0;
  for (Node& n : nodes_) {
    if (!n.heavy) continue;
    const Vec6 p = momentum_of(n);
    for (int i = 0; i < 6; ++i)
      if (std::abs(p[i]) > rounding * p.norm()) n.momentum[static_cast<std::size_t>(i)] = momentum_count_++;
  }
}

// A mechanism that moves in a plane with its drive's axis feels these forces across its coordinates alone.
bool MotionProducts::coriolis_matters() {
  constexpr double rounding = 1e-12;
  Eigen::VectorXd out;
  velocity(any_motion(coordinates_), out);
  for (const Node& n : nodes_) {
    const Vec3 felt = n.angular ? n.wrench.head<3>() : n.wrench.tail<3>();
    for (int c = 0; c < n.columns; ++c)
      if (std::abs(out[n.v + c]) > rounding * n.axes.col(c).norm() * felt.norm()) return true;
  }
  return false;
}

void MotionProducts::outwards(const Eigen::VectorXd& x) {
  for (Node& n : nodes_) {
    n.motion = n.parent >= 0 ? carried(node(n.parent).motion, n.arm) : Vec6(Vec6::Zero());
    for (int c = 0; c < n.columns; ++c)
      n.motion.segment<3>(n.angular ? 0 : 3) += n.axes.col(c) * x[n.v + c];
  }
}

// From wrenches on the bodies to what the coordinates feel of them: own(node) adds a node's own to those that
// it has, which end up as those of its subtree.
template <class Own>
void MotionProducts::inwards(Eigen::VectorXd& out, Own own) {
  out.resize(coordinates_);
  for (std::size_t i = nodes_.size(); i-- > 0;) {
    Node& n = nodes_[i];
    own(n);
    for (int c = 0; c < n.columns; ++c)
      out[n.v + c] = n.axes.col(c).dot(n.wrench.segment<3>(n.angular ? 0 : 3));
    if (n.parent >= 0) node(n.parent).wrench += about(n.wrench, n.arm);
  }
}

Vec6 MotionProducts::momentum_of(const Node& n) {
  Vec6 p;
  p << n.root_of_inertia * n.motion.head<3>(),
      n.root_of_mass * (n.motion.tail<3>() + n.motion.head<3>().cross(n.centre));
  return p;
}

void MotionProducts::momentum(const Eigen::VectorXd& x, Eigen::VectorXd& out) {
  outwards(x);
  out.resize(momenta());
  for (const Node& n : nodes_) {
    if (!n.heavy) continue;
    const Vec6 p = momentum_of(n);
    for (std::size_t i = 0; i < 6; ++i)
      if (n.momentum[i] >= 0) out[n.momentum[i]] = p[static_cast<Eigen::Index>(i)];
  }
}

void MotionProducts::momentum_transposed(const Eigen::VectorXd& p, Eigen::VectorXd& out) {
  for (Node& n : nodes_)
    n.wrench.setZero();
  inwards(out, [&](Node& n) {
    if (!n.heavy) return;
    Vec6 own = Vec6::Zero();
    for (std::size_t i = 0; i < 6; ++i)
      if (n.momentum[i] >= 0) own[static_cast<Eigen::Index>(i)] = p[n.momentum[i]];
    const Vec3 force = n.root_of_mass * own.tail<3>();
    n.wrench.head<3>() += n.root_of_inertia * own.head<3>() + n.centre.cross(force);
    n.wrench.tail<3>() += force;
  });
}

void MotionProducts::mass(const Eigen::VectorXd& x, Eigen::VectorXd& out) {
  momentum(x, momenta_);
  momentum_transposed(momenta_, out);
}

void MotionProducts::inertia(const Eigen::VectorXd& x, Eigen::VectorXd& out) {
  outwards(x);
  for (Node& n : nodes_)
    n.wrench.setZero();
  inwards(out, [&](Node& n) {
    if (n.heavy) n.wrench += times_inertia(n.body, n.motion);
  });
}

void MotionProducts::velocity(const Eigen::VectorXd& x, Eigen::VectorXd& out) {
  outwards(x);
  for (Node& n : nodes_)
    n.wrench.setZero();
  for (const Damper& d : dampers_) {
    const RowGradient& g = d.pair.rate;
    const double force = d.pair.damping * (g.a.dot(motion_of(d.a)) + g.b.dot(motion_of(d.b)));
    if (d.a >= 0) node(d.a).wrench += force * g.a;
    if (d.b >= 0) node(d.b).wrench += force * g.b;
  }
  inwards(out, [&](Node& n) {
    if (n.damped) n.wrench += n.damping * n.motion;
  });
  for (const Node& n : nodes_)
    if (n.columns > 0)
      out.segment(n.v, n.columns) += n.damper.topLeftCorner(n.columns, n.columns) * x.segment(n.v, n.columns);
}

// With F the load of the subtree and H what its change is beyond turning along with the node: as in
// tree_kkt.hpp a node hands on H + (S dq) x* F.
void MotionProducts::stiffness(const Eigen::VectorXd& x, Eigen::VectorXd& out) {
  outwards(x);
  for (Node& n : nodes_)
    n.wrench.setZero();
  for (const Pair& pair : pairs_) {
    const Vec6 a = motion_of(pair.a), b = motion_of(pair.b);
    if (pair.a >= 0) node(pair.a).wrench += pair.blocks.aa * a + pair.blocks.ab * b;
    if (pair.b >= 0) node(pair.b).wrench += pair.blocks.ba * a + pair.blocks.bb * b;
  }
  inwards(out, [&](Node& n) {
    if (n.stiff) n.wrench += n.stiffness * n.motion;
    for (int c = 0; c < n.columns; ++c) {
      Vec6 step = Vec6::Zero();
      step.segment<3>(n.angular ? 0 : 3) = n.axes.col(c) * x[n.v + c];
      n.wrench += turned(step, n.load.head<3>(), n.load.tail<3>());
    }
  });
  for (const Node& n : nodes_)
    if (n.columns > 0)
      out.segment(n.v, n.columns) += n.joint.topLeftCorner(n.columns, n.columns) * x.segment(n.v, n.columns);
}

double MotionProducts::stiffness_terms(const Eigen::VectorXd& x) {
  Eigen::VectorXd terms;
  stiffness(x, terms);
  for (Node& n : nodes_)
    n.wrench.setZero();
  for (const Pair& pair : pairs_) {
    const Vec6 a = motion_of(pair.a), b = motion_of(pair.b);
    const PairBlocks& k = pair.blocks;
    if (pair.a >= 0) node(pair.a).wrench += (k.aa * a).cwiseAbs() + (k.ab * b).cwiseAbs();
    if (pair.b >= 0) node(pair.b).wrench += (k.ba * a).cwiseAbs() + (k.bb * b).cwiseAbs();
  }
  double square = 0;
  for (Node& n : nodes_) {
    n.wrench += turned(n.motion, n.load.head<3>(), n.load.tail<3>()).cwiseAbs();
    const Eigen::Index at = n.angular ? 0 : 3;
    const Vec3 along = n.axes.transpose() * n.motion.segment<3>(at); // axes are of a scaled unit each
    for (int c = 0; c < n.columns; ++c) {
      const double unit = n.axes.col(c).squaredNorm();
      const double own = n.joint.row(c).cwiseAbs().dot(along.cwiseAbs()) / unit;
      const double between = n.axes.col(c).cwiseAbs().dot(n.wrench.segment<3>(at));
      const double all = std::abs(terms[n.v + c]) + own + between;
      square += all * all;
    }
  }
  return std::sqrt(square);
}

void MotionProducts::constraint(const Eigen::VectorXd& x, Eigen::VectorXd& out) const {
  out.setZero(rows_);
  for (const Gradient& g : gradients_)
    out[g.row] += g.value * x[g.v];
}

void MotionProducts::constraint_transposed(const Eigen::VectorXd& lambda, Eigen::VectorXd& out) const {
  out.setZero(coordinates_);
  for (const Gradient& g : gradients_)
    out[g.v] += g.value * lambda[g.row];
}

} // namespace flyball
